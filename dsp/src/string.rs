//! One step of one string: predict without contacts, solve the contacts, advance.

use crate::contact::Before;
use crate::drive::Drive;
use crate::grid::{READING_NORM, Reading};
use crate::kernel::{Kernel, Products, Weights};
use crate::model::{Model, STEEPEST, Stiffness};
use crate::solver::{Active, Convergence, EnergyScale, Solver};
use crate::state::{Finger, ForceHistory, State};

/// Room to step one string, and what the last step did, for whoever measures it.
#[derive(Debug, Clone)]
pub struct Scratch {
    kernel: Kernel,
    stiffness: Stiffness,
    weights: Weights,
    products: Products,
    /// Undivided second differences of uⁿ.
    curvature: Vec<f64>,
    /// The motion to n + 1 without contacts and tension modulation, then with contacts.
    prediction: Vec<f64>,
    /// dⁿ⁺¹ and uⁿ⁺¹ before the step, dⁿ and uⁿ after it.
    pub(crate) motion: Vec<f64>,
    pub(crate) displacement: Vec<f64>,
    pub(crate) solver: Solver,
    /// The contacts active in the last step, with their forces.
    pub(crate) active: Vec<Active>,
    /// The step in which each contact or finger was last solved for, one more than its index.
    held: Vec<u64>,
    near_room: Vec<u32>,
    /// Fingers before the last step.
    pub(crate) fingers: Vec<Option<Finger>>,
}

impl Scratch {
    /// Room for every contact and finger of the model.
    pub fn new(model: &Model) -> Scratch {
        let contacts = model.contacts.len() + model.finger_slots;
        let grid = || vec![0.0; model.grid.padded_len()];
        let stiffness = model.stiffness(model.string.tension);
        let spans: Vec<_> = model.contacts.iter().map(|contact| contact.reading.span()).collect();
        Scratch {
            kernel: Kernel::new(model),
            weights: Weights::new(model, &stiffness),
            stiffness,
            products: Products::default(),
            curvature: grid(),
            prediction: grid(),
            motion: grid(),
            displacement: grid(),
            solver: Solver::with_capacity(&spans, model.finger_slots),
            active: Vec::with_capacity(contacts),
            held: vec![0; contacts],
            near_room: Vec::with_capacity(model.contacts.len()),
            fingers: vec![None; model.finger_slots],
        }
    }

    /// Has the string stepped by instructions that any processor has, from now on. The bits are the same; this
    /// is for whoever measures what vectors are worth.
    pub fn leave_vectors(&mut self) {
        self.kernel = self.kernel.without_vectors();
    }

    /// Back to the state of new room, without allocating.
    pub fn reset(&mut self) {
        self.active.clear();
        self.held.fill(0);
        self.products = Products::default();
        self.fingers.fill(None);
        self.motion.fill(0.0);
        self.displacement.fill(0.0);
    }

    /// The stiffness of the last step.
    pub fn stiffness(&self) -> &Stiffness {
        &self.stiffness
    }

    /// Sum of squared differences between neighbours at the sample the last step led from, m².
    pub fn steepness(&self) -> f64 {
        self.products.steepness
    }

    /// Energy of the string as a linear one without bending at the sample the last step led from, J:
    /// what the step knew anyway.
    pub(crate) fn string_energy(&self, model: &Model) -> f64 {
        let (k, h) = (model.grid.time_step, model.grid.spacing);
        0.5 * model.string.linear_density * h / (k * k) * self.products.motion
            + 0.5 * self.stiffness.tension / h * self.products.steepness
    }

    /// Force of each active contact in the last step, N, by index: the model's contacts, then fingers.
    pub fn forces(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.active.iter().map(|active| (active.slot, active.force))
    }
}

