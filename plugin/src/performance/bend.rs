//! What bends one string: pitch wheel, note's own tuning, tremolo arm and vibrato, followed no faster than
//! a hand bends, in goals at a bounded rate. Before a note on a string at rest nobody hears it pulled: it begins in tune.
//!
//! Wheel and tuning pull the string as far as its set-up lets tension go. Past that a finger that stops the
//! string slides to the nearest fret and pulling does the rest, or comes down there if it has yet to; an open string
//! that sounds stays where pulling ends. A finger that has ceased to press, as its note is over, stays where it has slid or glided to,
//! and pulling does what it can.

mod course;
mod sliding;

use std::f64::consts::TAU;

use low_action_dsp::Gesture;

use super::fingers::Fingers;
use super::technique::{BEND_INTERVAL, BEND_RAMP, BEND_SPEED, FOLLOWED, OUT_OF_TUNE, VIBRATO, VIBRATO_STEP};
use super::{Annotation, GestureSink, Moment, Pull};
use course::Course;

/// What is asked of a string and what has been done about it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Bend {
    /// Channel whose wheel bends the string: that of its last note.
    channel: Option<u8>,
    /// Bend by the channel's wheel, semitones.
    wheel: f64,
    /// The note's own tuning, semitones.
    tuning: f64,
    /// Bend by the tremolo arm, semitones.
    arm: f64,
    /// Depth of the vibrato, 0 to 1.
    vibrato: f64,
    /// Since which sample the hand swings.
    swings: Option<u64>,
    /// Bend by tension last sent, semitones.
    sent: f64,
    /// What hands take that to raise the string by, semitones.
    raised: Course,
    /// The tension for it, as a multiple of the string's own: what stops the string counts, too.
    tension: Course,
    /// All of the bend as told, semitones, and what of its end is pulled.
    told: Course,
    pull: Pull,
    /// Frets the finger has been slid by.
    slid: i32,
    /// Whether the string is pulled for the frets that are still before a sliding finger.
    makes_up: bool,
    /// Semitones the finger has glided.
    glided: f64,
    /// Wheel and tuning as last followed, semitones.
    followed: f64,
    /// When the next goal is to be sent.
    due: Option<u64>,
    /// Earliest sample for it.
    ready: u64,
    /// When a note began that nobody hears a string bent for before, and within how many seconds nobody does.
    unheard: Option<(u64, f64)>,
}

impl Bend {
    /// A straight string.
    pub(crate) fn new() -> Self {
        Self { tension: Course::at_rest(1.0), ..Self::default() }
    }

    /// A new note begins: from now on its channel's wheel counts, its finger has not slid, and what it is bent by takes
    /// another tension.
    pub(crate) fn begin(&mut self, channel: u8) {
        self.channel = Some(channel);
        self.tuning = 0.0;
        self.vibrato = 0.0;
        (self.slid, self.glided, self.makes_up) = (0, 0.0, false);
        self.followed = f64::NAN;
    }

    /// The note is struck, and begins at its pitch: the hand swings from there, even if it did so before. What else bends a string does
    /// so before it sounds if nobody hears what is done to it within so many seconds.
    pub(crate) fn begin_struck(&mut self, time: u64, unheard: Option<f64>) {
        self.swings = None;
        if let Some(within) = unheard {
            self.unheard = Some((time, within));
            self.ready = time;
        }
        self.due = self.due.map(|_| time.max(self.ready));
    }

    /// The fret at which a finger, or a bar, comes down for a note on another, 0 for the open string, which wheel and tuning bend by
    /// so much from the beginning, semitones: past the reach of pulling it is where it would have to slide. Where nothing keeps it
    /// on frets it comes down beside that of the note.
    pub(crate) fn begin_slid(&mut self, fret: usize, asked: f64, bar: bool, fingers: &mut Fingers) -> usize {
        if bar || fingers.is_fretless() {
            fingers.expect_beside(asked);
        } else {
            self.slid = fingers.reach(fret, self.frets_to_slide(asked, reach_of_pulling(fingers)));
        }
        (fret as i32 + self.slid) as usize
    }

