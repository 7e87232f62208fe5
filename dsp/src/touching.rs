//! Which contacts act in a step: those the string touches at n − 1 or n, or would at n + 1.

use pulp::Simd;

use crate::active::Active;
use crate::contact::Before;
use crate::drive::Drive;
use crate::finger::{FingerBefore, Inertia};
use crate::grid::{READING_NORM, Reading};
use crate::model::Model;
use crate::state::{Close, State};
use crate::string::Scratch;

/// What a finger reads of the string under it at n.
#[derive(Clone, Copy)]
struct Under {
    place: f64,
    motion: f64,
}

impl Under {
    /// The place at n − 1.
    fn before(&self) -> f64 {
        self.place - self.motion
    }
}

/// What a contact reads of a step without contact forces.
#[derive(Clone, Copy)]
pub(crate) struct Free {
    /// Motion to n + 1, m.
    pub motion: f64,
    /// Undivided second difference of uⁿ, m.
    pub curvature: f64,
}

/// Penetrations of a fixed contact at n − 1 and n, m.
#[derive(Clone, Copy)]
struct Overlap {
    before: f64,
    now: f64,
}

impl Scratch {
    /// The motion of a point to n + 1 without contact forces, and the second difference there.
    #[inline(always)]
    pub(crate) fn free(&self, reading: &Reading, free_pull: f64) -> Free {
        let curvature = reading.of(&self.curvature);
        Free { motion: reading.of(&self.prediction) - free_pull * curvature, curvature }
    }
}

/// How far ahead contacts are predicted, in steps of the size of the last one: all that touch the string at n − 1 or n
/// are within one, and most that will at n + 1 within two. What is driven farther is found when it has been.
const AHEAD: f64 = 2.0;

/// How far ahead they are looked for, likewise: the farther, the less often, and the more are to be watched.
const WATCHED: f64 = 12.0;

impl State {
    /// Adds the fixed contacts that touched the string at n − 1 or, as predicted, will at n + 1; lossy ones also if they
    /// touch it at n.
    #[inline(always)]
    pub(crate) fn find_fixed(&self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        let near = AHEAD * self.nearer;
        for close in &self.close {
            let index = close.index as usize;
            let now = self.heights[index] - close.displacement;
            if now < -near {
                continue;
            }
            let reading = &model.contacts[index].reading;
            let before = self.heights_before[index] - close.before;
            let free = scratch.free(reading, free_pull);
            let after = self.heights_next[index] - (close.displacement + free.motion);
            // A lossy one resists at n what goes on into it, even if that is out of it before and after.
            let resists = now > 0.0 && model.contacts[index].damping > 0.0;
            if before > 0.0 || after > 0.0 || resists {
                self.activate(model, index, Overlap { before, now }, free, scratch);
            }
        }
    }

