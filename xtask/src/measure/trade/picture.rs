//! The Pareto front: error over cost, and why energy is no measure of it.

use anyhow::Result;
use low_action_dsp::{Quality, Stencil};
use low_action_figures::style::colour;
use low_action_figures::{Axis as Scale, Layer, Panel, Sheet, Stroke};

use super::scenes::Kind;
use super::settings::{Axis, BASE, Setting, quality, settings};
use super::table::{self, mean_load, of};
use super::{Outcome, percent};
use crate::stencils::STENCILS;

/// Something that can go wrong, for the vertical axis.
struct Wrong {
    title: &'static str,
    /// What is written along the axis, with the unit.
    label: &'static str,
    /// Both ends of the axis, in the unit of the label.
    range: [f64; 2],
    /// The scenes that are looked at.
    kinds: &'static [Kind],
    /// What it is, in the unit of the label, of a scene that tells it.
    of: fn(&Outcome) -> Option<f64>,
}

const ALL: &[Kind] = &[Kind::Open, Kind::Pressed, Kind::BuzzingLight, Kind::BuzzingHeavy, Kind::Mixed];
/// What is drawn over the cost.
const ERRORS: [Wrong; 4] = [
    Wrong {
        title: "Partials of open strings up to 4 kHz",
        label: "largest error, cents",
        range: [1e-3, 1e2],
        kinds: &[Kind::Open],
        of: |outcome| outcome.errors.partials(),
    },
    Wrong {
        title: "Waveform from the pluck to the first contact",
        label: "largest error, %",
        range: [0.6, 1e2],
        kinds: ALL,
        of: Outcome::waveform,
    },
    Wrong {
        title: "Contact impulses of stopped strings",
        label: "largest error, %",
        range: [1e-3, 1e1],
        kinds: &[Kind::Pressed],
        of: Outcome::impulses,
    },
    Wrong {
        title: "Contact impulses of buzzing strings",
        label: "largest error, %",
        range: [1.0, 1e2],
        kinds: &[Kind::BuzzingLight, Kind::BuzzingHeavy],
        of: Outcome::impulses,
    },
];

/// The largest error of a kind of a setting.
fn largest(wrong: &Wrong, setting: &Setting, outcomes: &[Outcome]) -> f64 {
    let seen = of(setting, outcomes).filter(|outcome| wrong.kinds.contains(&outcome.kind()));
    seen.filter_map(wrong.of).fold(0.0, f64::max)
}

/// Cost of a string, % of a core.
fn cost(setting: &Setting, outcomes: &[Outcome]) -> f64 {
    percent(mean_load(setting, outcomes).expect("all that is drawn is timed"))
}

/// Draws it.
pub fn draw(outcomes: &[Outcome]) -> Result<String> {
    let mut panels: Vec<Panel> = ERRORS.iter().map(|wrong| front(wrong, outcomes)).collect();
    let below = panels.split_off(2);
    let caption = "Each dot is one sample rate with one stencil; the number is the rate in kHz. Lines join the rates \
                   of a stencil, all strings at the same rate; dots of their own colour are the qualities at a host's 48 kHz, each string \
                   at its own. The broken line is the front: for each price the smallest error. Cost: the mean over \
                   all scenes on the machine that wrote the tables. Error: that of the worst scene against the reference. \
                   Below: every row of the tables of rates and of caps, with the largest part of the energy booked to the solver in any scene.";
    Sheet::new("What accuracy costs", caption)
        .row(1200, panels)
        .row(1200, below)
        .row(1200, vec![energy(outcomes)])
        .draw()
}

