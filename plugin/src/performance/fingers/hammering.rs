//! How fast a finger comes that is to make a string sound by itself.

use std::f64::consts::PI;

use super::Fingers;
use crate::performance::technique::*;

impl Fingers {
    /// Speed of a finger that hammers or taps at a place counted in frets, how hard, 0 to 1, in m/s: such that the note is about as
    /// loud as it is plucked as hard at the usual place, on every string, as far as fingers are so fast.
    ///
    /// What a finger stops there, at speed v, had been turning about the saddle: it leaves partial n of a string with the
    /// period T an amplitude of v T / (π² n²). A pluck with the force F, where a part β of the string sounds on its other side,
    /// leaves 2 F L sin(π n β) / (π² n² H), H being the tension: the first partial is the same at v = F sin(π β) / Z, with the
    /// string's wave impedance Z = H T / (2 L).
    pub(super) fn hammer_speed(&self, place: f64, strength: f64) -> f64 {
        let geometry = &self.string.geometry;
        let sounding = geometry.length - self.glided_place(place, false);
        let pluck = self.usual_place.min(FARTHEST_PLUCK * sounding);
        let as_loud = self.hands.pluck_force * libm::sin(PI * pluck / sounding) / geometry.wave_impedance;
        let Hammer { part, slowest, limit, effort } = HAMMER;
        let hardest = part * as_loud;
        // What is asked for over what limits it, where the hardest has 1: no force, no speed.
        let asked = if strength < 1.0 { libm::pow(strength, 1.0 - effort) } else { strength };
        slowest + strength * hardest / (1.0 + asked * hardest / limit)
    }
}
