//! The right hand on one string: plucks of every kind, the palm near the saddle, the thumb.

mod laying;

use low_action_dsp::setup::{Damper, Player};
use low_action_dsp::{Gesture, StringGeometry, Touch};

use super::articulation::Stroke;
use super::fingers::{Pace, QUIET_LIFT, lifting};
use super::technique::*;
use super::{GestureSink, Moment};
use laying::{GENTLY, Laying, falling};

/// What the right hand has on the string.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum Laid {
    /// Nothing.
    #[default]
    Nothing,
    /// The palm, with this pressure, above 0 to 1.
    Palm(f64),
    /// The thumb, of a slap or a pinch.
    Thumb(Touch),
}

/// The right hand on one string.
#[derive(Debug, Clone, Default)]
pub(crate) struct RightHand {
    laid: Laid,
    /// Pressure of the palm on notes to come, 0 to 1.
    palm: f64,
    /// Sample by which a hand that has left quietly is off the string.
    clear: u64,
    /// Sample by which the palm presses as it is to.
    pressed: u64,
    /// Sample before which one that has been laid down gently has hardly sunk in.
    sinking: u64,
    /// When it follows what it is told next.
    pace: Pace,
}

/// Where a stroke falls.
pub(crate) struct Field<'a> {
    /// The string.
    pub geometry: &'a StringGeometry,
    /// How the hands act.
    pub hands: &'a Player,
    /// Length that sounds, m.
    pub sounding: f64,
}

impl Field<'_> {
    /// The place of a pluck so far from the saddle, m, as near to that as fingers can be.
    fn place(&self, from_saddle: f64) -> f64 {
        let farthest = FARTHEST_PLUCK * self.sounding;
        self.geometry.length - from_saddle.max(NEAREST_PLUCK).min(farthest)
    }

    /// A stroke that pulls or pushes: so hard (0 to 1), and so far beside the usual place (m), of which the hand has been
    /// moved so far on purpose (m). `None` for those that strike.
    pub(crate) fn pluck(&self, stroke: Stroke, strength: f64, beside: f64, moved: f64) -> Option<Gesture> {
        let Player { pluck_position, pluck_duration, pluck_release, pluck_force, .. } = *self.hands;
        let Striking { force, duration, nearer } = match stroke {
            Stroke::Down | Stroke::Alternate => DOWN_STROKE,
            Stroke::Pinch => {
                let thumb = self.geometry.length - self.pinched(self.pinched_partial(moved));
                Striking { nearer: pluck_position + moved - BESIDE_THUMB * thumb, ..DOWN_STROKE }
            }
            Stroke::Up => UP_STROKE,
            Stroke::Rest => REST_STROKE,
            Stroke::Pop => POP,
            Stroke::Slap | Stroke::Tap => return None,
        };
        Some(Gesture::Pluck {
            position: self.place(pluck_position + beside - nearer),
            force: pluck_force * strength * force,
            duration: pluck_duration * duration,
            release: pluck_release / (strength * force).abs().max(SLOWEST_STROKE),
        })
    }

    /// A touch so lossy that it takes up what the string sends it: pad's damping × force is so many times
    /// twice the wave impedance, what the string's two halves offer it.
    pub(crate) fn matched(&self, times: f64) -> (Touch, f64) {
        let Damper { touch, force, .. } = self.hands.damper;
        let matched = 2.0 * self.geometry.wave_impedance / touch.damping;
        (touch, if matched.is_finite() { times * matched } else { times * force })
    }

    /// What the palm touches the string with, pressed so hard (0 to 1), and its force, N.
    fn palm_force(&self, pressure: f64) -> (Touch, f64) {
        let (least, most) = PALM_FORCE;
        self.matched(least * libm::pow(most / least, pressure))
    }

    /// How far the palm reaches, pressed so hard (0 to 1), m from the saddle.
    fn palm_reach(&self, pressure: f64) -> f64 {
        let part = PALM_PLACE.0 + (PALM_PLACE.1 - PALM_PLACE.0) * pressure;
        let before_pluck = PALM_BEFORE_PLUCK * self.hands.pluck_position;
        (part * self.geometry.length).min(before_pluck)
    }

    /// Where the thumb of a slap falls, m from the nut: just past the last fret, or where it would be.
    fn slapped(&self) -> f64 {
        let Self { geometry, .. } = self;
        let last = geometry.frets.last().copied().unwrap_or(0.7 * geometry.length);
        last + PAST_LAST_FRET * geometry.length
    }

    /// Where a thumb grazes the string for a partial of what sounds, m from the nut: at its node nearest to the saddle.
    fn pinched(&self, partial: u32) -> f64 {
        self.geometry.length - self.sounding / f64::from(partial)
    }

    /// The partial whose node is nearest to the pluck of a hand that has been moved so far from the saddle (m): the third
    /// of what sounds, or a higher one that a thumb can graze.
    pub(crate) fn pinched_partial(&self, moved: f64) -> u32 {
        let place = (self.hands.pluck_position + moved).max(NEAREST_PLUCK);
        let from_saddle = place.min(FARTHEST_PLUCK * self.sounding);
        (self.sounding / from_saddle).round().clamp(PINCHED.0, PINCHED.1) as u32
    }
}

