//! One string under two hands: a note's life as gestures at exact samples.
//!
//! A note begins with the finger landing behind its fret and the pluck, at once; a finger already
//! there just stays. It ends under the edge of a hand that comes to rest on the string; only when the
//! string is quiet do the fretting finger and then the hand ease off, so slowly that their going
//! makes no sound. What is to happen later is kept here as deadlines, because the next note may come
//! first and call it off.

use low_action_dsp::setup::{Damper, Fretting, Player};
use low_action_dsp::{FINGERS_PER_STRING, FingerSlot, Gesture, StringGeometry, TimedGesture, Touch};

use super::hand::Use;
use super::technique::*;
use super::variation::Deviation;
use super::{GestureSink, PlayedString};

/// A note to begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Start {
    /// Its channel.
    pub channel: u8,
    /// Its key, as sent.
    pub key: u8,
    /// Fret, 0 for the open string.
    pub fret: usize,
    /// How hard, above 0 to 1.
    pub velocity: f64,
    /// How this pluck differs from the usual.
    pub deviation: Deviation,
}

/// The note on a string, from its pluck until it is damped.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Note {
    channel: u8,
    key: u8,
    since: u64,
    key_down: bool,
    /// Sample of the last key press of this very note while it was already down. The note-off of
    /// the press before may come a moment later and must not end the new one.
    pressed_again: Option<u64>,
}

/// A finger behind a fret.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Finger {
    slot: FingerSlot,
    fret: usize,
    /// Whether its force has been eased off.
    eased: bool,
}

/// The steps by which a note is ended, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ending {
    /// The dampers come to rest on the string.
    Damp,
    /// The string is quiet: the fretting finger eases off.
    EaseFinger,
    /// The fretting finger has left: the dampers ease off.
    EaseDampers,
    /// The dampers have left too.
    Free,
}

/// The player's dealings with one string.
#[derive(Debug, Clone)]
pub(crate) struct StringPlayer {
    index: usize,
    geometry: StringGeometry,
    leaving_forces: Vec<f64>,
    hands: Player,
    sample_rate: f64,
    note: Option<Note>,
    finger: Option<Finger>,
    next_slot: FingerSlot,
    /// Which slots hold a damper that rests on the string.
    resting: [bool; FINGERS_PER_STRING],
    /// The next step of the last note's ending, and when.
    ending: Option<(u64, Ending)>,
    /// When the bend is to be changed.
    bend_due: Option<u64>,
    /// Channel whose wheel bends the string: that of its last note.
    channel: Option<u8>,
    /// Bend asked for and bend last sent, semitones.
    bend: (f64, f64),
    /// Earliest time of the next change of bend.
    bend_ready: u64,
    plucked_at: Option<u64>,
}

impl StringPlayer {
    /// A string nobody touches.
    pub(crate) fn new(index: usize, string: PlayedString, hands: Player, sample_rate: f64) -> Self {
        let PlayedString { geometry, leaving_forces } = string;
        Self {
            index,
            geometry,
            leaving_forces,
            hands,
            sample_rate,
            note: None,
            finger: None,
            next_slot: 0,
            resting: [false; FINGERS_PER_STRING],
            ending: None,
            bend_due: None,
            channel: None,
            bend: (0.0, 0.0),
            bend_ready: 0,
            plucked_at: None,
        }
    }

    /// Back to the start.
    pub(crate) fn reset(&mut self) {
        self.note = None;
        self.finger = None;
        self.next_slot = 0;
        self.resting = [false; FINGERS_PER_STRING];
        self.ending = None;
        self.bend_due = None;
        self.channel = None;
        self.bend = (0.0, 0.0);
        self.bend_ready = 0;
        self.plucked_at = None;
    }

    /// What the string is doing, for the choice of strings.
    pub(crate) fn usage(&self, time: u64) -> Use {
        match self.note {
            _ if self.plucked_at == Some(time) => Use::Untouchable,
            Some(Note { channel, key, since, key_down, .. }) => Use::Taken { channel, key, since, key_down },
            None => Use::Free,
        }
    }

    /// Begins a note; one that sounds gives way.
    pub(crate) fn start(&mut self, time: u64, start: Start, out: &mut impl GestureSink) {
        let pressed_again = self
            .note
            .filter(|note| note.key_down && (note.channel, note.key) == (start.channel, start.key))
            .map(|_| time);
        self.note =
            Some(Note { channel: start.channel, key: start.key, since: time, key_down: true, pressed_again });
        self.channel = Some(start.channel);
        self.plucked_at = Some(time);
        self.ending = None;
        self.lift_dampers(time, out);
        self.finger_fret(time, start.fret, out);
        self.pluck(time, start, out);
    }

