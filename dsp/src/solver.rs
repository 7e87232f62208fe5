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
mod newton;
mod room;

use crate::active::{Active, ActiveSet};
use crate::instructions::Instructions;
use crate::response::{Few, Response};
use crate::roomy::Roomy;
use crate::scene::SolverSettings;
use early_stop::{bounded, stop_early};
use many::Many;
use newton::{Progress, newton_step};
use room::{ARRAYS, Room};

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

/// Solves for a few contacts. (What a solution that is found at once is made of is lent to nobody, so that it need not stand in
/// memory; one that is not goes on with copies.)
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
    let mut room = Room::new(numbers.as_flattened_mut(), N);
    let first = begin(contacts, &mut few, &mut room, demands);
    if first.settled {
        take(contacts, room.forces);
        return first.gain;
    }
    let (mut few, mut numbers) = (few, numbers);
    let room = Room::new(numbers.as_flattened_mut(), N);
    go_on(contacts, &mut few, room, first, demands, convergence)
}

/// The same for any number, in room that is at hand.
#[inline(always)]
fn solve(
    contacts: &mut [Active],
    answer: &mut impl Answer,
    mut room: Room,
    demands: Demands,
    convergence: &mut Convergence,
) -> f64 {
    let first = begin(contacts, answer, &mut room, demands);
    go_on(contacts, answer, room, first, demands, convergence)
}

/// What is known of forces that have been tried.
#[derive(Clone, Copy)]
struct Judgement {
    /// Whether they will do.
    settled: bool,
    /// How far the contacts would move by what the forces lack, m.
    error: f64,
    /// The energy, J, that they give to the string.
    gain: f64,
}

/// The first forces, and what is to be thought of them.
#[inline(always)]
fn begin(contacts: &mut [Active], answer: &mut impl Answer, room: &mut Room, demands: Demands) -> Judgement {
    start(contacts, answer, room);
    place(contacts, answer, room, 0.0);
    judge(contacts, answer, room, demands)
}

/// Whether the forces will do, whose residual and what it would move are left in the room.
#[inline(always)]
fn judge(
    contacts: &[Active],
    answer: &impl Answer,
    room: &mut Room,
    Demands { settings, scale }: Demands,
) -> Judgement {
    let work_tolerance = WORK_TOLERANCE.max(WORK_PER_METRE * settings.tolerance) * scale.present;
    let mut work = 0.0;
    let mut created = 0.0;
    for (residual, (contact, force)) in room.residual.iter_mut().zip(contacts.iter().zip(&*room.forces)) {
        let force = contact.base + force;
        *residual = contact.required - force;
        work += *residual * contact.change;
        created += (contact.lambda - force) * contact.change;
    }
    let gain = 0.5 * created;
    answer.product(room.residual, room.motion);
    // A full Newton step moves by Mδ, which is no more than M R in the norm of M; the largest number of it may be about twice
    // that of M R.
    let error = largest(room.motion);
    let settled = error <= settings.tolerance && work.abs() <= work_tolerance && gain <= scale.credit;
    Judgement { settled, error, gain }
}

/// Goes on from the first forces for as long as they will not do.
#[inline(always)]
fn go_on(
    contacts: &mut [Active],
    answer: &mut impl Answer,
    mut room: Room,
    first: Judgement,
    demands: Demands,
    convergence: &mut Convergence,
) -> f64 {
    let Demands { settings, scale } = demands;
    let mut iterations = 0;
    let mut progress = Progress::default();
    let mut found = first;
    while !found.settled {
        if iterations >= settings.max_iterations || progress.has_ended(found.error, contacts) {
            break;
        }
        iterations += 1;
        if newton_step(contacts, answer, &mut room) == 0.0 {
            break;
        }
        found = judge(contacts, answer, &mut room, demands);
    }
    convergence.iterations += iterations as u32;
    let Judgement { settled, mut gain, .. } = found;
    // Written so that what is not a number is refused too.
    let usable = gain <= scale.credit && (settled || bounded(contacts, room.forces, settings.tolerance));
    if !(settled && usable) {
        gain = stop_early(contacts, answer, &mut room, usable, scale, convergence);
    }
    take(contacts, room.forces);
    gain
}

/// The forces are those found.
#[inline(always)]
fn take(contacts: &mut [Active], forces: &[f64]) {
    for (contact, force) in contacts.iter_mut().zip(forces) {
        contact.force = contact.base + *force;
    }
}

/// Forces from which to start, were each law a straight line from the change of penetration that is expected on, at which
/// it has been evaluated.
///
/// (Penetrations run smoothly from sample to sample. Forces of stiff contacts do not: continued from the samples
/// before, they take twice as many iterations.)
#[inline(always)]
fn start(contacts: &[Active], answer: &mut impl Answer, room: &mut Room) {
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
