//! The tables of the page, and their comparison with what was committed.

use anyhow::{Context, Result, ensure};
use low_action_dsp::Quality;

use super::scenes::{Kind, SCENES};
use super::settings::{Axis, BASE, Law, Setting, quality, settings};
use super::{Outcome, PAGE, percent};

/// How far a number may be from the one in the table.
#[derive(Clone, Copy)]
struct Agreement {
    /// As a part of it.
    part: f64,
    /// And at least, in the unit of the column: below what anything in it comes to.
    least: f64,
}

/// Errors of what does not depend on how strings bounce change with the scheme alone: a solver that is
/// exact to another last digit does not move them.
const fn smooth(least: f64) -> Agreement {
    Agreement { part: 0.1, least }
}

/// A string that bounces forgets within some contacts where it came from: another last digit is another
/// bounce. The figures then differ as much as between contact laws of neighbouring exponents, by up to half.
const fn bouncing(least: f64) -> Agreement {
    Agreement { part: 0.6, least }
}

/// One column of errors: what it is called, of which scenes, what, and how it is compared.
struct Column {
    name: &'static str,
    of: fn(&Outcome) -> Option<f64>,
    kinds: &'static [Kind],
    median: bool,
    agreement: Agreement,
}

const ALL: &[Kind] = &[Kind::Open, Kind::Pressed, Kind::BuzzingLight, Kind::BuzzingHeavy, Kind::Mixed];

/// A column of the largest error over scenes of some kinds.
const fn worst(
    name: &'static str,
    kinds: &'static [Kind],
    of: fn(&Outcome) -> Option<f64>,
    agreement: Agreement,
) -> Column {
    Column { name, of, kinds, median: false, agreement }
}

/// A column of the median over all scenes.
const fn median(name: &'static str, of: fn(&Outcome) -> Option<f64>, agreement: Agreement) -> Column {
    Column { name, of, kinds: ALL, median: true, agreement }
}

const COLUMNS: &[Column] = &[
    median("waveform, median, %", Outcome::waveform, smooth(0.05)),
    worst("worst, %", ALL, Outcome::waveform, smooth(0.05)),
    worst("pitch, stopped, cents", &[Kind::Pressed], |o| o.errors.pitch(), smooth(0.01)),
    worst("partials, open, cents", &[Kind::Open], |o| o.errors.partials(), smooth(0.01)),
    worst("partials, stopped, cents", &[Kind::Pressed], |o| o.errors.partials(), smooth(0.01)),
    worst("decay, open, %", &[Kind::Open], Outcome::decay, smooth(0.01)),
    worst("impulses, stopped, %", &[Kind::Pressed], Outcome::impulses, smooth(0.01)),
    worst("buzzing, light, %", &[Kind::BuzzingLight], Outcome::impulses, bouncing(0.5)),
    worst("buzzing, heavy, %", &[Kind::BuzzingHeavy], Outcome::impulses, bouncing(0.5)),
    worst("bridge, worst, %", ALL, |o| Some(percent(o.errors.level)), bouncing(0.5)),
    median("spectrum, median, dB", |o| Some(o.errors.spectrum), bouncing(0.3)),
    worst("spectrum, worst, dB", ALL, |o| Some(o.errors.spectrum), bouncing(0.3)),
];

impl Column {
    /// Its number for a setting, if a scene tells it.
    fn value(&self, setting: &Setting, outcomes: &[Outcome]) -> Option<f64> {
        let these = of(setting, outcomes);
        let kind = |outcome: &&Outcome| self.kinds.contains(&outcome.kind());
        let mut values: Vec<f64> = these.filter(kind).filter_map(self.of).collect();
        values.sort_by(f64::total_cmp);
        let place = if self.median { values.len() / 2 } else { values.len().saturating_sub(1) };
        values.get(place).copied()
    }
}

/// A number with about three digits, always written out so that it can be read again.
pub fn plain(value: f64) -> String {
    match value {
        value if value.abs() < 0.995 => format!("{value:.3}"),
        value if value.abs() < 9.95 => format!("{value:.2}"),
        value if value.abs() < 99.5 => format!("{value:.1}"),
        value => format!("{value:.0}"),
    }
}

/// The same, and a dash for what is not measured.
pub fn shown(value: Option<f64>) -> String {
    value.map_or_else(|| "–".into(), plain)
}

/// A whole number, and a dash for what is not measured.
fn shown_whole(value: Option<f64>) -> String {
    value.map_or_else(|| "–".into(), |value| format!("{value:.0}"))
}

/// A power of ten and what it is taken times, and a dash for what is not measured.
fn shown_power(value: Option<f64>) -> String {
    value.map_or_else(|| "–".into(), |value| format!("{value:.0e}"))
}

