//! The fingers of both hands on one string: which slot each takes, and how it comes and goes.

use low_action_dsp::setup::{Damper, Fretting, Player};
use low_action_dsp::{FINGERS_PER_STRING, FingerSlot, Gesture, StringGeometry, Touch};

use super::technique::*;
use super::{GestureSink, Moment, PlayedString};

/// A finger behind a fret.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Finger {
    slot: FingerSlot,
    fret: usize,
    touch: Touch,
    /// Whether its force has been eased off.
    eased: bool,
}

/// The fingers near one string.
#[derive(Debug, Clone)]
pub(crate) struct Fingers {
    geometry: StringGeometry,
    leaving_forces: Vec<f64>,
    hands: Player,
    fretting: Option<Finger>,
    /// Slot of the next fretting finger.
    next_slot: FingerSlot,
    /// Which slots hold a damper that rests on the string.
    resting: [bool; FINGERS_PER_STRING],
    /// Fret of the present note, from which slides are counted.
    home: usize,
    /// Factor of the fretting finger's force: what a key is pressed down with.
    pressure: f64,
}

impl Fingers {
    /// No finger near the string.
    pub(crate) fn new(string: PlayedString, hands: Player) -> Self {
        let PlayedString { geometry, leaving_forces } = string;
        let resting = [false; FINGERS_PER_STRING];
        let fretting = None;
        Self { geometry, leaving_forces, hands, fretting, next_slot: 0, resting, home: 0, pressure: 1.0 }
    }

    /// All away.
    pub(crate) fn reset(&mut self) {
        self.fretting = None;
        self.next_slot = 0;
        self.resting = [false; FINGERS_PER_STRING];
        self.home = 0;
        self.pressure = 1.0;
    }

    /// Takes over the fingers on this string, when it has been given another model.
    pub(crate) fn take_over(&mut self, old: &Self) {
        let Self { fretting, next_slot, resting, home, pressure, .. } = *old;
        (self.fretting, self.next_slot, self.resting) = (fretting, next_slot, resting);
        (self.home, self.pressure) = (home, pressure);
    }

    /// The hands of a string nobody has touched yet act so.
    pub(crate) fn begin_with(&mut self, hands: &Player) {
        self.hands = hands.clone();
    }

    /// The hands act differently from now on; a finger on the string presses with the new force.
    pub(crate) fn set_hands(&mut self, hands: &Player, at: &mut Moment<impl GestureSink>) {
        let pressed = self.hands.fretting.force;
        self.hands = hands.clone();
        if self.hands.fretting.force != pressed {
            self.press_on(at);
        }
    }

    /// The fretting finger presses with so many times its usual force.
    pub(crate) fn press(&mut self, pressure: f64, at: &mut Moment<impl GestureSink>) {
        if pressure != self.pressure {
            self.pressure = pressure;
            self.press_on(at);
        }
    }

    fn press_on(&mut self, at: &mut Moment<impl GestureSink>) {
        if let Some(finger) = self.fretting.filter(|finger| !finger.eased) {
            let force = self.hands.fretting.force * self.pressure;
            at.does(Gesture::Press { finger: finger.slot, force, duration: PRESSURE_RAMP });
        }
    }

    /// Slides the fretting finger so many frets away from where the note began, as far as there are frets.
    /// Gives back how many it is away then; an open string cannot be slid.
    pub(crate) fn slide(&mut self, frets: i32, duration: f64, at: &mut Moment<impl GestureSink>) -> i32 {
        let Some(finger) = self.fretting.as_mut().filter(|finger| !finger.eased) else { return 0 };
        let last = self.geometry.frets.len() as i32;
        let fret = (self.home as i32 + frets).clamp(1, last);
        if fret as usize != finger.fret {
            finger.fret = fret as usize;
            let position = self.geometry.finger_position(finger.fret);
            at.does(Gesture::Slide { finger: finger.slot, position, duration });
        }
        fret - self.home as i32
    }

    /// The string under them.
    pub(crate) fn geometry(&self) -> &StringGeometry {
        &self.geometry
    }

    /// Whether a finger is behind a fret.
    pub(crate) fn frets(&self) -> bool {
        self.fretting.is_some()
    }

    /// Makes way for a note of some strength (0 to 1): dampers off, a finger behind the fret (0: none).
    /// One that is there already stays; any other leaves for a new one, at once because the pluck covers
    /// its sound.
    pub(crate) fn stop(&mut self, fret: usize, strength: f64, at: &mut Moment<impl GestureSink>) {
        for slot in self.resting_slots() {
            at.does(lifting(slot, self.hands.damper.touch, QUICK_LIFT));
        }
        self.resting = [false; FINGERS_PER_STRING];
        self.home = fret;
        let Fretting { mut touch, hover, landing, .. } = self.hands.fretting;
        let force = self.hands.fretting.force * self.pressure;
        if let Some(finger) = self.fretting.as_mut().filter(|finger| finger.fret == fret) {
            if std::mem::take(&mut finger.eased) {
                at.does(Gesture::Press { finger: finger.slot, force, duration: landing });
            }
            return;
        }
        if let Some(old) = self.fretting.take() {
            at.does(lifting(old.slot, old.touch, QUICK_LIFT));
        }
        if fret > 0 {
            touch.hand_damping /= 1.0 + HASTE * strength;
            let slot = self.next_slot;
            self.next_slot = (slot + 1) % FRETTING_SLOTS;
            self.fretting = Some(Finger { slot, fret, touch, eased: false });
            let position = self.geometry.finger_position(fret);
            at.does(Gesture::Place { finger: slot, touch, position, clearance: hover });
            at.does(Gesture::Press { finger: slot, force, duration: landing });
        }
    }

