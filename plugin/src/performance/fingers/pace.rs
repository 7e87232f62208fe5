//! How often hands are given another goal where one follows upon the other, as automation has it, up to one a sample: each begins
//! from rest, so that one after every sample would leave them where they were.

use crate::performance::{GestureSink, Moment};

/// Part of a hand's ramp after which it is given another goal at the soonest.
const PART: f64 = 0.25;

/// When a hand that has been given a goal is to have the next one.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pace {
    /// Earliest sample for it.
    ready: u64,
    /// When it is to have one that has come before that.
    due: Option<u64>,
}

impl Pace {
    /// There is another goal, which takes so long to reach, s. Gives back whether the hand is to have it now; else it is due later.
    pub(crate) fn asks(&mut self, duration: f64, at: &Moment<impl GestureSink>) -> bool {
        let now = at.time >= self.ready;
        if now {
            self.ready = at.after(PART * duration);
        }
        self.due = (!now).then_some(self.ready);
        now
    }

    /// The hand has its last goal, by whatever it was given.
    pub(crate) fn done(&mut self) {
        self.due = None;
    }

    /// When the next goal is due, if one is.
    pub(crate) fn due(&self) -> Option<u64> {
        self.due
    }
}
