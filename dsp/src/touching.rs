//! Which contacts act in a step: those the string touches at n − 1 or n, or would at n + 1.

use crate::active::Active;
use crate::close::Pressed;
use crate::contact::Before;
use crate::drive::Drive;
use crate::field::Field;
use crate::grid::Reading;
use crate::model::{Contact, Model};
use crate::state::State;
use crate::string::Scratch;

/// What a contact reads of a step without contact forces.
#[derive(Clone, Copy)]
pub(crate) struct Free {
    /// Motion to n + 1, m.
    pub motion: f64,
    /// Undivided second difference of uⁿ, m.
    pub curvature: f64,
}

impl State {
    /// Takes up what is known to act without the prediction: the fixed contacts that touched the string at n − 1, lossy
    /// ones also if they touch it at n, and the fingers that did at either. The other fingers are kept aside.
    #[inline(always)]
    pub(crate) fn hold(&mut self, model: &Model, drive: &Drive, resting: bool, scratch: &mut Scratch) {
        if !drive.heights.is_empty() && !resting {
            self.heights_next.copy_from_slice(&drive.heights);
            model.beside.draw_all(&self.heights_next, &self.asleep, &mut self.skyline);
            self.heights_rest_in = 2;
        }
        scratch.active.clear();
        scratch.near.clear();
        for (position, close) in self.close.iter().enumerate() {
            let index = close.index as usize;
            let (now, before) = (close.now.depth.penetration, close.before.penetration);
            if now > 0.0 && before <= 0.0 {
                self.calm[index] = self.steps + Contact::RADIATING;
            }
            // A lossy one resists at n what goes on into it, even if that is out of it before and after.
            if before > 0.0 || (now > 0.0 && model.contacts[index].resists()) {
                self.activate(model, index, (close.before, &close.now), scratch);
            } else {
                scratch.near.push(position);
            }
        }
        self.hold_fingers(model, drive, resting, scratch);
    }

    /// Moves the fingers as if they were free, and adds those that touch the string at n − 1 or n.
    #[inline(always)]
    fn hold_fingers(&mut self, model: &Model, drive: &Drive, resting: bool, scratch: &mut Scratch) {
        let string = (&self.displacement, &self.motion);
        let mut squares = 0.0;
        let (from, mut last) = (self.no_finger_from, 0);
        let fingers = &mut self.fingers[..from];
        let past = scratch.fingers[..from].iter_mut().zip(&drive.hands[..from]);
        for (slot, (finger, (before, hand))) in fingers.iter_mut().zip(past).enumerate() {
            let Some(finger) = finger else {
                if before.is_some() {
                    *before = None;
                }
                continue;
            };
            last = slot + 1;
            finger.remember(before);
            squares += finger.inertia.mass * finger.motion * finger.motion;
            let mut hand = *hand;
            if resting {
                hand.position = finger.position;
            }
            let mobility = scratch.coasting.mobility;
            let places = [&mut scratch.active, &mut scratch.solver.aside];
            finger.hold(model, &hand, string, mobility, slot, places);
        }
        self.no_finger_from = last;
        let k = model.grid.time_step;
        scratch.finger_energy = 0.5 * squares / (k * k);
    }

    /// Shows all that is held how the string would move, and adds what that drives the string into.
    #[inline(always)]
    pub(crate) fn touch(&self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        self.show(free_pull, scratch);
        for position in 0..scratch.near.len() {
            let close = &self.close[scratch.near[position]];
            let index = close.index as usize;
            let free = self.free(&model.contacts[index].reading, free_pull, &scratch.motion);
            if close.displacement + free.motion < self.heights_next[index] {
                self.activate(model, index, (close.before, &close.now), scratch).meet(free);
            }
        }
        // Fingers not yet in contact stay aside, to be looked at again when the string has been moved.
        let mut position = 0;
        while position < scratch.solver.aside.len() {
            let finger = &mut scratch.solver.aside[position];
            finger.meet(self.free(&finger.reading, free_pull, &scratch.motion));
            if finger.before.penetration + finger.centre > 0.0 {
                *scratch.active.next() = scratch.solver.aside.remove(position);
            } else {
                position += 1;
            }
        }
    }

    /// Shows all that is held how the string would move.
    #[inline(always)]
    pub(crate) fn show(&self, free_pull: f64, scratch: &mut Scratch) {
        for active in scratch.active.iter_mut() {
            active.meet(self.free(&active.reading, free_pull, &scratch.motion));
        }
    }

    /// The motion of a point to n + 1 without contact forces, and the second difference there.
    #[inline(always)]
    fn free(&self, reading: &Reading, free_pull: f64, prediction: &Field) -> Free {
        let [motion, curvature] = reading.of_each([prediction, &self.curvature]);
        Free { motion: motion - free_pull * curvature, curvature }
    }

    /// Adds a fixed contact, which the string's prediction has yet to be shown to, by how deep it was at n − 1 and is at n.
    #[inline(always)]
    fn activate<'a>(
        &self,
        model: &Model,
        index: usize,
        (before, now): (Before, &Pressed),
        scratch: &'a mut Scratch,
    ) -> &'a mut Active {
        let contact = &model.contacts[index];
        let moves = self.heights_rest_in > 0;
        let raised = if moves { self.heights_next[index] - self.heights_before[index] } else { 0.0 };
        let motion = contact.reading.of(&self.motion);
        let mut lossy = model.lossy(|_| now.own_force, contact.damping, now.depth.penetration, 0.0);
        if now.depth.penetration > 0.0 && self.steps < self.calm[index] {
            lossy += contact.radiating(self.calm[index] - self.steps) * model.half_rate;
        }
        scratch.held[index] = self.steps + 1;
        let active = scratch.active.next();
        // What stood here in the last step is mostly the same contact: of that only what changes is written.
        if active.slot != index {
            *active = Active { slot: index, reading: contact.reading, law: contact.law, ..Active::NOTHING };
        }
        active.lossy = lossy;
        active.before = before;
        active.rest = motion - raised;
        active.base = 0.0;
        active.raised = raised;
        active.mobility = scratch.coasting.mobility;
        active.evaluate(raised - 2.0 * motion);
        active
    }

    /// Adds the contacts that the string at n + 1 overlaps but the solution did not hold.
    pub(crate) fn add_missed(&self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        for close in &self.close {
            let index = close.index as usize;
            if self.is_missed(close, &scratch.held) {
                let contact = &model.contacts[index];
                let reading = &contact.reading;
                let [displacement, motion] = reading.of_each([&self.displacement, &self.motion]);
                let before = Before::new(&contact.law, self.heights_before[index] - (displacement - motion));
                let now = contact.pressed(self.heights[index] - displacement);
                let free = self.free(reading, free_pull, &scratch.motion);
                self.activate(model, index, (before, &now), scratch).meet(free);
            }
        }
    }
}
