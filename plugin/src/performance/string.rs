//! One string under two hands: a note's life as gestures at exact samples.
//!
//! A note begins with the finger landing behind its fret and the pluck, at once; a finger already
//! there just stays. It ends under the edge of a hand that comes to rest on the string; only when the
//! string is quiet do the fretting finger and then the hand ease off, so slowly that their going
//! makes no sound. What is to happen later is kept here as deadlines, because the next note may come
//! first and call it off.

use low_action_dsp::setup::Player;

use super::bend::Bend;
use super::fingers::Fingers;
use super::hand::Use;
use super::technique::*;
use super::variation::Deviation;
use super::{GestureSink, Moment, PlayedString};

/// A note to begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Start {
    /// Its channel.
    pub channel: u8,
    /// Its key, as sent.
    pub key: u8,
    /// Fret, 0 for the open string.
    pub fret: usize,
    /// Part of the hardest pluck's force.
    pub strength: f64,
    /// How this pluck differs from the usual.
    pub deviation: Deviation,
    /// What the note has for itself.
    pub manner: Manner,
}

/// What a note can have for itself, beside what holds for all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Manner {
    /// Moves the pluck away from the saddle, m.
    pub place: f64,
    /// Factor of the pluck's force.
    pub force: f64,
    /// Factor of the finger's force.
    pub pressure: f64,
    /// Tuning, semitones.
    pub tuning: f64,
    /// Depth of the vibrato, 0 to 1.
    pub vibrato: f64,
}

impl Manner {
    /// Nothing special.
    pub const PLAIN: Self = Self { place: 0.0, force: 1.0, pressure: 1.0, tuning: 0.0, vibrato: 0.0 };
}

/// The note on a string, from its pluck until it is damped.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Note {
    channel: u8,
    key: u8,
    since: u64,
    key_down: bool,
    /// Whether the sostenuto pedal caught it.
    caught: bool,
    /// Sample of the last key press of this very note while it was already down. The note-off of
    /// the press before may come a moment later and must not end the new one.
    pressed_again: Option<u64>,
}

/// The steps by which a note is ended, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ending {
    /// The dampers come to rest on the string.
    Damp,
    /// The string is quiet: the fretting finger eases off.
    EaseOff,
    /// The fretting finger goes, and the dampers ease off.
    Leave,
    /// The dampers have gone too.
    Gone,
}

/// The player's dealings with one string.
#[derive(Debug, Clone)]
pub(crate) struct StringPlayer {
    index: usize,
    sample_rate: f64,
    fingers: Fingers,
    bend: Bend,
    note: Option<Note>,
    /// The next step of the last note's ending, and when.
    ending: Option<(u64, Ending)>,
    plucked_at: Option<u64>,
}

impl StringPlayer {
    /// A string nobody touches.
    pub(crate) fn new(index: usize, string: PlayedString, hands: Player, sample_rate: f64) -> Self {
        Self {
            index,
            sample_rate,
            fingers: Fingers::new(string, hands),
            bend: Bend::new(),
            note: None,
            ending: None,
            plucked_at: None,
        }
    }

    /// Back to the start.
    pub(crate) fn reset(&mut self) {
        self.fingers.reset();
        self.bend = Bend::new();
        self.note = None;
        self.ending = None;
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
        self.note = Some(Note {
            channel: start.channel,
            key: start.key,
            since: time,
            key_down: true,
            caught: false,
            pressed_again,
        });
        self.bend.begin(start.channel);
        self.plucked_at = Some(time);
        self.ending = None;
        let mut at = self.moment(time, out);
        let Manner { place, force, pressure, tuning, vibrato } = start.manner;
        let strength = start.strength * start.deviation.force * force;
        self.fingers.press(pressure, &mut at);
        self.fingers.stop(start.fret, strength, &mut at);
        let pluck = self.fingers.pluck(strength, start.deviation.place + place);
        at.does_later(start.deviation.delay, pluck);
        self.bend.tune(time, tuning);
        self.bend.set_vibrato(time, vibrato);
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
        if !pedal && !note.caught {
            self.end(time);
        }
        true
    }

    /// The sostenuto pedal of a channel goes down: it catches the note if its key is down.
    pub(crate) fn catch(&mut self, channel: u8) {
        if let Some(note) = self.note.as_mut().filter(|note| note.channel == channel) {
            note.caught = note.key_down;
        }
    }

    /// It goes up: a note that only it kept ends.
    pub(crate) fn let_fall(&mut self, time: u64, channel: u8, pedal: bool) {
        if let Some(note) = self.note.as_mut().filter(|note| note.channel == channel && note.caught) {
            note.caught = false;
            if !note.key_down && !pedal {
                self.end(time);
            }
        }
    }