impl State {
    /// Advances the string by one step under a drive.
    ///
    /// Never allocates, never fails: whatever the numbers, the energy cannot exceed what was put in.
    pub fn step(&mut self, model: &Model, drive: &Drive, scratch: &mut Scratch) -> Convergence {
        let unknowns = model.grid.unknowns();
        // What is known of the energy before anything is computed.
        let resting = self.energy_scale.max(scratch.string_energy(model)) > MOST_ENERGY;
        if drive.tension != scratch.stiffness.tension && !resting {
            scratch.stiffness = model.stiffness(drive.tension);
            scratch.weights = Weights::new(model, &scratch.stiffness);
        }
        let mut products = scratch.kernel.predict(
            unknowns,
            &scratch.weights,
            (&self.displacement, &self.motion),
            &mut scratch.curvature,
            &mut scratch.prediction,
        );
        scratch.products = products;
        for push in &drive.pushes {
            let motion = model.mobility * push.force;
            push.reading.spread(&mut scratch.prediction, motion);
            products.curvature_prediction += motion * push.reading.of(&scratch.curvature);
        }
        let mut convergence = Convergence::default();
        if model.contacts.is_empty() && self.fingers.iter().all(Option::is_none) {
            // Nothing of the last contact may be left in the record.
            scratch.active.clear();
            scratch.fingers.fill(None);
            let pull = pull(model, &products, 0.0);
            self.advance(model, pull, scratch);
        } else {
            self.contact_step(model, drive, &products, resting, scratch, &mut convergence);
        }
        std::mem::swap(&mut self.displacement, &mut scratch.displacement);
        std::mem::swap(&mut self.motion, &mut scratch.motion);
        self.steps += 1;
        convergence
    }

    fn advance(&self, model: &Model, pull: f64, scratch: &mut Scratch) -> f64 {
        scratch.kernel.advance(
            model.grid.unknowns(),
            pull,
            (&scratch.prediction, &scratch.curvature, &self.displacement),
            &mut scratch.motion,
            &mut scratch.displacement,
        )
    }

    fn contact_step(
        &mut self,
        model: &Model,
        drive: &Drive,
        products: &Products,
        resting: bool,
        scratch: &mut Scratch,
        convergence: &mut Convergence,
    ) {
        if !drive.heights.is_empty() && !resting {
            self.heights_next.copy_from_slice(&drive.heights);
            self.settling = 2;
        }
        let free_pull = pull(model, products, 0.0);
        scratch.active.clear();
        self.find_active(model, free_pull, scratch);
        self.find_fingers(model, drive, free_pull, resting, scratch);
        let mut created = 0.0;
        loop {
            let mut largest = 0.0;
            if scratch.active.is_empty() {
                largest = self.advance(model, free_pull, scratch);
            } else {
                // M's rank-one term: mobility·G/(1 + G vᵀv) z zᵀ.
                let factor = model.mobility * model.stretch / (1.0 + model.stretch * products.curvature);
                let scale = self.energy_scale(model, scratch);
                for active in &mut scratch.active {
                    let at = active.reading.first;
                    active.saved.copy_from_slice(&scratch.prediction[at..at + 4]);
                }
                let mut along = 0.0;
                for round in 0.. {
                    created = scratch.solver.solve(
                        &mut scratch.active,
                        factor,
                        &model.settings,
                        scale,
                        convergence,
                    );
                    let spread = spread(model, &mut scratch.active, &mut scratch.prediction);
                    along += spread.along;
                    largest = self.advance(model, pull(model, products, along), scratch);
                    let rounding = f64::EPSILON * model.mobility * spread.sum * spread.sum;
                    let exact = rounding <= ROUNDING * self.energy_scale && created <= scale.credit;
                    if exact || round == REFINEMENTS {
                        break;
                    }
                    self.recentre(scratch);
                }
            }
            let before = scratch.active.len();
            for active in &scratch.active {
                scratch.held[active.slot] = self.steps + 1;
            }
            self.find_missed(model, drive, largest, free_pull, scratch);
            if scratch.active.len() == before {
                break;
            }
            // Something was driven into a contact that was not in the solution: take the forces back
            // and solve again with it.
            convergence.repeats += 1;
            for active in &mut scratch.active[..before] {
                let at = active.reading.first;
                scratch.prediction[at..at + 4].copy_from_slice(&active.saved);
                active.base = 0.0;
            }
            for index in 0..before {
                let free = self.free_motion(&scratch.active[index].reading, free_pull, scratch);
                let active = &mut scratch.active[index];
                active.centre = -(active.sign * free + active.rest);
            }
            scratch.active.sort_unstable_by(|a, b| {
                a.reading.centre().total_cmp(&b.reading.centre()).then(a.slot.cmp(&b.slot))
            });
        }
        convergence.active = scratch.active.len() as u32;
        self.solver_balance = (self.solver_balance + created).max(0.0);
        self.finish(model, scratch);
    }