    /// The pluck of a note: so hard (0 to 1), and so far beside the usual place (m).
    pub(crate) fn pluck(&self, strength: f64, beside: f64) -> Gesture {
        let Player { pluck_position, pluck_duration, pluck_force, .. } = self.hands;
        let farthest = FARTHEST_PLUCK * self.sounding_length();
        let from_saddle = (pluck_position + beside).max(NEAREST_PLUCK).min(farthest);
        Gesture::Pluck {
            position: self.geometry.length - from_saddle,
            force: pluck_force * strength,
            duration: pluck_duration,
        }
    }

    /// Lays the edge of the hand near the saddle, and a finger of the other hand behind a fretting one,
    /// which goes on pressing just hard enough.
    pub(crate) fn damp(&mut self, at: &mut Moment<impl GestureSink>) {
        let near_saddle = self.hands.damper.position.min(FARTHEST_DAMPER * self.sounding_length());
        for (slot, part) in DAMPERS {
            self.rest(slot, self.geometry.length - part * near_saddle, at);
        }
        let behind = BEHIND_FINGER * (self.geometry.length - self.sounding_length());
        if behind >= NEAREST_NUT {
            self.rest(self.next_slot, behind, at);
        }
        let leaving = self.fretting.and_then(|finger| self.leaving_forces.get(finger.fret - 1));
        let holding = HOLDING * leaving.copied().unwrap_or(0.0);
        if holding < self.hands.fretting.force {
            self.ease(holding, RELAXING, at);
        }
    }

    /// The fretting finger eases off until the string is free of it.
    pub(crate) fn ease_off(&mut self, at: &mut Moment<impl GestureSink>) {
        // It is not lifted yet: the next note may want it back.
        if let Some(finger) = self.fretting {
            self.ease(-lift_force(finger.touch, FINGER_EASING), FINGER_EASING.turning, at);
        }
    }

    /// The fretting finger goes, and the dampers ease off and go.
    pub(crate) fn leave(&mut self, at: &mut Moment<impl GestureSink>) {
        if let Some(finger) = self.fretting.take() {
            at.does(lifting(finger.slot, finger.touch, FINGER_EASING));
        }
        for slot in self.resting_slots() {
            at.does(lifting(slot, self.hands.damper.touch, DAMPER_EASING));
        }
    }

    /// The dampers have gone.
    pub(crate) fn gone(&mut self) {
        self.resting = [false; FINGERS_PER_STRING];
    }

    /// Brings the fretting finger's force to another value, N.
    fn ease(&mut self, force: f64, duration: f64, at: &mut Moment<impl GestureSink>) {
        if let Some(finger) = &mut self.fretting {
            finger.eased = true;
            at.does(Gesture::Press { finger: finger.slot, force, duration });
        }
    }

    fn rest(&mut self, finger: FingerSlot, position: f64, at: &mut Moment<impl GestureSink>) {
        let Damper { touch, force, landing, .. } = self.hands.damper;
        let clearance = self.hands.fretting.hover;
        self.resting[finger] = true;
        at.does(Gesture::Place { finger, touch, position, clearance });
        at.does(Gesture::Press { finger, force, duration: landing });
    }

    fn resting_slots(&self) -> impl Iterator<Item = FingerSlot> + use<> {
        let resting = self.resting;
        (0..FINGERS_PER_STRING).filter(move |&slot| resting[slot])
    }

    /// Length that sounds: from the fretting finger, or the nut, to the saddle, m.
    fn sounding_length(&self) -> f64 {
        let stopped_at = self.fretting.map_or(0.0, |finger| self.geometry.finger_position(finger.fret));
        self.geometry.length - stopped_at
    }
}

/// Lifts a finger in a manner of leaving.
fn lifting(finger: FingerSlot, touch: Touch, manner: Leaving) -> Gesture {
    Gesture::Lift { finger, force: lift_force(touch, manner), duration: manner.turning }
}

/// Force that brings a finger to its leaving speed, N: the hand's damping takes one part of it, the
/// finger's inertia the other.
fn lift_force(touch: Touch, Leaving { speed, turning }: Leaving) -> f64 {
    touch.hand_damping * speed + touch.mass * speed / turning
}
