//! The body under the bridge, as far as one string moves it: it gives way to strings, loses what air and wood take, and sounds.
//!
//! Each mode is a mass of 1 kg on a spring. The bridge is where their motions q add up, w = Σφq. A string's end goes with it:
//! seen from the straight line between its ends the string moves as one with fixed ends, so that the same passes do for it,
//! and what the line adds is a push on the few points next to the bridge and as much the other way on the body
//! (docs/physics.md). Modes are linear, so what each string of an instrument has them do is kept apart, to be heard as that
//! string's own; the bridge, the same under all strings, is where all of it adds up. A scene has one [`Modes`] for all.

mod coefficients;
mod end;
mod modes;
mod refusals;
mod swing;

use crate::drive::Push;
use crate::model::Model;
use crate::setup::Body as Description;
use crate::state::State;
pub(crate) use end::End;
pub(crate) use modes::Modes;
pub(crate) use refusals::check;

/// A body as one string moves it.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    modes: Modes,
    end: End,
    still: bool,
    /// Whether it has never moved, nor taken over from another that has.
    new: bool,
}

/// What is heard of a body at a sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Heard {
    /// Sound pressure, Pa.
    pub pressure: f64,
    /// How far the bridge is up, by all strings, m.
    pub lift: f64,
    /// The force on the bridge of a string that goes along in a straight line, N, up is positive.
    pub straight: f64,
}

/// The most tension that hands may ask for, N: what is left beyond it is for a body, if there is one.
pub(crate) fn most_tension(model: &Model, has_body: bool) -> f64 {
    model.string.tension_limit / room(has_body)
}

/// How much more tension grids bear than that, as a factor.
pub(crate) fn room(has_body: bool) -> f64 {
    if has_body { 1.0 + end::ROOM } else { 1.0 }
}

impl Body {
    /// The body under a string. Whether there can be one is [asked](check) of all its strings together.
    pub fn new(description: &Description, model: &Model) -> Body {
        Body {
            modes: Modes::new(description, model.grid.time_step),
            end: End::new(model, model.string.tension),
            still: true,
            new: true,
        }
    }

    /// How far the bridge is up by its string, m.
    #[inline]
    pub fn lift(&self) -> f64 {
        self.modes.lift()
    }

    /// Takes the body's own step, under what the string does to a bridge that is `lift` m up, and gives back what that bridge does to
    /// the string in the step to come, and what is heard of the body. To be called before the string moves.
    #[inline]
    pub fn step(&mut self, model: &Model, state: &State, tension: f64, lift: f64) -> (Push, Heard) {
        self.end.pull_at(model, tension);
        (self.end.push(lift), self.swing(self.end.force(state, lift), lift))
    }

    /// Goes on by itself, under a string at rest. Once nobody could hear it it rests, too; that is looked for in every sample, so that
    /// it does not depend on the pieces in which they come.
    pub fn ring(&mut self, lift: f64) -> Heard {
        if self.still && lift == 0.0 {
            return Heard::default();
        }
        let heard = self.swing(-self.end.line * lift, lift);
        if self.energy() < STILLNESS {
            self.be_still();
        }
        heard
    }

    /// Advances all modes under a force on the bridge, N.
    #[inline]
    fn swing(&mut self, force: f64, lift: f64) -> Heard {
        let pressure = self.modes.swing(force);
        (self.still, self.new) = (false, false);
        Heard { pressure, lift, straight: -self.end.line * lift }
    }

    /// Energy of its motion half a step ago, J.
    pub fn energy(&self) -> f64 {
        self.modes.energy()
    }

    /// Whether nothing is left to be heard of it.
    pub fn is_still(&self) -> bool {
        self.still
    }

    /// Whether it has never moved, nor taken over from one that has.
    pub fn is_new(&self) -> bool {
        self.new
    }

    /// Whether it takes over how another body moves: as many modes as it has itself.
    pub fn goes_on_from(&self, old: &Body) -> bool {
        self.modes.count() == old.modes.count()
    }

    /// Takes over how another body moves, mode by mode; one that has fewer or more modes, or none, leaves it new.
    pub fn take_over(&mut self, old: Option<&Body>, model: &Model, tension: f64) {
        self.end = End::new(model, tension);
        if let Some(old) = old.filter(|old| self.modes.take_over(&old.modes)) {
            (self.still, self.new) = (old.is_still() && self.lift() == 0.0, old.new);
        }
    }

    /// How the string pulls at the bridge.
    pub fn end(&self) -> &End {
        &self.end
    }

    /// How far the bridge gives way to 1 N that stays, m.
    pub fn gives(&self) -> f64 {
        self.modes.gives()
    }

    /// Rests under a force that stays, N.
    pub fn rest_under(&mut self, force: f64) {
        self.modes.rest_under(force);
        (self.still, self.new) = (self.lift() == 0.0, false);
    }

    fn be_still(&mut self) {
        self.modes.be_still();
        self.still = true;
    }

    /// At rest, as if it had never moved.
    pub fn reset(&mut self) {
        self.be_still();
        self.new = true;
    }
}

/// Below this energy nothing is heard of a body, J: a soft pluck has 1e-6 J, of which a part reaches it.
const STILLNESS: f64 = 1e-25;

#[cfg(test)]
mod tests;