    /// Adds a fixed contact.
    #[inline(always)]
    fn activate(&self, model: &Model, index: usize, overlap: Overlap, free: Free, scratch: &mut Scratch) {
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
            lossy: model.lossy(&contact.law, contact.damping, overlap.now, 0.0),
            before: Before::new(&contact.law, overlap.before),
            rest,
            base: 0.0,
            centre: -(free.motion + rest),
            raised,
            own_mobility: 0.0,
            mobility: model.mobility,
            pull: free.curvature,
            expected: raised - 2.0 * motion,
            force: 0.0,
            change: 0.0,
            lambda: 0.0,
            required: 0.0,
            slope: 0.0,
        });
    }

    /// Moves every finger as if it were free, and adds those that touch the string at n − 1, n or, as
    /// predicted, n + 1.
    #[inline(always)]
    pub(crate) fn find_fingers(
        &mut self,
        model: &Model,
        drive: &Drive,
        free_pull: f64,
        resting: bool,
        scratch: &mut Scratch,
    ) {
        for slot in 0..self.fingers.len() {
            let Some(finger) = &mut self.fingers[slot] else {
                if scratch.fingers[slot].is_some() {
                    scratch.fingers[slot] = None;
                }
                continue;
            };
            let (height, motion, reading_before) = (finger.height, finger.motion, finger.reading_before);
            scratch.fingers[slot] = Some(FingerBefore { height, motion, reading_before });
            let mut hand = drive.hands[slot];
            if resting {
                hand.position = finger.position;
            }
            let Inertia { mobility: own_mobility, persistence } = finger.inertia;
            let free = persistence * motion - own_mobility * hand.force;
            let (law, damping) = (finger.law, finger.touch.damping);
            let under = |reading: &Reading| Under {
                place: reading.of(&self.displacement),
                motion: reading.of(&self.motion),
            };
            // A finger that stays where it is reads the string once.
            let now = under(&finger.reading);
            let past = if reading_before.same_place(&finger.reading) { now } else { under(&reading_before) };
            finger.reading_before = finger.reading;
            let mut here = now;
            if hand.position != finger.position {
                finger.position = hand.position;
                finger.reading = model.grid.reading(hand.position);
                here = under(&finger.reading);
            }
            finger.motion = free;
            finger.height = height + free;
            let reading = finger.reading;

            let before = past.before() - (height - motion);
            let string_free = scratch.free(&reading, free_pull);
            let after = here.place + string_free.motion - (height + free);
            let slid = if reading.same_place(&reading_before) { 0.0 } else { here.before() - past.before() };
            let rest = (free + motion) - slid - here.motion;
            let penetration = now.place - height;
            scratch.active.push(Active {
                slot: model.contacts.len() + slot,
                reading,
                sign: -1.0,
                law,
                lossy: model.lossy(&law, damping, penetration, own_mobility),
                before: Before::new(&law, before),
                rest,
                base: 0.0,
                centre: -(rest - string_free.motion),
                raised: 0.0,
                own_mobility,
                mobility: model.mobility,
                pull: -string_free.curvature,
                expected: 2.0 * (now.motion - motion),
                force: 0.0,
                change: 0.0,
                lambda: 0.0,
                required: 0.0,
                slope: 0.0,
            });
            // Not yet in contact: kept aside, to be looked at again when the string has been moved.
            let touches = before > 0.0 || penetration > 0.0 || after > 0.0;
            if !touches && let Some(finger) = scratch.active.pop() {
                scratch.solver.aside.push(finger);
            }
        }
    }

    /// Whether the string at n + 1 overlaps a contact that the solution did not hold. Fingers of which that is true are
    /// added to it. Keeps watch of the fixed contacts that may be touched next. No grid point has moved by more than
    /// `largest`, m. `again` where this step has been taken and looked at before.
    #[inline(always)]
    pub(crate) fn find_missed<S: Simd>(
        &mut self,
        simd: S,
        model: &Model,
        largest: f64,
        again: bool,
        scratch: &mut Scratch,
    ) -> bool {
        let mut missed = false;
        let mut position = 0;
        while let Some(finger) = scratch.solver.aside.get(position) {
            let height = self.fingers[finger.slot - model.contacts.len()].map_or(0.0, |f| f.height);
            if finger.reading.of(&scratch.displacement) - height > 0.0 {
                scratch.active.push(scratch.solver.aside.remove(position));
                missed = true;
            } else {
                position += 1;
            }
        }
        if model.contacts.is_empty() {
            return missed;
        }
        let nearer = READING_NORM * largest + self.lifted();
        // (What is close may be known for a string that then did not move so.)
        if again || self.sure - nearer <= AHEAD * nearer {
            self.look_around(simd, model, nearer, largest, scratch);
        } else {
            self.sure -= nearer;
            for close in &mut self.close {
                close.before = close.displacement;
                close.displacement = model.contacts[close.index as usize].reading.of(&scratch.displacement);
            }
        }
        self.nearer = nearer;
        missed | self.close.iter().any(|close| self.is_missed(close, &scratch.held))
    }

    /// Whether the string at n + 1 overlaps a contact that was not held in this step.
    #[inline(always)]
    fn is_missed(&self, close: &Close, held: &[u64]) -> bool {
        let index = close.index as usize;
        close.displacement < self.heights_next[index] && held[index] != self.steps + 1
    }

    /// Looks through all fixed contacts for those that are close, were the string to go on as in this step.
    #[inline(always)]
    fn look_around<S: Simd>(
        &mut self,
        simd: S,
        model: &Model,
        nearer: f64,
        largest: f64,
        scratch: &mut Scratch,
    ) {
        self.sure = WATCHED * nearer;
        let (near, margin) = (self.sure, scratch.margin(model, self.sure, largest));
        let Scratch { kernel, displacement, clearances, .. } = scratch;
        kernel.clear(simd, displacement, &self.skyline, clearances);
        self.close.clear();
        model.blocks.look(margin, clearances, &self.heights_next, |index| {
            let reading = &model.contacts[index].reading;
            let displacement = reading.of(displacement);
            if displacement - self.heights_next[index] <= near {
                let before = reading.of(&self.displacement);
                self.close.push(Close { index: index as u32, displacement, before });
            }
        });
    }

    /// How far any fixed contact itself moves in this step, m.
    fn lifted(&self) -> f64 {
        if self.settling == 0 {
            return 0.0;
        }
        let lifts = self.heights_next.iter().zip(&self.heights).map(|(next, now)| (next - now).abs());
        lifts.fold(0.0, f64::max)
    }

    /// Adds the contacts that the string at n + 1 overlaps but the solution did not hold.
    pub(crate) fn add_missed(&self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        for close in &self.close {
            let index = close.index as usize;
            if self.is_missed(close, &scratch.held) {
                let reading = &model.contacts[index].reading;
                let displacement = reading.of(&self.displacement);
                let past = displacement - reading.of(&self.motion);
                let overlap = Overlap {
                    before: self.heights_before[index] - past,
                    now: self.heights[index] - displacement,
                };
                let free = scratch.free(reading, free_pull);
                self.activate(model, index, overlap, free, scratch);
            }
        }
    }
}
