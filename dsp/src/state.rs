//! The state of one string: all that must be remembered from one sample to the next.
//!
//! What it does stands where it belongs:
//! - here: how it begins, in a shape or thrown; what is seen of it; fingers put and taken away;
//! - `release`: how it begins to move when it is let go of;
//! - `string`: a step of it, and what of that needs no contacts;
//! - `close`: which fixed contacts it may touch soon, which are asleep, and which were missed;
//! - `touching`: which contacts act in a step;
//! - `contact_step`: the part of a step that solves for them;
//! - `handover`: what it takes over from a string on another model.

use crate::close::Close;
use crate::curve::Curve;
use crate::error::{Error, within};
use crate::field::{Ends, Field, LANES};
use crate::finger::Finger;
use crate::gesture::{FASTEST, Touch};
use crate::grid::Reading;
use crate::model::Model;
use crate::roomy::Roomy;

/// How high or low a finger may be put, m: anywhere over a string that swings far, and not so far in it that the energy that pressing
/// it there takes is none that numbers have.
const FARTHEST: f64 = 1e30;

/// The state of one string, its fingers and its contacts.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// uⁿ, oddly continued beyond both ends, m.
    pub(crate) displacement: Field,
    /// uⁿ − uⁿ⁻¹, m.
    pub(crate) motion: Field,
    /// Undivided second differences of uⁿ⁻¹, m; once a step has been predicted, of uⁿ.
    pub(crate) curvature: Field,
    /// (δuⁿ)ᵀδuⁿ⁻¹, m²: how far the string was stretched between the last two samples, if it pulls itself tight.
    pub(crate) stretched: f64,
    /// (dⁿ)ᵀdⁿ, m².
    pub(crate) squares: f64,
    /// Fingers, by slot.
    pub(crate) fingers: Vec<Option<Finger>>,
    /// From this slot on there is no finger, and was none in the last step.
    pub(crate) no_finger_from: usize,
    /// Heights bⁿ and bⁿ⁻¹ of the fixed contacts, m.
    pub(crate) heights: Vec<f64>,
    pub(crate) heights_before: Vec<f64>,
    /// Heights bⁿ⁺¹ within a step; the same as bⁿ between steps, once the barrier rests.
    pub(crate) heights_next: Vec<f64>,
    /// Steps until all three heights are the same again.
    pub(crate) heights_rest_in: u8,
    /// How often a finger has been placed or removed.
    pub(crate) finger_changes: u64,
    /// Fixed contacts that are touched or near, in order.
    pub(crate) close: Roomy<Close>,
    /// Of each of the others, how much its piece of the skyline rises from the point before it to the one after it, m.
    pub(crate) asleep: Vec<Option<f64>>,
    /// The skyline of those at each grid point, m, by `heights_next`.
    pub(crate) skyline: Field,
    /// The first step in which nothing is left of the waves that each contact sent off when it was made.
    pub(crate) calm: Vec<u64>,
    /// Number of steps taken.
    pub(crate) steps: u64,
    /// Energy that inexact solutions have put in and not yet taken out again, J; kept tiny.
    pub(crate) solver_balance: f64,
    /// The largest energy (of string, contacts and fingers) seen at a contact so far, J.
    pub(crate) energy_scale: f64,
    interior: usize,
}

impl State {
    /// A string at rest with no finger near it.
    pub fn new(model: &Model) -> State {
        let heights: Vec<f64> = model.contacts.iter().map(|contact| contact.height).collect();
        let contacts = heights.len();
        let mut state = State {
            displacement: Field::new(&model.grid),
            motion: Field::new(&model.grid),
            curvature: Field::new(&model.grid),
            stretched: 0.0,
            squares: 0.0,
            fingers: vec![None; model.finger_slots],
            no_finger_from: 0,
            heights_before: heights.clone(),
            heights_next: heights.clone(),
            heights,
            heights_rest_in: 0,
            finger_changes: 0,
            close: Roomy::with_capacity(contacts),
            asleep: vec![None; contacts],
            skyline: Field::new(&model.grid),
            calm: vec![0; contacts],
            steps: 0,
            solver_balance: 0.0,
            energy_scale: 0.0,
            interior: model.grid.unknowns(),
        };
        state.look_at_all(model);
        state
    }

    /// Back to rest, without allocating. The [`Scratch`](crate::Scratch) that steps it is to be reset with it: that knows by
    /// numbers of steps what touched in the last one.
    pub fn reset(&mut self, model: &Model) {
        self.displacement.fill(0.0);
        self.motion.fill(0.0);
        self.curvature.fill(0.0);
        (self.stretched, self.squares) = (0.0, 0.0);
        self.fingers.fill(None);
        self.no_finger_from = 0;
        for (height, contact) in self.heights.iter_mut().zip(&model.contacts) {
            *height = contact.height;
        }
        self.heights_before.copy_from_slice(&self.heights);
        self.heights_next.copy_from_slice(&self.heights);
        self.heights_rest_in = 0;
        self.finger_changes = 0;
        self.look_at_all(model);
        self.calm.fill(0);
        self.steps = 0;
        self.solver_balance = 0.0;
        self.energy_scale = 0.0;
    }

    /// Gives the string a displacement over places (m over m from the nut), at rest or, by [`State::set_velocity`] afterwards,
    /// at a velocity. What was set is not yet released: [`State::let_go`] does that at the moment of this sample; stepped
    /// without it, the string begins half a step early.
    pub fn set_shape(&mut self, model: &Model, shape: &Curve) {
        for node in 1..model.grid.intervals {
            self.displacement[model.grid.cell(node)] = shape.at(model.grid.place(node));
        }
        self.motion.fill(0.0);
        self.close_shape(model);
        self.look_at_all(model);
    }