pub fn head(names: impl IntoIterator<Item = String>) -> String {
    let names: Vec<String> = names.into_iter().collect();
    format!("| | {} |\n|---|{}\n", names.join(" | "), "--:|".repeat(names.len()))
}

/// Errors, a row for each setting.
pub fn accuracy(axis: Axis, settings: &[Setting], outcomes: &[Outcome]) -> String {
    let mut text = head(COLUMNS.iter().map(|column| column.name.to_owned()));
    for setting in settings {
        let cells: Vec<String> =
            COLUMNS.iter().map(|column| shown(column.value(setting, outcomes))).collect();
        text += &format!("| {} | {} |\n", setting.name(axis), cells.join(" | "));
    }
    text
}

/// The mean part of a core that a string takes under a setting, if times were taken.
pub fn mean_load(setting: &Setting, outcomes: &[Outcome]) -> Option<f64> {
    let loads: Vec<f64> = of(setting, outcomes).filter_map(|outcome| outcome.load).collect();
    (!loads.is_empty()).then(|| loads.iter().sum::<f64>() / loads.len() as f64)
}

/// The largest part of the energy that was booked to the solver under a setting, if there is one.
pub fn booked(setting: &Setting, outcomes: &[Outcome]) -> Option<f64> {
    let all = of(setting, outcomes).filter_map(|outcome| outcome.booked);
    all.map(f64::abs).max_by(f64::total_cmp)
}

/// All outcomes of a setting in the scenes of which all tables are made.
pub fn of<'a>(setting: &Setting, outcomes: &'a [Outcome]) -> impl Iterator<Item = &'a Outcome> {
    outcomes.iter().filter(move |outcome| outcome.setting == *setting && outcome.kind().is_main())
}

/// Cost and energy, a row for each setting.
pub fn cost(axis: Axis, outcomes: &[Outcome]) -> String {
    let names = [
        "of a core, a string, %",
        "dearest scene",
        "ns a sample and string",
        "worst sample, iterations",
        "instructions",
        "fallbacks, %",
        "energy booked, at most",
        "deepest, µm",
        "strongest pull, N",
    ];
    let mut text = head(names.map(str::to_owned));
    for setting in &settings(axis) {
        let most = |value: fn(&Outcome) -> f64| of(setting, outcomes).map(value).fold(0.0f64, f64::max);
        let load = mean_load(setting, outcomes);
        let dearest = of(setting, outcomes).filter_map(|outcome| outcome.load).max_by(f64::total_cmp);
        let counted = of(setting, outcomes).find_map(|outcome| outcome.instructions);
        text += &format!(
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
            setting.name(axis),
            shown(load.map(percent)),
            shown(dearest.map(percent)),
            shown_whole(load.map(|load| 1e9 * load / setting.rate)),
            most(|outcome| f64::from(outcome.iterations)),
            shown_whole(counted),
            plain(100.0 * most(|outcome| outcome.fallbacks)),
            shown_power(booked(setting, outcomes)),
            plain(1e6 * most(|outcome| outcome.penetration[0])),
            plain(most(|outcome| outcome.pull)),
        );
    }
    text
}

/// Everything of one setting, a row for each scene.
fn by_scene(setting: &Setting, outcomes: &[Outcome]) -> String {
    let names = [
        "of a core, a string, %",
        "iterations at most",
        "energy booked",
        "deepest, µm (reference)",
        "waveform, %",
        "pitch, cents",
        "partials, cents",
        "decay, %",
        "impulses, %",
        "bridge, %",
        "spectrum, dB",
    ];
    let mut text = head(names.map(str::to_owned));
    for outcome in of(setting, outcomes) {
        let errors = &outcome.errors;
        let [deepest, reference] = outcome.penetration.map(|depth| plain(1e6 * depth));
        let cells = [
            outcome.waveform(),
            errors.pitch(),
            errors.partials(),
            outcome.decay(),
            outcome.impulses(),
            Some(percent(errors.level)),
            Some(errors.spectrum),
        ];
        text += &format!(
            "| {} | {} | {} | {} | {deepest} ({reference}) | {} |\n",
            SCENES[outcome.scene].name,
            shown(outcome.load.map(percent)),
            outcome.iterations,
            shown_power(outcome.booked),
            cells.map(shown).join(" | ")
        );
    }
    text
}

