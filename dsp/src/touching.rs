//! Which contacts act in a step: those the string touches at n − 1 or n, or would at n + 1.

use crate::active::Active;
use crate::contact::Before;
use crate::drive::Drive;
use crate::grid::{READING_NORM, Reading};
use crate::instructions::Vectors;
use crate::model::{Contact, Model};
use crate::skyline::draw;
use crate::state::{Close, State};
use crate::string::Scratch;

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
    /// Shows the last contact added how the string would move.
    #[inline(always)]
    fn show_last(&mut self, free: Free) {
        if let Some(last) = self.active.last_mut() {
            last.meet(free);
        }
    }
}

/// How far ahead contacts are predicted, in steps of the size of the last one: all that touch the string at n − 1 or n
/// are within one, and most that will at n + 1 within two. What is driven farther is found when it has been.
const AHEAD: f64 = 2.0;

/// How far ahead they are looked for, likewise: the farther, the less often, and the more are to be watched.
const WATCHED: f64 = 12.0;

impl State {
    /// Takes up what is known to act before the string is predicted: the fixed contacts that touched the string at n − 1, lossy
    /// ones also if they touch it at n, and the fingers that did at either. The other fingers are kept aside.
    #[inline(always)]
    pub(crate) fn hold(&mut self, model: &Model, drive: &Drive, resting: bool, scratch: &mut Scratch) {
        if !drive.heights.is_empty() && !resting {
            self.heights_next.copy_from_slice(&drive.heights);
            draw(&model.grid, &model.contacts, &self.heights_next, &mut self.skyline);
            self.heights_rest_in = 2;
        }
        scratch.active.clear();
        scratch.near.clear();
        let near = AHEAD * self.nearer;
        for position in 0..self.close.len() {
            let close = &self.close[position];
            let index = close.index as usize;
            let overlap = self.overlap(close);
            if overlap.now > 0.0 && overlap.before <= 0.0 {
                self.calm[index] = self.steps + Contact::RADIATING;
            }
            // A lossy one resists at n what goes on into it, even if that is out of it before and after.
            let resists = overlap.now > 0.0 && model.contacts[index].resists();
            if overlap.before > 0.0 || resists {
                self.activate(model, index, overlap, scratch);
            } else if overlap.now >= -near {
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
            let touches = finger.hold(model, &hand, string, mobility, slot, scratch.active.next());
            if !touches && let Some(finger) = scratch.active.pop() {
                scratch.solver.aside.push(finger);
            }
        }
        self.no_finger_from = last;
        let k = model.grid.time_step;
        scratch.finger_energy = 0.5 * squares / (k * k);
    }

    /// Shows all that is held how the string would move, and adds what that drives the string into.
    #[inline(always)]
    pub(crate) fn touch(&self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        for index in 0..scratch.active.len() {
            let free = self.free(&scratch.active[index].reading, free_pull, scratch);
            scratch.active[index].meet(free);
        }
        for position in 0..scratch.near.len() {
            let close = &self.close[scratch.near[position]];
            let index = close.index as usize;
            let free = self.free(&model.contacts[index].reading, free_pull, scratch);
            if close.displacement + free.motion < self.heights_next[index] {
                self.activate(model, index, self.overlap(close), scratch);
                scratch.show_last(free);
            }
        }
        // Fingers not yet in contact stay aside, to be looked at again when the string has been moved.
        let mut position = 0;
        while position < scratch.solver.aside.len() {
            let free = self.free(&scratch.solver.aside[position].reading, free_pull, scratch);
            let finger = &mut scratch.solver.aside[position];
            finger.meet(free);
            if finger.before.penetration + finger.centre > 0.0 {
                *scratch.active.next() = scratch.solver.aside.remove(position);
            } else {
                position += 1;
            }
        }
    }

    /// The motion of a point to n + 1 without contact forces, and the second difference there.
    #[inline(always)]
    pub(crate) fn free(&self, reading: &Reading, free_pull: f64, scratch: &Scratch) -> Free {
        let [motion, curvature] = reading.of_each([&scratch.prediction, &self.curvature]);
        Free { motion: motion - free_pull * curvature, curvature }
    }

    /// How deep the string is in a fixed contact.
    #[inline(always)]
    fn overlap(&self, close: &Close) -> Overlap {
        let index = close.index as usize;
        let before = self.heights_before[index] - close.before;
        Overlap { before, now: self.heights[index] - close.displacement }
    }

    /// Adds a fixed contact, which the string's prediction has yet to be shown to.
    #[inline(always)]
    fn activate(&self, model: &Model, index: usize, overlap: Overlap, scratch: &mut Scratch) {
        let contact = &model.contacts[index];
        let raised = self.heights_next[index] - self.heights_before[index];
        let motion = contact.reading.of(&self.motion);
        let mut lossy = model.lossy(|depth| contact.own_force(depth), contact.damping, overlap.now, 0.0);
        if overlap.now > 0.0 && self.steps < self.calm[index] {
            lossy += contact.radiating(self.calm[index] - self.steps) * model.half_rate;
        }
        scratch.held[index] = self.steps + 1;
        let active = scratch.active.next();
        *active = Active {
            slot: index,
            reading: contact.reading,
            law: contact.law,
            lossy,
            before: Before::new(&contact.law, overlap.before),
            rest: motion - raised,
            raised,
            mobility: scratch.coasting.mobility,
            ..Active::NOTHING
        };
        active.evaluate(raised - 2.0 * motion);
    }

    /// Whether the string at n + 1 overlaps a contact that the solution did not hold. Fingers of which that is true are
    /// added to it. Keeps watch of the fixed contacts that may be touched next. No grid point has moved by more than
    /// `largest`, m. `again` where this step has been taken and looked at before.
    #[inline(always)]
    pub(crate) fn find_missed<V: Vectors>(
        &mut self,
        simd: V,
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
                *scratch.active.next() = scratch.solver.aside.remove(position);
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
    fn look_around<V: Vectors>(
        &mut self,
        simd: V,
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
        if self.heights_rest_in == 0 {
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
                let free = self.free(reading, free_pull, scratch);
                self.activate(model, index, overlap, scratch);
                scratch.show_last(free);
            }
        }
    }
}
