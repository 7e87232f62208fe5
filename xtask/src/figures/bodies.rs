//! Beyond the paper: what a bridge that gives way sends out, and what it takes from the strings.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use low_action_dsp::{Gesture, Instrument, Quality, Setup, TimedGesture};
use low_action_figures::describe::significant;
use low_action_figures::style::colour;
use low_action_figures::{Axis, Layer, Panel, Sheet, Stroke};
use xtask::numbers::largest;

use super::Made;
use super::page::{Claim, Section};
use super::running::Repository;

/// Instruments with a body of their own.
const BODIES: [(&str, Stroke); 3] = [
    ("classical", Stroke::new(colour::VERMILION)),
    ("steel", Stroke::new(colour::BLUE)),
    ("ukulele", Stroke::new(colour::GREEN)),
];

/// Those of its strings that are shown, by index, with their lines.
const STRINGS: [(usize, &str, Stroke); 3] = [
    (0, "E4", Stroke::new(colour::VERMILION)),
    (2, "G3", Stroke::new(colour::GREEN)),
    (5, "E2", Stroke::new(colour::PURPLE)),
];

/// Partials of each.
const PARTIALS: u32 = 12;

/// When partials are looked at first, and how much later again, s.
const FROM: f64 = 0.05;
const LATER: f64 = 0.25;

/// From how far on what is found may differ from the sum of first order, %.
const OFF: f64 = 10.0;

/// Above this decay, 1/s, string and mode swing as one, and a sum of first order means nothing.
const STRONG: f64 = 4.0;

/// A partial of a string.
struct Partial {
    frequency: f64,
    expected: f64,
    found: f64,
}

/// Draws it and compares.
pub fn make(_: &Repository) -> Result<Made> {
    let classical = Setup::builtin("classical").context("it is built in")?;
    let strings = STRINGS.map(|(index, ..)| partials(&classical, index));
    let [first, second, third] = strings;
    let strings = [first?, second?, third?];
    Ok(Made { picture: draw(&strings)?, section: Some(section(&strings)?), sounds: Vec::new() })
}

/// Partials of an open string, plucked so softly that it hardly stretches, and how fast each dies away, 1/s.
fn partials(setup: &Setup, index: usize) -> Result<Vec<Partial>> {
    let alone = Setup { string: vec![setup.string[index].clone()], tuning: 0.0, ..setup.clone() };
    let rate = 48_000.0;
    let mut instrument = Instrument::new(&alone, &Quality::Live.settings(rate))?;
    let pluck = Gesture::Pluck { position: 0.61, force: 1e-3, duration: 1e-4, release: 0.0 };
    instrument.schedule(TimedGesture { time: 0, string: 0, gesture: pluck })?;
    let mut amplitudes = Vec::new();
    for samples in [(FROM * rate) as usize, (LATER * rate) as usize] {
        let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
        instrument.process(&mut left, &mut right);
        amplitudes.push((1..=PARTIALS).map(|n| amplitude(&instrument, n)).collect::<Vec<_>>());
    }
    let fundamental = low_action_dsp::setup::frequency(alone.string[0].pitch);
    let of = |n: u32| Partial {
        frequency: f64::from(n) * fundamental,
        expected: alone.decay(0, f64::from(n)),
        found: libm::log(amplitudes[0][n as usize - 1] / amplitudes[1][n as usize - 1]) / LATER,
    };
    Ok((1..=PARTIALS).map(of).collect())
}

/// How far a partial swings, by where it is and how fast it moves.
fn amplitude(instrument: &Instrument, partial: u32) -> f64 {
    let (grid, state) = (&instrument.model(0).grid, instrument.state(0));
    let wave = PI * f64::from(partial) / grid.intervals as f64;
    let part = |values: &mut dyn Iterator<Item = f64>| -> f64 {
        (1..).zip(values).map(|(node, value)| value * libm::sin(wave * f64::from(node))).sum()
    };
    let (place, motion) = (part(&mut state.displacement()), part(&mut state.motion()));
    let string = &instrument.model(0).string;
    let fundamental = (string.tension / string.linear_density).sqrt() / (2.0 * string.length);
    let half = PI * f64::from(partial) * fundamental * grid.time_step;
    let (still, swing) = ((place - 0.5 * motion) / libm::cos(half), 0.5 * motion / libm::sin(half));
    (still * still + swing * swing).sqrt()
}

