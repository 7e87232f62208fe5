//! The string at rest under a finger.

use crate::band::{Band, RankOne, dot, read, weights};
use crate::grid::Reading;
use crate::model::{Model, Stiffness};

/// A string at rest, pressed against whatever is below it.
#[derive(Debug, Clone)]
pub(super) struct Equilibrium {
    /// Displacement at the unknowns, m.
    pub displacement: Vec<f64>,
    /// Tension, raised by stretching, N.
    pub tension: f64,
    /// Stiffness of every contact of the model there, N/m; 0 for those that are not touched.
    pub contact_stiffness: Vec<f64>,
}

/// More Newton steps than any convex problem of this kind has needed.
const MOST_STEPS: usize = 200;

/// A step cut back further than this is taken as it is.
const SHORTEST_STEP: f64 = 1e-9;

/// The forces must balance to this fraction of the finger's.
const BALANCE: f64 = 1e-11;

/// The forces on a displaced string: the gradient of a strictly convex energy.
struct Potential<'a> {
    model: &'a Model,
    at: &'a Reading,
    force: f64,
    linear: Band<f64>,
    /// −δ² over h: the string's stiffness per newton of tension.
    slope: Band<f64>,
    /// EA/L, N/m, or 0.
    stretch: f64,
}

impl Potential<'_> {
    /// Extra tension from stretching and −δ²u/h.
    fn stretched(&self, u: &[f64]) -> (f64, Vec<f64>) {
        let curvature = self.slope.times(u);
        (0.5 * self.stretch * dot(u, &curvature), curvature)
    }

    /// What the forces lack of balance, N at each unknown: the gradient of the energy.
    fn imbalance(&self, u: &[f64]) -> Vec<f64> {
        let (extra, curvature) = self.stretched(u);
        let mut gradient = self.linear.times(u);
        for (value, curved) in gradient.iter_mut().zip(&curvature) {
            *value += extra * curved;
        }
        for contact in &self.model.contacts {
            let force = contact.law.force(contact.height - read(&contact.reading, u));
            if force > 0.0 {
                for (i, weight) in weights(&contact.reading) {
                    gradient[i] -= weight * force;
                }
            }
        }
        for (i, weight) in weights(self.at) {
            gradient[i] += weight * self.force;
        }
        gradient
    }

    /// The Newton step from u.
    fn step(&self, u: &[f64], imbalance: &[f64]) -> Vec<f64> {
        let (extra, curvature) = self.stretched(u);
        let mut matrix = stiffness_at(self.model, self.model.string.tension + extra);
        for contact in &self.model.contacts {
            let slope = contact.law.slope(contact.height - read(&contact.reading, u));
            if slope > 0.0 {
                matrix.add_spring(&contact.reading, slope);
            }
        }
        RankOne::new(matrix.factor(), curvature, self.stretch).solve(imbalance)
    }
}

/// The string's stiffness with another tension but the stencil's own corrections, which belong to the
/// tension at rest.
pub(super) fn stiffness_at<T: crate::band::Number>(model: &Model, tension: f64) -> Band<T> {
    let own = model.stiffness(model.string.tension);
    Band::of_string(&model.grid, model.string.linear_density, &Stiffness { tension, ..own })
}

/// EA/L, N/m, of a string whose stretching counts.
pub(super) fn axial_spring(model: &Model) -> f64 {
    if model.string.tension_modulation { model.string.axial_stiffness() / model.string.length } else { 0.0 }
}

impl Equilibrium {
    /// The rest that a finger's `force` (N, towards the board) at a point leads to. The energy is
    /// strictly convex, so there is exactly one; Newton's method with a search along the step finds it
    /// from any `guess`, sooner from a good one.
    pub fn new(model: &Model, at: &Reading, force: f64, guess: Vec<f64>) -> Equilibrium {
        let unit = Stiffness { tension: 1.0, kappa_squared: 0.0, kappa_6: 0.0 };
        let potential = Potential {
            model,
            at,
            force,
            linear: stiffness_at(model, model.string.tension),
            slope: Band::of_string(&model.grid, 0.0, &unit),
            stretch: axial_spring(model),
        };
        let mut u = guess;
        let mut imbalance = potential.imbalance(&u);
        for _ in 0..MOST_STEPS {
            if dot(&imbalance, &imbalance).sqrt() <= BALANCE * force.abs() {
                break;
            }
            let step = potential.step(&u, &imbalance);
            // Along the step the energy falls while imbalanceᵀstep is positive. Where it has become
            // too negative the step went beyond the minimum and is cut back by the secant.
            let descent = dot(&imbalance, &step);
            let mut part = 1.0;
            (u, imbalance) = loop {
                let trial: Vec<f64> = u.iter().zip(&step).map(|(x, s)| x - part * s).collect();
                let left = potential.imbalance(&trial);
                let rise = -dot(&left, &step);
                if rise <= 0.5 * descent || part < SHORTEST_STEP {
                    break (trial, left);
                }
                part *= (descent / (descent + rise)).max(0.1);
            };
        }
        let (extra, _) = potential.stretched(&u);
        let slope =
            |contact: &crate::model::Contact| contact.law.slope(contact.height - read(&contact.reading, &u));
        let contact_stiffness = model.contacts.iter().map(slope).collect();
        Equilibrium { tension: model.string.tension + extra, contact_stiffness, displacement: u }
    }
}
