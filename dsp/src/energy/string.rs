//! What one string stores and loses, from its shapes at two samples.

use crate::entry::Losses;
use crate::field::{Field, LANES, total};
use crate::model::{Model, Stiffness};
use crate::state::State;

/// The string at the samples n and n + 1, at the nodes in order of place.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Shapes {
    pub now: Vec<f64>,
    pub motion_now: Vec<f64>,
    pub next: Vec<f64>,
    pub motion: Vec<f64>,
}

impl Shapes {
    /// Takes uⁿ and dⁿ, and what the state holds at n + 1. Allocates the first time.
    pub fn take(&mut self, model: &Model, now: &Field, motion_now: &Field, state: &State) {
        let arrays = [
            (&mut self.now, now),
            (&mut self.motion_now, motion_now),
            (&mut self.next, &state.displacement),
            (&mut self.motion, &state.motion),
        ];
        for (array, field) in arrays {
            field.unfold(model.grid.intervals, array);
        }
    }
}

/// Energies of the string and of tension modulation between uⁿ and uⁿ⁺¹, J.
pub(super) fn string_energy(model: &Model, stiffness: &Stiffness, shapes: &Shapes) -> (f64, f64) {
    let (k, h) = (model.grid.time_step, model.grid.spacing);
    let string = &model.string;
    let Shapes { now, next, motion, .. } = shapes;
    let slope = slopes(now, next);
    let kinetic = sum(motion.iter().map(|d| d * d));
    let mut energy = 0.5 * string.linear_density * h / (k * k) * kinetic
        + stiffness_energy(model, stiffness, now, next, slope);
    if string.loss_1 > 0.0 {
        let shear = slopes(motion, motion);
        energy -= 0.5 * string.linear_density * string.loss_1 / (h * k) * shear;
    }
    (energy, stretch_energy(model, slope))
}

/// Energy of tension modulation, J, where the squared differences between neighbours sum up to so much, m².
pub(super) fn stretch_energy(model: &Model, squares: f64) -> f64 {
    let (string, h) = (&model.string, model.grid.spacing);
    if string.tension_modulation {
        string.axial_stiffness() / (8.0 * string.length * h * h) * squares * squares
    } else {
        0.0
    }
}

/// Energy of tension, bending and the stencil's correction between two displacements, J.
fn stiffness_energy(model: &Model, stiffness: &Stiffness, a: &[f64], b: &[f64], slope: f64) -> f64 {
    let h = model.grid.spacing;
    let rho = model.string.linear_density;
    let (second, third) = curvatures(a, b);
    let h3 = h * h * h;
    0.5 * stiffness.tension / h * slope
        + 0.5 * rho * stiffness.kappa_squared / h3 * second
        + 0.5 * rho * stiffness.kappa_6 / (h3 * h * h) * third
}

/// Energy that a change of stiffness puts into the string between uⁿ⁻¹ and uⁿ, J.
pub(super) fn stiffness_change(model: &Model, new: &Stiffness, old: &Stiffness, shapes: &Shapes) -> f64 {
    let Shapes { now, motion_now, .. } = shapes;
    let past: Vec<f64> = now.iter().zip(motion_now).map(|(u, d)| u - d).collect();
    let slope = slopes(now, &past);
    let change = Stiffness {
        tension: new.tension - old.tension,
        kappa_squared: new.kappa_squared - old.kappa_squared,
        kappa_6: new.kappa_6 - old.kappa_6,
    };
    stiffness_energy(model, &change, now, &past, slope)
}

/// Powers lost in the string and to a hand laid along it, which brings its loss σ₀ to `loss_0`, 1/s, together with its own: W,
/// from its motions dⁿ and dⁿ⁺¹; nothing elsewhere.
pub(super) fn string_losses(model: &Model, loss_0: f64, shapes: &Shapes) -> Losses {
    let (now, next) = (&shapes.motion_now, &shapes.motion);
    let (k, h) = (model.grid.time_step, model.grid.spacing);
    let string = &model.string;
    let mut losses = Losses::default();
    if loss_0 > 0.0 {
        let square = sum(now.iter().zip(next).map(|(a, b)| (a + b) * (a + b)));
        let power = |loss: f64| 2.0 * string.linear_density * loss * h * square / (4.0 * k * k);
        losses.loss_0 = power(string.loss_0);
        losses.hand = power(loss_0 - string.loss_0);
    }
    if string.loss_1 > 0.0 {
        let square = sum((1..now.len()).map(|i| {
            let shear = (now[i] - now[i - 1]) + (next[i] - next[i - 1]);
            shear * shear
        }));
        losses.loss_1 = 2.0 * string.linear_density * string.loss_1 * square / (4.0 * k * k * h);
    }
    losses
}

/// A sum in [`LANES`] parts: rounded a few times less than one after another, which the balance of a sample shows.
#[derive(Default)]
struct Sum([f64; LANES]);

impl Sum {
    #[inline(always)]
    fn add(&mut self, index: usize, value: f64) {
        self.0[index % LANES] += value;
    }

    fn total(&self) -> f64 {
        total(&self.0)
    }
}

/// The sum of values, in parts.
fn sum(values: impl Iterator<Item = f64>) -> f64 {
    let mut sum = Sum::default();
    values.enumerate().for_each(|(index, value)| sum.add(index, value));
    sum.total()
}

/// Σ of products of neighbours' differences, (δa)ᵀδb over all intervals.
pub(super) fn slopes(a: &[f64], b: &[f64]) -> f64 {
    sum((1..a.len()).map(|i| (a[i] - a[i - 1]) * (b[i] - b[i - 1])))
}

/// The undivided second difference at an interior node.
#[inline(always)]
fn second(u: &[f64], i: usize) -> f64 {
    (u[i + 1] - u[i]) - (u[i] - u[i - 1])
}

/// Σ(δ²a)(δ²b) over the unknowns, and Σ(δ³a)(δ³b) over the intervals, δ²u vanishing at both ends.
fn curvatures(a: &[f64], b: &[f64]) -> (f64, f64) {
    let (mut second_sum, mut third_sum) = (Sum::default(), Sum::default());
    let (mut a_before, mut b_before) = (0.0, 0.0);
    for i in 1..a.len() - 1 {
        let (va, vb) = (second(a, i), second(b, i));
        second_sum.add(i, va * vb);
        third_sum.add(i, (va - a_before) * (vb - b_before));
        (a_before, b_before) = (va, vb);
    }
    (second_sum.total(), third_sum.total() + a_before * b_before)
}
