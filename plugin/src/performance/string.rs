//! One string under two hands: a note's life as gestures at exact samples.
//!
//! A note begins with the finger landing behind its fret and the stroke, at once; a finger already
//! there just stays (`beginning`). Or it takes over from the one before by a hammer, a pull or a slide
//! (`legato`). It ends under the edge of a hand that comes to rest on the string; only when the string is
//! quiet do the fretting finger and then the hand ease off, so slowly that their going makes no sound
//! (`ending`). What is to happen later is kept here as deadlines (`deeds`), because the next note may come
//! first and call it off.

mod annotated;
mod beginning;
mod deeds;
mod ending;
mod keys;
mod legato;
mod note;
mod own;
mod sighted;
mod stilling;

use low_action_dsp::setup::Player;

use super::articulation::Articulation;
use super::bend::Bend;
use super::fingers::Fingers;
use super::hand::Use;
use super::technique::*;
use super::{Annotation, GestureSink, Moment, PlayedString};
use deeds::{Deed, Deeds};
use ending::Ending;
pub(crate) use note::{Manner, Note, Start};
pub(crate) use own::Own;

/// The player's dealings with one string.
#[derive(Debug, Clone)]
pub(crate) struct StringPlayer {
    index: usize,
    sample_rate: f64,
    fingers: Fingers,
    bend: Bend,
    note: Option<Note>,
    /// How the finger of the last note goes when that is over.
    parting: Parting,
    /// The next step of the last note's ending, and when.
    ending: Option<(u64, Ending)>,
    plucked_at: Option<u64>,
    /// Notes under the one that sounds whose keys are still down, or caught by a pedal, the latest last.
    under: [Option<Note>; UNDER],
    /// What is to be done to the present note.
    deeds: Deeds,
    /// Sample by which a hand that stills it is off it.
    stilled: u64,
    /// Sample at which dampers came to rest on it last.
    damped: u64,
    /// Sample at which a finger comes that is late: hands do nothing to the string before it.
    late: u64,
    /// Strokes a second of a tremolo, 0 for none.
    tremolo: f64,
    /// Since when it may sound without a note, by somebody who sees it.
    touched: Option<u64>,
    /// Notes bent less far than asked, since that was last asked for.
    bent_short: u64,
    /// Notes whose string another took before it was struck, since that was last asked for.
    overtaken: u64,
    /// Whether its last note has yet to be struck, or whatever else makes it sound.
    unheard: bool,
    /// Notes that were silenced before they were struck, since that was last asked for.
    called_off: u64,
    /// Whether a note has come back whose key was down under another, since that was last asked for.
    gone_back: bool,
}

/// Most keys that are remembered under the one that sounds.
const UNDER: usize = 8;

impl StringPlayer {
    /// A string nobody touches.
    pub(crate) fn new(index: usize, string: PlayedString, hands: Player, sample_rate: f64) -> Self {
        Self {
            index,
            sample_rate,
            fingers: Fingers::new(string, hands),
            bend: Bend::new(),
            note: None,
            parting: RESTING,
            ending: None,
            plucked_at: None,
            under: [None; UNDER],
            deeds: Deeds::default(),
            stilled: 0,
            damped: 0,
            late: 0,
            tremolo: 0.0,
            touched: None,
            bent_short: 0,
            overtaken: 0,
            unheard: false,
            called_off: 0,
            gone_back: false,
        }
    }

    /// Back to the start.
    pub(crate) fn reset(&mut self) {
        self.fingers.reset();
        self.bend = Bend::new();
        self.note = None;
        self.parting = RESTING;
        self.ending = None;
        self.plucked_at = None;
        self.under = [None; UNDER];
        self.deeds = Deeds::default();
        self.stilled = 0;
        self.damped = 0;
        self.late = 0;
        self.tremolo = 0.0;
        self.touched = None;
        self.bent_short = 0;
        self.overtaken = 0;
        self.unheard = false;
        self.called_off = 0;
        self.gone_back = false;
    }

    /// What the string is doing, for the choice of strings.
    pub(crate) fn usage(&self, time: u64) -> Use {
        match self.note {
            _ if self.plucked_at == Some(time) => Use::Untouchable,
            Some(note @ Note { channel, key, since, fret, .. }) => {
                Use::Taken { channel, key, since, key_down: note.key_down(), fret }
            }
            None => Use::Free,
        }
    }

    /// Whether it has a note.
    pub(crate) fn is_played(&self) -> bool {
        self.note.is_some()
    }

    /// Channel of the string's last note, whose wheel and pedals count.
    pub(crate) fn channel(&self) -> Option<u8> {
        self.bend.channel()
    }

    /// The note's vibrato goes so deep, 0 to 1. Without a note no hand swings.
    pub(crate) fn swing(&mut self, time: u64, depth: f64) {
        if self.note.is_some() {
            self.bend.set_vibrato(time, depth);
        }
    }

    /// The tremolo arm moves, semitones.
    pub(crate) fn set_arm(&mut self, time: u64, semitones: f64) {
        self.bend.set_arm(time, semitones);
    }

    /// The finger presses with so many times its usual force, as keys are pressed; the note may have a factor of its own.
    pub(crate) fn press(&mut self, time: u64, pressure: f64, out: &mut impl GestureSink) {
        let firmness = self.note.map_or(1.0, |note| note.manner.firmness);
        let mut at = self.moment(time, out);
        self.fingers.press(pressure * firmness, &mut at);
    }

