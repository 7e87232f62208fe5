//! How the hand stills a string that still sounds before it plucks it. A pluck only adds to what a string does: on one that
//! swings as it left it, every stroke would be louder or softer than the first by how the two fall together. Under it a finger sets the
//! string down for a harmonic, on one that is at rest, too.

use low_action_dsp::Gesture;

use super::StringPlayer;
use super::deeds::Deed;
use super::ending::Ending;
use crate::performance::articulation::Stroke;
use crate::performance::fingers::Ahead;
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

/// A hand that is laid along a string for a stroke to come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stilling {
    /// How long before the stroke it comes, s.
    pub lead: f64,
    /// How long it stays, s.
    duration: f64,
    /// What it adds to the loss of the string, 1/s.
    loss: f64,
    /// Whether a finger sets the string down under it, ahead of the stroke.
    pub ahead: bool,
}

impl Stilling {
    /// Whether the hand is on the string at once, for a stroke so many seconds from now.
    pub(super) fn comes_at_once(&self, wait: f64) -> bool {
        wait <= self.lead
    }

    /// From when to when it is there, for a stroke so many seconds from now, s.
    pub(super) fn stays(&self, wait: f64) -> [f64; 2] {
        let comes = (wait - self.lead).max(0.0);
        [comes, comes + self.duration]
    }
}

impl StringPlayer {
    /// Whether the hand stills the string for a stroke: where it sounds, and where hands damp it, however long it has been silent
    /// under them. They bend it a little, and let go of it for the stroke.
    pub(super) fn wants_stilling(&self, time: u64) -> bool {
        let ends = self.ending.is_some_and(|(_, step)| step != Ending::Over);
        let rings = self.touched.is_some_and(|since| time < since + self.samples(POINTED_RINGING));
        self.note.is_some() || ends || rings
    }

    /// Whether nobody hears what is done to the string: it has been damped, or has come to rest.
    pub(super) fn is_silent(&self, time: u64) -> bool {
        let damped = |step| match step {
            // What stops the string eases off first, when it is quiet.
            Ending::Leave => self.fingers.stopped(),
            Ending::Gone | Ending::Over => true,
            Ending::Damp | Ending::DampBehind(_) | Ending::EaseOff => false,
        };
        let is_damped = self.ending.is_some_and(|(_, step)| damped(step));
        !self.wants_stilling(time) || (self.note.is_none() && self.touched.is_none() && is_damped)
    }

    /// Whether hands damp it whose note is over, and have done so for as long as a bend takes at least: under them nobody hears what
    /// pulls it for another one.
    pub(super) fn is_under_dampers(&self, time: u64) -> bool {
        let damps = self.ending.is_some_and(|(_, step)| step != Ending::Damp)
            && time >= self.damped + self.samples(BEND_RAMP);
        self.note.is_none() && self.touched.is_none() && damps
    }

    /// How the hand stills the string for a stroke on a fret, 0 for the open string, or for a harmonic there. Where a finger lets the
    /// string up to that, what counts is how long the hand is still there when the string has come up: letting go is a pluck, too. So it
    /// is where a finger sets the string down ahead of the stroke.
    pub(super) fn stilling(
        &self,
        stroke: Stroke,
        fret: usize,
        harmonic: bool,
        ahead: Option<Ahead>,
    ) -> Stilling {
        let period = ahead.map_or_else(|| self.fingers.period(fret), |ahead| ahead.period);
        // A thumb takes some time to come.
        let within = |stroke| STILLED_PUSH * self.fingers.push_time(stroke).unwrap_or(0.0);
        let rising = if self.fingers.lets_up_to(fret as f64) { RISING } else { 0.0 };
        let longer = if harmonic { STILLED_LONGER } else { 0.0 };
        let still = STILLING.0 * period;
        let time = match ahead {
            Some(ahead) => ahead.time + still,
            None => (rising + still).max(STILLED_AT_LEAST) + longer,
        };
        let lead = (time - within(Stroke::Down)).clamp(0.0, LONGEST_LEAD);
        let (duration, loss) = (time.min(lead + within(stroke)), STILLING.1 / period);
        Stilling { lead, duration, loss, ahead: ahead.is_some() }
    }

    /// Has the hand still the string for a stroke so many seconds from now, no less than it comes before it.
    pub(super) fn still_before(&mut self, wait: f64, stilling: Stilling, at: &mut Moment<impl GestureSink>) {
        if stilling.comes_at_once(wait) {
            self.still(stilling, at);
        } else {
            self.deeds.plan(at.after(wait - stilling.lead), Deed::Still(stilling));
        }
    }

    /// The note is played elsewhere: a stroke that is on its way does not come. Gives back whether there was one.
    pub(crate) fn give_up_stroke(&mut self) -> bool {
        let awaited = self.deeds.await_sound();
        self.deeds.forget_strokes();
        awaited
    }

    /// A stroke whose hand is on its way falls at once, where another note takes its string: no note is lost by having
    /// waited for a string to be stilled. Gives back whether there was one.
    pub(super) fn strike_in_time(&mut self, at: &mut Moment<impl GestureSink>) -> bool {
        let struck = self.deeds.take_stroke(at.after(LONGEST_LEAD) + 1);
        if let Some(struck) = struck {
            self.strike(struck, 0.0, at);
        }
        struck.is_some()
    }

    /// The hand comes.
    pub(super) fn still(&mut self, stilling: Stilling, at: &mut Moment<impl GestureSink>) {
        let Stilling { duration, loss, .. } = stilling;
        self.stilled = at.after(duration);
        at.does(Gesture::Still { loss, duration });
    }

    /// It goes before its time: what sounds now is not what it came to still.
    pub(super) fn still_no_more(&mut self, at: &mut Moment<impl GestureSink>) {
        if at.time < std::mem::take(&mut self.stilled) {
            at.does(Gesture::Still { loss: 0.0, duration: 0.0 });
        }
    }
}
