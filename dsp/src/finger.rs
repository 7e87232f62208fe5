//! A finger near a string.

use crate::active::{Active, ActiveSet};
use crate::contact::{Before, ContactLaw};
use crate::drive::Hand;
use crate::field::Field;
use crate::gesture::Touch;
use crate::grid::{Grid, Reading};
use crate::kernel::STILL;
use crate::model::Model;

/// A finger near the string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finger {
    /// Its parameters.
    pub touch: Touch,
    /// Which of all fingers it is that have been placed on the string, from 1 on; 0 before it is.
    pub(crate) number: u64,
    /// Contact law of its pad.
    pub law: ContactLaw,
    /// How it moves by itself.
    pub(crate) inertia: Inertia,
    /// Height of the pad uⁿ, m.
    pub height: f64,
    /// Motion in the last step uⁿ − uⁿ⁻¹, m.
    pub motion: f64,
    /// Place at n, m from the nut.
    pub position: f64,
    /// Place at n − 1.
    pub(crate) position_before: f64,
    /// Reading of the string under it at n.
    pub reading: Reading,
    /// Reading of the string under it at n − 1.
    pub reading_before: Reading,
}

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

impl Finger {
    /// At a place (m from the nut), a height (m) and a velocity (m/s), its pad with a law.
    pub(crate) fn over(
        model: &Model,
        touch: Touch,
        law: ContactLaw,
        position: f64,
        height: f64,
        velocity: f64,
    ) -> Self {
        let reading = model.grid.reading(position);
        let motion = velocity * model.grid.time_step;
        let inertia = Inertia::new(&touch, model.grid.time_step);
        Finger {
            touch,
            number: 0,
            law,
            inertia,
            height,
            motion,
            position,
            position_before: position,
            reading,
            reading_before: reading,
        }
    }

    /// Moves it by a step as if it were free, and makes it a contact with a string of this displacement and motion at n, which one
    /// newton moves by its mobility, m/N, in a step: an active one if it touches that at n − 1 or n, or else one aside.
    #[inline(always)]
    pub(crate) fn hold(
        &mut self,
        model: &Model,
        hand: &Hand,
        (displacement, motion): (&Field, &Field),
        mobility: f64,
        slot: usize,
        [active, aside]: [&mut ActiveSet; 2],
    ) {
        let (height, motion_before) = (self.height, self.motion);
        let Inertia { mobility: own_mobility, persistence, .. } = self.inertia;
        let free = persistence * motion_before - own_mobility * hand.force;
        // What a hand brakes would move by ever smaller numbers otherwise.
        let free = if free.abs() < STILL { 0.0 } else { free };
        let under = |reading: &Reading| {
            let [place, motion] = reading.of_each([displacement, motion]);
            Under { place, motion }
        };
        // A finger that stays where it is reads the string once.
        let now = under(&self.reading);
        let has_slid = self.position != self.position_before;
        let past = if has_slid { under(&self.reading_before) } else { now };
        let slides = hand.position != self.position;
        if has_slid || slides {
            self.position_before = self.position;
            self.reading_before = self.reading;
        }
        let mut here = now;
        if slides {
            self.position = hand.position;
            self.reading = model.grid.reading(hand.position);
            here = under(&self.reading);
        }
        self.motion = free;
        self.height = height + free;
        let slid = if has_slid || slides { here.before() - past.before() } else { 0.0 };
        let penetration_before = past.before() - (height - motion_before);
        let penetration = now.place - height;
        let slot = model.contacts.len() + slot;
        let touches = penetration_before > 0.0 || penetration > 0.0;
        let active = if touches { active.next() } else { aside.next() };
        // What stood here in the last step is mostly this finger where it is now: of that only what changes is written.
        if active.slot != slot || active.number != self.number {
            *active = Active { slot, number: self.number, sign: -1.0, law: self.law, ..Active::NOTHING };
        }
        if active.position != self.position {
            active.position = self.position;
            active.reading = self.reading;
        }
        active.lossy =
            model.lossy(|depth| self.law.force(depth), self.touch.damping, penetration, own_mobility);
        active.before = Before::new(&self.law, penetration_before);
        active.rest = (free + motion_before) - slid - here.motion;
        active.base = 0.0;
        active.own_mobility = own_mobility;
        active.mobility = mobility;
        active.evaluate(2.0 * (now.motion - motion_before));
    }

    /// What a step overwrites of it.
    fn before(&self) -> FingerBefore {
        FingerBefore { height: self.height, motion: self.motion, position_before: self.position_before }
    }

    /// Keeps what a step overwrites of it, number by number: a whole that is put together first is waited for.
    #[inline(always)]
    pub(crate) fn remember(&self, place: &mut Option<FingerBefore>) {
        match place {
            Some(before) => {
                before.height = self.height;
                before.motion = self.motion;
                before.position_before = self.position_before;
            }
            None => *place = Some(self.before()),
        }
    }

    /// The finger before the last step.
    pub(crate) fn back(&self, grid: &Grid, before: &FingerBefore) -> Finger {
        let FingerBefore { height, motion, position_before } = *before;
        let (position, reading) = (self.position_before, self.reading_before);
        let reading_before = grid.reading(position_before);
        Finger { height, motion, position, position_before, reading, reading_before, ..*self }
    }
}

/// How a finger moves between hand and string, at one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Inertia {
    /// M̃ = Rk/2 / tanh(Rk/(2M)), the mass that it moves with in steps of this length, kg: M(1 + (Rk/M)²/12 − …).
    pub mass: f64,
    /// k²/(M̃ + Rk/2), what one newton moves it in a step, m/N.
    pub mobility: f64,
    /// (M̃ − Rk/2)/(M̃ + Rk/2), how much of its motion is left after a step: exp(−Rk/M).
    pub persistence: f64,
}

impl Inertia {
    /// Of a finger with its hand.
    ///
    /// With M itself a finger that a hand brakes hard, R > 2M/k, would turn round in each step. With M̃ it comes to rest as
    /// fast as the continuous one, and a steady force moves it at F/R, whatever the step.
    pub fn new(touch: &Touch, time_step: f64) -> Self {
        let half_loss = 0.5 * touch.hand_damping * time_step;
        // Of a loss that is nothing beside the mass: without, below it would be 0/0, and of less than any normal number x/0.
        let part = half_loss / touch.mass;
        let braked = if part >= f64::MIN_POSITIVE { half_loss / libm::tanh(part) } else { touch.mass };
        let mass = braked.max(touch.mass);
        let heft = mass + half_loss;
        Inertia { mass, mobility: time_step * time_step / heft, persistence: (mass - half_loss) / heft }
    }
}

/// What a step overwrites of a finger.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FingerBefore {
    /// Height of the pad uⁿ, m.
    pub height: f64,
    /// Motion uⁿ − uⁿ⁻¹, m.
    pub motion: f64,
    /// Place at n − 1, m from the nut.
    pub position_before: f64,
}
