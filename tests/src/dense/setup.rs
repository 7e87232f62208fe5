//! What the reference needs to know of a scene, and the grid that follows from it.

use nalgebra::DVector;
use std::f64::consts::PI;

use crate::numbers::largest;

/// Straight lines through (argument, value) pairs in ascending order, held constant outside them.
pub type Table = Vec<[f64; 2]>;

/// Which finite-difference formula stands for the string's stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stencil {
    /// Five points, the physical bending stiffness (the paper's).
    Paper,
    /// Five points, bending stiffness shifted so that the leading dispersion error vanishes.
    Corrected,
    /// Seven points: the next dispersion error vanishes as well.
    Wide,
}

/// One fret: place from the nut (m) and absolute height of its crown (m).
#[derive(Clone, Copy, Debug)]
pub struct Fret {
    /// Distance from the nut, m.
    pub position: f64,
    /// Absolute height of the crown, m (0 is the string at rest).
    pub top: f64,
}

/// Where frets act on the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// At their places, by interpolation.
    Exact,
    /// Each on the grid point next to it.
    Nearest,
    /// At their places, the string bending round them within a cell of the grid.
    Kinked,
}

/// What lies under the string.
#[derive(Clone, Debug)]
pub struct Fretboard {
    /// Stiffness K of every contact point, N/m^α.
    pub stiffness: f64,
    /// Exponent α of the contact law, at least 1.
    pub exponent: f64,
    /// Hunt–Crossley damping β of every contact point, s/m.
    pub damping: f64,
    /// Height over place (m, m), or no board at all between the frets.
    pub board: Option<Table>,
    /// Spacing h_ref (m) at which a board point has stiffness K; at spacing h it has K h/h_ref.
    pub board_reference_spacing: Option<f64>,
    /// The frets.
    pub frets: Vec<Fret>,
    /// Where they act.
    pub placement: Placement,
}

/// One pluck: a raised cosine that lets go at its top, at once or by another one.
#[derive(Clone, Copy, Debug)]
pub struct Pluck {
    /// Start t₀, s.
    pub start: f64,
    /// Duration t_p, s.
    pub duration: f64,
    /// How long it takes to let go, t_r, s.
    pub release: f64,
    /// Distance from the nut, m.
    pub position: f64,
    /// Largest force f_p, N, up is positive.
    pub force: f64,
}

/// One finger above the string.
#[derive(Clone, Debug)]
pub struct Finger {
    /// Mass M_f, kg.
    pub mass: f64,
    /// Stiffness K_f of the contact, N/m^α.
    pub stiffness: f64,
    /// Exponent α_f of the contact, at least 1.
    pub exponent: f64,
    /// Hunt–Crossley damping β_f of the contact, s/m.
    pub damping: f64,
    /// Damping R_f by the hand, N s/m.
    pub hand_damping: f64,
    /// Distance from the nut over time (s, m).
    pub position: Table,
    /// Height at the start, m.
    pub height: f64,
    /// Velocity at the start, m/s, up is positive.
    pub velocity: f64,
    /// Force by the player over time (s, N), down is positive.
    pub force: Table,
}

impl Finger {
    /// M̃, the mass that moves as this one does, brakes and all, in steps of k: what is left of a motion after one is exp(−R k/M).
    pub fn mass_in_steps_of(&self, k: f64) -> f64 {
        let left = (-self.hand_damping * k / self.mass).exp();
        if left == 1.0 { self.mass } else { self.hand_damping * k / 2.0 * (1.0 + left) / (1.0 - left) }
    }
}

/// Everything the reference needs to know, in SI units.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Samples per second.
    pub sample_rate: f64,
    /// The stiffness formula.
    pub stencil: Stencil,
    /// Length L, m.
    pub length: f64,
    /// Linear density ρ, kg/m.
    pub linear_density: f64,
    /// Tension T over time (s, N).
    pub tension: Table,
    /// Young's modulus E, Pa.
    pub youngs_modulus: f64,
    /// Radius r of the core, m.
    pub core_radius: f64,
    /// Loss σ₀, 1/s.
    pub loss_0: f64,
    /// Loss σ₁, m²/s.
    pub loss_1: f64,
    /// Whether stretching raises the tension.
    pub tension_modulation: bool,
    /// What a hand laid along the string adds to σ₀ over time (s, 1/s); empty is no hand.
    pub stilling: Table,
    /// Height over place (m, m) at the start; empty is a straight string.
    pub shape: Table,
    /// Velocity over place (m, m/s) at the start, up is positive; empty is a string at rest.
    pub velocity: Table,
    /// Board and frets, if any.
    pub fretboard: Option<Fretboard>,
    /// All plucks.
    pub plucks: Vec<Pluck>,
    /// All fingers.
    pub fingers: Vec<Finger>,
}