    /// Lets go of a key, if it is this string's. Under the pedal the note goes on.
    pub(crate) fn release(&mut self, time: u64, channel: u8, key: u8, pedal: bool) -> bool {
        let near = self.samples(SHORTEST_NOTE);
        let Some(note) =
            self.note.as_mut().filter(|note| note.key_down && (note.channel, note.key) == (channel, key))
        else {
            return false;
        };
        if note.pressed_again.take().is_some_and(|pressed| time - pressed <= near) {
            return true;
        }
        note.key_down = false;
        if !pedal {
            self.end(time);
        }
        true
    }

    /// Lets go of whatever key of a channel holds this string.
    pub(crate) fn release_channel(&mut self, time: u64, channel: u8, pedal: bool) {
        if let Some(note) = self.note.as_mut().filter(|note| note.channel == channel) {
            note.key_down = false;
            if !pedal {
                self.end(time);
            }
        }
    }

    /// The pedal of a channel goes up: a note it kept ends.
    pub(crate) fn pedal_up(&mut self, time: u64, channel: u8) {
        if self.note.is_some_and(|note| note.channel == channel && !note.key_down) {
            self.end(time);
        }
    }

    /// Ends the string's note, whoever holds it; `None` means any channel's.
    pub(crate) fn silence(&mut self, time: u64, channel: Option<u8>) {
        if self.note.is_some_and(|note| channel.is_none_or(|channel| note.channel == channel)) {
            self.end(time);
        }
    }

    /// Bends the string if its last note is of that channel.
    pub(crate) fn bend(&mut self, time: u64, channel: u8, semitones: f64) {
        if self.channel == Some(channel) {
            self.bend.0 = semitones;
            if self.bend.0 != self.bend.1 && self.bend_due.is_none() {
                self.bend_due = Some(time.max(self.bend_ready));
            }
        }
    }

    /// Does what has fallen due before `until`, in order of time.
    pub(crate) fn advance(&mut self, until: u64, out: &mut impl GestureSink) {
        loop {
            let ending = self.ending.filter(|&(time, _)| time < until);
            let bend = self.bend_due.filter(|&time| time < until);
            match (ending, bend) {
                (None, None) => return,
                (Some((time, step)), bend) if bend.is_none_or(|bend| time <= bend) => {
                    self.end_by(time, step, out)
                }
                (_, Some(time)) => self.send_bend(time, out),
                (Some(_), None) => unreachable!("without a bend, the ending comes first"),
            }
        }
    }

    /// The note is over: it is damped now, or once it has been heard.
    fn end(&mut self, time: u64) {
        let heard = self.note.take().map_or(0, |note| note.since + self.samples(SHORTEST_NOTE));
        self.ending = Some((time.max(heard), Ending::Damp));
    }

    /// Takes one step of an ending and plans the next.
    fn end_by(&mut self, time: u64, step: Ending, out: &mut impl GestureSink) {
        let next = match step {
            Ending::Damp => {
                self.rest_dampers(time, out);
                let holding = HOLDING * self.finger.map_or(0.0, |finger| self.leaving_force(finger.fret));
                self.ease_finger(time, holding, QUIET_AFTER, out);
                Some((QUIET_AFTER, Ending::EaseFinger))
            }
            Ending::EaseFinger => {
                if let Some(finger) = &mut self.finger {
                    finger.eased = true;
                    let slot = finger.slot;
                    self.lift(time, slot, self.hands.fretting.touch, FINGER_EASING, out);
                }
                Some((self.finger.map_or(0.0, |_| FINGER_EASING.turning), Ending::EaseDampers))
            }
            Ending::EaseDampers => {
                self.finger = None;
                for slot in self.resting_slots() {
                    self.lift(time, slot, self.hands.damper.touch, DAMPER_EASING, out);
                }
                Some((DAMPER_EASING.turning, Ending::Free))
            }
            Ending::Free => {
                self.resting = [false; FINGERS_PER_STRING];
                None
            }
        };
        self.ending = next.map(|(delay, step)| (time + self.samples(delay), step));
    }

    /// Eases the fretting finger off to a force (N), if it presses harder.
    fn ease_finger(&mut self, time: u64, force: f64, duration: f64, out: &mut impl GestureSink) {
        if let Some(finger) = &mut self.finger
            && force < self.hands.fretting.force
        {
            finger.eased = true;
            let finger = finger.slot;
            self.emit(time, Gesture::Press { finger, force, duration }, out);
        }
    }

    /// Force of a finger behind a fret under which the string leaves the fret, N.
    fn leaving_force(&self, fret: usize) -> f64 {
        fret.checked_sub(1).and_then(|index| self.leaving_forces.get(index)).copied().unwrap_or(0.0)
    }