/// So many frequencies, Hz, in equal factors.
fn sweep(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
    (0..=count).map(move |i| from * libm::pow(to / from, i as f64 / count as f64))
}

fn draw(strings: &[Vec<Partial>; 3]) -> Result<String> {
    let mut sound = Panel::new(
        "What 1 N on the bridge sends out",
        Axis::log("frequency, Hz", 50.0..1e4).ticks(4),
        Axis::linear("dB over 1 Pa, 1 m in front", -70.0..5.0).cut(),
    );
    for (name, stroke) in BODIES {
        let body = Setup::shipped(name).and_then(|setup| setup.body).context("it has one")?;
        let line = sweep(50.0, 1e4, 800).map(|f| (f, 20.0 * libm::log10(body.sounds(f)))).collect();
        sound = sound.with(Layer::line(name, stroke, line));
    }
    let classical = Setup::builtin("classical").context("it is built in")?;
    let mut times = Panel::new(
        "Decay, classical: lines theory, dots computed",
        Axis::log("frequency, Hz", 50.0..5e3).ticks(4),
        Axis::log("T60, s", 0.3..30.0).ticks(3).cut(),
    );
    for ((index, name, stroke), partials) in STRINGS.into_iter().zip(strings) {
        let lowest = partials[0].frequency;
        let t60 = |rate: f64| libm::log(1000.0) / rate;
        let highest = f64::from(PARTIALS) * lowest;
        let line =
            sweep(lowest, highest, 400).map(|f| (f, t60(classical.decay(index, f / lowest)))).collect();
        let dots = partials.iter().map(|partial| (partial.frequency, t60(partial.found))).collect();
        times = times.with(Layer::line(name, stroke, line)).with(Layer::dots("", stroke, dots));
    }
    let caption = "Left: sound pressure by all modes of each body, in the open. Right: a string loses what its own losses and \
                   the bridge take from it, which is most where the body swings most; dots are partials of open strings, \
                   from 0.05 to 0.3 s.";
    Sheet::new("A bridge that gives way", caption).row(1300, vec![sound, times]).draw()
}

fn section(strings: &[Vec<Partial>; 3]) -> Result<Section> {
    let mut rows = Vec::new();
    for (name, _) in BODIES {
        let body = Setup::shipped(name).and_then(|setup| setup.body).context("it has one")?;
        let level = |f: f64| format!("{:.1}", 20.0 * libm::log10(body.sounds(f))).replace('-', "−");
        rows.push(format!(
            "{name} | {} | {} | {} | {}",
            level(60.0),
            level(200.0),
            level(1000.0),
            level(5000.0)
        ));
    }
    let off = |partial: &&Partial| 100.0 * (partial.found / partial.expected - 1.0).abs();
    let weak = |partial: &&Partial| partial.expected < STRONG;
    let all = || strings.iter().flatten();
    let worst = largest(all().filter(weak).map(|partial| off(&partial)));
    let count = all().filter(weak).count();
    let claims = vec![Claim::ours(
        format!("Partials that lose less than {STRONG} 1/s die away as theory says, within {OFF} %"),
        format!(
            "{count} of {} lose less than {STRONG} 1/s; these within {} %",
            all().count(),
            significant(worst, 2)
        ),
        worst < OFF,
    )];
    Ok(Section::new("Beyond: a bridge that gives way")
        .text(
            "The paper’s string ends at rest. Instruments with a [body](physics.md#a-body) stand on a soundboard that swings \
             with them: it sounds, and it takes from each partial what there is of it in its modes, 2f₁Z Re Y to first order. \
             Partials that meet a mode strongly are no longer those of the string alone; they are shown and not claimed.",
        )
        .picture("Sound pressure over frequency for three bodies, and T60 over frequency for three strings of a classical guitar")
        .claims(claims)
        .text("Sound pressure for 1 N on the bridge, dB over 1 Pa:")
        .table("body | 60 Hz | 200 Hz | 1 kHz | 5 kHz", &rows))
}
