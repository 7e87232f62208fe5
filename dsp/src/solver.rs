//! The contact forces of one sample: f = law(−c − M f) for all active contacts together.
//!
//! M is symmetric and ≥ 0 and the law non-decreasing, so f is the minimum of a strongly convex function
//! of r: unique, and reached by a line-searched Newton iteration from anywhere. The unknown is f and r is
//! always −c − M f, so that wherever the iteration stops the string really moves by r and only the force
//! law is inexact. An inexact solution may give the string at most as much energy as the contacts give
//! up; if the iteration stops with a solution that would give more, a secant solution that cannot
//! replaces it.

use crate::contact::{Before, ContactLaw};
use crate::grid::Reading;
use crate::response::{Response, Row};
use crate::scene::SolverSettings;

/// One active contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Active {
    /// Index of its force history: contacts first, then fingers.
    pub slot: usize,
    /// The string under it at n + 1.
    pub reading: Reading,
    /// +1 when it pushes the string up (board, fret), −1 when down (finger).
    pub sign: f64,
    /// Contact law.
    pub law: ContactLaw,
    /// P = βK[ηⁿ]^α/(2k), N/m.
    pub lossy: f64,
    /// Penetration and energy at n − 1.
    pub before: Before,
    /// c: the penetration lost between n − 1 and n + 1 were there no contact, m.
    pub opening: f64,
    /// bⁿ⁺¹ − bⁿ⁻¹, how far the barrier itself rose, m.
    pub raised: f64,
    /// k²/(M + Rk/2) of a finger, 0 of the board, m/N.
    pub own_mobility: f64,
    /// k²/(ρhs), m/N.
    pub mobility: f64,
    /// z = (hgᵀv)·sign.
    pub pull: f64,
    /// The force found, N.
    pub force: f64,
    /// The change of penetration, m.
    pub change: f64,
    /// λ at that change, N: what the stored energy explains.
    pub lambda: f64,
    /// The force law at that change, N.
    pub required: f64,
    /// Its slope, N/m.
    pub slope: f64,
    /// The prediction under the contact before its force was spread.
    pub saved: [f64; 4],
}

impl Active {
    /// Evaluates the law at a change of penetration.
    #[inline(always)]
    fn evaluate(&mut self, change: f64) {
        let (lambda, slope) = self.law.gradient(&self.before, change);
        self.change = change;
        self.lambda = lambda;
        let required = lambda + self.lossy * change;
        if required > 0.0 {
            self.required = required;
            self.slope = slope + self.lossy;
        } else {
            self.required = 0.0;
            self.slope = 0.0;
        }
    }
}

impl Row for Active {
    #[inline]
    fn span(&self) -> (usize, usize) {
        (self.reading.first, self.reading.first + 4)
    }
    #[inline]
    fn coupling(&self, other: &Self) -> f64 {
        self.mobility * (self.sign * other.sign * self.reading.overlap(&other.reading))
    }
    #[inline]
    fn own_mobility(&self) -> f64 {
        self.own_mobility
    }
    #[inline]
    fn pull(&self) -> f64 {
        self.pull
    }
}

/// How a sample's contacts were solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Convergence {
    /// Newton iterations taken.
    pub iterations: u32,
    /// Attempts of the secant fallback.
    pub fallbacks: u32,
    /// Number of contacts that were active.
    pub active: u32,
    /// Times the solution was repeated because it drove the string into a further contact.
    pub repeats: u32,
}

/// The energies against which errors are judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EnergyScale {
    /// The present energy, J.
    pub present: f64,
    /// The most energy that inexact solutions may still put in, J.
    pub credit: f64,
}

/// Room to solve the contacts of a sample.
#[derive(Debug, Clone, Default)]
pub(crate) struct Solver {
    pub response: Response,
    residual: Vec<f64>,
    step: Vec<f64>,
    motion: Vec<f64>,
    roots: Vec<f64>,
    unknown: Vec<f64>,
    start: Vec<f64>,
    forces: Vec<f64>,
    /// Fingers near the string that no contact is predicted for.
    pub aside: Vec<Active>,
}

/// Force errors may do at most this part of the present energy as work in a converged sample.
const WORK_TOLERANCE: f64 = 1e-13;

/// Attempts at a shorter step before it is taken as it is; the secant guard still stands behind it.
const LINE_SEARCHES: usize = 12;

/// Attempts of the fallback; its stiffnesses double from the fourth on, so that long before the last
/// the contacts hardly move at all.
const FALLBACKS: u32 = 200;

impl Solver {
    pub fn with_capacity(contacts: usize) -> Self {
        let room = || Vec::with_capacity(contacts);
        Solver {
            response: Response::with_capacity(contacts),
            residual: room(),
            step: room(),
            motion: room(),
            roots: room(),
            unknown: room(),
            start: room(),
            forces: room(),
            aside: Vec::with_capacity(contacts),
        }
    }

