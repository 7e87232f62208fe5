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
use crate::response::{Few, Response, Row};
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
    /// What the penetration loses between n − 1 and n + 1 besides the string's own motion to n + 1, m.
    pub rest: f64,
    /// The force that the string's prediction already holds, N; 0 when the solution begins.
    pub base: f64,
    /// The change of penetration under the base forces, −c when the solution begins, m.
    pub centre: f64,
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
        self.reading.span()
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
    response: Response,
    /// One array after another of as many numbers as there are contacts.
    room: Vec<f64>,
    /// Fingers near the string that no contact is predicted for.
    pub aside: Vec<Active>,
}

/// How a set of contacts answers forces.
pub(crate) trait Answer {
    /// out = M x.
    fn product(&self, x: &[f64], out: &mut [f64]);
    /// Solves (1 + √D M √D) y = y₀ in place, `roots` being the diagonal of √D.
    fn solve(&mut self, roots: &[f64], y: &mut [f64]);
}

/// The arrays of one solution, each with a number for each contact.
struct Room<'a> {
    residual: &'a mut [f64],
    step: &'a mut [f64],
    motion: &'a mut [f64],
    roots: &'a mut [f64],
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
        let (roots, rest) = rest.split_at_mut(count);
        let (unknown, rest) = rest.split_at_mut(count);
        let (start, rest) = rest.split_at_mut(count);
        let (forces, _) = rest.split_at_mut(count);
        Room { residual, step, motion, roots, unknown, start, forces }
    }
}

/// What a solution is judged by.
#[derive(Clone, Copy)]
struct Demands<'a> {
    settings: &'a SolverSettings,
    scale: EnergyScale,
}

/// Force errors may do at most this part of the present energy as work in a converged sample.
const WORK_TOLERANCE: f64 = 1e-13;

/// Attempts at a shorter step before it is taken as it is; the secant guard still stands behind it.
const LINE_SEARCHES: usize = 12;

/// Attempts of the fallback; its stiffnesses double after the first few, so that long before the last the
/// contacts hardly move at all.
const FALLBACKS: u32 = 60;

/// Steps on the way to an answer that takes nothing, and the part of what was taken at which it is near enough.
const APPROACHES: usize = 16;
const NEUTRAL: f64 = 1e-3;

/// Attempts in which a secant that pulls may be eased.
const EASINGS: u32 = 6;