    /// Puts a finger behind a fret, or takes it off for an open string.
    fn finger_fret(&mut self, time: u64, fret: usize, out: &mut impl GestureSink) {
        let Fretting { touch, force, hover, landing, .. } = self.hands.fretting;
        match &mut self.finger {
            Some(finger) if finger.fret == fret => {
                if std::mem::take(&mut finger.eased) {
                    let finger = finger.slot;
                    self.emit(time, Gesture::Press { finger, force, duration: landing }, out);
                }
                return;
            }
            Some(finger) => {
                let slot = finger.slot;
                self.lift(time, slot, touch, QUICK_LIFT, out);
                self.finger = None;
            }
            None => {}
        }
        if fret > 0 {
            let slot = self.next_slot;
            self.next_slot = (slot + 1) % FRETTING_SLOTS;
            self.finger = Some(Finger { slot, fret, eased: false });
            let position = self.geometry.finger_position(fret);
            self.emit(time, Gesture::Place { finger: slot, touch, position, clearance: hover }, out);
            self.emit(time, Gesture::Press { finger: slot, force, duration: landing }, out);
        }
    }

    fn pluck(&mut self, time: u64, start: Start, out: &mut impl GestureSink) {
        let Player { pluck_position, pluck_duration, pluck_force, .. } = self.hands;
        let farthest = FARTHEST_PLUCK * self.sounding_length();
        let from_saddle = (pluck_position + start.deviation.place).max(NEAREST_PLUCK).min(farthest);
        let strength = libm::pow(start.velocity, VELOCITY_EXPONENT) * start.deviation.force;
        let gesture = Gesture::Pluck {
            position: self.geometry.length - from_saddle,
            force: pluck_force * strength,
            duration: pluck_duration,
        };
        self.emit(time + self.samples(start.deviation.delay), gesture, out);
    }

    /// Lays the edge of the hand near the saddle, and a finger of the other hand behind a fretting
    /// one.
    fn rest_dampers(&mut self, time: u64, out: &mut impl GestureSink) {
        let near_saddle = self.hands.damper.position.min(FARTHEST_DAMPER * self.sounding_length());
        for (slot, part) in DAMPERS {
            self.rest_damper(time, slot, self.geometry.length - part * near_saddle, out);
        }
        let behind = BEHIND_FINGER * (self.geometry.length - self.sounding_length());
        if behind >= NEAREST_NUT {
            self.rest_damper(time, self.next_slot, behind, out);
        }
    }

    fn rest_damper(&mut self, time: u64, finger: FingerSlot, position: f64, out: &mut impl GestureSink) {
        let Damper { touch, force, landing, .. } = self.hands.damper;
        let clearance = self.hands.fretting.hover;
        self.resting[finger] = true;
        self.emit(time, Gesture::Place { finger, touch, position, clearance }, out);
        self.emit(time, Gesture::Press { finger, force, duration: landing }, out);
    }

    /// Takes the dampers off because the next note is about to sound.
    fn lift_dampers(&mut self, time: u64, out: &mut impl GestureSink) {
        for slot in self.resting_slots() {
            self.lift(time, slot, self.hands.damper.touch, QUICK_LIFT, out);
        }
        self.resting = [false; FINGERS_PER_STRING];
    }

    fn resting_slots(&self) -> impl Iterator<Item = FingerSlot> + use<> {
        let resting = self.resting;
        (0..FINGERS_PER_STRING).filter(move |&slot| resting[slot])
    }

    /// Length that sounds: from the fretting finger, or the nut, to the saddle, m.
    fn sounding_length(&self) -> f64 {
        self.geometry.length - self.finger.map_or(0.0, |finger| self.geometry.finger_position(finger.fret))
    }

    fn send_bend(&mut self, time: u64, out: &mut impl GestureSink) {
        self.bend_due = None;
        self.bend_ready = time + self.samples(BEND_INTERVAL);
        let (asked, sent) = self.bend;
        if asked != sent {
            self.bend.1 = asked;
            let tension_ratio = self.geometry.tension_ratio(asked).min(self.geometry.highest_ratio);
            let duration = ((asked - sent).abs() / BEND_SPEED).max(BEND_RAMP);
            self.emit(time, Gesture::Bend { tension_ratio, duration }, out);
        }
    }

    /// Lifts a finger.
    fn lift(
        &self,
        time: u64,
        finger: FingerSlot,
        touch: Touch,
        Leaving { speed, turning }: Leaving,
        out: &mut impl GestureSink,
    ) {
        // The hand's damping takes one part of the force, the finger's inertia the other.
        let force = touch.hand_damping * speed + touch.mass * speed / turning;
        self.emit(time, Gesture::Lift { finger, force, duration: turning }, out);
    }

    fn emit(&self, time: u64, gesture: Gesture, out: &mut impl GestureSink) {
        out.gesture(TimedGesture { time, string: self.index, gesture });
    }

    /// A time in samples, rounded.
    fn samples(&self, seconds: f64) -> u64 {
        (seconds * self.sample_rate).round() as u64
    }
}