    /// Takes the string as it has come out for the place from which forces are solved for.
    #[cold]
    fn recentre(&self, scratch: &mut Scratch) {
        for active in &mut scratch.active {
            active.base = active.force;
            let moved = active.sign * active.reading.of(&scratch.motion);
            active.centre = -(moved + active.rest + active.own_mobility * active.base);
        }
    }

    /// Adds the fixed contacts near the string that touch it at n − 1 or would at n + 1.
    fn find_active(&self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        for &index in &self.watch.near {
            let index = index as usize;
            let contact = &model.contacts[index];
            let reading = &contact.reading;
            let before =
                self.heights_before[index] - (reading.of(&self.displacement) - reading.of(&self.motion));
            let free = self.free_motion(reading, free_pull, scratch);
            let after = self.heights_next[index] - (reading.of(&self.displacement) + free);
            if before > 0.0 || after > 0.0 {
                let active = self.activate(model, index, before, free, scratch);
                scratch.active.push(active);
            }
        }
    }

    /// The motion of a point to n + 1 without contact forces.
    #[inline(always)]
    fn free_motion(&self, reading: &Reading, free_pull: f64, scratch: &Scratch) -> f64 {
        reading.of(&scratch.prediction) - free_pull * reading.of(&scratch.curvature)
    }

    fn activate(&self, model: &Model, index: usize, before: f64, free: f64, scratch: &Scratch) -> Active {
        let contact = &model.contacts[index];
        let raised = self.heights_next[index] - self.heights_before[index];
        let rest = contact.reading.of(&self.motion) - raised;
        Active {
            slot: index,
            reading: contact.reading,
            sign: 1.0,
            law: contact.law,
            lossy: 0.0,
            before: Before::new(&contact.law, before),
            rest,
            base: 0.0,
            centre: -(free + rest),
            raised,
            own_mobility: 0.0,
            mobility: model.mobility,
            pull: contact.reading.of(&scratch.curvature),
            force: self.start_force(index),
            change: 0.0,
            lambda: 0.0,
            required: 0.0,
            slope: 0.0,
            saved: [0.0; 4],
        }
    }

    /// Forces of the last two steps, continued by a straight line.
    fn start_force(&self, slot: usize) -> f64 {
        let history = &self.forces[slot];
        if history.step == self.steps { (2.0 * history.last - history.before).max(0.0) } else { 0.0 }
    }

    /// Moves every finger as if it were free, and adds those that touch the string at n − 1, n or, as
    /// predicted, n + 1.
    fn find_fingers(
        &mut self,
        model: &Model,
        drive: &Drive,
        free_pull: f64,
        resting: bool,
        scratch: &mut Scratch,
    ) {
        let k = model.grid.time_step;
        scratch.fingers.copy_from_slice(&self.fingers);
        for slot in 0..self.fingers.len() {
            let Some(finger) = &mut self.fingers[slot] else { continue };
            let mut hand = drive.hands[slot];
            if resting {
                hand.position = finger.position;
            }
            let touch = finger.touch;
            let half_loss = 0.5 * touch.hand_damping * k;
            let own_mobility = k * k / (touch.mass + half_loss);
            let free = own_mobility * ((touch.mass - half_loss) / (k * k) * finger.motion - hand.force);
            let (reading_before, reading_now) = (finger.reading_before, finger.reading);
            let reading = if hand.position == finger.position {
                reading_now
            } else {
                model.grid.reading(hand.position)
            };
            let (height, motion) = (finger.height, finger.motion);
            let (law, damping) = (finger.law, touch.damping);
            finger.position = hand.position;
            finger.reading = reading;
            finger.reading_before = reading_now;
            finger.motion = free;
            finger.height = height + free;

            let past = |r: &Reading| r.of(&self.displacement) - r.of(&self.motion);
            let before = past(&reading_before) - (height - motion);
            let now = reading_now.of(&self.displacement) - height;
            let string_free = self.free_motion(&reading, free_pull, scratch);
            let after = reading.of(&self.displacement) + string_free - (height + free);
            let slid = if reading == reading_before { 0.0 } else { past(&reading) - past(&reading_before) };
            let rest = (free + motion) - slid - reading.of(&self.motion);
            let active = Active {
                slot: model.contacts.len() + slot,
                reading,
                sign: -1.0,
                law,
                lossy: (damping * law.force(now) / (2.0 * k)).min(STEEPEST / (model.mobility + own_mobility)),
                before: Before::new(&law, before),
                rest,
                base: 0.0,
                centre: -(rest - string_free),
                raised: 0.0,
                own_mobility,
                mobility: model.mobility,
                pull: -reading.of(&scratch.curvature),
                force: self.start_force(model.contacts.len() + slot),
                change: 0.0,
                lambda: 0.0,
                required: 0.0,
                slope: 0.0,
                saved: [0.0; 4],
            };
            if before > 0.0 || now > 0.0 || after > 0.0 {
                let at =
                    scratch.active.partition_point(|other| other.reading.centre() <= active.reading.centre());
                scratch.active.insert(at, active);
            } else {
                // Not yet in contact: kept aside, to be looked at again when the string has been moved.
                scratch.solver.aside.push(active);
            }
        }
    }

