//! What is heard of a string.

use crate::grid::NUT;
use crate::model::Model;
use crate::state::State;

/// Transverse force of the string on the bridge, N, up is positive: −T ∂ₓu + EI ∂ₓₓₓu at x = L, with the
/// stencil's own bending term and the tension raised by stretching.
pub fn bridge_force(model: &Model, state: &State, tension: f64) -> f64 {
    let h = model.grid.spacing;
    let u = &state.displacement;
    let end = NUT + model.grid.intervals;
    let slope = (u[end] - u[end - 1]) / h;
    let last_curvature = ((u[end] - u[end - 1]) - (u[end - 1] - u[end - 2])) / (h * h);
    let stiffness = model.stiffness(tension);
    // ∂ₓₓu vanishes at the bridge, so ∂ₓₓₓu there is minus the last curvature over h.
    -(tension + stretch_tension(model, state)) * slope
        - model.string.linear_density * stiffness.kappa_2 * last_curvature / h
}

/// Tension added by stretching, EA/(2L)·∫(∂ₓu)² dx, N; 0 where the string has no tension modulation.
pub fn stretch_tension(model: &Model, state: &State) -> f64 {
    if !model.string.tension_modulation {
        return 0.0;
    }
    let u = &state.displacement;
    let sum: f64 = (NUT..NUT + model.grid.intervals).map(|i| (u[i + 1] - u[i]).powi(2)).sum();
    model.string.axial_stiffness() / (2.0 * model.string.length * model.grid.spacing) * sum
}
