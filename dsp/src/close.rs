//! Fixed contacts that are close to the string; all others are asleep.
//!
//! Those that are close are read in every step. Of the others the string knows a skyline, and in each step how far its lowest point
//! is over it: when one has come near, what is beside it wakes up, and what is farther off again falls asleep.

use crate::contact::Before;
use crate::field::LANES;
use crate::instructions::Vectors;
use crate::kernel::Moved;
use crate::model::{Contact, Model};
use crate::state::State;
use crate::string::Scratch;

/// How near a contact wakes up, in steps as points take them on the mean (the root of the mean square), and how far off it falls
/// asleep. What is not awake when the string is driven into it is found when it has been, and its step is taken twice, so that a small
/// number costs time only, and so does a large one.
pub(crate) const WAKING: f64 = 2.0;
const DOZING: f64 = 3.0;

/// How deep a fixed contact is in the string at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pressed {
    /// Penetration and energy, as the law of a later step asks for them.
    pub depth: Before,
    /// [The force](crate::model::Contact::own_force) on which its damping acts, N.
    pub own_force: f64,
}

/// A fixed contact that the string may touch soon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Close {
    /// Its index.
    pub index: u32,
    /// The displacement of the string there, m.
    pub displacement: f64,
    /// How deep it is in the string, now and a step ago.
    pub now: Pressed,
    pub before: Before,
}

impl Close {
    /// One at a height now over which the string is displaced so much, and at one a step ago, m each.
    #[inline(always)]
    pub fn new(index: usize, contact: &Contact, now: [f64; 2], before: [f64; 2]) -> Self {
        let [penetration, penetration_before] =
            [now, before].map(|[displacement, height]| height - displacement);
        Close {
            index: index as u32,
            displacement: now[0],
            now: contact.pressed(penetration),
            before: Before::new(&contact.law, penetration_before),
        }
    }
}

impl State {
    /// Whether the string at n + 1, which has moved so, overlaps a contact that the solution did not hold. Fingers of which that
    /// is true are added to it. Wakes up the fixed contacts that may be touched next. `again` where this step has been taken and
    /// looked at before.
    #[inline(always)]
    pub(crate) fn find_missed<V: Vectors>(
        &mut self,
        simd: V,
        model: &Model,
        moved: &Moved,
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
        let step = (moved.squares * model.point_share).sqrt() + self.lifted();
        let sag = scratch.sag(model);
        missed |= self.watch(model, DOZING * step + sag, again, scratch);
        let near = WAKING * step + sag;
        if simd.any_at_most(&moved.over, near) {
            missed |= self.wake(model, moved, near, scratch);
        }
        missed
    }

    /// Reads the close contacts, and has those fall asleep that are farther off than `far`, m. Returns whether one of them was
    /// missed.
    #[inline(always)]
    fn watch(&mut self, model: &Model, far: f64, again: bool, scratch: &Scratch) -> bool {
        let (mut missed, mut some_far) = (false, false);
        for close in &mut self.close {
            let index = close.index as usize;
            let (contact, height) = (&model.contacts[index], self.heights_next[index]);
            // (Where the step is taken again this has been done.)
            if !again {
                close.before = close.now.depth;
            }
            close.displacement = contact.reading.of(&scratch.displacement);
            close.now = contact.pressed(height - close.displacement);
            missed |= close.displacement < height && scratch.held[index] != self.steps + 1;
            some_far |= close.displacement - height > far;
        }
        if some_far {
            self.doze(model, far, scratch);
        }
        missed
    }

    /// Whether the string at n + 1 overlaps a contact that was not held in this step.
    pub(crate) fn is_missed(&self, close: &Close, held: &[u64]) -> bool {
        let index = close.index as usize;
        close.displacement < self.heights_next[index] && held[index] != self.steps + 1
    }

    /// Has close contacts fall asleep that do not touch the string and are farther off than `far`, m.
    #[inline(never)]
    fn doze(&mut self, model: &Model, far: f64, scratch: &Scratch) {
        let State { close, asleep, heights_next, skyline, .. } = self;
        let (beside, u) = (&model.beside, &scratch.displacement);
        close.retain(|close| {
            let index = close.index as usize;
            let touched = close.now.depth.penetration.max(close.before.penetration) > 0.0;
            let line = beside.line(index, u);
            if touched || !beside.may_sleep(index) || line.displacement - heights_next[index] <= far {
                return true;
            }
            asleep[index] = Some(line.rise);
            for cell in beside.cells(index) {
                beside.draw(cell, heights_next, asleep, skyline);
            }
            false
        });
    }

    /// Wakes up what is beside points that are no more than `near`, m, over the skyline. Returns whether one of these contacts was
    /// missed.
    #[inline(never)]
    fn wake(&mut self, model: &Model, moved: &Moved, near: f64, scratch: &Scratch) -> bool {
        let (beside, u) = (&model.beside, &scratch.displacement);
        let woken_from = self.close.len();
        let mut missed = false;
        let rows = u.len() / LANES;
        let lanes = (0..LANES).filter(|&lane| moved.over[lane] <= near);
        for cell in lanes.flat_map(|lane| (0..rows).map(move |row| LANES * row + lane)) {
            if u[cell] - self.skyline[cell] > near {
                continue;
            }
            for index in beside.contacts(cell) {
                let Some(rise) = self.asleep[index] else { continue };
                if u[cell] - beside.piece(index, cell, self.heights_next[index], rise) > near {
                    continue;
                }
                self.asleep[index] = None;
                let contact = &model.contacts[index];
                let now = [contact.reading.of(u), self.heights_next[index]];
                let before = [contact.reading.of(&self.displacement), self.heights[index]];
                let close = Close::new(index, contact, now, before);
                missed |= self.is_missed(&close, &scratch.held);
                self.close.push(close);
            }
        }
        for position in woken_from..self.close.len() {
            for cell in beside.cells(self.close[position].index as usize) {
                beside.draw(cell, &self.heights_next, &self.asleep, &mut self.skyline);
            }
        }
        self.close.sort_unstable_by_key(|close| close.index);
        missed
    }

    /// How far any fixed contact itself moves in this step, m.
    fn lifted(&self) -> f64 {
        if self.heights_rest_in == 0 {
            return 0.0;
        }
        let lifts = self.heights_next.iter().zip(&self.heights).map(|(next, now)| (next - now).abs());
        lifts.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests;