    /// What wheel and tuning ask of a note that comes back, semitones, if its channel's wheel is known.
    pub(crate) fn asked_by(&self, channel: u8, tuning: f64) -> f64 {
        tuning + if self.channel == Some(channel) { self.wheel } else { 0.0 }
    }

    /// A note is stopped by another finger, or by one that is on its way to it. What the one before had slid or glided is over within a
    /// sample, and what is pulled goes on from where it has come. (A hand that swings has its next goals told, and they have the finger
    /// there already.)
    pub(crate) fn tell_change(&mut self, fingers: &Fingers, at: &mut Moment<impl GestureSink>) {
        if fingers.glides() {
            self.glided = fingers.away();
        }
        let moved = if self.swings.is_some() { fingers.away() } else { fingers.away_by_now(at) };
        let [raised, ratio] = [&self.raised, &self.tension].map(|course| course.at(at.time));
        let semitones = moved + raised;
        let is_told = (semitones - self.told.at(at.time)).abs() < OUT_OF_TUNE;
        // On a string at rest what is pulled is there at once, too.
        if !is_told && self.unheard.is_none_or(|(_, within)| within > 0.0) {
            self.tell(semitones, 0.0, Pull::new(raised, ratio, fingers.stretched_at()), at);
            self.ready = self.ready.max(at.time + 1);
            self.due = self.due.map(|due| due.max(self.ready));
            self.unheard = self.unheard.map(|(_, within)| (self.ready, within));
        }
    }

    /// Tells where the bend goes within so many seconds, or within a sample, since labels divide by durations.
    fn tell(&mut self, semitones: f64, duration: f64, pull: Pull, at: &mut Moment<impl GestureSink>) {
        let duration = duration.max(1.0 / at.sample_rate);
        self.told.turn(semitones, duration, at);
        self.pull = pull;
        at.tells(Annotation::Bent { semitones, duration, pull });
    }

    /// What keeps the finger on frets is another matter now than where it went from its note's fret.
    pub(crate) fn count_anew(&mut self, fingers: &Fingers) {
        let away = fingers.away();
        let glides = fingers.is_fretless();
        (self.slid, self.glided) = if glides { (0, away) } else { (away.round() as i32, 0.0) };
    }

    /// Something else stops the string.
    pub(crate) fn renew(&mut self, time: u64) {
        self.followed = f64::NAN;
        self.plan(time);
    }

    /// The note is over, and with it its tuning.
    pub(crate) fn loosen(&mut self, time: u64) {
        if self.tuning != 0.0 {
            self.tune(time, 0.0);
        }
    }

    /// Channel whose wheel bends the string.
    pub(crate) fn channel(&self) -> Option<u8> {
        self.channel
    }

    /// A channel's wheel moves; nothing happens if it is not this string's.
    pub(crate) fn ask(&mut self, time: u64, channel: u8, semitones: f64) {
        if self.channel == Some(channel) {
            self.wheel = semitones;
            self.plan(time);
        }
    }

    /// The note's own tuning changes.
    pub(crate) fn tune(&mut self, time: u64, semitones: f64) {
        self.tuning = semitones;
        self.plan(time);
    }

    /// The tremolo arm moves.
    pub(crate) fn set_arm(&mut self, time: u64, semitones: f64) {
        self.arm = semitones;
        self.plan(time);
    }

    /// The fretting hand swings so deep, 0 to 1. One that swings already goes on, for a note that is not struck, too.
    pub(crate) fn set_vibrato(&mut self, time: u64, depth: f64) {
        self.vibrato = depth;
        self.swings = (depth > 0.0).then(|| self.swings.unwrap_or(time));
        self.plan(time);
    }

    /// When there is something to send.
    pub(crate) fn due(&self) -> Option<u64> {
        self.due
    }

