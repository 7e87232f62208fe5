//! How well a balance can be known at all.

use super::string::{Shapes, slopes};
use crate::field::LANES;
use crate::model::{Model, Stiffness};
use crate::state::State;
use crate::string::Scratch;

/// What is added and taken off in a step's balance, J, each part as large as it is however much of it cancels:
/// a unit in the last place of this is what rounding may do to the balance.
pub(super) fn gross(
    model: &Model,
    stiffness: &Stiffness,
    shapes: &Shapes,
    state: &State,
    scratch: &Scratch,
) -> f64 {
    let (now, next) = (&shapes.now, &shapes.next);
    let (k, h) = (model.grid.time_step, model.grid.spacing);
    let string = &model.string;
    let square = |array: &[f64]| -> f64 { array.iter().map(|d| d * d).sum() };
    let kinetic =
        0.5 * string.linear_density * h / (k * k) * (square(&shapes.motion_now) + square(&shapes.motion));
    // A difference of neighbours is known no better than they are.
    let size = |i: usize| now[i].abs() + next[i].abs();
    let slope: f64 = (0..model.grid.intervals)
        .map(|i| (size(i) + size(i + 1)) * ((now[i + 1] - now[i]).abs() + (next[i + 1] - next[i]).abs()))
        .sum();
    // Differences of higher order are at most four times as large each.
    let h2 = h * h;
    let per_slope = 0.5 / h
        * (stiffness.tension
            + 4.0 * string.linear_density * (stiffness.kappa_squared + 4.0 * stiffness.kappa_6 / h2) / h2);
    let stretched = if string.tension_modulation {
        let product = slopes(now, next);
        // Where the product all but vanishes what is left of it is what the whole sum was rounded by, and its square
        // never is negative.
        let summed = slope * (1.0 + model.grid.intervals as f64 / (2 * LANES) as f64);
        string.axial_stiffness() / (4.0 * string.length * h2)
            * (product.abs() * slope + f64::EPSILON * summed * summed)
    } else {
        0.0
    };
    // Forces that were taken back in part were rounded as large as they were.
    let forces = scratch.tried;
    let (mut contacts, mut fingers) = (0.0, 0.0);
    for active in scratch.active.iter() {
        let (before, after) = (active.before.penetration, active.before.penetration + active.change);
        let place = before.abs() + active.change.abs() + active.raised.abs();
        let place = place
            + active.reading.of(&state.displacement).abs()
            + active.reading.of(&scratch.displacement).abs();
        contacts += (active.law.force(before) + active.law.force(after) + active.force.abs()) * place;
        // A finger's own motion without contact and its answer to the force may all but cancel.
        let answer = active.own_mobility * active.force.abs();
        fingers += answer * active.force.abs();
    }
    // Each change of penetration is a sum over all forces, and may be off by a last digit for each of them.
    let sums = scratch.active.len() as f64 * scratch.coasting.mobility * forces * forces;
    kinetic + per_slope * slope + stretched + contacts + sums + fingers
}
