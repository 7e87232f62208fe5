//! The tables of the page.

use low_action_dsp::Quality;

use super::columns::COLUMNS;
use super::scenes::SCENES;
use super::settings::{Axis, BASE, Law, Setting, quality, settings};
use super::{Outcome, percent};

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
