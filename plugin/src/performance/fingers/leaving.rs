//! How hands silence a string, and leave it.

use low_action_dsp::setup::Damper;
use low_action_dsp::{FINGERS_PER_STRING, FingerSlot, Gesture, Touch};

use super::Fingers;
use super::held::Grip;
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

impl Fingers {
    /// Lays the edge of the hand near the saddle, and a finger of the other hand behind a fretting one, which goes on pressing
    /// just hard enough; behind a bar one rests already. A hand that mutes the string stays where it is, and so does a light
    /// finger: a string that is let go of sounds.
    pub(crate) fn damp(&mut self, parting: Parting, at: &mut Moment<impl GestureSink>) {
        self.come(at);
        let near_saddle = self.hands.damper.position.min(FARTHEST_DAMPER * self.sounding_length());
        let (light, mutes) = (self.light, self.light.is_some() && self.resting[LIGHT]);
        for (slot, part) in DAMPERS.into_iter().filter(|&(slot, _)| !mutes && light != Some(slot)) {
            let slot = if self.behind_bar && slot == BEHIND_BAR { self.next_slot } else { slot };
            self.rest(slot, self.string.geometry.length - part * near_saddle, at);
        }
        if let Some(anchor) = self.anchor.take() {
            // It keeps quiet what is behind; it leaves as softly as the other.
            self.depart(anchor.slot, anchor.touch, parting.easing, at);
        } else if self.light.is_none() && !self.behind_bar && self.waits_behind(at.time).is_none() {
            self.damp_behind(at);
        }
        if let Some(finger) = self.fretting.filter(|finger| !finger.bar) {
            let holding = self.holding_force(finger.nearest_fret(), self.force());
            self.ease(Grip::Holds, holding, parting.relaxing, at);
        }
        self.relax_capo(parting.relaxing, at);
    }

    /// Until when a damper waits behind the finger that stops the string: the finger before that one is still leaving there. It
    /// keeps quiet what is behind, and does not become the damper: a string that is let go of at once sounds.
    pub(crate) fn waits_behind(&self, time: u64) -> Option<u64> {
        let clear = self.departing[self.next_slot].map(|departing| departing.clear);
        clear.filter(|&clear| clear > time && self.light.is_none())
    }

    /// Rests a finger of the left hand behind the one that stops the string, or behind the capo if there is more that could
    /// ring.
    pub(crate) fn damp_behind(&mut self, at: &mut Moment<impl GestureSink>) {
        let stopped = self.string.geometry.length - self.sounding_length();
        let capo = self.string.geometry.finger_position(self.capo[1]);
        let (from, to) = if stopped - capo < capo { (0.0, capo) } else { (capo, stopped) };
        if BEHIND_FINGER * (to - from) >= NEAREST_NUT {
            self.rest(self.next_slot, from + BEHIND_FINGER * (to - from), at);
        }
    }

    /// Fretting finger and capo ease off until the string is free of them: what was shut in behind them comes out under the
    /// hand that damps.
    pub(crate) fn ease_off(&mut self, Parting { easing, .. }: Parting, at: &mut Moment<impl GestureSink>) {
        self.ease_capo(easing, at);
        // It is not lifted yet: the next note may want it back.
        if let Some(finger) = self.fretting {
            let eases = Grip::Eases { since: at.time, manner: easing };
            self.ease(eases, -lift_force(finger.touch, easing), easing.turning, at);
        }
    }

    /// Fretting finger and capo go, and the dampers ease off and go. A palm waits for the next note.
    pub(crate) fn leave(&mut self, parting: Parting, at: &mut Moment<impl GestureSink>) {
        if let Some(finger) = self.fretting.take() {
            self.depart(finger.slot, finger.touch, parting.easing, at);
        }
        self.ease_from_behind_bar(at);
        self.lift_capo(parting.easing, at);
        for slot in self.resting_slots() {
            at.does(lifting(slot, self.hands.damper.touch, DAMPER_EASING));
        }
        self.lift_light(DAMPER_EASING, at);
        if !self.palm_rests() {
            self.lift_palm(at);
        }
    }

    /// The dampers have gone.
    pub(crate) fn gone(&mut self) {
        self.resting = [false; FINGERS_PER_STRING];
    }

    /// Brings the fretting finger's force to another value, N, which is one of another grip.
    fn ease(&mut self, grip: Grip, force: f64, duration: f64, at: &mut Moment<impl GestureSink>) {
        if let Some(finger) = &mut self.fretting {
            finger.grip = grip;
            at.does(Gesture::Press { finger: finger.slot, force, duration });
        }
    }

    pub(super) fn rest(&mut self, finger: FingerSlot, position: f64, at: &mut Moment<impl GestureSink>) {
        // It takes the place of a light finger that is still there.
        self.light = self.light.filter(|&light| light != finger);
        let Damper { touch, force, landing, .. } = self.hands.damper;
        let clearance = self.hands.fretting.hover;
        self.resting[finger] = true;
        self.departing[finger] = None;
        at.does(Gesture::Place { finger, touch, position, clearance });
        at.does(Gesture::Press { finger, force, duration: landing });
    }

    pub(super) fn resting_slots(&self) -> impl Iterator<Item = FingerSlot> + use<> {
        let resting = self.resting;
        (0..FINGERS_PER_STRING).filter(move |&slot| resting[slot])
    }
}

/// How the right hand leaves a ringing string.
pub(in crate::performance) const QUIET_LIFT: Leaving = NODE_LIFT;

/// Lifts a finger in a manner of leaving.
pub(in crate::performance) fn lifting(finger: FingerSlot, touch: Touch, manner: Leaving) -> Gesture {
    Gesture::Lift { finger, force: lift_force(touch, manner), duration: manner.turning }
}

/// Lifts a finger, or a bar, that is in the way of the next note.
pub(super) fn hurried(finger: FingerSlot, touch: Touch) -> Gesture {
    lifting(finger, touch, if touch == BAR { BAR_LIFT } else { QUICK_LIFT })
}

/// Force that brings a finger to its leaving speed, N: the hand's damping takes one part of it, the
/// finger's inertia the other.
pub(in crate::performance) fn lift_force(touch: Touch, Leaving { speed, turning }: Leaving) -> f64 {
    touch.hand_damping * speed + touch.mass * speed / turning
}
