//! One string under two hands: a note's life as gestures at exact samples.
//!
//! A note begins with the finger landing behind its fret and the pluck, at once; a finger already
//! there just stays. It ends under the damper, a soft heavy finger that comes to rest on the
//! string; only when the string is quiet do the fretting finger and then the damper leave, slowly,
//! so that their going makes no sound. What is to happen later is kept here as deadlines, because
//! the next note may come first and call it off.

use low_action_dsp::setup::{Damper, Fretting, Player};
use low_action_dsp::{FingerSlot, Gesture, StringGeometry, TimedGesture};

use super::GestureSink;
use super::hand::Use;
use super::technique::*;
use super::variation::Deviation;

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

/// A finger that presses.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Finger {
    slot: FingerSlot,
    fret: usize,
}

/// Things to be done later unless something else comes first, as sample times.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Deadlines {
    damp: Option<u64>,
    unfret: Option<u64>,
    undamp: Option<u64>,
    bend: Option<u64>,
}

/// The player's dealings with one string.
#[derive(Debug, Clone)]
pub(crate) struct StringPlayer {
    index: usize,
    geometry: StringGeometry,
    hands: Player,
    sample_rate: f64,
    note: Option<Note>,
    finger: Option<Finger>,
    next_slot: FingerSlot,
    damper_rests: bool,
    deadlines: Deadlines,
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
    pub(crate) fn new(index: usize, geometry: StringGeometry, hands: Player, sample_rate: f64) -> Self {
        Self {
            index,
            geometry,
            hands,
            sample_rate,
            note: None,
            finger: None,
            next_slot: 0,
            damper_rests: false,
            deadlines: Deadlines::default(),
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
        self.damper_rests = false;
        self.deadlines = Deadlines::default();
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
        self.deadlines = Deadlines { bend: self.deadlines.bend, ..Deadlines::default() };
        if self.damper_rests {
            self.lift(time, DAMPER_SLOT, self.hands.damper.force, QUICK_LIFT, out);
            self.damper_rests = false;
        }
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
            if self.bend.0 != self.bend.1 && self.deadlines.bend.is_none() {
                self.deadlines.bend = Some(time.max(self.bend_ready));
            }
        }
    }

    /// Does what has fallen due before `until`, in order of time.
    pub(crate) fn advance(&mut self, until: u64, out: &mut impl GestureSink) {
        while let Some((time, task)) = self.next_deadline().filter(|&(time, _)| time < until) {
            match task {
                Task::Damp => self.damp(time, out),
                Task::Unfret => self.unfret(time, out),
                Task::Undamp => self.undamp(time, out),
                Task::Bend => self.send_bend(time, out),
            }
        }
    }

    fn next_deadline(&self) -> Option<(u64, Task)> {
        let Deadlines { damp, unfret, undamp, bend } = self.deadlines;
        [(damp, Task::Damp), (unfret, Task::Unfret), (undamp, Task::Undamp), (bend, Task::Bend)]
            .into_iter()
            .filter_map(|(time, task)| time.map(|time| (time, task)))
            .min_by_key(|&(time, _)| time)
    }

    /// The note is over: it is damped now, or once it has been heard.
    fn end(&mut self, time: u64) {
        let heard = self.note.take().map_or(0, |note| note.since + self.samples(SHORTEST_NOTE));
        self.deadlines.damp = Some(time.max(heard));
    }

    /// Puts a finger behind a fret, or takes it off for an open string.
    fn finger_fret(&mut self, time: u64, fret: usize, out: &mut impl GestureSink) {
        if self.finger.map_or(0, |finger| finger.fret) == fret {
            return;
        }
        if let Some(old) = self.finger.take() {
            self.lift(time, old.slot, self.hands.fretting.force, QUICK_LIFT, out);
        }
        if fret > 0 {
            let slot = self.next_slot;
            self.next_slot = (slot + 1) % FRETTING_SLOTS;
            self.finger = Some(Finger { slot, fret });
            let Fretting { touch, force, hover, landing, .. } = self.hands.fretting;
            let position = self.geometry.finger_position(fret);
            self.emit(time, Gesture::Place { finger: slot, touch, position, clearance: hover }, out);
            self.emit(time, Gesture::Press { finger: slot, force, duration: landing }, out);
        }
    }

    fn pluck(&mut self, time: u64, start: Start, out: &mut impl GestureSink) {
        let Player { pluck_position, pluck_duration, pluck_force, .. } = self.hands;
        let length = self.geometry.length;
        let stopped_at = match start.fret {
            0 => 0.0,
            fret => self.geometry.finger_position(fret),
        };
        let farthest = FARTHEST_PLUCK * (length - stopped_at);
        let from_saddle = (pluck_position + start.deviation.place).max(NEAREST_PLUCK).min(farthest);
        let strength = start.velocity.powi(VELOCITY_EXPONENT).max(SOFTEST) * start.deviation.force;
        let gesture = Gesture::Pluck {
            position: length - from_saddle,
            force: pluck_force * strength,
            duration: pluck_duration,
        };
        self.emit(time + self.samples(start.deviation.delay), gesture, out);
    }

    fn damp(&mut self, time: u64, out: &mut impl GestureSink) {
        self.deadlines.damp = None;
        self.deadlines.unfret = self.finger.map(|_| time + self.samples(UNFRET_AFTER));
        self.deadlines.undamp = Some(time + self.samples(UNDAMP_AFTER));
        if !self.damper_rests {
            self.damper_rests = true;
            let Damper { touch, force, landing, position } = self.hands.damper;
            let position = self.geometry.length - position;
            let clearance = self.hands.fretting.hover;
            self.emit(time, Gesture::Place { finger: DAMPER_SLOT, touch, position, clearance }, out);
            self.emit(time, Gesture::Press { finger: DAMPER_SLOT, force, duration: landing }, out);
        }
    }

    fn unfret(&mut self, time: u64, out: &mut impl GestureSink) {
        self.deadlines.unfret = None;
        if let Some(finger) = self.finger.take() {
            self.lift(time, finger.slot, self.hands.fretting.force, GENTLE_LIFT, out);
        }
    }

    fn undamp(&mut self, time: u64, out: &mut impl GestureSink) {
        self.deadlines.undamp = None;
        self.damper_rests = false;
        self.lift(time, DAMPER_SLOT, self.hands.damper.force, GENTLE_LIFT, out);
    }

    fn send_bend(&mut self, time: u64, out: &mut impl GestureSink) {
        self.deadlines.bend = None;
        self.bend_ready = time + self.samples(BEND_INTERVAL);
        let (asked, sent) = self.bend;
        if asked != sent {
            self.bend.1 = asked;
            let tension_ratio = self.geometry.tension_ratio(asked).min(self.geometry.highest_ratio);
            let duration = ((asked - sent).abs() / BEND_SPEED).max(BEND_RAMP);
            self.emit(time, Gesture::Bend { tension_ratio, duration }, out);
        }
    }

    fn lift(&self, time: u64, finger: FingerSlot, pressed: f64, duration: f64, out: &mut impl GestureSink) {
        self.emit(time, Gesture::Lift { finger, force: LIFT_FORCE * pressed, duration }, out);
    }

    fn emit(&self, time: u64, gesture: Gesture, out: &mut impl GestureSink) {
        out.gesture(TimedGesture { time, string: self.index, gesture });
    }

    /// A time in samples, rounded.
    fn samples(&self, seconds: f64) -> u64 {
        (seconds * self.sample_rate).round() as u64
    }
}

/// Something that falls due.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Task {
    Damp,
    Unfret,
    Undamp,
    Bend,
}