    /// Adds every contact that the string at n + 1 overlaps but the solution did not hold, and renews
    /// the watch when the string has moved far enough.
    fn find_missed(
        &mut self,
        model: &Model,
        drive: &Drive,
        largest: f64,
        free_pull: f64,
        scratch: &mut Scratch,
    ) {
        let held = scratch.active.len();
        for index in 0..scratch.solver.aside.len() {
            let finger = scratch.solver.aside[index];
            let height = self.fingers[finger.slot - model.contacts.len()].map_or(0.0, |f| f.height);
            let overlaps = finger.reading.of(&scratch.displacement) - height > 0.0;
            if overlaps && scratch.held[finger.slot] != self.steps + 1 {
                scratch.held[finger.slot] = self.steps + 1;
                scratch.active.push(finger);
            }
        }
        for position in 0..self.watch.near.len() {
            let index = self.watch.near[position] as usize;
            self.add_missed(model, index, held, free_pull, scratch);
        }
        let lifted = if drive.heights.is_empty() {
            0.0
        } else {
            let lifts = self.heights_next.iter().zip(&self.heights).map(|(next, now)| (next - now).abs());
            lifts.fold(0.0f64, f64::max)
        };
        let moved = READING_NORM * largest + lifted;
        if self.watch.budget - moved >= 0.0 {
            if scratch.active.len() == held {
                self.watch.budget -= moved;
            }
            return;
        }
        // The watch has run out: look at every contact.
        for index in 0..model.contacts.len() {
            self.add_missed(model, index, held, free_pull, scratch);
        }
        if scratch.active.len() > held {
            return;
        }
        let horizon = WATCH_STEPS * moved;
        scratch.near_room.clear();
        let mut budget = f64::INFINITY;
        for (index, contact) in model.contacts.iter().enumerate() {
            let gap = contact.reading.of(&scratch.displacement) - self.heights_next[index];
            if gap <= horizon {
                scratch.near_room.push(index as u32);
            } else {
                budget = budget.min(gap);
            }
        }
        std::mem::swap(&mut self.watch.near, &mut scratch.near_room);
        self.watch.budget = budget;
    }

    fn add_missed(&self, model: &Model, index: usize, held: usize, free_pull: f64, scratch: &mut Scratch) {
        let reading = &model.contacts[index].reading;
        let overlap = self.heights_next[index] - reading.of(&scratch.displacement);
        // Written so that a string that is not a number counts as clear.
        let overlaps = overlap > 0.0;
        if !overlaps || scratch.held[index] == self.steps + 1 {
            return;
        }
        scratch.held[index] = self.steps + 1;
        let before = self.heights_before[index] - (reading.of(&self.displacement) - reading.of(&self.motion));
        // The prediction holds forces by now; the free one is what was saved under them.
        let mut window = [0.0; 4];
        window.copy_from_slice(&scratch.prediction[reading.first..reading.first + 4]);
        for active in &scratch.active[..held] {
            for (offset, &saved) in active.saved.iter().enumerate() {
                let node = active.reading.first + offset;
                if node >= reading.first && node < reading.first + 4 {
                    window[node - reading.first] = saved;
                }
            }
        }
        let w = &reading.weights;
        let predicted = (w[0] * window[0] + w[1] * window[1]) + (w[2] * window[2] + w[3] * window[3]);
        let free = predicted - free_pull * reading.of(&scratch.curvature);
        let active = self.activate(model, index, before, free, scratch);
        scratch.active.push(active);
    }

