//! The contact forces of one sample: f = law(−c − M f) for all active contacts together.
//!
//! M is symmetric and ≥ 0 and the law non-decreasing, so r is the minimum of a strongly convex function:
//! unique, with it f = law(r), and reached by a line-searched Newton iteration from anywhere. The unknown is f and r is
//! always −c − M f, so that wherever the iteration stops the string really moves by r and only the force
//! law is inexact. An inexact solution may give the string at most as much energy as the contacts give
//! up; if the iteration stops with a solution that would give more, a secant solution that cannot
//! replaces it.

mod early_stop;
mod many;

use crate::active::{Active, ActiveSet};
use crate::instructions::Instructions;
use crate::response::{Few, Response, dot};
use crate::roomy::Roomy;
use crate::scene::SolverSettings;
use early_stop::{bounded, stop_early};
use many::Many;

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
#[derive(Debug, Clone)]
pub(crate) struct Solver {
    response: Response,
    /// One array after another of as many numbers as there are contacts.
    room: Roomy<f64>,
    /// Fingers near the string that no contact is predicted for.
    pub aside: ActiveSet,
}

/// How a set of contacts answers forces.
pub(crate) trait Answer {
    /// out = M x.
    fn product(&self, x: &[f64], out: &mut [f64]);
    /// The forces x = D(g − M x) of springs of these slopes D, were the penetrations g without them. In place: g
    /// goes in, x comes out.
    fn springs(&mut self, slopes: &[f64], x: &mut [f64]);
}

/// The arrays of one solution, each with a number for each contact.
struct Room<'a> {
    residual: &'a mut [f64],
    step: &'a mut [f64],
    motion: &'a mut [f64],
    slopes: &'a mut [f64],
    unknown: &'a mut [f64],
    start: &'a mut [f64],
    /// Forces beyond the base.
    forces: &'a mut [f64],
}

/// Arrays of a [`Room`].
const ARRAYS: usize = 7;

impl<'a> Room<'a> {
    #[inline(always)]
    fn new(numbers: &'a mut [f64], count: usize) -> Self {
        let (residual, rest) = numbers.split_at_mut(count);
        let (step, rest) = rest.split_at_mut(count);
        let (motion, rest) = rest.split_at_mut(count);
        let (slopes, rest) = rest.split_at_mut(count);
        let (unknown, rest) = rest.split_at_mut(count);
        let (start, rest) = rest.split_at_mut(count);
        let (forces, _) = rest.split_at_mut(count);
        Room { residual, step, motion, slopes, unknown, start, forces }
    }

    /// The same, lent as a whole: where the arrays are then need not stand in memory for who keeps it.
    #[inline(always)]
    fn lend(&mut self) -> Room<'_> {
        Room {
            residual: self.residual,
            step: self.step,
            motion: self.motion,
            slopes: self.slopes,
            unknown: self.unknown,
            start: self.start,
            forces: self.forces,
        }
    }
}

/// What a solution is judged by.
#[derive(Clone, Copy)]
struct Demands<'a> {
    settings: &'a SolverSettings,
    scale: EnergyScale,
}

/// Force errors may do at most this part of the present energy as work in a converged sample.
const WORK_TOLERANCE: f64 = 1e-15;

/// As much more as the tolerance is wider, 1/m: 1e-13 at 1e-12 m.
const WORK_PER_METRE: f64 = 0.1;

/// Attempts at a shorter step before it is taken as it is; the secant guard still stands behind it.
const LINE_SEARCHES: usize = 12;

impl Solver {
    /// Room for fixed contacts with these spans, in order of place, and so many fingers.
    pub fn with_capacity(spans: &[(usize, usize)], fingers: usize) -> Self {
        let contacts = spans.len() + fingers;
        Solver {
            response: Response::with_capacity(spans, fingers),
            room: Roomy::with_capacity(ARRAYS * contacts),
            aside: ActiveSet::with_capacity(fingers),
        }
    }

