//! How far a finger still holds the string down that eases off after its note.

use super::{Finger, Fingers, lift_force};
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

/// What a finger does with the string that it stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Grip {
    /// It presses.
    Presses,
    /// It presses just hard enough for the string to stay on the fret: the note is over.
    Holds,
    /// It lets the string up, since a sample.
    Eases { since: u64, manner: Leaving },
}

/// Where a string is held down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Down {
    /// Behind this fret, 0 for none.
    pub fret: usize,
    /// As a part of the way from where it is without that finger to where the fret stops it.
    pub part: f64,
}

impl Down {
    /// On that fret.
    pub fn on(fret: usize) -> Self {
        Self { fret, part: 1.0 }
    }
}

/// A finger that holds the string down so far presses again where it is; otherwise another lands as on a string that is up.
pub(super) const STILL_DOWN: f64 = 0.9;

/// In how many parts of the time since a finger began to ease off it is followed: each exact for a force that stays as it is.
const PARTS: u32 = 32;

impl Fingers {
    /// Where the string is held down by the finger that stops it, or by the capo.
    pub(super) fn down(&self, finger: Option<&Finger>, at: &Moment<impl GestureSink>) -> Down {
        finger.map_or(Down::on(self.capo[1]), |finger| self.held_down(finger, at.time, at.sample_rate))
    }

    /// Where a finger holds the string down at a sample.
    ///
    /// Its force f falls along a ramp to what lifts the finger, and its hand brakes it: R dy/dt = f − Ly/w, if w is the way down and L
    /// what the string pulls with there. The mass counts for nothing in so slow a motion.
    fn held_down(&self, finger: &Finger, time: u64, sample_rate: f64) -> Down {
        let fret = finger.nearest_fret();
        let pull = self.leaving_force(fret);
        let Grip::Eases { since, manner } = finger.grip else { return Down::on(fret) };
        if pull <= 0.0 {
            return Down::on(fret);
        }
        let step_time = time.saturating_sub(since) as f64 / sample_rate / f64::from(PARTS);
        let rise = finger.touch.hand_damping * self.string.depth(fret) / pull;
        let stays = libm::exp(-step_time / rise.max(f64::MIN_POSITIVE));
        let (from, to) = (HOLDING, -lift_force(finger.touch, manner) / pull);
        let follow = |part: f64, step: u32| {
            let x = ((f64::from(step) + 0.5) * step_time / manner.turning).min(1.0);
            let goal = from + (to - from) * x * x * (3.0 - 2.0 * x);
            (goal + (part - goal) * stays).clamp(0.0, 1.0)
        };
        Down { fret, part: (0..PARTS).fold(1.0, follow) }
    }
}
