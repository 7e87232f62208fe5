//! The sounding mode of a string: open, in closed form; stopped, by inverse iteration.

use nalgebra::Complex;

use super::equilibrium::{Equilibrium, axial_spring, stiffness_at};
use crate::band::{Band, RankOne, dot};
use crate::contact::ContactLaw;
use crate::gesture::Touch;
use crate::grid::Reading;
use crate::model::{Model, Stiffness};

/// Angular frequency of a partial of the open string on its grid, 1/s: the scheme turns a stiffness Λ
/// (1/s²) into the frequency with 4/k² sin²(ωk/2) = Λ.
pub(super) fn open_frequency(model: &Model, partial: usize) -> f64 {
    let grid = &model.grid;
    let own = model.stiffness(model.string.tension);
    let half = libm::sin(0.5 * std::f64::consts::PI * partial as f64 / grid.intervals as f64);
    let s = 4.0 * half * half / (grid.spacing * grid.spacing);
    let stiffness =
        s * (own.tension / model.string.linear_density + s * (own.kappa_squared + s * own.kappa_6));
    realised(stiffness, grid.time_step)
}

/// The wavenumber, 1/m, of what swings at an angular frequency, 1/s, on the grid of a string under a tension, N: the same backwards.
pub(super) fn wavenumber(model: &Model, tension: f64, frequency: f64) -> f64 {
    let grid = &model.grid;
    let own = model.stiffness(model.string.tension);
    let chord = 2.0 / grid.time_step * libm::sin(0.5 * frequency * grid.time_step);
    let square = tension / model.string.linear_density;
    // Bending adds a small part of it to what tension does.
    let s =
        (0..BENDINGS).fold(0.0, |s, _| chord * chord / (square + s * (own.kappa_squared + s * own.kappa_6)));
    2.0 / grid.spacing * libm::asin((0.5 * grid.spacing * s.sqrt()).min(1.0))
}

/// How often that part is found anew: each time it is off by that part of what it was.
const BENDINGS: usize = 8;

/// The frequency that the scheme gives a stiffness, both angular.
fn realised(stiffness: f64, time_step: f64) -> f64 {
    2.0 / time_step * libm::asin((0.5 * time_step * stiffness.max(0.0).sqrt()).min(1.0))
}

/// A finger that rests on a string.
#[derive(Debug, Clone, Copy)]
pub(super) struct Resting<'a> {
    /// The point it rests on.
    pub at: Reading,
    /// The law of its pad.
    pub law: ContactLaw,
    /// The rest of it.
    pub touch: &'a Touch,
    /// What it presses with, N.
    pub force: f64,
}

impl Resting<'_> {
    /// Force per displacement of the string at an angular frequency, N/m: a pad (spring and resistance
    /// side by side) with the finger's mass and the hand's damping behind it. Centred differences in
    /// time turn 1 into cos ωk where a mean of n + 1 and n − 1 acts, iω into i sin(ωk)/k. (The mass is M where steps have M̃, 1 to
    /// 2 % more at 48 kHz for fingers that press: that would move the frets of guitars and basses by less than 1e-4 cents.)
    pub fn stiffness(&self, frequency: f64, time_step: f64) -> Complex<f64> {
        let Self { touch, force, .. } = *self;
        let angle = frequency * time_step;
        let rate = libm::sin(angle) / time_step;
        let chord = 2.0 / time_step * libm::sin(0.5 * angle);
        let spring = self.law.slope(self.law.penetration_at(force));
        let pad = Complex::new(spring * libm::cos(angle), touch.damping * force * rate);
        let hand = Complex::new(-touch.mass * chord * chord, touch.hand_damping * rate);
        pad * hand / (pad + hand)
    }
}

/// Angular frequency, 1/s, of the oscillation about `rest` that is nearest to `near` (1/s) and lives beyond `stop` (m from the nut).
///
/// As far as `still_to`, m from the nut, the string has no mass, and so no oscillations of its own there.
pub(super) fn stopped_frequency(
    model: &Model,
    rest: &Equilibrium,
    finger: &Resting,
    stop: f64,
    near: f64,
    still_to: f64,
) -> f64 {
    let (grid, k) = (&model.grid, model.grid.time_step);
    let node_mass = model.string.linear_density * grid.spacing;
    let mean = libm::cos(near * k);
    let chord = 2.0 / k * libm::sin(0.5 * near * k);
    let mut matrix: Band<Complex<f64>> = stiffness_at(model, rest.tension);
    for (contact, &spring) in model.contacts.iter().zip(&rest.contact_stiffness) {
        if spring > 0.0 {
            matrix.add_spring(&contact.reading, Complex::from(spring * mean));
        }
    }
    matrix.add_spring(&finger.at, finger.stiffness(near, k));
    let shift = node_mass * chord * chord;
    let massless = (1..grid.intervals).take_while(|&node| grid.place(node) <= still_to).count();
    matrix.shift_from(massless, Complex::from(-shift));
    let unit = Stiffness { tension: 1.0, kappa_squared: 0.0, kappa_6: 0.0 };
    let curvature = Band::of_string(grid, 0.0, &unit).times(&rest.displacement);
    let curvature = curvature.into_iter().map(Complex::from).collect();
    // The stretch acts half at n and half as the mean of n + 1 and n − 1.
    let strength = Complex::from(axial_spring(model) * 0.5 * (1.0 + mean));
    let system = RankOne::new(matrix.factor(), curvature, strength);
    let mut shape: Vec<Complex<f64>> = (1..grid.intervals)
        .map(|node| {
            let x = (grid.place(node) - stop) / (model.string.length - stop);
            Complex::from(if x > 0.0 { libm::sin(std::f64::consts::PI * x) } else { 0.0 })
        })
        .collect();
    let mut offset = Complex::from(0.0);
    for _ in 0..ITERATIONS {
        // What has no mass follows, and drives nothing.
        shape[..massless].fill(Complex::from(0.0));
        let next = system.solve(&shape);
        offset = dot(&shape, &shape) / dot(&shape, &next);
        let scale = Complex::from(modulus(dot(&next, &next)).sqrt().recip());
        shape = next.into_iter().map(|x| x * scale).collect();
    }
    let stiffness = (offset + shift) / node_mass;
    realised(stiffness.re, k)
}

/// |x|. (That of `Complex` asks the machine's own mathematics, whose last digits differ.)
fn modulus(x: Complex<f64>) -> f64 {
    libm::hypot(x.re, x.im)
}

/// The shift is within a few per cent of the mode sought and its neighbours a factor of two away, so
/// each iteration gains one to two digits in the shape and twice that in the frequency.
const ITERATIONS: usize = 6;
