//! Fixed contacts that are close to the string, and how long each is left alone.
//!
//! In a step the string comes nearer to no contact by more than its fastest point moves. So one that is some way off need not be
//! read before the string may be within [`AHEAD`] steps of it; and those that are not even close are looked through only when
//! the string may have come so near to one of them.

use crate::contact::Before;
use crate::grid::READING_NORM;
use crate::instructions::Vectors;
use crate::model::{Contact, Model};
use crate::state::State;
use crate::string::Scratch;

/// How far ahead contacts are predicted, in steps of the size of the last one: all that touch the string at n − 1 or n
/// are within one, and most that will at n + 1 within two. What is driven farther is found when it has been.
pub(crate) const AHEAD: f64 = 2.0;

/// How far ahead they are looked for, likewise: the farther, the less often, and the more are to be watched.
pub(crate) const WATCHED: f64 = 16.0;

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
    /// What is left of what is sure when the string may have come to it, m. (It is less than that by the distance at which it
    /// was read.)
    pub reach: f64,
}

impl Close {
    /// One at a height over which the string is displaced so much, m, when so much is sure; where it was a step ago is not known.
    #[inline(always)]
    pub fn new(index: usize, contact: &Contact, displacement: f64, height: f64, sure: f64) -> Self {
        let now = contact.pressed(height - displacement);
        let reach = sure + now.depth.penetration;
        Close { index: index as u32, displacement, now, before: Before::NOTHING, reach }
    }

    /// Whether it is too far off to be read, where the string is known to come no nearer to any until so much is left of what is
    /// sure, m.
    #[inline(always)]
    pub fn is_left_alone(&self, ahead: f64) -> bool {
        self.reach < ahead
    }
}

impl State {
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
            return missed | self.close.iter().any(|close| self.is_missed(close, &scratch.held));
        }
        missed | self.watch(model, nearer, scratch)
    }

    /// What of what is sure will be left when the string has gone on for so many steps as are looked ahead.
    #[inline(always)]
    pub(crate) fn ahead(&self) -> f64 {
        self.sure - AHEAD * self.nearer
    }

    /// Reads the close contacts that are not left alone, in a step in which the string has come nearer to any by no more than
    /// `nearer`, m. Returns whether one of them was missed.
    #[inline(always)]
    fn watch(&mut self, model: &Model, nearer: f64, scratch: &Scratch) -> bool {
        let ahead_before = self.ahead();
        self.sure -= nearer;
        self.nearer = nearer;
        let ahead = self.ahead();
        let mut missed = false;
        for close in &mut self.close {
            if close.is_left_alone(ahead) {
                continue;
            }
            let index = close.index as usize;
            let (contact, height) = (&model.contacts[index], self.heights_next[index]);
            close.before = if close.is_left_alone(ahead_before) {
                Before::new(&contact.law, self.heights[index] - contact.reading.of(&self.displacement))
            } else {
                close.now.depth
            };
            close.displacement = contact.reading.of(&scratch.displacement);
            close.now = contact.pressed(height - close.displacement);
            close.reach = self.sure + close.now.depth.penetration;
            missed |= close.displacement < height && scratch.held[index] != self.steps + 1;
        }
        missed
    }

    /// Whether the string at n + 1 overlaps a contact that was not held in this step.
    #[inline(always)]
    pub(crate) fn is_missed(&self, close: &Close, held: &[u64]) -> bool {
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
        (self.sure, self.nearer) = (WATCHED * nearer, nearer);
        let (near, margin, ahead) = (self.sure, scratch.margin(model, self.sure, largest), self.ahead());
        let Scratch { kernel, displacement, clearances, .. } = scratch;
        kernel.clear(simd, displacement, &self.skyline, clearances);
        self.close.clear();
        model.blocks.look(margin, clearances, &self.heights_next, |index| {
            let contact = &model.contacts[index];
            let reading = &contact.reading;
            let (displacement, height) = (reading.of(displacement), self.heights_next[index]);
            if displacement - height <= near {
                let mut close = Close::new(index, contact, displacement, height, near);
                if !close.is_left_alone(ahead) {
                    let before = self.heights[index] - reading.of(&self.displacement);
                    close.before = Before::new(&contact.law, before);
                }
                self.close.push(close);
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
}

#[cfg(test)]
mod tests;