    /// Whether the string sounds a key of a channel.
    pub(crate) fn sounds(&self, channel: u8, key: u8) -> bool {
        self.note.is_some_and(|note| (note.channel, note.key) == (channel, key))
    }

    /// Channel of the string's last note, whose wheel and pedals count.
    pub(crate) fn channel(&self) -> Option<u8> {
        self.bend.channel()
    }

    /// The note changes its tuning, semitones.
    pub(crate) fn tune(&mut self, time: u64, semitones: f64) {
        self.bend.tune(time, semitones);
    }

    /// The note's vibrato goes so deep, 0 to 1.
    pub(crate) fn swing(&mut self, time: u64, depth: f64) {
        self.bend.set_vibrato(time, depth);
    }

    /// The tremolo arm moves, semitones.
    pub(crate) fn set_arm(&mut self, time: u64, semitones: f64) {
        self.bend.set_arm(time, semitones);
    }

    /// The finger presses with so many times its usual force.
    pub(crate) fn press(&mut self, time: u64, pressure: f64, out: &mut impl GestureSink) {
        let mut at = self.moment(time, out);
        self.fingers.press(pressure, &mut at);
    }

    /// The hands act differently from now on.
    pub(crate) fn set_hands(&mut self, time: u64, hands: &Player, out: &mut impl GestureSink) {
        let mut at = self.moment(time, out);
        self.fingers.set_hands(hands, &mut at);
    }

    /// The hands act so from the start, and the tremolo arm stands there, semitones.
    pub(crate) fn begin_with(&mut self, time: u64, hands: &Player, arm: f64) {
        self.fingers.begin_with(hands);
        self.bend.set_arm(time, arm);
    }

    /// Takes over what the player was doing with this string, when it has been given another model.
    pub(crate) fn take_over(&mut self, old: &Self) {
        self.fingers.take_over(&old.fingers);
        (self.bend, self.note, self.ending) = (old.bend, old.note, old.ending);
        self.plucked_at = old.plucked_at;
    }

    /// Lets go of whatever key of a channel holds this string.
    pub(crate) fn release_channel(&mut self, time: u64, channel: u8, pedal: bool) {
        if let Some(note) = self.note.as_mut().filter(|note| note.channel == channel) {
            note.key_down = false;
            if !pedal && !note.caught {
                self.end(time);
            }
        }
    }

    /// The pedal of a channel goes up: a note it kept ends.
    pub(crate) fn pedal_up(&mut self, time: u64, channel: u8) {
        if self.note.is_some_and(|note| note.channel == channel && !note.key_down && !note.caught) {
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
        self.bend.ask(time, channel, semitones);
    }

    /// Does what has fallen due before `until`, in order of time.
    pub(crate) fn advance(&mut self, until: u64, out: &mut impl GestureSink) {
        loop {
            let ending = self.ending.filter(|&(time, _)| time < until);
            let bend = self.bend.due().filter(|&time| time < until);
            if let Some((time, step)) = ending.filter(|&(time, _)| bend.is_none_or(|bend| time <= bend)) {
                self.end_by(step, self.moment(time, out));
            } else if let Some(time) = bend {
                let mut at = self.moment(time, out);
                self.bend.send(&mut self.fingers, &mut at);
            } else {
                return;
            }
        }
    }

    /// The note is over: it is damped now, or once it has been heard.
    fn end(&mut self, time: u64) {
        let heard = self.note.take().map_or(0, |note| note.since + self.samples(SHORTEST_NOTE));
        self.ending = Some((time.max(heard), Ending::Damp));
    }

    /// Takes one step of an ending and plans the next.
    fn end_by(&mut self, step: Ending, mut at: Moment<impl GestureSink>) {
        let next = match step {
            Ending::Damp => {
                self.fingers.damp(&mut at);
                let next = if self.fingers.frets() { Ending::EaseOff } else { Ending::Leave };
                Some((RELAXING, next))
            }
            Ending::EaseOff => {
                self.fingers.ease_off(&mut at);
                Some((FINGER_EASING.turning, Ending::Leave))
            }
            Ending::Leave => {
                self.fingers.leave(&mut at);
                Some((DAMPER_EASING.turning, Ending::Gone))
            }
            Ending::Gone => {
                self.fingers.gone();
                None
            }
        };
        self.ending = next.map(|(delay, step)| (at.after(delay), step));
    }

    fn moment<'a, S: GestureSink>(&self, time: u64, out: &'a mut S) -> Moment<'a, S> {
        Moment { time, string: self.index, sample_rate: self.sample_rate, out }
    }

    /// A time in samples, rounded.
    fn samples(&self, seconds: f64) -> u64 {
        (seconds * self.sample_rate).round() as u64
    }
}
