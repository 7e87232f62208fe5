//! Which contacts act in a step: those the string touches at n − 1 or n, or would at n + 1.

use crate::active::Active;
use crate::contact::Before;
use crate::drive::Drive;
use crate::grid::{READING_NORM, Reading};
use crate::model::{Model, STEEPEST};
use crate::state::State;
use crate::string::Scratch;

impl Scratch {
    /// The motion of a point to n + 1 without contact forces.
    #[inline(always)]
    pub(crate) fn free_motion(&self, reading: &Reading, free_pull: f64) -> f64 {
        reading.of(&self.prediction) - free_pull * reading.of(&self.curvature)
    }
}

impl State {
    /// Adds the fixed contacts that touched the string at n − 1 or, as predicted, will at n + 1.
    pub(crate) fn find_fixed(&mut self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        let ahead = self.watch.ahead();
        self.watch.look(ahead);
        for position in 0..self.watch.near().len() {
            let index = self.watch.near()[position] as usize;
            if !self.watch.is_due(index, ahead) {
                continue;
            }
            let reading = &model.contacts[index].reading;
            let now = reading.of(&self.displacement);
            let before = self.heights_before[index] - (now - reading.of(&self.motion));
            let free = scratch.free_motion(reading, free_pull);
            let after = self.heights_next[index] - (now + free);
            if before > 0.0 || after > 0.0 {
                self.activate(model, index, before, free, scratch);
            } else {
                self.watch.note(index, now - self.heights[index]);
            }
        }
    }

    /// Adds a fixed contact.
    #[inline(always)]
    fn activate(&self, model: &Model, index: usize, before: f64, free: f64, scratch: &mut Scratch) {
        let contact = &model.contacts[index];
        let raised = self.heights_next[index] - self.heights_before[index];
        let rest = contact.reading.of(&self.motion) - raised;
        scratch.held[index] = self.steps + 1;
        scratch.active.push(Active {
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
            saved: contact.reading.window(&scratch.prediction),
        });
    }

    /// Forces of the last three steps, continued by a parabola where they lie on one, otherwise by a line.
    #[inline(always)]
    fn start_force(&self, slot: usize) -> f64 {
        let history = &self.forces[slot];
        if history.step != self.steps {
            return 0.0;
        }
        let slope = history.last - history.before;
        let bend = slope - (history.before - history.earlier);
        let bend = if bend.abs() <= slope.abs() { bend } else { 0.0 };
        (history.last + slope + bend).max(0.0)
    }

    /// Moves every finger as if it were free, and adds those that touch the string at n − 1, n or, as
    /// predicted, n + 1.
    pub(crate) fn find_fingers(
        &mut self,
        model: &Model,
        drive: &Drive,
        free_pull: f64,
        resting: bool,
        scratch: &mut Scratch,
    ) {
        let k = model.grid.time_step;
        for slot in 0..self.fingers.len() {
            let Some(finger) = &mut self.fingers[slot] else {
                if scratch.fingers[slot].is_some() {
                    scratch.fingers[slot] = None;
                }
                continue;
            };
            scratch.fingers[slot] = Some(*finger);
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
            let string_free = scratch.free_motion(&reading, free_pull);
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
                saved: reading.window(&scratch.prediction),
            };
            if before > 0.0 || now > 0.0 || after > 0.0 {
                scratch.held[active.slot] = self.steps + 1;
                scratch.active.push(active);
            } else {
                // Not yet in contact: kept aside, to be looked at again when the string has been moved.
                scratch.solver.aside.push(active);
            }
        }
    }

    /// Adds every contact that the string at n + 1 overlaps but the solution did not hold. Returns how far the
    /// string can have moved against any fixed contact, m.
    pub(crate) fn find_missed(
        &mut self,
        model: &Model,
        drive: &Drive,
        largest: f64,
        free_pull: f64,
        scratch: &mut Scratch,
    ) -> f64 {
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
        let lifted = if drive.heights.is_empty() {
            0.0
        } else {
            let lifts = self.heights_next.iter().zip(&self.heights).map(|(next, now)| (next - now).abs());
            lifts.fold(0.0f64, f64::max)
        };
        let moved = READING_NORM * largest + lifted;
        let way = self.watch.after(moved);
        self.watch.look(way);
        for position in 0..self.watch.near().len() {
            let index = self.watch.near()[position] as usize;
            if self.watch.is_due(index, way) && scratch.held[index] != self.steps + 1 {
                self.add_missed(model, index, held, free_pull, scratch);
            }
        }
        moved
    }

    fn add_missed(&self, model: &Model, index: usize, held: usize, free_pull: f64, scratch: &mut Scratch) {
        let reading = &model.contacts[index].reading;
        let overlap = self.heights_next[index] - reading.of(&scratch.displacement);
        // Written so that a string that is not a number counts as clear.
        let overlaps = overlap > 0.0;
        if !overlaps {
            return;
        }
        let before = self.heights_before[index] - (reading.of(&self.displacement) - reading.of(&self.motion));
        // The prediction holds forces by now; the free one is what was saved under them.
        let mut window = reading.window(&scratch.prediction);
        for active in &scratch.active[..held] {
            for (offset, &saved) in active.saved.iter().enumerate() {
                let node = active.reading.first + offset;
                if node >= reading.first && node < reading.first + 4 {
                    window[node - reading.first] = saved;
                }
            }
        }
        let free = reading.of_window(&window) - free_pull * reading.of(&scratch.curvature);
        self.activate(model, index, before, free, scratch);
        if let Some(added) = scratch.active.last_mut() {
            added.saved = window;
        }
    }
}
