//! The energy ledger: what is stored, lost and put in, term by term, and whether it adds up.
//!
//! The ledger only reads the state after a step and the record the step left in its scratch; it never
//! touches what it measures. Stored energy lives half way between samples, at n + ½; power at n. The
//! balance 𝔥ⁿ⁺½ − 𝔥ⁿ⁻½ + k(𝔮 − 𝔭) = 0 holds exactly in exact arithmetic, whatever the solver's cap.

mod account;
mod body;
mod rounding;
mod string;

use std::ops::Deref;

use crate::drive::Drive;
use crate::entry::{Energies, Entry, Inputs};
use crate::field::Field;
use crate::finger::Finger;
use crate::model::Model;
use crate::state::State;
use crate::string::Scratch;
pub use account::Account;
pub use body::BodyLedger;
use rounding::gross;
use string::{Shapes, stiffness_change, string_energy, string_losses};

/// The running ledger of one string.
#[derive(Debug, Clone, PartialEq)]
pub struct Ledger {
    account: Account,
    /// The part of the contact energy that is board and frets, J.
    board: f64,
    /// Tension in the last step, N.
    tension: f64,
    finger_changes: u64,
    shapes: Shapes,
}

impl Deref for Ledger {
    type Target = Account;
    fn deref(&self) -> &Account {
        &self.account
    }
}

impl Ledger {
    /// Opens the ledger of a string in its present state, at the tension, N, that it has there.
    pub fn new(model: &Model, state: &State, tension: f64) -> Ledger {
        let mut ledger = Ledger {
            account: Account::new(Energies::default()),
            board: 0.0,
            tension,
            finger_changes: 0,
            shapes: Shapes::default(),
        };
        ledger.account = Account::new(ledger.look(model, state, tension));
        ledger
    }

    /// Looks at what there is, without a step that would lead to it.
    fn look(&mut self, model: &Model, state: &State, tension: f64) -> Energies {
        let past = before(&state.displacement, &state.motion);
        let stiffness = model.stiffness(tension);
        self.shapes.take(model, &past, &state.motion, state);
        let (string, stretched) = string_energy(model, &stiffness, &self.shapes);
        self.board = board_energy(model, &state.heights, &state.displacement, &past, state);
        let contact = self.board + fingers_energy(&state.fingers, &state.displacement, &past);
        let finger = fingers_motion(model, &state.fingers);
        self.tension = tension;
        self.finger_changes = state.finger_changes;
        Energies { string, tension: stretched, contact, finger, ..Energies::default() }
    }

    /// Counts what the fingers held before the step anew if any has been placed or taken away since the last one.
    /// Gives back what has come in by that, J.
    fn change_fingers(&mut self, model: &Model, state: &State, scratch: &Scratch) -> f64 {
        if state.finger_changes == self.finger_changes {
            return 0.0;
        }
        self.finger_changes = state.finger_changes;
        let (now, motion_now) = (&scratch.displacement, &scratch.motion);
        let energies = &mut self.account.energies;
        let before_that = energies.total();
        let past = state.fingers.iter().zip(&scratch.fingers);
        let past: Vec<_> = past.map(|(now, past)| Some((*now)?.back(&model.grid, past.as_ref()?))).collect();
        energies.contact = self.board + fingers_energy(&past, now, &before(now, motion_now));
        energies.finger = fingers_motion(model, &past);
        let total = energies.total();
        // However much of it is lost within the step.
        self.account.largest = self.account.largest.max(total);
        total - before_that
    }