fn front(wrong: &Wrong, outcomes: &[Outcome]) -> Panel {
    let Wrong { title, label, range: [low, high], .. } = wrong;
    let x = Scale::log("cost of a string, % of a core", 0.4..40.0).ticks(4);
    let mut panel = Panel::new(*title, x, Scale::log(*label, *low..*high).ticks(6));
    let grid = settings(Axis::Grid);
    let place = |setting: &Setting| (cost(setting, outcomes), largest(wrong, setting, outcomes));
    let qualities = Quality::ALL.map(|one| quality(one, BASE.rate));
    let mut best: Vec<(f64, f64)> = grid.iter().chain(&qualities).map(place).collect();
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut least = f64::INFINITY;
    best.retain(|(_, error)| {
        let better = *error < least;
        least = least.min(*error);
        better
    });
    panel = panel.with(Layer::line("front", Stroke::thin(colour::INK).dashed(), best));
    let line = |stencil: Stencil| {
        let own = grid.iter().filter(move |setting| setting.stencil == stencil);
        let mut line: Vec<(f64, f64)> = own.map(place).collect();
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        line
    };
    let others = [line(Stencil::Paper), line(Stencil::Corrected)];
    for (stencil, stroke) in STENCILS {
        let own: Vec<&Setting> = grid.iter().filter(|setting| setting.stencil == stencil).collect();
        let points: Vec<(f64, f64)> = own.iter().map(|setting| place(setting)).collect();
        panel = panel.with(Layer::line(stencil.name(), stroke, points.clone()));
        panel = panel.with(Layer::dots("", stroke, points.clone()));
        if stencil == Stencil::Wide {
            // A little above the dot; the two lowest rates are too near to each other for a word each, and stand to the left.
            let up = |error: f64, part: f64| error * (high / low).powf(part);
            let (near, far): (Vec<_>, Vec<_>) =
                own.iter().zip(points).partition(|(setting, _)| setting.rate < 90e3);
            let left = near.iter().fold(f64::INFINITY, |left, (_, at)| left.min(at.0));
            let top = near.iter().fold(0.0, |top: f64, (_, at)| top.max(at.1));
            let mut words = vec![Layer::words((0.4 * left, up(top, 0.1)), "44.1 and 48")];
            words.extend(far.iter().map(|(setting, at)| {
                // Below the dot where another stencil's line would run through the word.
                let word = (at.0 * 1.02, up(at.1, 0.06));
                let runs_through = |line: &Vec<(f64, f64)>| {
                    height(line, word.0 * 1.1)
                        .is_some_and(|y| (up(word.1, -0.04)..up(word.1, 0.04)).contains(&y))
                };
                let word = if others.iter().any(runs_through) { (at.0 * 0.9, up(at.1, -0.1)) } else { word };
                Layer::words(word, format!("{}", setting.rate / 1e3))
            }));
            panel = panel.with_all(words);
        }
    }
    let wide = line(Stencil::Wide);
    let names = Quality::ALL.iter().zip(&qualities).map(|(one, setting)| {
        let at = place(setting);
        // Where no line runs: below the dot, to the left but for the last; above it where the line is below. The first stands left of
        // all dots.
        let (right, above) = match one {
            Quality::Draft => (0.53, -0.01),
            Quality::Studio if height(&wide, at.0).is_some_and(|line| at.1 > line) => (0.8, 0.08),
            Quality::Live | Quality::Studio => (0.72, -0.09),
            Quality::Reference => (0.9, -0.09),
        };
        Layer::words((at.0 * right, at.1 * (high / low).powf(above)), one.name())
    });
    panel = panel.with_all(names.collect::<Vec<_>>());
    let stroke = Stroke::new(colour::VERMILION);
    panel.with(Layer::dots("qualities at a host's 48 kHz", stroke, qualities.iter().map(place).collect()))
}

/// Where a line runs at a cost, as it is drawn, both by logarithms; nowhere beyond its ends.
fn height(line: &[(f64, f64)], x: f64) -> Option<f64> {
    line.windows(2).find_map(|ends| {
        let [from, to] = [ends[0], ends[1]];
        let part = (x / from.0).ln() / (to.0 / from.0).ln();
        (0.0..=1.0).contains(&part).then(|| from.1 * (to.1 / from.1).powf(part))
    })
}

/// Waveform error over energy booked to the solver: neither tells the other.
fn energy(outcomes: &[Outcome]) -> Panel {
    let x = Scale::log("energy booked to the solver, part of the largest energy", 1e-15..1.0).ticks(8);
    let y = Scale::log("largest error of the waveform, %", 1.0..1e2).ticks(3);
    let booked = |setting: &Setting| table::booked(setting, outcomes).unwrap_or(0.0).max(1e-15);
    let place = |setting: &Setting| (booked(setting), largest(&ERRORS[1], setting, outcomes));
    let mut panel = Panel::new("Energy conserved is not accuracy", x, y);
    for (axis, name, stroke) in [
        (Axis::Grid, "rates and stencils, solved to 1e-12 m", Stroke::new(colour::BLUE)),
        (Axis::Solver, "caps and tolerances, wide", Stroke::new(colour::VERMILION)),
    ] {
        panel = panel.with(Layer::dots(name, stroke, settings(axis).iter().map(place).collect()));
    }
    panel
}