impl Setup {
    /// Every force of the scene, pluck or finger, times `factor`.
    pub fn with_forces_scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        scaled.plucks.iter_mut().for_each(|pluck| pluck.force *= factor);
        scaled.fingers.iter_mut().flat_map(|finger| &mut finger.force).for_each(|point| point[1] *= factor);
        scaled
    }

    /// Bending stiffness over density of the material itself, κ² = EI/ρ with I = πr⁴/4.
    fn kappa_squared(&self) -> f64 {
        self.youngs_modulus * PI * self.core_radius.powi(4) / 4.0 / self.linear_density
    }

    /// The stencil's κ₂² and κ₆ at a given spacing and tension.
    pub fn stencil_stiffness(&self, spacing: f64, tension: f64) -> (f64, f64) {
        let kappa_squared = self.kappa_squared();
        let c_squared = tension / self.linear_density;
        let h_squared = spacing * spacing;
        let courant_squared = c_squared / (self.sample_rate * self.sample_rate * h_squared);
        let corrected = kappa_squared + c_squared * h_squared / 12.0 * (1.0 - courant_squared);
        let sixth = (1.0 - courant_squared)
            * h_squared
            * (c_squared * h_squared * (4.0 - courant_squared) / 360.0 + kappa_squared / 6.0);
        match self.stencil {
            Stencil::Paper => (kappa_squared, 0.0),
            Stencil::Corrected => (corrected, 0.0),
            Stencil::Wide => (corrected, sixth),
        }
    }

    /// Γ(x, x): by how much the string itself gives way under one newton at a place x from the nut, m/N, at a tension.
    pub fn flexibility(&self, place: f64, tension: f64) -> f64 {
        let far = self.length - place;
        let straight = place * far / (self.length * tension);
        let rounding = (self.kappa_squared() * self.linear_density / tension).sqrt();
        if rounding == 0.0 {
            return straight;
        }
        // sinh(x) sinh(y)/sinh(x + y) = 1/(coth x + coth y).
        let coth = |x: f64| 1.0 / (x / rounding).tanh();
        straight - rounding / (tension * (coth(place) + coth(far)))
    }

    /// Whether `intervals` grid intervals keep the energy non-negative at the largest tension.
    fn is_stable(&self, intervals: usize) -> bool {
        let (h, k) = (self.length / intervals as f64, 1.0 / self.sample_rate);
        let tension = largest(self.tension.iter().map(|point| point[1]));
        let (kappa2, kappa6) = self.stencil_stiffness(h, tension);
        let courant_squared = tension / self.linear_density * k * k / (h * h);
        let sum = courant_squared
            + 4.0 * kappa2 * k * k / h.powi(4)
            + 16.0 * kappa6 * k * k / h.powi(6)
            + 4.0 * self.loss_1 * k / (h * h);
        // Beyond a Courant number of 1 the corrections change sign and the sum falls again.
        courant_squared <= 1.0 && sum <= 1.0
    }

    /// The finest stable grid: how many intervals N the string is divided into.
    pub fn intervals(&self) -> usize {
        (1..).take_while(|&intervals| self.is_stable(intervals)).last().unwrap_or(0)
    }
}

/// The table's value at `argument`.
pub(super) fn at(table: &Table, argument: f64) -> f64 {
    let after = table.iter().position(|point| point[0] > argument);
    match after {
        None => table.last().map_or(0.0, |point| point[1]),
        Some(0) => table[0][1],
        Some(i) => {
            let ([x0, y0], [x1, y1]) = (table[i - 1], table[i]);
            y0 + (y1 - y0) * (argument - x0) / (x1 - x0)
        }
    }
}

/// The table's mean from one argument to another.
pub(super) fn mean(table: &Table, from: f64, to: f64) -> f64 {
    let between = table.iter().map(|point| point[0]).filter(|&x| from < x && x < to);
    let ends: Vec<_> = [from].into_iter().chain(between).chain([to]).collect();
    let area = |x: f64, y: f64| (at(table, x) + at(table, y)) / 2.0 * (y - x);
    ends.windows(2).map(|pair| area(pair[0], pair[1])).sum::<f64>() / (to - from)
}

/// Weights of the interior points in a straight interpolation at `position`: of the two nodes beside it.
pub fn straight_weights(position: f64, spacing: f64, intervals: usize) -> DVector<f64> {
    DVector::from_fn(intervals - 1, |i, _| (1.0 - (position / spacing - (i + 1) as f64).abs()).max(0.0))
}

/// Weights of the interior points in a cubic interpolation at `position` on `intervals` intervals of width
/// `spacing`: Lagrange's polynomial through the two nearest nodes on either side. Beyond an end the
/// string continues odd.
pub fn weights(position: f64, spacing: f64, intervals: usize) -> DVector<f64> {
    let mut row = DVector::zeros(intervals - 1);
    let place = position / spacing;
    if (place - place.round()).abs() < 1e-9 {
        row[place.round() as usize - 1] = 1.0;
        return row;
    }
    let left = place.floor() as i64;
    let nodes = [left - 1, left, left + 1, left + 2];
    for node in nodes {
        let weight: f64 = nodes
            .iter()
            .filter(|&&other| other != node)
            .map(|&other| (place - other as f64) / (node - other) as f64)
            .product();
        let last = intervals as i64;
        if node < 0 {
            row[(-node) as usize - 1] -= weight;
        } else if node > last {
            row[(2 * last - node) as usize - 1] -= weight;
        } else if node > 0 && node < last {
            row[node as usize - 1] += weight;
        }
    }
    row
}
