//! A finger near a string.

use crate::contact::ContactLaw;
use crate::gesture::Touch;
use crate::grid::Reading;

/// A finger near the string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finger {
    /// Its parameters.
    pub touch: Touch,
    /// Contact law of its pad.
    pub law: ContactLaw,
    /// How it moves by itself.
    pub(crate) inertia: Inertia,
    /// Height of the pad uⁿ, m.
    pub height: f64,
    /// Motion in the last step uⁿ − uⁿ⁻¹, m.
    pub motion: f64,
    /// Place at n, m from the nut.
    pub position: f64,
    /// Reading of the string under it at n.
    pub reading: Reading,
    /// Reading of the string under it at n − 1.
    pub reading_before: Reading,
}

impl Finger {
    /// The finger before the last step.
    pub(crate) fn back(&self, before: &FingerBefore) -> Finger {
        let FingerBefore { height, motion, reading_before } = *before;
        Finger { height, motion, reading: self.reading_before, reading_before, ..*self }
    }
}

/// How a finger moves between hand and string, at one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Inertia {
    /// k²/(M + Rk/2), what one newton moves it in a step, m/N.
    pub mobility: f64,
    /// (M − Rk/2)/(M + Rk/2), how much of its motion is left after a step.
    pub persistence: f64,
}

impl Inertia {
    /// Of a finger with its hand.
    pub fn new(touch: &Touch, time_step: f64) -> Self {
        let half_loss = 0.5 * touch.hand_damping * time_step;
        let mass = touch.mass + half_loss;
        Inertia { mobility: time_step * time_step / mass, persistence: (touch.mass - half_loss) / mass }
    }
}

/// What a step overwrites of a finger.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FingerBefore {
    /// Height of the pad uⁿ, m.
    pub height: f64,
    /// Motion uⁿ − uⁿ⁻¹, m.
    pub motion: f64,
    /// Reading of the string under it at n − 1.
    pub reading_before: Reading,
}