    /// Books the step that has just been taken under `drive`.
    pub fn record(&mut self, model: &Model, state: &State, scratch: &Scratch, drive: &Drive) -> Entry {
        let k = model.grid.time_step;
        let two_k = 2.0 * k;
        // After the step the scratch holds uⁿ and dⁿ, and the fingers as they were at n.
        let (now, motion_now) = (&scratch.displacement, &scratch.motion);
        let entered = self.change_fingers(model, state, scratch);
        let stiffness = *scratch.stiffness();
        self.shapes.take(model, now, motion_now, state);
        let (string, stretched) = string_energy(model, &stiffness, &self.shapes);
        self.board = board_energy(model, &state.heights, &state.displacement, now, state);
        let contact = self.board + fingers_energy(&state.fingers, &state.displacement, now);
        let finger = fingers_motion(model, &state.fingers);
        let energies = Energies { string, tension: stretched, contact, finger, ..Energies::default() };

        let mut losses = string_losses(model, scratch.coasting.loss_0, &self.shapes);
        let mut loss = losses.loss_0 + losses.loss_1 + losses.hand;
        let mut inputs = Inputs { finger: entered / k, ..Inputs::default() };
        let mut input = inputs.finger;
        for push in &drive.pushes {
            book(push.power(motion_now, &state.motion, k), &mut input, &mut inputs.pluck);
        }
        if let Some(push) = &drive.bridge {
            inputs.bridge = push.power(motion_now, &state.motion, k);
        }
        for (slot, finger) in state.fingers.iter().enumerate() {
            let (Some(finger), Some(old)) = (finger, &scratch.fingers[slot]) else { continue };
            let velocity = (finger.motion + old.motion) / two_k;
            book(finger.touch.hand_damping * velocity * velocity, &mut loss, &mut losses.hand);
            book(-drive.hands[slot].force * velocity, &mut input, &mut inputs.hand);
        }
        let lost_elsewhere = loss;
        // What contacts take besides what they store. Loss and solver share it; where a pad asks for far more than it
        // was given both are large, and their sum would be known less well than their common part.
        let (mut solver, mut taken) = (0.0, 0.0);
        for active in scratch.active.iter() {
            let lossy = (active.required - active.lambda) * active.change / two_k;
            book(lossy, &mut loss, &mut losses.contact);
            solver += (active.force - active.required) * active.change / two_k;
            taken += (active.force - active.lambda) * active.change / two_k;
            book(active.force * active.raised / two_k, &mut input, &mut inputs.barrier);
            if let Some(slot) = active.slot.checked_sub(model.contacts.len())
                && let Some(old) = &scratch.fingers[slot]
                && old.position_before != active.position
            {
                let past = |r: &crate::grid::Reading| r.of(now) - r.of(motion_now);
                let slid = past(&active.reading) - past(&model.grid.reading(old.position_before));
                book(active.force * slid / two_k, &mut input, &mut inputs.slide);
            }
        }
        if stiffness.tension != self.tension {
            let old = model.stiffness(self.tension);
            let change = stiffness_change(model, &stiffness, &old, &self.shapes);
            book(change / k, &mut input, &mut inputs.tension);
            self.tension = stiffness.tension;
        }
        self.account.rounding += f64::EPSILON * gross(model, &stiffness, &self.shapes, state, scratch);
        let put_in = input + inputs.bridge;
        let residual = energies.total() - (self.account.energies.total() - entered)
            + k * (lost_elsewhere + taken - put_in);
        self.account.book(energies, energies.total(), k * put_in, residual);
        Entry { energies, power_loss: loss, losses, power_solver: solver, power_in: input, inputs, residual }
    }

    /// Books what was done to the string beside its steps, such as another model put under its motion: what
    /// it holds now less what it held counts as put in. Gives that back, J.
    pub fn rebook(&mut self, model: &Model, state: &State, tension: f64) -> f64 {
        let energies = self.look(model, state, tension);
        self.account.rebook(energies)
    }
}

/// Adds a power to a total and to the term of it that it belongs to. (The balance closes on the total, added up one by one:
/// the sum of the terms is rounded otherwise.)
fn book(power: f64, total: &mut f64, term: &mut f64) {
    *total += power;
    *term += power;
}

/// A displacement u less its motion d: that of the sample before.
fn before(displacement: &Field, motion: &Field) -> Field {
    let mut past = displacement.clone();
    past.iter_mut().zip(&**motion).for_each(|(u, d)| *u -= d);
    past
}

/// Σ½(Φⁿ + Φⁿ⁺¹) over board and frets, J.
fn board_energy(model: &Model, heights: &[f64], next: &Field, now: &Field, state: &State) -> f64 {
    // Heights at n are only apart from those at n + 1 while the barrier moves.
    model
        .contacts
        .iter()
        .enumerate()
        .map(|(i, contact)| {
            let after = contact.law.energy(heights[i] - contact.reading.of(next));
            let before = contact.law.energy(state.heights_before[i] - contact.reading.of(now));
            0.5 * (before + after)
        })
        .fold(0.0, add)
}

/// Σ½(Φⁿ + Φⁿ⁺¹) over fingers' pads, J; fingers as they are at n + 1.
fn fingers_energy(fingers: &[Option<Finger>], next: &Field, now: &Field) -> f64 {
    fingers
        .iter()
        .flatten()
        .map(|finger| {
            let after = finger.law.energy(finger.reading.of(next) - finger.height);
            let height_now = finger.height - finger.motion;
            let before = finger.law.energy(finger.reading_before.of(now) - height_now);
            0.5 * (before + after)
        })
        .fold(0.0, add)
}

/// Energy of tension modulation at the sample the last step led from, J: EA/(8L)·(∫(∂ₓu)² dx)².
pub fn stretch_energy(model: &Model, scratch: &Scratch) -> f64 {
    string::stretch_energy(model, scratch.stretching())
}

/// ΣM̃/2(δu_f)², J.
fn fingers_motion(model: &Model, fingers: &[Option<Finger>]) -> f64 {
    let k = model.grid.time_step;
    let square = |finger: &Finger| finger.inertia.mass * (finger.motion / k) * (finger.motion / k);
    fingers.iter().flatten().map(|finger| 0.5 * square(finger)).fold(0.0, add)
}

/// Adds two numbers, from 0 on: a `sum` of nothing is a negative zero, which nobody wants to read.
fn add(sum: f64, next: f64) -> f64 {
    sum + next
}