impl Solver {
    /// Room for fixed contacts with these spans, in order of place, and so many fingers.
    pub fn with_capacity(spans: &[(usize, usize)], fingers: usize) -> Self {
        let contacts = spans.len() + fingers;
        Solver {
            response: Response::with_capacity(spans, fingers),
            room: Vec::with_capacity(ARRAYS * contacts),
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
        let demands = Demands { settings, scale };
        // The same code for any number of contacts; for the usual few the compiler knows how many.
        match rows.len() {
            1 => solve_few::<1>(rows, pull_factor, demands, convergence),
            2 => solve_few::<2>(rows, pull_factor, demands, convergence),
            3 => solve_few::<3>(rows, pull_factor, demands, convergence),
            4 => solve_few::<4>(rows, pull_factor, demands, convergence),
            count => {
                self.response.gather(rows, pull_factor);
                self.room.clear();
                self.room.resize(ARRAYS * count, 0.0);
                let room = Room::new(&mut self.room, count);
                solve(rows, &mut self.response, room, demands, convergence)
            }
        }
    }
}

fn solve_few<const N: usize>(
    rows: &mut [Active],
    pull_factor: f64,
    demands: Demands,
    convergence: &mut Convergence,
) -> f64 {
    let Some(rows) = rows.first_chunk_mut::<N>() else { return 0.0 };
    let mut few = Few::gather(rows, pull_factor);
    let mut numbers = [[0.0; N]; ARRAYS];
    let room = Room::new(numbers.as_flattened_mut(), N);
    solve(rows, &mut few, room, demands, convergence)
}

#[inline(always)]
fn solve(
    rows: &mut [Active],
    answer: &mut impl Answer,
    mut room: Room,
    Demands { settings, scale }: Demands,
    convergence: &mut Convergence,
) -> f64 {
    for (start, row) in room.start.iter_mut().zip(rows.iter()) {
        *start = row.force - row.base;
    }
    place(rows, answer, &mut room, 0.0);
    let work_tolerance = WORK_TOLERANCE * scale.present;
    let mut iterations = 0;
    let mut progress = Progress::default();
    let settled = loop {
        let mut work = 0.0;
        for (residual, (row, force)) in room.residual.iter_mut().zip(rows.iter().zip(&*room.forces)) {
            *residual = row.required - (row.base + force);
            work += *residual * row.change;
        }
        answer.product(room.residual, room.motion);
        // |Mδ| of a full Newton step is at most |M R|.
        let error = largest(room.motion);
        if error <= settings.tolerance && work.abs() <= work_tolerance {
            break true;
        }
        if iterations >= settings.max_iterations || progress.has_ended(error, rows) {
            break false;
        }
        iterations += 1;
        if newton_step(rows, answer, &mut room) == 0.0 {
            break false;
        }
    };
    convergence.iterations += iterations as u32;
    let mut gain = 0.5 * created(rows, room.forces);
    // Written so that what is not a number is refused too.
    let usable = gain <= scale.credit && (settled || bounded(rows, room.forces, settings.tolerance));
    if !(settled && usable) {
        gain = stop_early(rows, answer, &mut room, usable, scale, convergence);
    }
    for (row, force) in rows.iter_mut().zip(&*room.forces) {
        row.force = row.base + *force;
    }
    gain
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
    fn has_ended(&mut self, error: f64, rows: &[Active]) -> bool {
        if error < 0.5 * self.best || self.best == 0.0 {
            self.best = error;
            self.without = 0;
            return false;
        }
        self.without += 1;
        self.without >= STALLED
            && error <= SMALL * rows.iter().fold(0.0f64, |most, row| most.max(row.centre.abs()))
    }
}

/// Whether forces that should only push are bounded by what they do together. Between the same grid points
/// barriers may push against each other by any amount that the string does not feel, but then some pull: where
/// the pulls are less than half of the pushes no force is more than the net push and a half.
#[inline(always)]
fn bounded(rows: &[Active], forces: &[f64], tolerance: f64) -> bool {
    let (mut pushes, mut pulls, mut mobility) = (0.0, 0.0, 0.0);
    for (row, force) in rows.iter().zip(forces) {
        if row.own_mobility == 0.0 {
            let force = row.base + force;
            pushes += force.max(0.0);
            pulls -= force.min(0.0);
            mobility = row.mobility;
        }
    }
    mobility * (pulls - 0.5 * pushes) <= tolerance
}

/// r = r₀ − M(f + tδ) from the forces `start` beyond the base and the step δ; evaluates the laws there.
#[inline(always)]
fn place(rows: &mut [Active], answer: &impl Answer, room: &mut Room, t: f64) {
    for ((force, start), step) in room.forces.iter_mut().zip(&*room.start).zip(&*room.step) {
        *force = if t == 0.0 { *start } else { start + t * step };
    }
    answer.product(room.forces, room.unknown);
    for (row, answer) in rows.iter_mut().zip(&*room.unknown) {
        row.evaluate(row.centre - answer);
    }
}

/// The step δ of Newton's method from the residual R and M R, which stand in `residual` and `motion`:
/// (1 + √D M √D) y = −√D M R, δ = R + √D y.
#[inline(always)]
fn newton_direction(rows: &[Active], answer: &mut impl Answer, room: &mut Room) {
    for (i, row) in rows.iter().enumerate() {
        room.roots[i] = row.slope.sqrt();
        room.unknown[i] = -room.roots[i] * room.motion[i];
    }
    answer.solve(room.roots, room.unknown);
    for i in 0..rows.len() {
        room.step[i] = room.residual[i] + room.roots[i] * room.unknown[i];
    }
}

/// One Newton step with a line search; returns the largest change of penetration it made.
#[inline(always)]
fn newton_step(rows: &mut [Active], answer: &mut impl Answer, room: &mut Room) -> f64 {
    newton_direction(rows, answer, room);
    answer.product(room.step, room.motion);
    room.start.copy_from_slice(room.forces);
    // Along the step −(Mδ)ᵀ(law − f) rises monotonically through 0, where the best point is.
    let downhill = -dot(room.motion, room.residual);
    let (mut low, mut low_value) = (0.0, downhill);
    let (mut high, mut high_value) = (1.0, f64::INFINITY);
    let mut t = 1.0;
    for _ in 0..LINE_SEARCHES {
        place(rows, answer, room, t);
        let mut value = 0.0;
        for (i, row) in rows.iter().enumerate() {
            value -= room.motion[i] * (row.required - (row.base + room.forces[i]));
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

/// Makes the best of an iteration that did not come to its end, whose forces are `usable` or not. Returns the
/// energy they give to the string, J.
#[cold]
#[inline(never)]
fn stop_early(
    rows: &mut [Active],
    answer: &mut impl Answer,
    room: &mut Room,
    usable: bool,
    scale: EnergyScale,
    convergence: &mut Convergence,
) -> f64 {
    let gain =
        if usable { 0.5 * created(rows, room.forces) } else { fall_back(rows, answer, room, convergence) };
    let taken = 0.5 * demanded(rows, room.forces);
    if gain <= scale.credit && taken.abs() > WORK_TOLERANCE * scale.present {
        return approach(rows, answer, room, taken, scale.credit);
    }
    gain
}

/// Forces that create no energy: f = λ(0) + S r with secants S steep enough. Returns the energy they give to
/// the string, J: not above 0 unless rounding leaves no better.
fn fall_back(
    rows: &mut [Active],
    answer: &mut impl Answer,
    room: &mut Room,
    convergence: &mut Convergence,
) -> f64 {
    // The secants take the place of the residual, the best forces so far that of the step.
    for (i, row) in rows.iter_mut().enumerate() {
        row.evaluate(0.0);
        room.start[i] = row.lambda - row.base;
        room.residual[i] = row.slope;
    }
    let mut least = f64::INFINITY;
    for attempt in 0..FALLBACKS {
        convergence.fallbacks += 1;
        // y = (1 + √S M √S)⁻¹ √S(r₀ − Mλ(0)), f = λ(0) + √S y.
        answer.product(room.start, room.motion);
        for (i, row) in rows.iter().enumerate() {
            room.roots[i] = room.residual[i].sqrt();
            room.unknown[i] = room.roots[i] * (row.centre - room.motion[i]);
        }
        answer.solve(room.roots, room.unknown);
        for i in 0..rows.len() {
            room.forces[i] = room.start[i] + room.roots[i] * room.unknown[i];
        }
        let gain = settle(rows, answer, room.forces, room.motion);
        if gain <= 0.0 && (attempt >= EASINGS || bounded(rows, room.forces, 0.0)) {
            return gain;
        }
        if gain < least {
            least = gain;
            room.step.copy_from_slice(room.forces);
        }
        for (i, row) in rows.iter().enumerate() {
            let secant = (row.lambda - (row.base + room.start[i])) / row.change;
            let pulls = row.base + room.forces[i] < 0.0;
            let present = room.residual[i];
            room.residual[i] = if !secant.is_finite() {
                present
            } else if attempt < EASINGS {
                if pulls { secant.max(0.0) } else { present.max(secant) }
            } else {
                2.0 * present.max(secant)
            };
        }
    }
    room.forces.copy_from_slice(room.step);
    settle(rows, answer, room.forces, room.motion)
}

/// Goes on from forces that create nothing, by which the solver takes `taken`, in the direction of a Newton step
/// as far as it takes nothing: an answer that is not exact, but neither takes energy nor gives any.
fn approach(rows: &mut [Active], answer: &mut impl Answer, room: &mut Room, taken: f64, credit: f64) -> f64 {
    for (i, row) in rows.iter().enumerate() {
        room.residual[i] = row.required - (row.base + room.forces[i]);
    }
    answer.product(room.residual, room.motion);
    newton_direction(rows, answer, room);
    let error = largest(room.motion);
    room.start.copy_from_slice(room.forces);
    let (mut best, mut least) = (0.0, taken.abs());
    // Lengths of the step with what is given there (negative: taken), either side of nothing.
    let mut low = (0.0, taken);
    let mut high: Option<(f64, f64)> = None;
    let mut t = 1.0;
    for attempt in 0..APPROACHES {
        let gain = stretch_to(t, rows, answer, room);
        let given = 0.5 * demanded(rows, room.forces);
        if gain <= credit && given.abs() < least && bounded(rows, room.forces, 0.0) {
            for (i, row) in rows.iter().enumerate() {
                room.residual[i] = row.required - (row.base + room.forces[i]);
            }
            answer.product(room.residual, room.motion);
            if largest(room.motion) <= 0.5 * error {
                (best, least) = (t, given.abs());
            }
        }
        if least <= NEUTRAL * taken.abs() || low.1 > 0.0 {
            break;
        }
        if given > 0.0 {
            high = Some((t, given));
        } else {
            low = (t, given);
        }
        t = match high {
            None => 4.0 * t,
            Some(high) => {
                // The chord, and every other time beyond it, or the far end would never move.
                let chord = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1)).clamp(0.0, 1.0);
                if attempt % 2 == 0 { chord } else { 0.5 * (chord + high.0) }
            }
        };
    }
    stretch_to(best, rows, answer, room)
}

/// Takes the forces so many steps from the start; returns the energy given to the string, J.
fn stretch_to(t: f64, rows: &mut [Active], answer: &impl Answer, room: &mut Room) -> f64 {
    for i in 0..rows.len() {
        room.forces[i] = room.start[i] + t * room.step[i];
    }
    settle(rows, answer, room.forces, room.motion)
}

/// Evaluates the laws under forces beyond the base; returns the energy given to the string, J.
fn settle(rows: &mut [Active], answer: &impl Answer, forces: &[f64], motion: &mut [f64]) -> f64 {
    answer.product(forces, motion);
    for (row, answer) in rows.iter_mut().zip(&*motion) {
        row.evaluate(row.centre - answer);
    }
    0.5 * created(rows, forces)
}

/// Σ(law − f)r, twice the energy given to the string beyond what the contacts' laws have it get.
fn demanded(rows: &[Active], forces: &[f64]) -> f64 {
    rows.iter().zip(forces).map(|(row, force)| (row.required - (row.base + force)) * row.change).sum()
}

/// Σ(λ − f)r, twice the energy given to the string beyond what the contacts gave up.
#[inline(always)]
fn created(rows: &[Active], forces: &[f64]) -> f64 {
    rows.iter().zip(forces).map(|(row, force)| (row.lambda - (row.base + force)) * row.change).sum()
}

#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[inline(always)]
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |most, value| most.max(value.abs()))
}
