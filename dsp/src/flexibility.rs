//! How far a string gives way under a force at one point, and how much of that its grid lacks.
//!
//! A force at a point bends a flexible string to a kink. A grid has no room for one between its points, nor for what is
//! shorter than two spacings: there it gives way too little, by the residual flexibility C = Γ(x, x) − wᵀKₕ⁻¹w. Γ is the static
//! displacement of the string under one newton in the same place, Kₕ the stiffness of the grid, and w = hg the weights by
//! which the place is read and driven. Structural dynamics adds the like to a sum of modes that has been cut short.

use crate::band::{Band, Factored, dot};
use crate::grid::{Grid, Reading};
use crate::model::{Stiffness, StringParameters};

/// A string at rest, on its grid and without one.
pub(crate) struct Flexibility {
    length: f64,
    tension: f64,
    /// √(EI/T), m: over this length bending stiffness rounds a kink.
    rounding: f64,
    grid: Factored<f64>,
    unknowns: usize,
}

impl Flexibility {
    /// Of a string on a grid.
    pub fn new(string: &StringParameters, stiffness: &Stiffness, grid: &Grid) -> Self {
        let bending = string.linear_density * string.kappa_squared();
        Flexibility {
            length: grid.length,
            tension: stiffness.tension,
            rounding: (bending / stiffness.tension).sqrt(),
            grid: Band::of_string(grid, string.linear_density, stiffness).factor(),
            unknowns: grid.unknowns(),
        }
    }

    /// C, m/N, where `reading` reads the place `place`, m from the nut. Negative where the grid gives way too much, for it
    /// does not know how a stiff string resists a kink that is shorter than a spacing.
    pub fn residual(&self, place: f64, reading: &Reading) -> f64 {
        self.of_string(place) - self.of_grid(reading)
    }

    /// Γ(x, x) between simple supports: that of a flexible string, two straight lines, less what bending takes from it.
    fn of_string(&self, place: f64) -> f64 {
        let (near, far, length) = (place, self.length - place, self.length);
        let straight = near * far / length;
        // ℓ sinh(x/ℓ) sinh((L − x)/ℓ)/sinh(L/ℓ), written so that nothing grows.
        let less = |x: f64| if self.rounding > 0.0 { -libm::expm1(-2.0 * x / self.rounding) } else { 1.0 };
        let bent = 0.5 * self.rounding * less(near) * less(far) / less(length);
        (straight - bent) / self.tension
    }

    /// wᵀKₕ⁻¹w, m/N.
    pub fn of_grid(&self, reading: &Reading) -> f64 {
        let mut weights = vec![0.0; self.unknowns];
        for (i, weight) in crate::band::weights(reading) {
            weights[i] += weight;
        }
        dot(&weights, &self.grid.solve(&weights))
    }
}

#[cfg(test)]
mod tests {
    use super::Flexibility;
    use crate::grid::Grid;
    use crate::model::{Stiffness, StringParameters};

    const LENGTH: f64 = 0.65;
    const TENSION: f64 = 72.0;

    fn string(core_radius: f64) -> StringParameters {
        StringParameters {
            length: LENGTH,
            linear_density: 4e-4,
            tension: TENSION,
            tension_limit: TENSION,
            youngs_modulus: 2e11,
            core_radius,
            loss_0: 0.0,
            loss_1: 0.0,
            tension_modulation: false,
        }
    }

    /// Of two straight lines a grid without bending knows all at its points; between them it reads the chord under the kink,
    /// p(1 − p)h/T lower.
    #[test]
    fn between_points_a_flexible_string_lacks_its_kink() {
        let grid = Grid::new(LENGTH, 60, 1e-5);
        let stiffness = Stiffness { tension: TENSION, kappa_squared: 0.0, kappa_6: 0.0 };
        let flexibility = Flexibility::new(&string(0.0), &stiffness, &grid);
        for (cell, p) in [(0, 0.3), (7, 0.0), (20, 0.5), (33, 0.9), (59, 0.7)] {
            let place = (cell as f64 + p) * grid.spacing;
            let residual = flexibility.residual(place, &grid.straight_reading(place));
            let expected = p * (1.0 - p) * grid.spacing / TENSION;
            // A solution of 59 equations whose condition is some 4·60²/π².
            assert!(
                (residual - expected).abs() < 1e-12 * LENGTH / TENSION,
                "{cell} + {p}: {residual:e} {expected:e}"
            );
        }
    }

    /// With bending, and on a grid ever finer, nothing is lacking: the residual falls as the grid's error does, with h².
    #[test]
    fn a_fine_grid_lacks_nothing() {
        let string = string(2.5e-4);
        let residual = |intervals: usize, place: f64| {
            let grid = Grid::new(LENGTH, intervals, 1e-7);
            let stiffness =
                Stiffness { tension: TENSION, kappa_squared: string.kappa_squared(), kappa_6: 0.0 };
            Flexibility::new(&string, &stiffness, &grid).residual(place, &grid.reading(place)).abs()
        };
        for place in [0.2 * LENGTH, 0.01 * LENGTH, 0.77 * LENGTH] {
            // Points of both grids, that nothing but the operator counts.
            let (coarse, fine) = (residual(2000, place), residual(4000, place));
            println!("{place}: {coarse:e}, {fine:e}");
            // A quarter, and what the next order adds; and far less than the h/T that a straight line would lack (5e-4 L/T).
            assert!(fine < 0.3 * coarse && coarse < 1e-5 * LENGTH / TENSION, "{place}: {coarse:e}, {fine:e}");
        }
    }
}