/// Tables of every axis but that of the qualities, under their headings.
pub fn all(outcomes: &[Outcome]) -> String {
    let mut text = String::new();
    for (axis, title) in [
        (Axis::Grid, "Sample rate and stencil (cap 20, tolerance 1e-12 m, every string at the rate)"),
        (Axis::Solver, "Cap and tolerance (wide)"),
        (Axis::Exponent, "Exponent of the contact law (wide, cap 20, tolerance 1e-12 m)"),
        (Axis::Law, "Newton's method or a quadratised law (wide)"),
    ] {
        let errors = accuracy(axis, &settings(axis), outcomes);
        text +=
            &format!("\n### {title}\n\nErrors:\n\n{errors}\nCost and energy:\n\n{}", cost(axis, outcomes));
    }
    let [live, studio] = [Quality::Live, Quality::Studio].map(|one| quality(one, BASE.rate));
    for (setting, what) in [
        (live, "`live` at 48 kHz, scene by scene"),
        (studio, "`studio` at 48 kHz, scene by scene"),
        (
            Setting { law: Law::Quadratised, rate: 96e3, ..BASE },
            "The quadratised law at 96 kHz, scene by scene",
        ),
    ] {
        text += &format!("\n### {what}\n\n{}", by_scene(&setting, outcomes));
    }
    text + "\n"
}

/// Refuses errors that are not those of the committed tables, column by column.
pub fn compare(now: &str, committed: &str) -> Result<()> {
    let names = COLUMNS.iter().map(|column| column.name.to_owned());
    let title = head(names);
    let first = title.lines().next().unwrap_or_default();
    ensure!(
        committed.contains(first),
        "the table has other columns: run `cargo xtask measure trade --write`"
    );
    for line in now.lines().skip(2) {
        let (name, found) = cells(line).with_context(|| format!("`{line}` is no row"))?;
        let stated = committed.lines().filter_map(cells).find(|(known, _)| *known == name);
        let (_, stated) = stated.with_context(|| format!("{} has no row `{name}`", PAGE))?;
        ensure!(found.len() == stated.len(), "row `{name}` has other columns");
        for (column, (found, stated)) in COLUMNS.iter().zip(found.iter().zip(stated)) {
            let (Ok(found), Ok(stated)) = (found.parse::<f64>(), stated.parse::<f64>()) else {
                ensure!(*found == stated, "`{name}`, {}: {found}, but {} says {stated}", column.name, PAGE);
                continue;
            };
            let Agreement { part, least } = column.agreement;
            ensure!(
                (found - stated).abs() <= least.max(part * stated),
                "`{name}`, {}: {found}, but {} says {stated}: if that is meant, run `cargo xtask measure trade --write`",
                column.name,
                PAGE
            );
        }
    }
    Ok(())
}

/// Name and cells of a row.
fn cells(line: &str) -> Option<(&str, Vec<&str>)> {
    let mut cells = line.strip_prefix('|')?.strip_suffix('|')?.split('|').map(str::trim);
    Some((cells.next()?, cells.collect()))
}

#[cfg(test)]
mod tests {
    use super::{COLUMNS, PAGE, cells, compare, head};
    use crate::measure::page;
    use crate::measure::trade::settings::{Axis, quick};

    #[test]
    fn a_changed_number_is_refused_and_a_last_digit_is_not() {
        let names = || COLUMNS.iter().map(|column| column.name.to_owned());
        let table = |first: &str| {
            let rest = " | 2.00".repeat(COLUMNS.len() - 1);
            format!("{}| 48 kHz, wide | {first}{rest} |\n", head(names()))
        };
        assert!(compare(&table("2.06"), &table("2.01")).is_ok());
        let refused = compare(&table("2.51"), &table("2.01")).unwrap_err().to_string();
        assert!(refused.contains(COLUMNS[0].name) && refused.contains("2.51"), "{refused}");
        assert!(compare(&table("–"), &table("2.00")).is_err());
        assert!(compare(&table("2.00"), "nothing").is_err());
        assert!(compare(&table("NaN"), &table("2.00")).is_err());
    }

    /// Of those that `--quick` compares.
    #[test]
    fn no_number_of_the_page_may_double() {
        let committed = page::read(PAGE, &page::marks("trade")).expect("there are tables");
        for axis in [Axis::Quality, Axis::Grid] {
            for setting in quick(axis) {
                let rows = || committed.lines().filter_map(cells);
                let name = setting.name(axis);
                let (_, numbers) = rows().find(|(known, _)| *known == name).expect("it has a row");
                let table = |numbers: &[String]| {
                    let names = COLUMNS.iter().map(|column| column.name.to_owned());
                    format!("{}| {name} | {} |\n", head(names), numbers.join(" | "))
                };
                let numbers: Vec<String> = numbers.into_iter().map(str::to_owned).collect();
                compare(&table(&numbers), &committed).expect("it is what is there");
                for (place, column) in COLUMNS.iter().enumerate() {
                    let mut doubled = numbers.clone();
                    let number: f64 = numbers[place].parse().expect("it is a number");
                    doubled[place] = (2.0 * number).to_string();
                    assert!(compare(&table(&doubled), &committed).is_err(), "{name}, {}", column.name);
                }
            }
        }
    }
}