impl RightHand {
    /// Pressure of the palm on notes to come, and on the one that sounds, 0 to 1.
    pub(crate) fn palm_pressure(&self) -> f64 {
        self.palm
    }

    /// Takes over from another.
    pub(crate) fn take_over(&mut self, old: &Self) {
        *self = old.clone();
    }

    /// Nothing is on the string.
    pub(crate) fn reset(&mut self) {
        *self = Self::default();
    }

    /// The palm is to rest so hard, 0 to 1, at the next stroke.
    pub(crate) fn expect_palm(&mut self, palm: f64) {
        self.palm = palm;
    }

    /// The palm is to rest so hard on the string, 0 to 1. It is laid on one that is silent, too: pressed in by a soft weight its
    /// flesh takes some hundredths of a second, longer than any stroke waits. One that has gone meanwhile comes back.
    pub(crate) fn set_palm(&mut self, palm: f64, field: &Field, at: &mut Moment<impl GestureSink>) {
        self.palm = palm;
        // One that is to come or to go does not wait.
        let presses_on = self.rests() && palm > 0.0 && self.laid != Laid::Palm(palm);
        if !presses_on || self.pace.asks(PALM_RAMP, at) {
            self.follow_now(field, at);
        }
    }

    /// When the palm has yet to follow what it has been told.
    pub(crate) fn due(&self) -> Option<u64> {
        self.pace.due()
    }

    /// It does, if that is due.
    pub(crate) fn follow(&mut self, field: &Field, at: &mut Moment<impl GestureSink>) {
        if self.pace.due() == Some(at.time) && self.pace.asks(PALM_RAMP, at) {
            self.follow_now(field, at);
        }
    }

    /// A thumb goes first; the palm follows it.
    fn follow_now(&mut self, field: &Field, at: &mut Moment<impl GestureSink>) {
        self.pace.done();
        if self.thumb().is_none() {
            self.lay(GENTLY, field, at);
        }
    }

    /// The thumb, if it is on the string.
    fn thumb(&self) -> Option<Touch> {
        match self.laid {
            Laid::Thumb(touch) => Some(touch),
            Laid::Nothing | Laid::Palm(_) => None,
        }
    }

    /// Whether the palm rests on the string.
    pub(crate) fn rests(&self) -> bool {
        matches!(self.laid, Laid::Palm(_))
    }

    /// Gets ready for a stroke so hard, 0 to 1: thumb off, palm on or off, at once even if it is on its way off.
    pub(crate) fn prepare(&mut self, strength: f64, field: &Field, at: &mut Moment<impl GestureSink>) {
        let lingers = self.palm <= 0.0 && (self.laid != Laid::Nothing || at.time < self.clear);
        self.clear = 0;
        if self.thumb().is_some() || lingers {
            self.lift(QUICK_LIFT, field, at);
            self.laid = Laid::Nothing;
        }
        self.lay(Laying::for_stroke(strength * field.hands.pluck_force), field, at);
    }