    /// Solves for the forces of `rows`, starting from those they hold. Returns the energy, J, that the
    /// solution's inexactness gives to the string (negative: takes from it).
    pub fn solve(
        &mut self,
        rows: &mut [Active],
        pull_factor: f64,
        settings: &SolverSettings,
        scale: EnergyScale,
        convergence: &mut Convergence,
    ) -> f64 {
        let count = rows.len();
        self.response.gather(rows, pull_factor);
        for room in [
            &mut self.residual,
            &mut self.step,
            &mut self.motion,
            &mut self.roots,
            &mut self.unknown,
            &mut self.start,
            &mut self.forces,
        ] {
            room.clear();
            room.resize(count, 0.0);
        }
        for (start, row) in self.start.iter_mut().zip(rows.iter()) {
            *start = row.force;
        }
        self.forces.copy_from_slice(&self.start);
        self.place(rows, 0.0);
        let work_tolerance = WORK_TOLERANCE * scale.present;
        let mut iterations = 0;
        loop {
            let mut work = 0.0;
            for (residual, (row, force)) in self.residual.iter_mut().zip(rows.iter().zip(&self.forces)) {
                *residual = row.required - force;
                work += *residual * row.change;
            }
            self.response.product(&self.residual, &mut self.motion);
            let far = largest(&self.motion);
            // |Mδ| of a full Newton step is at most |M R|.
            if far <= settings.tolerance && work.abs() <= work_tolerance {
                break;
            }
            if iterations == settings.max_iterations {
                break;
            }
            iterations += 1;
            let step = self.newton_step(rows);
            if step == 0.0 {
                break;
            }
        }
        convergence.iterations += iterations as u32;
        let gain = 0.5 * created(rows, &self.forces);
        if gain <= scale.credit {
            for (row, force) in rows.iter_mut().zip(&self.forces) {
                row.force = *force;
            }
            return gain;
        }
        self.fall_back(rows, convergence)
    }

    /// r = −c − M(f + tδ) for the present forces `start` and step δ; evaluates the laws there.
    #[inline(always)]
    fn place(&mut self, rows: &mut [Active], t: f64) {
        for ((force, start), step) in self.forces.iter_mut().zip(&self.start).zip(&self.step) {
            *force = if t == 0.0 { *start } else { start + t * step };
        }
        self.response.product(&self.forces, &mut self.unknown);
        for (row, answer) in rows.iter_mut().zip(&self.unknown) {
            row.evaluate(-row.opening - answer);
        }
    }

    /// One Newton step with a line search; returns the largest change of penetration it made.
    #[inline(always)]
    fn newton_step(&mut self, rows: &mut [Active]) -> f64 {
        // (1 + √D M √D) y = −√D M R, δ = R + √D y.
        for (i, row) in rows.iter().enumerate() {
            self.roots[i] = row.slope.sqrt();
            self.unknown[i] = -self.roots[i] * self.motion[i];
        }
        self.response.solve(&self.roots, &mut self.unknown);
        for i in 0..rows.len() {
            self.step[i] = self.residual[i] + self.roots[i] * self.unknown[i];
        }
        self.response.product(&self.step, &mut self.motion);
        self.start.copy_from_slice(&self.forces);
        // Along the step −(Mδ)ᵀ(law − f) rises monotonically through 0, where the best point is.
        let downhill = -dot(&self.motion, &self.residual);
        let (mut low, mut low_value) = (0.0, downhill);
        let (mut high, mut high_value) = (1.0, f64::INFINITY);
        let mut t = 1.0;
        for _ in 0..LINE_SEARCHES {
            self.place(rows, t);
            let mut value = 0.0;
            for (i, row) in rows.iter().enumerate() {
                value -= self.motion[i] * (row.required - self.forces[i]);
            }
            if value.abs() <= 0.5 * downhill.abs() || (t == 1.0 && value <= 0.0) {
                break;
            }
            if value > 0.0 {
                (high, high_value) = (t, value);
            } else {
                (low, low_value) = (t, value);
            }
            // False position, kept away from the ends of the bracket.
            let fraction = (low_value / (low_value - high_value)).clamp(0.1, 0.9);
            t = low + (high - low) * fraction;
        }
        t * largest(&self.motion)
    }

    /// Forces f = λ(0) + S r with secants S steep enough that no energy is created.
    fn fall_back(&mut self, rows: &mut [Active], convergence: &mut Convergence) -> f64 {
        let count = rows.len();
        for (i, row) in rows.iter_mut().enumerate() {
            row.evaluate(0.0);
            self.start[i] = row.lambda;
            self.residual[i] = row.slope;
        }
        let mut gain = 0.0;
        for attempt in 0..FALLBACKS {
            convergence.fallbacks += 1;
            // y = (1 + √S M √S)⁻¹ √S(−c − Mλ(0)), f = λ(0) + √S y.
            self.response.product(&self.start, &mut self.motion);
            for (i, row) in rows.iter().enumerate() {
                self.roots[i] = self.residual[i].sqrt();
                self.unknown[i] = self.roots[i] * (-row.opening - self.motion[i]);
            }
            self.response.solve(&self.roots, &mut self.unknown);
            for i in 0..count {
                self.forces[i] = self.start[i] + self.roots[i] * self.unknown[i];
            }
            self.response.product(&self.forces, &mut self.motion);
            for (row, answer) in rows.iter_mut().zip(&self.motion) {
                row.evaluate(-row.opening - answer);
            }
            gain = 0.5 * created(rows, &self.forces);
            if gain <= 0.0 {
                break;
            }
            for (i, row) in rows.iter().enumerate() {
                let secant = (row.lambda - self.start[i]) / row.change;
                let raised = if attempt < 4 { self.residual[i] } else { 2.0 * self.residual[i] };
                self.residual[i] = if secant.is_finite() { raised.max(secant) } else { raised };
            }
        }
        for (row, force) in rows.iter_mut().zip(&self.forces) {
            row.force = *force;
        }
        gain
    }
}

/// Σ(λ − f)r, twice the energy given to the string beyond what the contacts gave up.
#[inline(always)]
fn created(rows: &[Active], forces: &[f64]) -> f64 {
    rows.iter().zip(forces).map(|(row, force)| (row.lambda - force) * row.change).sum()
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[inline(always)]
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |most, value| most.max(value.abs()))
}
