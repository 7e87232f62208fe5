//! Columns of errors: what stands in them, and how nearly it must be what was committed.

use super::scenes::Kind;
use super::settings::Setting;
use super::table::of;
use super::{Outcome, percent};

/// How far a number may be from the one in the table.
#[derive(Clone, Copy)]
pub struct Agreement {
    /// As a part of it.
    pub part: f64,
    /// And at least, in the unit of the column: below what anything in it comes to.
    pub least: f64,
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
pub struct Column {
    pub name: &'static str,
    of: fn(&Outcome) -> Option<f64>,
    kinds: &'static [Kind],
    median: bool,
    pub agreement: Agreement,
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

/// All of them, in the order of the tables.
pub const COLUMNS: &[Column] = &[
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
    pub fn value(&self, setting: &Setting, outcomes: &[Outcome]) -> Option<f64> {
        let these = of(setting, outcomes);
        let kind = |outcome: &&Outcome| self.kinds.contains(&outcome.kind());
        let mut values: Vec<f64> = these.filter(kind).filter_map(self.of).collect();
        values.sort_by(f64::total_cmp);
        let place = if self.median { values.len() / 2 } else { values.len().saturating_sub(1) };
        values.get(place).copied()
    }
}