    /// Sends what is due. Gives back whether wheel and tuning ask for more than string and finger can do.
    pub(crate) fn send(&mut self, fingers: &mut Fingers, at: &mut Moment<impl GestureSink>) -> bool {
        self.due = None;
        let asked = self.wheel + self.tuning;
        let most = reach_of_pulling(fingers);
        let unheard = self.unheard.take().filter(|&(time, _)| time == at.time).map(|(_, within)| within);
        let duration = |change: f64| (change.abs() / BEND_SPEED).max(BEND_RAMP);
        // A finger that slides takes its time even so: it is heard.
        let within = unheard.map_or(f64::INFINITY, |within| within.max(1.0 / at.sample_rate));
        let pulling = |change| duration(change).min(within);
        // What is pulled before the note leaves the swing out.
        let before = unheard.is_some() && !fingers.glides();
        let swing = if before { 0.0 } else { self.swing(at) };
        let turned = (asked - std::mem::replace(&mut self.followed, asked)).abs();
        let (mut at_last, mut pulled) = (self.arm, self.arm);
        let (reached, moved);
        let mut taken: f64 = 0.0;
        if fingers.glides() {
            let goal = fingers.can_glide(asked + swing);
            if fingers.has_to_glide(goal) {
                taken = duration(goal - fingers.away_by_now(at));
            }
            moved = fingers.glide(goal, taken, at);
            reached = moved - swing;
            self.glided = goal;
        } else {
            let wanted = fingers.can_slide(self.frets_to_slide(asked, most));
            let way = duration(f64::from(wanted - self.slid));
            let on_its_way = fingers.passes(0.0, at).is_some();
            let (slid, slide) = fingers.slide(wanted, way, at);
            if let Some(Gesture::Slide { duration, .. }) = slide {
                self.makes_up = if on_its_way { self.makes_up } else { turned <= FOLLOWED };
                taken = duration;
            }
            self.slid = slid;
            // Where a finger has glided to it stays, once it has ceased to press.
            moved = f64::from(self.slid) + self.glided;
            let tension = (asked - moved).clamp(-most, most);
            reached = moved + tension;
            at_last = tension + self.arm + swing;
            pulled = at_last - tension + self.meanwhile(asked, tension, most, fingers, at);
        }
        if self.swings.is_some() {
            let next =
                if before { at.after(taken.max(within)).max(at.time + 1) } else { at.after(VIBRATO_STEP) };
            self.due = Some(next);
        }
        let change = pulled - std::mem::replace(&mut self.sent, pulled);
        let Pull { semitones: raised, ratio, .. } = fingers.pulled(pulled);
        if taken > 0.0 || ratio != self.tension.to {
            self.ready = at.after(BEND_INTERVAL);
        }
        // What is on its way there already goes on, or is hurried.
        let mut left = self.tension.left(at);
        if ratio != self.tension.to || left > within {
            left = 0.0;
            // For a wheel that is far ahead the string is as it is to be when the finger gets there.
            let duration = pulling(change).max(if self.makes_up { 0.0 } else { taken });
            at.does(Gesture::Bend { tension_ratio: ratio, duration });
            self.raised.turn(raised, duration, at);
            self.tension.turn(ratio, duration, at);
            fingers.hold_pulled(ratio, duration, at);
        }
        let pull = fingers.pulled(at_last);
        let semitones = moved + pull.semitones;
        let is_late = self.told.left(at) > within;
        if semitones != self.told.to || pull != self.pull || is_late {
            let slides = if self.swings.is_none() { fingers.time_to_arrive(at) } else { 0.0 };
            let duration = taken.max(pulling(change)).max(slides).max(left);
            self.tell(semitones, duration, pull, at);
        }
        (asked - reached).abs() > OUT_OF_TUNE
    }

    /// How far the hand has swung when its next goal follows, semitones.
    fn swing(&self, at: &Moment<impl GestureSink>) -> f64 {
        let Some(since) = self.swings else { return 0.0 };
        let (rate, depth) = VIBRATO;
        let seconds = at.after(VIBRATO_STEP).saturating_sub(since) as f64 / at.sample_rate;
        self.vibrato * depth * libm::sin(TAU * rate * seconds)
    }

    /// Sees to it that a change is sent.
    fn plan(&mut self, time: u64) {
        let asked = self.wheel + self.tuning;
        let straight = asked - f64::from(self.slid) + self.arm == self.sent && asked == self.followed;
        if (!straight || self.swings.is_some()) && self.due.is_none() {
            self.due = Some(time.max(self.ready));
        }
    }
}

/// How far tension goes, semitones.
fn reach_of_pulling(fingers: &Fingers) -> f64 {
    6.0 * libm::log2(fingers.geometry().highest_ratio)
}
