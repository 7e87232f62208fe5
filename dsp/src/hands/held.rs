//! What hands do to a string for a while: a pluck, a hand laid along it, fingers over it.

use crate::drive::Push;
use crate::gesture::pluck_push;
use crate::grid::Reading;
use crate::ramp::Ramp;

/// A pluck under way.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pluck {
    /// m from the nut.
    pub position: f64,
    pub reading: Reading,
    pub force: f64,
    pub done: u64,
    pub duration: f64,
    pub release: f64,
}

/// A hand laid along the string.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Stilling {
    /// What it adds to the string's loss, 1/s.
    pub(super) loss: f64,
    /// Samples for which it is still there.
    pub(super) left: u64,
    /// Whether the string was played under it: it is that of a player, who goes on when it goes.
    pub(super) is_players: bool,
}

/// A finger of the hands, as far as it is not in the string's state.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Held {
    pub(super) force: Ramp,
    pub(super) position: Ramp,
    pub(super) leaving: bool,
}

impl Pluck {
    /// What it does to the string in the next step, at a rate in Hz.
    pub fn push(&self, rate: f64) -> Push {
        let since = self.done as f64 / rate;
        let force = self.force * pluck_push(since, 1.0 / rate, self.duration, self.release);
        Push { reading: self.reading, force }
    }

    /// The same push in samples of another length, of which there are `factor` for each of the old.
    pub fn resampled(self, factor: f64) -> Self {
        Pluck { done: (self.done as f64 * factor).round() as u64, ..self }
    }
}

impl Stilling {
    /// The same in samples of which there are `factor` for each of the old. What is not over is not over there either: the last
    /// step tells the string that nobody plays it.
    pub fn resampled(self, factor: f64) -> Self {
        let left = ((self.left as f64 * factor).round() as u64).max(u64::from(self.left > 0));
        Stilling { left, ..self }
    }

    /// What it adds in the next step, 1/s.
    #[inline]
    pub(super) fn step(&mut self) -> f64 {
        let Some(left) = self.left.checked_sub(1) else { return 0.0 };
        self.left = left;
        self.loss
    }

    /// Whether the next step is its last, after which nobody plays the string.
    pub(super) fn leaves(&self) -> bool {
        self.left == 1 && self.loss > 0.0 && !self.is_players
    }
}

impl Held {
    /// The same motion over a string `scale` times as long, in samples of which there are `factor` for each
    /// of the old.
    pub fn carried(self, scale: f64, factor: f64) -> Self {
        let position = self.position.map(|place| place * scale).resampled(factor);
        Held { position, force: self.force.resampled(factor), ..self }
    }
}
