//! How a string comes to be stopped for a note that is plucked, and what stopped it before lets go.

use low_action_dsp::setup::frequency;
use low_action_dsp::{FingerSlot, Gesture, Touch};

use super::held::{Down, Grip, STILL_DOWN};
use super::{Finger, Fingers, Way};
use crate::performance::articulation::Stop;
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

impl Fingers {
    /// Makes way for a note: dampers off, a finger behind the fret (0: none), or beside it where it is expected. One that is there
    /// already stays. One nearer to the nut leaves when the new one has landed, one nearer to the saddle, in a manner of leaving, when the
    /// new one stops the string behind it, so that the string does not come up in between. Gives back whether a finger waits for a hand
    /// that stills the string to go.
    pub(crate) fn stop(
        &mut self,
        fret: usize,
        stop: Stop,
        coming: Coming,
        leaves: Leaving,
        at: &mut Moment<impl GestureSink>,
    ) -> bool {
        let place = self.comes_to(fret);
        let damped = self.resting_slots().next().is_some();
        let called_back = if fret > 0 && self.lets_up_to(place) { self.call_back(at.time) } else { None };
        self.make_way(coming.strength, at);
        self.lay_capo(at);
        self.home = fret;
        let bar = self.lays_bar(stop);
        // A bar that eases off is too heavy to press again in time: it is laid anew.
        let stays_down = |finger: &Finger| match bar {
            true => finger.grip == Grip::Presses,
            false => self.down(Some(finger), at).part > STILL_DOWN,
        };
        let stays = |finger: &Finger| {
            finger.is_at(place)
                && finger.bar == bar
                && finger.free.is_none()
                && stop != Stop::Mute
                && stays_down(finger)
                // On a string that sounds it goes on to its place; on one that hands damp it is not to be heard on its way.
                && !(damped && self.is_far(finger, at.time))
        };
        if self.fretting.is_some_and(|finger| stays(&finger)) {
            self.stay(fret, damped, at);
            return false;
        }
        let (old, anchor) = (self.take_fretting(at), self.anchor.take().or(called_back));
        let presses = matches!(stop, Stop::Press | Stop::Harmonic) && !bar && fret > self.capo[1];
        let down = self.down(old.as_ref(), at);
        match old.filter(|old| presses && !old.bar && old.free.is_none()) {
            Some(old) if old.is_below(place) && !self.is_far(&old, at.time) => {
                let waits = self.land(fret, down, coming, at);
                self.depart_from(old, BEHIND_LIFT, at);
                return waits;
            }
            Some(old) if self.is_over(place, down) => {
                let waits = self.land(fret, down, coming, at);
                at.does(old.lets_go(leaves));
                return waits;
            }
            Some(old) => {
                self.stop_behind(fret, old.slot, anchor, at);
                at.does(old.lets_go(leaves));
                return false;
            }
            None => {}
        }
        for finger in [old, anchor].into_iter().flatten() {
            at.does(finger.lets_go(leaves));
        }
        match stop {
            Stop::Mute => self.mute(fret, at),
            _ if fret <= self.capo[1] => {}
            _ if bar => self.lay_bar(fret, at),
            _ => return self.land(fret, Down::on(self.capo[1]), coming, at),
        }
        false
    }

    /// Whether it is a bar that stops the string. Where fingers press nothing down the octave under a harmonic has one, too.
    pub(crate) fn lays_bar(&self, stop: Stop) -> bool {
        stop == Stop::Bar || stop == Stop::Harmonic && self.string.barred
    }

    /// How a finger leaves a string that a note of some strength is about to sound on: a string let go of suddenly sounds as
    /// if plucked, by as much as it was pressed down.
    pub(crate) fn letting_go(&self, strength: f64) -> Leaving {
        let softness = (1.0 - strength).clamp(0.0, 1.0);
        let pitch = frequency(self.string.geometry.open_pitch);
        let Leaving { speed, turning } = QUICK_LIFT;
        Leaving {
            speed: (1.0 - softness) * speed + softness * RISE * pitch,
            turning: turning + softness / pitch,
        }
    }

    /// The finger that stops the string does so for a note at its fret. The little that it is beside its place it goes at once where
    /// hands damp the string, unheard.
    fn stay(&mut self, fret: usize, damped: bool, at: &mut Moment<impl GestureSink>) {
        self.press_again(at);
        let place = self.comes_to(fret);
        let Some(finger) = &mut self.fretting else { return };
        finger.count_from(fret);
        if damped && finger.stands() != place {
            self.move_beside(place - fret as f64, BEHIND_SLIDE, at);
        }
    }

    /// A finger that has eased off presses again.
    fn press_again(&mut self, at: &mut Moment<impl GestureSink>) {
        let (force, landing) = (self.force(), self.hands.fretting.landing);
        let Some(finger) = &mut self.fretting else { return };
        if std::mem::replace(&mut finger.grip, Grip::Presses) != Grip::Presses {
            at.does(Gesture::Press { finger: finger.slot, force, duration: landing });
        }
    }

    /// Gives the next slot to a finger that stops the string from now on.
    pub(super) fn take_slot(&mut self, fret: usize, touch: Touch, bar: bool) -> FingerSlot {
        // It comes with the force that it is to have.
        self.pace.done();
        let slot = self.next_slot;
        self.next_slot = (slot + 1) % FRETTING_SLOTS;
        let grip = Grip::Presses;
        let glided = self.comes_beside(fret);
        let way = Way::default();
        self.fretting = Some(Finger { slot, fret, touch, grip, bar, way, at_note: 0, glided, free: None });
        slot
    }
}
