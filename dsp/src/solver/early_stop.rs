//! What becomes of an iteration that was stopped before its end: forces that create no energy, as near to the
//! solution as can be had for little.

use super::newton::newton_direction;
use super::{Answer, Convergence, EnergyScale, Room, created, evaluate, largest, place};
use crate::active::Active;

/// Attempts of the fallback; its stiffnesses double after the first few, so that long before the last the
/// contacts hardly move at all.
const FALLBACKS: u32 = 60;

/// The part of the present energy that may be taken or given and is left at that.
const NOTHING: f64 = 1e-13;

/// Steps on the way to an answer that neither takes nor gives, and the part of what it did at which that is near enough.
const APPROACHES: usize = 16;
const NEUTRAL: f64 = 1e-3;

/// Attempts in which a secant that pulls may be eased.
const EASINGS: u32 = 6;

/// No secant grows steeper than this over the contact's mobility, a million times as steep as any law: beyond it doubles lose
/// how far the contacts yield, which is what the energy is told from.
const STEEPEST_SECANT: f64 = 1e14;

/// Whether forces that should only push are bounded by what they do together. Between the same grid points
/// barriers may push against each other by any amount that the string does not feel, but then some pull: where
/// the pulls are less than half of the pushes no force is more than twice the net push.
#[inline(always)]
pub(super) fn bounded(contacts: &[Active], forces: &[f64], tolerance: f64) -> bool {
    let (mut pushes, mut pulls, mut mobility) = (0.0, 0.0, 0.0);
    for (contact, force) in contacts.iter().zip(forces) {
        if contact.own_mobility == 0.0 {
            let force = contact.base + force;
            pushes += force.max(0.0);
            pulls -= force.min(0.0);
            mobility = contact.mobility;
        }
    }
    mobility * (pulls - 0.5 * pushes) <= tolerance
}

/// Makes the best of an iteration that did not come to its end, whose forces are `usable` or not. Returns the
/// energy they give to the string, J.
#[cold]
#[inline(never)]
pub(super) fn stop_early(
    contacts: &mut [Active],
    answer: &mut impl Answer,
    room: &mut Room,
    usable: bool,
    scale: EnergyScale,
    convergence: &mut Convergence,
) -> f64 {
    let gain = if usable {
        0.5 * created(contacts, room.forces)
    } else {
        fall_back(contacts, answer, room, convergence)
    };
    let given = 0.5 * demanded(contacts, room.forces);
    if gain <= scale.credit && given.abs() > NOTHING * scale.present {
        return approach(contacts, answer, room, given, scale.credit);
    }
    gain
}

/// Forces that create no energy: f = λ(0) + S r with secants S steep enough. Returns the energy they give to
/// the string, J: not above 0 unless rounding leaves no better.
fn fall_back(
    contacts: &mut [Active],
    answer: &mut impl Answer,
    room: &mut Room,
    convergence: &mut Convergence,
) -> f64 {
    // The secants take the place of the residual, the best forces so far that of the step.
    for (i, contact) in contacts.iter_mut().enumerate() {
        contact.evaluate(0.0);
        room.start[i] = contact.lambda - contact.base;
        room.residual[i] = contact.slope;
    }
    let mut least = f64::INFINITY;
    for attempt in 0..FALLBACKS {
        convergence.fallbacks += 1;
        // x = S(r₀ − Mλ(0) − M x), f = λ(0) + x.
        answer.product(room.start, room.motion);
        for (i, contact) in contacts.iter().enumerate() {
            room.unknown[i] = contact.centre - room.motion[i];
        }
        answer.springs(room.residual, room.unknown);
        for i in 0..contacts.len() {
            room.forces[i] = room.start[i] + room.unknown[i];
        }
        let gain = energy_given(contacts, answer, room);
        if gain <= 0.0 && (attempt >= EASINGS || bounded(contacts, room.forces, 0.0)) {
            return gain;
        }
        if gain < least {
            least = gain;
            room.step.copy_from_slice(room.forces);
        }
        for (i, contact) in contacts.iter().enumerate() {
            let secant = (contact.lambda - (contact.base + room.start[i])) / contact.change;
            let pulls = contact.base + room.forces[i] < 0.0;
            let present = room.residual[i];
            let next = if !secant.is_finite() {
                present
            } else if attempt < EASINGS {
                if pulls { secant.max(0.0) } else { present.max(secant) }
            } else {
                2.0 * present.max(secant)
            };
            room.residual[i] = next.min(STEEPEST_SECANT / (contact.mobility + contact.own_mobility));
        }
    }
    room.forces.copy_from_slice(room.step);
    energy_given(contacts, answer, room)
}

