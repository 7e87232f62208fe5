//! Where something is that goes from one value to another as hands pull strings, and as labels have it.

use crate::performance::{GestureSink, Moment};

/// From one value to another, slowly at first and at the end: by 3x² − 2x³, as strings are pulled.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Course {
    from: f64,
    /// Where it ends.
    pub to: f64,
    begins: u64,
    ends: u64,
}

impl Course {
    /// At rest at a value.
    pub fn at_rest(value: f64) -> Self {
        Self { from: value, to: value, begins: 0, ends: 0 }
    }

    /// Where it has come.
    pub fn at(&self, time: u64) -> f64 {
        if time >= self.ends {
            return self.to;
        }
        let x = time.saturating_sub(self.begins) as f64 / (self.ends - self.begins) as f64;
        self.from + (self.to - self.from) * x * x * (3.0 - 2.0 * x)
    }

    /// From where it has come it goes elsewhere within so many seconds.
    pub fn turn(&mut self, to: f64, duration: f64, at: &Moment<impl GestureSink>) {
        *self = Self { from: self.at(at.time), to, begins: at.time, ends: at.after(duration) };
    }

    /// How long it takes yet, s.
    pub fn left(&self, at: &Moment<impl GestureSink>) -> f64 {
        self.ends.saturating_sub(at.time) as f64 / at.sample_rate
    }
}
