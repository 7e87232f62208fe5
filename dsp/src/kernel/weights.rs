//! The coefficients of a prediction.

use crate::model::{Coasting, Model, Stiffness};

/// Coefficients of one prediction in undivided differences, all times 1/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    /// Of the motion at a point itself.
    pub(super) motion: f64,
    /// Of v, by distance.
    pub(super) near: [f64; 3],
    /// Of v a step ago, taken away.
    pub(super) before: f64,
    /// Of dᵀd and of |δu|² in the energy of the string as a linear one without bending, N/m.
    pub(super) energy: [f64; 2],
}

impl Weights {
    /// The weights of a model at a stiffness and a loss.
    pub fn new(model: &Model, stiffness: &Stiffness, coasting: &Coasting) -> Self {
        let (k, h) = (model.grid.time_step, model.grid.spacing);
        let h2 = h * h;
        let k2 = k * k * coasting.inverse_s;
        let second = k2 * stiffness.tension / (model.string.linear_density * h2);
        let fourth = k2 * stiffness.kappa_squared / (h2 * h2);
        let sixth = k2 * stiffness.kappa_6 / (h2 * h2 * h2);
        let loss = 2.0 * model.string.loss_1 * k * coasting.inverse_s / h2;
        // second·v − fourth·δ²v + sixth·δ⁴v + loss·δ²d, gathered by neighbour; δ²d is what v has changed by.
        Weights {
            motion: coasting.decay,
            near: [second + 2.0 * fourth + 6.0 * sixth + loss, -fourth - 4.0 * sixth, sixth],
            before: loss,
            energy: [0.5 * model.string.linear_density * h / (k * k), 0.5 * stiffness.tension / h],
        }
    }

    /// That energy, J, by dᵀd and |δu|², m².
    #[inline(always)]
    pub fn energy(&self, motion: f64, steepness: f64) -> f64 {
        self.energy[0] * motion + self.energy[1] * steepness
    }
}
