//! Newton's method: a step of it, searched along its line, and whether another will get anywhere.

use super::{Answer, Room, largest, place};
use crate::active::Active;
use crate::response::dot;

/// Attempts at a shorter step before it is taken as it is; the secant guard still stands behind it.
const LINE_SEARCHES: usize = 12;

/// Whether the iteration still gets somewhere.
#[derive(Default)]
pub(super) struct Progress {
    best: f64,
    without: u32,
}

/// Iterations that do not halve the error after which a small one is taken for rounding.
const STALLED: u32 = 4;

/// What is small: this part of the motion without contacts. Rounding of the forces leaves 1e-16 of it in the
/// motion, and the steepest contact makes 1e-8 of that.
const SMALL: f64 = 1e-7;

impl Progress {
    #[inline(always)]
    pub fn has_ended(&mut self, error: f64, contacts: &[Active]) -> bool {
        if error < 0.5 * self.best || self.best == 0.0 {
            self.best = error;
            self.without = 0;
            return false;
        }
        self.without += 1;
        self.without >= STALLED
            && error <= SMALL * contacts.iter().fold(0.0f64, |most, contact| most.max(contact.centre.abs()))
    }
}

/// The step δ of Newton's method from the residual R and M R, which stand in `residual` and `motion`:
/// δ = R − D M δ, so δ = R + x with x = D(−M R − M x).
#[inline(always)]
pub(super) fn newton_direction(contacts: &[Active], answer: &mut impl Answer, room: &mut Room) {
    for (i, contact) in contacts.iter().enumerate() {
        room.slopes[i] = contact.slope;
        room.unknown[i] = -room.motion[i];
    }
    answer.springs(room.slopes, room.unknown);
    for i in 0..contacts.len() {
        room.step[i] = room.residual[i] + room.unknown[i];
    }
}

/// One Newton step with a line search; returns the largest change of penetration it made.
#[inline(always)]
pub(super) fn newton_step(contacts: &mut [Active], answer: &mut impl Answer, room: &mut Room) -> f64 {
    newton_direction(contacts, answer, room);
    answer.product(room.step, room.motion);
    room.start.copy_from_slice(room.forces);
    // Along the step −(Mδ)ᵀ(law − f) rises monotonically through 0, where the best point is.
    let downhill = -dot(room.motion, room.residual);
    let (mut low, mut low_value) = (0.0, downhill);
    let (mut high, mut high_value) = (1.0, f64::INFINITY);
    let mut t = 1.0;
    for _ in 0..LINE_SEARCHES {
        place(contacts, answer, room, t);
        let mut value = 0.0;
        for (i, contact) in contacts.iter().enumerate() {
            value -= room.motion[i] * (contact.required - (contact.base + room.forces[i]));
        }
        if value.abs() <= 0.5 * downhill.abs() || (t == 1.0 && value <= 0.0) {
            break;
        }
        if value > 0.0 {
            (high, high_value) = (t, value);
        } else {
            (low, low_value) = (t, value);
        }
        // False position, kept away from the ends of the bracket.
        let fraction = (low_value / (low_value - high_value)).clamp(0.1, 0.9);
        t = low + (high - low) * fraction;
    }
    t * largest(room.motion)
}
