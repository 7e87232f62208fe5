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

/// How far ahead contacts are looked for, in steps of the size of the last one: all that touch the string at n − 1 or n
/// are within one, and most that will at n + 1 within two. What is driven farther is found when it has been.
const AHEAD: f64 = 2.0;

impl State {
    /// Adds the fixed contacts that touched the string at n − 1 or, as predicted, will at n + 1.
    pub(crate) fn find_fixed(&self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        for &index in &self.close {
            let index = index as usize;
            let reading = &model.contacts[index].reading;
            let now = reading.of(&self.displacement);
            let before = self.heights_before[index] - (now - reading.of(&self.motion));
            let free = scratch.free_motion(reading, free_pull);
            let after = self.heights_next[index] - (now + free);
            if before > 0.0 || after > 0.0 {
                self.activate(model, index, before, free, scratch);
            }
        }
    }

    /// Adds a fixed contact.
    #[inline(always)]
    fn activate(&self, model: &Model, index: usize, before: f64, free: f64, scratch: &mut Scratch) {
        let contact = &model.contacts[index];
        let raised = self.heights_next[index] - self.heights_before[index];
        let motion = contact.reading.of(&self.motion);
        let rest = motion - raised;
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
            expected: raised - 2.0 * motion,
            force: 0.0,
            change: 0.0,
            lambda: 0.0,
            required: 0.0,
            slope: 0.0,
            saved: contact.reading.window(&scratch.prediction),
        });
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
                expected: 2.0 * (reading_now.of(&self.motion) - motion),
                force: 0.0,
                change: 0.0,
                lambda: 0.0,
                required: 0.0,
                slope: 0.0,
                saved: reading.window(&scratch.prediction),
            };
            if before > 0.0 || now > 0.0 || after > 0.0 {
                scratch.active.push(active);
            } else {
                // Not yet in contact: kept aside, to be looked at again when the string has been moved.
                scratch.solver.aside.push(active);
            }
        }
    }

    /// Adds every contact that the string at n + 1 overlaps but the solution did not hold, and keeps those that it
    /// may touch in the next step. No grid point has moved by more than `largest`, m.
    pub(crate) fn find_missed(&mut self, model: &Model, largest: f64, free_pull: f64, scratch: &mut Scratch) {
        let held = scratch.active.len();
        let mut position = 0;
        while let Some(finger) = scratch.solver.aside.get(position) {
            let height = self.fingers[finger.slot - model.contacts.len()].map_or(0.0, |f| f.height);
            if finger.reading.of(&scratch.displacement) - height > 0.0 {
                scratch.active.push(scratch.solver.aside.remove(position));
            } else {
                position += 1;
            }
        }
        if model.contacts.is_empty() {
            return;
        }
        let near = AHEAD * (READING_NORM * largest + self.lifted());
        let margin = scratch.margin(model, near, largest);
        let mut close = std::mem::take(&mut self.close);
        close.clear();
        let (displacement, heights) = (&scratch.displacement, &self.heights_next);
        model.blocks.look(margin, &scratch.clearances, displacement, heights, |index| {
            if model.contacts[index].reading.of(displacement) - heights[index] <= near {
                close.push(index as u32);
            }
        });
        for &index in &close {
            let index = index as usize;
            let gap = model.contacts[index].reading.of(&scratch.displacement) - self.heights_next[index];
            if gap < 0.0 && scratch.held[index] != self.steps + 1 {
                self.add_missed(model, index, held, free_pull, scratch);
            }
        }
        self.close = close;
    }

    /// How far any fixed contact itself moves in this step, m.
    fn lifted(&self) -> f64 {
        if self.settling == 0 {
            return 0.0;
        }
        let lifts = self.heights_next.iter().zip(&self.heights).map(|(next, now)| (next - now).abs());
        lifts.fold(0.0, f64::max)
    }

    #[cold]
    fn add_missed(&self, model: &Model, index: usize, held: usize, free_pull: f64, scratch: &mut Scratch) {
        let reading = &model.contacts[index].reading;
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