    /// Brings the palm to the pressure asked for.
    fn lay(&mut self, manner: Laying, field: &Field, at: &mut Moment<impl GestureSink>) {
        let Laying { duration, stroke } = manner;
        let wanted = if self.palm > 0.0 { Laid::Palm(self.palm) } else { Laid::Nothing };
        if wanted == self.laid && self.pressed <= at.after(duration) {
            return;
        }
        let Laid::Palm(pressure) = wanted else {
            return self.leave(field, at);
        };
        let (touch, force) = field.palm_force(pressure);
        let reach = field.palm_reach(pressure);
        let falls = stroke.map(|stroke| falling(touch, force, stroke));
        let stays = self.rests() && !(falls.is_some() && at.time < self.sinking);
        for (finger, place, share) in PALM {
            let position = field.geometry.length - place * reach;
            // The thumb becomes the part of the palm that has its slot.
            let is_there = stays || self.thumb().is_some() && finger == RIGHT_HAND;
            at.does(match falls {
                _ if is_there => Gesture::Slide { finger, position, duration },
                Some(speed) => Gesture::Throw { finger, touch, position, clearance: 0.0, speed },
                None => Gesture::Place { finger, touch, position, clearance: 0.0 },
            });
            at.does(Gesture::Press { finger, force: share * force, duration });
        }
        if !stays {
            self.sinking = if falls.is_some() { at.time } else { at.after(PALM_RAMP) };
        }
        self.laid = wanted;
        self.pressed = at.after(duration);
        self.pace.done();
    }

    /// The thumb is thrown at the string; gives back the throw.
    pub(crate) fn slap(
        &mut self,
        strength: f64,
        field: &Field,
        at: &mut Moment<impl GestureSink>,
    ) -> Gesture {
        let finger = RIGHT_HAND;
        let position = field.slapped();
        self.make_room(field, at);
        let strength = strength.min(1.0);
        let speed = SLAP_SPEED.0 + SLAP_SPEED.1 * strength;
        let thrown = Gesture::Throw { finger, touch: THUMB, position, clearance: SLAP_CLEARANCE, speed };
        at.does(thrown);
        at.does(Gesture::Press { finger, force: SLAP_FORCE * strength, duration: 0.0 });
        self.laid = Laid::Thumb(THUMB);
        thrown
    }

    /// The thumb bounces off the string it was thrown at.
    pub(crate) fn bounce(&mut self, at: &mut Moment<impl GestureSink>) {
        if self.thumb().is_some() {
            at.does(Gesture::Lift { finger: RIGHT_HAND, force: SLAP_BOUNCE, duration: 0.001 });
            self.laid = Laid::Nothing;
        }
    }

    /// The thumb grazes the string where a partial of what sounds has a node.
    pub(crate) fn graze(&mut self, partial: u32, field: &Field, at: &mut Moment<impl GestureSink>) {
        let finger = RIGHT_HAND;
        let (touch, force) = field.matched(GRAZE);
        self.make_room(field, at);
        at.does(Gesture::Place { finger, touch, position: field.pinched(partial), clearance: 0.0 });
        at.does(Gesture::Press { finger, force, duration: PALM_LANDING });
        self.laid = Laid::Thumb(touch);
    }

    /// The thumb takes the slot of one part of a palm; the others leave with it.
    fn make_room(&self, field: &Field, at: &mut Moment<impl GestureSink>) {
        if self.rests() {
            for (finger, ..) in PALM.into_iter().filter(|&(finger, ..)| finger != RIGHT_HAND) {
                at.does(lifting(finger, field.hands.damper.touch, QUICK_LIFT));
            }
        }
    }

    /// The thumb that grazes the string leaves it, or gives way to the palm, which is as soft.
    pub(crate) fn leave_graze(&mut self, field: &Field, at: &mut Moment<impl GestureSink>) {
        if self.thumb().is_some() {
            self.lay(GENTLY, field, at);
        }
    }

    /// The palm comes back after a thumb that has bounced off, if it is to rest there.
    pub(crate) fn lay_again(&mut self, field: &Field, at: &mut Moment<impl GestureSink>) {
        if self.laid == Laid::Nothing {
            self.lay(GENTLY, field, at);
        }
    }

    /// Thumb or palm goes in a manner of leaving.
    fn lift(&self, manner: Leaving, field: &Field, at: &mut Moment<impl GestureSink>) {
        // (A palm is as soft as any damper.)
        let (parts, touch) = self.thumb().map_or((PALM.len(), field.hands.damper.touch), |thumb| (1, thumb));
        for (finger, ..) in PALM.into_iter().take(parts) {
            at.does(lifting(finger, touch, manner));
        }
    }

    /// Whatever is on the string leaves it.
    pub(crate) fn leave(&mut self, field: &Field, at: &mut Moment<impl GestureSink>) {
        self.pace.done();
        if self.laid != Laid::Nothing {
            self.lift(QUIET_LIFT, field, at);
            self.laid = Laid::Nothing;
            self.clear = at.after(LINGERING * QUIET_LIFT.turning);
        }
    }
}
