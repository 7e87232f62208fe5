//! What a player chooses between: the qualities, and the rates of single strings.

use anyhow::Result;
use low_action_dsp::Quality;

use super::scenes::{Kind, SCENES};
use super::settings::{Axis, BASE, Setting, quality, settings};
use super::table::{accuracy, cost, head, shown};
use super::{Outcome, frets, losses};

/// Tables of the qualities and of single strings, under their headings.
pub fn tables(outcomes: &[Outcome], chords: &[(Setting, f64)]) -> Result<String> {
    let axis = Axis::Quality;
    let errors = accuracy(axis, &settings(axis), outcomes);
    let mut text =
        format!("\n### Qualities\n\nErrors:\n\n{errors}\nCost and energy:\n\n{}", cost(axis, outcomes));
    let [begin, end] = chord_marks();
    text += "\nSix strings fretted and ringing, with all that an instrument does:\n\n";
    text += &format!("{begin}\n{}{end}\n", speeds(chords));
    text += &format!("\n### Single strings\n\nBuzz, and the spacing of the grid:\n\n{}", buzz(outcomes)?);
    text += &format!(
        "\nBuzz under frets of other damping, at 48 kHz against a reference with the same; then how far damping alone \
         moves it at 768 kHz:\n\n{}",
        losses::table(outcomes)
    );
    text += &format!("\nThe light strings of `electric` stopped high on the neck:\n\n{}", high(outcomes));
    text += &format!("\n### Frets\n\n{}", frets::tables(outcomes));
    Ok(text)
}

/// The lines between which the table of the chord stands.
pub fn chord_marks() -> [String; 2] {
    ["<!-- chord -->".into(), "<!-- end of chord -->".into()]
}

/// How many times faster than real time the chord is, between two blank lines.
pub fn speeds(chords: &[(Setting, f64)]) -> String {
    let mut text = format!("\n{}", head(["× real time".into()]));
    for (setting, speed) in chords {
        text += &format!("| {} | {speed:.1} |\n", setting.name(Axis::Quality));
    }
    text + "\n"
}

/// The columns of single strings: all strings at a rate, then qualities at 48 kHz.
fn columns() -> Vec<(Setting, String)> {
    let rates = settings(Axis::String).into_iter().map(|one| (one, one.name(Axis::String)));
    let qualities = [Quality::Live, Quality::Studio, Quality::Reference];
    let qualities = qualities.map(|one| (quality(one, BASE.rate), format!("`{}`", one.name())));
    rates.chain(qualities).collect()
}

/// Buzz of each string of `electric`, and the spacing of its grid.
fn buzz(outcomes: &[Outcome]) -> Result<String> {
    let columns = columns();
    let mut text = head(columns.iter().map(|(_, name)| name.clone()));
    for (index, playing) in SCENES.iter().enumerate().filter(|(_, one)| one.kind == Kind::EachBuzzing) {
        text += &format!("| {}, %", playing.string()?);
        for (setting, _) in &columns {
            let found = outcomes.iter().find(|one| one.scene == index && one.setting == *setting);
            let error = found.and_then(Outcome::impulses);
            text += &format!(" | {} ({:.1} mm)", shown(error), 1e3 * playing.spacing(setting)?);
        }
        text += " |\n";
    }
    Ok(text)
}

/// Pitch and decay of a string stopped high on the neck.
fn high(outcomes: &[Outcome]) -> String {
    let columns = columns();
    let mut text = head(columns.iter().map(|(_, name)| name.clone()).chain(["reference at 768 kHz".into()]));
    for (index, playing) in SCENES.iter().enumerate().filter(|(_, one)| one.kind == Kind::High) {
        let of = |setting: &Setting| {
            outcomes.iter().find(|one| one.scene == index && one.setting == *setting)?.errors.ringing
        };
        let cells = columns.iter().map(|(setting, _)| of(setting));
        let pitch: Vec<String> = cells.clone().map(|one| shown(one.map(|one| one.pitch))).collect();
        let decay: Vec<String> = cells.map(|one| shown(one.map(|one| one.t60[0]))).collect();
        let reference = of(&BASE).map(|one| one.t60[1]);
        text += &format!("| {}, cents off | {} | 0 |\n", playing.name, pitch.join(" | "));
        text += &format!("| {}, T60, s | {} | {} |\n", playing.name, decay.join(" | "), shown(reference));
    }
    text
}