/// Goes on from forces that create nothing, by which the solver gives `given` (negative: takes), J, in the direction of a
/// Newton step as far as it gives nothing: an answer that is not exact, but neither takes energy nor gives any.
fn approach(
    contacts: &mut [Active],
    answer: &mut impl Answer,
    room: &mut Room,
    given: f64,
    credit: f64,
) -> f64 {
    for (i, contact) in contacts.iter().enumerate() {
        room.residual[i] = contact.required - (contact.base + room.forces[i]);
    }
    answer.product(room.residual, room.motion);
    newton_direction(contacts, answer, room);
    let error = largest(room.motion);
    room.start.copy_from_slice(room.forces);
    let (mut best, mut least) = (0.0, given.abs());
    // Lengths of the step with what is left there, which has the sign of `given` up to where it is nothing: one before that place,
    // and one beyond.
    let mut near = (0.0, given.abs());
    let mut beyond: Option<(f64, f64)> = None;
    let mut t = 1.0;
    for attempt in 0..APPROACHES {
        let gain = stretch_to(t, contacts, answer, room);
        let left = given.signum() * 0.5 * demanded(contacts, room.forces);
        if gain <= credit && left.abs() < least && bounded(contacts, room.forces, 0.0) {
            for (i, contact) in contacts.iter().enumerate() {
                room.residual[i] = contact.required - (contact.base + room.forces[i]);
            }
            answer.product(room.residual, room.motion);
            if largest(room.motion) <= 0.5 * error {
                (best, least) = (t, left.abs());
            }
        }
        if least <= NEUTRAL * given.abs() {
            break;
        }
        if left < 0.0 {
            beyond = Some((t, left));
        } else {
            near = (t, left);
        }
        t = match beyond {
            None => 4.0 * t,
            Some(beyond) => {
                // The chord, and every other time beyond it, or the far end would never move.
                let chord = near.0 + (beyond.0 - near.0) * (near.1 / (near.1 - beyond.1)).clamp(0.0, 1.0);
                if attempt % 2 == 0 { chord } else { 0.5 * (chord + beyond.0) }
            }
        };
    }
    stretch_to(best, contacts, answer, room)
}

/// Takes the forces so many steps from the start; returns the energy given to the string, J.
fn stretch_to(t: f64, contacts: &mut [Active], answer: &impl Answer, room: &mut Room) -> f64 {
    place(contacts, answer, room, t);
    0.5 * created(contacts, room.forces)
}

/// Evaluates the laws under the forces beyond the base; returns the energy given to the string, J.
fn energy_given(contacts: &mut [Active], answer: &impl Answer, room: &mut Room) -> f64 {
    evaluate(contacts, answer, room);
    0.5 * created(contacts, room.forces)
}

/// Σ(law − f)r, twice the energy given to the string beyond what the contacts' laws have it get.
fn demanded(contacts: &[Active], forces: &[f64]) -> f64 {
    contacts
        .iter()
        .zip(forces)
        .map(|(contact, force)| (contact.required - (contact.base + force)) * contact.change)
        .sum()
}

#[cfg(test)]
mod tests;
