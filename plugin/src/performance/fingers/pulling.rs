//! How a finger plucks the string that it leaves for a lower fret.

use low_action_dsp::Gesture;

use super::Fingers;
use crate::performance::technique::*;

impl Fingers {
    /// The pluck of a finger that pulls off a place (m from the nut) to a fret, 0 for the open string: how hard, 0 to 1.
    ///
    /// It takes the string along as far as a pluck of the right hand would. Near to where the string is stopped then that asks for
    /// more force.
    pub(super) fn pull_off_pluck(&self, place: f64, fret: usize, strength: f64) -> Gesture {
        let geometry = &self.string.geometry;
        let stop = fret.max(self.capo[1]).checked_sub(1).and_then(|index| geometry.frets.get(index));
        let stop = stop.copied().unwrap_or(0.0);
        let length = geometry.length - stop;
        let stiffness = |from_end: f64| self.string.stiffness(from_end, length - from_end);
        let usual = stiffness(self.hands.pluck_position.min(FARTHEST_PLUCK * length));
        let here = stiffness((place - stop).max(NEAREST_PLUCK));
        let PullOff { part, hardest, duration, release } = PULL_OFF;
        let force = part * (here / usual).clamp(1.0, hardest) * strength * self.hands.pluck_force;
        Gesture::Pluck { position: place, force, duration, release }
    }
}

/// How fast a finger lets go of a string that it pulls (0 to 1), how hard: faster than before a pluck, for most of what is
/// heard comes from letting go. Fitted to plucks as soft, where letting go at once would be 10 to 20 dB louder.
pub(super) fn letting_go(strength: f64) -> f64 {
    let softness = (1.0 - strength).clamp(0.0, 1.0);
    1.0 - softness * softness * softness
}