    /// Solves for the forces of `contacts`, starting from the changes they expect. Returns the energy, J, that the
    /// solution's inexactness gives to the string (negative: takes from it).
    #[inline(always)]
    pub fn solve(
        &mut self,
        instructions: Instructions,
        contacts: &mut [Active],
        pull_factor: f64,
        settings: &SolverSettings,
        scale: EnergyScale,
        convergence: &mut Convergence,
    ) -> f64 {
        let demands = Demands { settings, scale };
        // The same code for any number of contacts; of a few the compiler knows how many.
        match contacts.len() {
            1 => solve_few::<1>(contacts, pull_factor, demands, convergence),
            2 => solve_few::<2>(contacts, pull_factor, demands, convergence),
            3 => solve_few::<3>(contacts, pull_factor, demands, convergence),
            4 => solve_few::<4>(contacts, pull_factor, demands, convergence),
            5 => solve_few::<5>(contacts, pull_factor, demands, convergence),
            6 => solve_few::<6>(contacts, pull_factor, demands, convergence),
            _ => Many { solver: self, contacts, pull_factor, demands, convergence }.solve(instructions),
        }
    }
}

#[inline(always)]
fn solve_few<const N: usize>(
    contacts: &mut [Active],
    pull_factor: f64,
    demands: Demands,
    convergence: &mut Convergence,
) -> f64 {
    let Some(contacts) = contacts.first_chunk_mut::<N>() else { return 0.0 };
    let mut few = Few::gather(contacts, pull_factor);
    let mut numbers = [[0.0; N]; ARRAYS];
    let room = Room::new(numbers.as_flattened_mut(), N);
    solve(contacts, &mut few, room, demands, convergence)
}

#[inline(always)]
fn solve(
    contacts: &mut [Active],
    answer: &mut impl Answer,
    mut room: Room,
    Demands { settings, scale }: Demands,
    convergence: &mut Convergence,
) -> f64 {
    begin(contacts, answer, &mut room);
    place(contacts, answer, &mut room, 0.0);
    let work_tolerance = WORK_TOLERANCE.max(WORK_PER_METRE * settings.tolerance) * scale.present;
    let mut iterations = 0;
    let mut progress = Progress::default();
    let mut gain;
    let settled = loop {
        let mut work = 0.0;
        let mut created = 0.0;
        for (residual, (contact, force)) in room.residual.iter_mut().zip(contacts.iter().zip(&*room.forces)) {
            let force = contact.base + force;
            *residual = contact.required - force;
            work += *residual * contact.change;
            created += (contact.lambda - force) * contact.change;
        }
        gain = 0.5 * created;
        answer.product(room.residual, room.motion);
        // A full Newton step moves by Mδ, which is no more than M R in the norm of M; the largest number of it may be about twice
        // that of M R.
        let error = largest(room.motion);
        if error <= settings.tolerance && work.abs() <= work_tolerance && gain <= scale.credit {
            break true;
        }
        if iterations >= settings.max_iterations || progress.has_ended(error, contacts) {
            break false;
        }
        iterations += 1;
        if newton_step(contacts, answer, &mut room) == 0.0 {
            break false;
        }
    };
    convergence.iterations += iterations as u32;
    // Written so that what is not a number is refused too.
    let usable = gain <= scale.credit && (settled || bounded(contacts, room.forces, settings.tolerance));
    if !(settled && usable) {
        gain = stop_early(contacts, answer, room.lend(), usable, scale, convergence);
    }
    for (contact, force) in contacts.iter_mut().zip(&*room.forces) {
        contact.force = contact.base + *force;
    }
    gain
}

/// Forces from which to start, were each law a straight line from the change of penetration that is expected on, at which
/// it has been evaluated.
///
/// (Penetrations run smoothly from sample to sample. Forces of stiff contacts do not: continued from the samples
/// before, they take twice as many iterations.)
#[inline(always)]
fn begin(contacts: &[Active], answer: &mut impl Answer, room: &mut Room) {
    for (i, contact) in contacts.iter().enumerate() {
        room.start[i] = contact.required - contact.base;
        room.slopes[i] = contact.slope;
    }
    answer.product(room.start, room.motion);
    for (i, contact) in contacts.iter().enumerate() {
        room.unknown[i] = contact.centre - room.motion[i] - contact.change;
    }
    answer.springs(room.slopes, room.unknown);
    for (start, more) in room.start.iter_mut().zip(&*room.unknown) {
        *start += more;
    }
}

