//! What drives a string back: tension and bending, as a grid and a stencil have them.

use crate::grid::Grid;
use crate::scene::Stencil;

/// The string's stiffness at one tension: T D_xx − ρκ₂² D_xxxx + ρκ₆ D_xx³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness {
    /// Tension T, N.
    pub tension: f64,
    /// κ₂², m⁴/s²: bending stiffness over linear density, with the stencil's correction.
    pub kappa_squared: f64,
    /// κ₆, m⁶/s²: the sixth-order correction of the wide stencil, 0 in the others.
    pub kappa_6: f64,
}

impl Stiffness {
    /// The stiffness that a stencil gives a string of a tension, N, and a bending κ², m⁴/s².
    pub(super) fn new(
        stencil: Stencil,
        linear_density: f64,
        tension: f64,
        kappa_squared: f64,
        grid: &Grid,
    ) -> Self {
        let (k, h) = (grid.time_step, grid.spacing);
        let c2 = tension / linear_density;
        let courant2 = c2 * k * k / (h * h);
        let corrected = kappa_squared + c2 * h * h / 12.0 * (1.0 - courant2);
        let (kappa_squared, kappa_6) = match stencil {
            Stencil::Paper => (kappa_squared, 0.0),
            Stencil::Corrected => (corrected, 0.0),
            Stencil::Wide => {
                let sixth =
                    (1.0 - courant2) * h * h * (c2 * h * h * (4.0 - courant2) / 360.0 + kappa_squared / 6.0);
                (corrected, sixth)
            }
        };
        Stiffness { tension, kappa_squared, kappa_6 }
    }

    /// λ² + 4κ₂²k²/h⁴ + 16κ₆k²/h⁶ + 4σ₁k/h²: the scheme is stable while this is at most 1.
    pub(crate) fn stability(&self, linear_density: f64, loss_1: f64, grid: &Grid) -> f64 {
        let (k, h2) = (grid.time_step, grid.spacing * grid.spacing);
        let courant2 = self.tension / linear_density * k * k / h2;
        courant2
            + 4.0 * self.kappa_squared * k * k / (h2 * h2)
            + 16.0 * self.kappa_6 * k * k / (h2 * h2 * h2)
            + 4.0 * loss_1 * k / h2
    }
}
