//! What a player chooses between: the qualities, what they aim at, and the rates of single strings.

use anyhow::Result;
use low_action_dsp::Quality;

use super::scenes::{Kind, SCENES};
use super::settings::{Axis, BASE, Setting, quality, settings};
use super::table::{accuracy, cost, head, mean_load, plain, shown};
use super::{Outcome, frets, losses};

/// Tables of the qualities and of single strings, under their headings.
pub fn tables(outcomes: &[Outcome], chords: &[(Setting, f64)]) -> Result<String> {
    let axis = Axis::Quality;
    let errors = accuracy(axis, &settings(axis), outcomes);
    let mut text = format!("\n### What qualities reach\n\n{}", aims(outcomes));
    text += &format!("\n### Qualities\n\nErrors:\n\n{errors}\nCost and energy:\n\n{}", cost(axis, outcomes));
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

/// The largest of something over scenes of some kinds under a setting, if any of them tells it.
fn largest(
    setting: Setting,
    kinds: &[Kind],
    outcomes: &[Outcome],
    value: fn(&Outcome) -> Option<f64>,
) -> Option<f64> {
    let these = outcomes.iter().filter(|one| one.setting == setting && kinds.contains(&one.kind()));
    these.filter_map(value).max_by(f64::total_cmp)
}

/// What was aimed at, found and met, at a host's 48 kHz.
fn aims(outcomes: &[Outcome]) -> String {
    const BUZZING: &[Kind] = &[Kind::BuzzingLight, Kind::BuzzingHeavy, Kind::EachBuzzing];
    let at = |one: Quality| quality(one, BASE.rate);
    let live = at(Quality::Live);
    let impulses = Outcome::impulses;
    let price =
        |one: Quality| Some(mean_load(&at(one), outcomes)? / mean_load(&at(Quality::Draft), outcomes)?);
    let rows = [
        (
            "`live`: partials of every open string, up to 4 kHz, cents",
            1.0,
            largest(live, &[Kind::Open, Kind::EachOpen], outcomes, |one| one.errors.partials()),
        ),
        (
            "`live`: pitch of stopped strings before they are put in tune, cents",
            1.0,
            largest(live, &[Kind::Pressed], outcomes, |one| one.errors.pitch()),
        ),
        (
            "`live`: pitch of light strings stopped high on the neck, before they are put in tune, cents",
            1.0,
            largest(live, &[Kind::High], outcomes, |one| one.errors.pitch()),
        ),
        ("`live`: forces of pressed strings, %", 3.0, largest(live, &[Kind::Pressed], outcomes, impulses)),
        ("`live`: buzz, %", 25.0, largest(live, BUZZING, outcomes, impulses)),
        ("`live`: price over that of `draft`", 2.0, price(Quality::Live)),
        ("`studio`: price over that of `draft`", 7.0, price(Quality::Studio)),
        ("`studio`: buzz, %", 15.0, largest(at(Quality::Studio), BUZZING, outcomes, impulses)),
        ("`reference`: price over that of `draft`", 20.0, price(Quality::Reference)),
        ("`reference`: buzz, %", 12.0, largest(at(Quality::Reference), BUZZING, outcomes, impulses)),
    ];
    let mut text = head(["at most".into(), "found".into(), String::new()]);
    for (what, aim, found) in rows {
        let met = if found.is_some_and(|found| found <= aim) { "met" } else { "**missed**" };
        text += &format!("| {what} | {} | {} | {met} |\n", plain(aim), shown(found));
    }
    text + "\nOnce an instrument is put in tune, all frets of the electric and acoustic guitars are within a cent at `live` \
            (`tests/tests/instrument/tuning.rs`).\n"
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