    /// The energy against which this sample's errors are judged: of the string as a linear one, of the
    /// contacts, of the fingers.
    fn energy_scale(&mut self, model: &Model, scratch: &Scratch) -> EnergyScale {
        let k = model.grid.time_step;
        let contacts: f64 = scratch.active.iter().map(|active| active.before.energy).sum();
        let fingers: f64 = scratch
            .fingers
            .iter()
            .flatten()
            .map(|finger| 0.5 * finger.touch.mass * (finger.motion / k) * (finger.motion / k))
            .sum();
        let present = scratch.string_energy(model) + contacts + fingers;
        self.energy_scale = self.energy_scale.max(present);
        let credit = CREATED_AT_MOST * self.energy_scale - self.solver_balance;
        EnergyScale { present, credit }
    }

    /// Moves fingers by their forces, and keeps forces and heights for the next step.
    fn finish(&mut self, model: &Model, scratch: &mut Scratch) {
        scratch.solver.aside.clear();
        let contacts = model.contacts.len();
        for active in &scratch.active {
            let history = &mut self.forces[active.slot];
            let before = if history.step == self.steps { history.last } else { 0.0 };
            *history = ForceHistory { last: active.force, before, step: self.steps + 1 };
            if let Some(slot) = active.slot.checked_sub(contacts)
                && let (Some(finger), Some(old)) = (&mut self.fingers[slot], &scratch.fingers[slot])
            {
                finger.motion += active.own_mobility * active.force;
                finger.height = old.height + finger.motion;
            }
        }
        if self.settling > 0 {
            self.settling -= 1;
            self.heights_before.copy_from_slice(&self.heights);
            self.heights.copy_from_slice(&self.heights_next);
        }
    }
}

/// Above this energy, J, hands neither slide nor bend nor move a board: each of these multiplies what there is,
/// and if it were repeated for ever would reach infinity.
const MOST_ENERGY: f64 = 1e30;

/// Steps ahead for which contacts are listed as near.
const WATCH_STEPS: f64 = 16.0;

/// Where rounding of the forces moves the string so much that the energy is off by more than this part of the
/// largest, the string as it came out is solved for again.
const ROUNDING: f64 = 1e-15;

/// How often that is repeated at most.
const REFINEMENTS: usize = 3;

/// Inexact solutions may put in at most this part of the largest energy, all together.
const CREATED_AT_MOST: f64 = 1e-12;

/// What forces beyond the base do to the string.
struct Spread {
    /// What they add to vᵀw, m².
    along: f64,
    /// Sum of their sizes, N.
    sum: f64,
}

/// Adds the forces beyond the base to a prediction.
#[inline(always)]
fn spread(model: &Model, rows: &mut [Active], prediction: &mut [f64]) -> Spread {
    let mut done = Spread { along: 0.0, sum: 0.0 };
    for row in rows {
        let force = row.force - row.base;
        row.reading.spread(prediction, model.mobility * row.sign * force);
        done.along += model.mobility * force * row.pull;
        done.sum += force.abs();
    }
    done
}

/// ψ = G(vᵀw + 2vᵀu − vᵀd)/(1 + G vᵀv), so that dⁿ⁺¹ = w − ψ v; `along` is what contact forces add to
/// vᵀw. With a = γv and G = γ²/s this is χγ/s of the rank-one update.
#[inline(always)]
fn pull(model: &Model, products: &Products, along: f64) -> f64 {
    if model.stretch == 0.0 {
        return 0.0;
    }
    let sum = (products.curvature_prediction + along) - 2.0 * products.steepness - products.curvature_motion;
    model.stretch * sum / (1.0 + model.stretch * products.curvature)
}