/// Whether the iteration still gets somewhere.
#[derive(Default)]
struct Progress {
    best: f64,
    without: u32,
}

/// Iterations that do not halve the error after which a small one is taken for rounding.
const STALLED: u32 = 4;

/// What is small: this part of the motion without contacts. Rounding of the forces leaves 1e-16 of it in the
/// motion, and the steepest contact makes 1e-8 of that.
const SMALL: f64 = 1e-7;

impl Progress {
    #[inline(always)]
    fn has_ended(&mut self, error: f64, contacts: &[Active]) -> bool {
        if error < 0.5 * self.best || self.best == 0.0 {
            self.best = error;
            self.without = 0;
            return false;
        }
        self.without += 1;
        self.without >= STALLED
            && error <= SMALL * contacts.iter().fold(0.0f64, |most, contact| most.max(contact.centre.abs()))
    }
}

/// r = r₀ − M(f + tδ) from the forces `start` beyond the base and the step δ; evaluates the laws there.
#[inline(always)]
fn place(contacts: &mut [Active], answer: &impl Answer, room: &mut Room, t: f64) {
    for ((force, start), step) in room.forces.iter_mut().zip(&*room.start).zip(&*room.step) {
        *force = if t == 0.0 { *start } else { start + t * step };
    }
    evaluate(contacts, answer, room);
}

/// Evaluates the laws at r = r₀ − M f, for the forces f beyond the base.
#[inline(always)]
fn evaluate(contacts: &mut [Active], answer: &impl Answer, room: &mut Room) {
    answer.product(room.forces, room.unknown);
    for (contact, answer) in contacts.iter_mut().zip(&*room.unknown) {
        contact.evaluate(contact.centre - answer);
    }
}

/// The step δ of Newton's method from the residual R and M R, which stand in `residual` and `motion`:
/// δ = R − D M δ, so δ = R + x with x = D(−M R − M x).
#[inline(always)]
fn newton_direction(contacts: &[Active], answer: &mut impl Answer, room: &mut Room) {
    for (i, contact) in contacts.iter().enumerate() {
        room.slopes[i] = contact.slope;
        room.unknown[i] = -room.motion[i];
    }
    answer.springs(room.slopes, room.unknown);
    for i in 0..contacts.len() {
        room.step[i] = room.residual[i] + room.unknown[i];
    }
}

/// One Newton step with a line search; returns the largest change of penetration it made.
#[inline(always)]
fn newton_step(contacts: &mut [Active], answer: &mut impl Answer, room: &mut Room) -> f64 {
    newton_direction(contacts, answer, room);
    answer.product(room.step, room.motion);
    room.start.copy_from_slice(room.forces);
    // Along the step −(Mδ)ᵀ(law − f) rises monotonically through 0, where the best point is.
    let downhill = -dot(room.motion, room.residual);
    let (mut low, mut low_value) = (0.0, downhill);
    let (mut high, mut high_value) = (1.0, f64::INFINITY);
    let mut t = 1.0;
    for _ in 0..LINE_SEARCHES {
        place(contacts, answer, room, t);
        let mut value = 0.0;
        for (i, contact) in contacts.iter().enumerate() {
            value -= room.motion[i] * (contact.required - (contact.base + room.forces[i]));
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
    t * largest(room.motion)
}

/// Σ(λ − f)r, twice the energy given to the string beyond what the contacts gave up.
#[inline(always)]
fn created(contacts: &[Active], forces: &[f64]) -> f64 {
    contacts
        .iter()
        .zip(forces)
        .map(|(contact, force)| (contact.lambda - (contact.base + force)) * contact.change)
        .sum()
}

#[inline(always)]
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |most, value| most.max(value.abs()))
}