    /// Gives the string a velocity over places (m/s over m from the nut) beside the displacement it has: each grid point the
    /// mean of what stands within half a spacing of it, so that even the narrowest hammer leaves its momentum, but for what strikes
    /// within half a spacing of an end: that the end takes. As with a shape, [`State::let_go`] is to follow.
    pub fn set_velocity(&mut self, model: &Model, velocity: &Curve) {
        let (k, half) = (model.grid.time_step, 0.5 * model.grid.spacing);
        for node in 1..model.grid.intervals {
            let place = model.grid.place(node);
            self.motion[model.grid.cell(node)] = k * velocity.mean(place - half, place + half);
        }
        self.close_shape(model);
        self.look_at_all(model);
    }

    /// Finds all that follows from a displacement and a motion that no step has led to.
    pub(crate) fn close_shape(&mut self, model: &Model) {
        let grid = &model.grid;
        Ends::new(grid).close(&mut self.displacement);
        self.look_back(model);
        self.stretched = if model.coasting.stretch > 0.0 { self.stretch(model) } else { 0.0 };
        self.squares = self.motion.iter().map(|motion| motion * motion).sum();
    }

    /// (δuⁿ)ᵀδuⁿ⁻¹, m², of the string as it is now and as it was bent a step ago.
    pub(crate) fn stretch(&self, model: &Model) -> f64 {
        let (grid, u, v) = (&model.grid, &self.displacement, &self.curvature);
        let product: f64 = (1..grid.intervals).map(|node| u[grid.cell(node)] * v[grid.cell(node)]).sum();
        -product
    }

    /// Finds how the string was bent a step ago. (From point to point as they lie in memory: to ask where each is, and its neighbours,
    /// takes several times as long.)
    pub(crate) fn look_back(&mut self, model: &Model) {
        let (u, d, v) = (self.displacement.rows(), self.motion.rows(), self.curvature.rows_mut());
        let moving = model.grid.unknowns();
        let mut points = (0..LANES).flat_map(|lane| (0..u.len()).map(move |row| (row, lane))).take(moving);
        let before = |(row, lane): (usize, usize)| u[row][lane] - d[row][lane];
        let Some(mut here) = points.next() else { return };
        let mut place = before(here);
        let mut slope = place;
        for ahead in points {
            let (next, (row, lane)) = (before(ahead), here);
            v[row][lane] = (next - place) - slope;
            (slope, place, here) = (next - place, next, ahead);
        }
        v[here.0][here.1] = -place - slope;
    }

    /// Wakes up every fixed contact, at its present height.
    pub(crate) fn look_at_all(&mut self, model: &Model) {
        self.asleep.fill(None);
        self.skyline.fill(f64::NEG_INFINITY);
        self.close.clear();
        let heights = self.heights.iter().zip(&self.heights_before);
        self.close.extend(model.contacts.iter().enumerate().zip(heights).map(
            |((index, contact), heights)| {
                let [displacement, motion] = contact.reading.of_each([&self.displacement, &self.motion]);
                let before = [displacement - motion, *heights.1];
                Close::new(index, contact, [displacement, *heights.0], before)
            },
        ));
    }

    /// Displacement of the interior points u₁ … u_{N−1}, m.
    pub fn displacement(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        self.displacement.from_nut().take(self.interior)
    }

    /// Motion of the interior points in the last step, uⁿ − uⁿ⁻¹, m.
    pub fn motion(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        self.motion.from_nut().take(self.interior)
    }

    /// The fingers, by slot.
    pub fn fingers(&self) -> &[Option<Finger>] {
        &self.fingers
    }

    /// Present heights of the fixed contacts, m, in the model's order.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// The string's displacement at a reading, m.
    pub fn displacement_at(&self, reading: &Reading) -> f64 {
        reading.of(&self.displacement)
    }

    /// The string's velocity at a reading, m/s, half a step ago.
    pub fn velocity_at(&self, model: &Model, reading: &Reading) -> f64 {
        reading.of(&self.motion) / model.grid.time_step
    }

    /// Puts a finger into a slot: at a place (m from the nut), a height (m, 1e30 either way) and a velocity (m/s, 1000
    /// either way). What was in the slot is taken away.
    ///
    /// # Errors
    /// When the place is off the string, a number of the touch, the height or the velocity is out of its range, or the pad is too
    /// stiff for this rate. What is in the slot stays then.
    ///
    /// # Panics
    /// When the model has no such slot.
    pub fn place_finger(
        &mut self,
        model: &Model,
        slot: usize,
        touch: Touch,
        position: f64,
        height: f64,
        velocity: f64,
    ) -> Result<(), Error> {
        let position = model.grid.check_place("finger.position", position)?;
        within("finger.height", height, -FARTHEST, FARTHEST, "m")?;
        within("finger.velocity", velocity, -FASTEST, FASTEST, "m/s")?;
        let law = model.finger_law(&touch)?;
        self.put_finger(slot, Finger::over(model, touch, law, position, height, velocity));
        Ok(())
    }

    /// Puts a finger that is known to be good into a slot.
    pub(crate) fn put_finger(&mut self, slot: usize, finger: Finger) {
        self.finger_changes += 1;
        self.fingers[slot] = Some(Finger { number: self.finger_changes, ..finger });
        self.no_finger_from = self.no_finger_from.max(slot + 1);
    }

    /// Takes the finger in a slot away.
    ///
    /// # Panics
    /// When the model has no such slot.
    pub fn remove_finger(&mut self, slot: usize) {
        self.finger_changes += u64::from(self.fingers[slot].is_some());
        self.fingers[slot] = None;
    }
}
