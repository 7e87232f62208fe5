//! How a palm comes to rest on a string. Its flesh gives way by a millimetre, and what lays it down so softly that nothing is heard
//! takes some fifty milliseconds for that, in which a stroke would ring. So the palm falls, too, where a stroke does at the same moment.

use low_action_dsp::Touch;

use crate::performance::technique::{FALLING_PALM, PALM, PALM_LANDING, PALM_RAMP};

/// How it comes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Laying {
    /// Time in which it comes to press, s.
    pub duration: f64,
    /// Force of the stroke for which it falls, N, if it does.
    pub stroke: Option<f64>,
}

/// Where there is time.
pub(super) const GENTLY: Laying = Laying { duration: PALM_RAMP, stroke: None };

impl Laying {
    /// For a stroke of such a force, N, that falls now.
    pub fn for_stroke(force: f64) -> Self {
        Self { duration: PALM_LANDING, stroke: Some(force) }
    }
}

/// How fast each part of a palm falls that is to press with a force (N), for a stroke of another, m/s.
///
/// As fast as is right if nothing but its own hand is to brake it, within some m/R (4 ms), as deep in its flesh as the force will
/// press it. But the string sounds by it, too: for strokes that are not much harder than the palm it falls the more slowly.
pub(super) fn falling(touch: Touch, force: f64, stroke: f64) -> f64 {
    let share = PALM[0].2 * force;
    let depth = libm::pow(share / touch.stiffness, 1.0 / touch.exponent);
    let part = (stroke / (FALLING_PALM * force)).min(1.0);
    part * depth * touch.hand_damping / touch.mass
}