    /// The hands act differently from now on.
    pub(crate) fn set_hands(&mut self, time: u64, hands: &Player, out: &mut impl GestureSink) {
        let mut at = self.moment(time, out);
        self.fingers.set_hands(hands, &mut at);
        if self.fingers.settle(&mut at) {
            self.bend.renew(time);
        }
    }

    /// The hands act so on a string that nobody has touched yet, and the tremolo arm stands there, semitones.
    pub(crate) fn begin_with(&mut self, time: u64, hands: &Player, arm: f64) {
        self.fingers.begin_with(hands);
        self.bend.set_arm(time, arm);
    }

    /// Takes over what the player was doing with this string, when it has been given another model.
    pub(crate) fn take_over(&mut self, old: &Self) {
        let another_kind = self.fingers.take_over(&old.fingers);
        (self.bend, self.note, self.parting, self.ending) = (old.bend, old.note, old.parting, old.ending);
        if another_kind {
            self.bend.count_anew(&self.fingers);
        }
        self.plucked_at = old.plucked_at;
        (self.under, self.deeds, self.tremolo) = (old.under, old.deeds, old.tremolo);
        (self.touched, self.stilled, self.damped) = (old.touched, old.stilled, old.damped);
        (self.late, self.unheard) = (old.late, old.unheard);
    }

    /// The hands act differently on the note that sounds, and on those to come.
    pub(crate) fn set_touch(&mut self, time: u64, articulation: &Articulation, out: &mut impl GestureSink) {
        self.set_palm(time, articulation.palm, out);
        self.go_on_with_tremolo(time, articulation.tremolo, out);
    }

    /// The note that sounds has a tremolo of so many strokes a second from now on, 0 for none.
    pub(crate) fn go_on_with_tremolo(&mut self, time: u64, rate: f64, out: &mut impl GestureSink) {
        let at = self.moment(time, out);
        let before = self.set_tremolo(rate);
        self.begin_tremolo(before, &at);
    }

    /// The palm rests so hard on the string, 0 to 1; on a silent one for a while, until there is a note.
    pub(crate) fn set_palm(&mut self, time: u64, palm: f64, out: &mut impl GestureSink) {
        let mut at = self.moment(time, out);
        self.fingers.set_palm(palm, &mut at);
        // One that rests there when a note ends waits from when the fingers leave on.
        let over = self.ending.is_none_or(|(_, step)| matches!(step, Ending::Gone | Ending::Over));
        if self.note.is_none() && over {
            self.palm_waits(&at);
        }
    }

    /// A palm on a string that is silent waits for the next note, and goes if there is none.
    fn palm_waits(&mut self, at: &Moment<impl GestureSink>) {
        self.deeds.forget_palm();
        if self.fingers.palm_rests() {
            self.deeds.plan(at.after(PALM_WAITS), Deed::LiftPalm);
        }
    }

    /// A capo at this fret, 0 for none, from the next note on.
    pub(crate) fn set_capo(&mut self, fret: usize) {
        self.fingers.set_capo(fret);
    }

    /// Bends the string if its last note is of that channel.
    pub(crate) fn bend(&mut self, time: u64, channel: u8, semitones: f64) {
        self.bend.ask(time, channel, semitones);
    }

    /// Notes bent less far than asked, since this was last called.
    pub(crate) fn take_bent_short(&mut self) -> u64 {
        std::mem::take(&mut self.bent_short)
    }

    /// Notes whose string another took before it was struck, since this was last called.
    pub(crate) fn take_overtaken(&mut self) -> u64 {
        std::mem::take(&mut self.overtaken)
    }

    /// Notes that were silenced before they were struck, since this was last called.
    pub(crate) fn take_called_off(&mut self) -> u64 {
        std::mem::take(&mut self.called_off)
    }

    /// Does what has fallen due before `until`, in order of time.
    pub(crate) fn advance(&mut self, until: u64, out: &mut impl GestureSink) {
        loop {
            let ending = self.ending.filter(|&(time, _)| time < until);
            let bend = self.bend.due().filter(|&time| time < until);
            let deed = self.deeds.next().filter(|&time| time < until);
            let touch = self.fingers.due().filter(|&time| time < until);
            let times = [ending.map(|ending| ending.0), bend, touch, deed];
            let Some(first) = times.into_iter().flatten().min() else { return };
            let mut at = self.moment(first, out);
            if let Some((_, step)) = ending.filter(|&(time, _)| time == first) {
                self.end_by(step, at);
                if step == Ending::Gone {
                    self.bend.loosen(first);
                }
            } else if bend == Some(first) {
                let short = self.bend.send(&mut self.fingers, &mut at);
                if let Some(note) = self.note.as_mut().filter(|note| short && !note.bent_short) {
                    note.bent_short = true;
                    self.bent_short += 1;
                    at.tells(Annotation::BentShort);
                }
            } else if touch == Some(first) {
                self.fingers.follow(&mut at);
            } else {
                self.do_next(&mut at);
            }
        }
    }

    /// What hands do at a time, or as soon as a finger that is late has come.
    fn moment<'a, S: GestureSink>(&self, time: u64, out: &'a mut S) -> Moment<'a, S> {
        let time = time.max(self.late);
        Moment { time, string: self.index, sample_rate: self.sample_rate, out }
    }

    /// A time in samples, rounded.
    fn samples(&self, seconds: f64) -> u64 {
        (seconds * self.sample_rate).round() as u64
    }
}
