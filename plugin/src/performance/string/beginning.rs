//! How a note begins that is struck: by a stroke of the right hand, or by a tap.

use super::deeds::{Deed, Deeds, Struck};
use super::stilling::Stilling;
use super::{Manner, Note, Start, StringPlayer, UNDER};
use crate::performance::articulation::{Articulation, Stop, Stroke};
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment, Technique};

impl StringPlayer {
    /// Begins a note; one that sounds gives way.
    pub(crate) fn start(&mut self, time: u64, mut start: Start, out: &mut impl GestureSink) {
        self.strike_in_time(&mut self.moment(time, out));
        // A hand that is farther away has not come to the string when it turns to this note.
        self.overtaken += u64::from(self.deeds.await_sound());
        let (stills, silent, damped) =
            (self.wants_stilling(time), self.is_silent(time), self.is_under_dampers(time));
        self.take_presses(&mut start);
        self.under = [None; UNDER];
        self.deeds = Deeds::default();
        let Articulation { stroke, stop, .. } = start.articulation;
        // A finger that presses no fret has nothing to strike the string against.
        let taps = stroke == Stroke::Tap && stop == Stop::Press && start.fret > self.fingers.capo();
        if taps {
            // Fingers come down together: it is the right hand that goes over the strings.
            (start.wait, start.accent) = (0.0, 1.0);
        }
        let strength = start.force();
        let stroke = start.stroke();
        self.call_off(&mut self.moment(time, out));
        self.begin(time, &start, strength);
        let mut at = self.moment(time, out);
        at.tells(self.new_note(&start));
        self.fingers.press(start.manner.firm(), &mut at);
        let fret = self.comes_down_at(&start);
        let touched = stop == Stop::Harmonic;
        // What stops the string for a harmonic does so before that is struck, on one at rest, too.
        let ahead = if touched { self.fingers.lands_ahead(fret, &at) } else { None };
        let stilling =
            ((stills || ahead.is_some()) && !taps).then(|| self.stilling(stroke, start.fret, touched, ahead));
        start.wait = start.wait.max(stilling.map_or(0.0, |stilling| stilling.lead));
        let since = time + self.samples(start.wait);
        self.note = self.note.map(|note| Note { since, ..note });
        let gone = stilling.map_or(start.wait + STILLED_AT_LEAST, |stilling| stilling.stays(start.wait)[1]);
        self.bend.begin_struck(time, if silent { Some(0.0) } else { damped.then_some(gone) });
        self.parting = if taps { TAPPING } else { RESTING };
        if taps {
            self.begin_tap(fret, strength, &mut at);
        } else {
            self.begin_stroke(&start, fret, strength, stilling, &mut at);
        }
        self.follow(time, &start.manner);
    }

    /// The fret at which what stops the string for a note comes down: where wheel and tuning have it slide.
    fn comes_down_at(&mut self, start: &Start) -> usize {
        let stop = start.articulation.stop;
        let asked = start.wheel + start.manner.tuning;
        match stop {
            Stop::Press | Stop::Bar | Stop::Harmonic => {
                let bar = self.fingers.lays_bar(stop);
                self.bend.begin_slid(start.fret, asked, bar, &mut self.fingers)
            }
            Stop::Mute => start.fret,
        }
    }

    /// A finger comes down on the fret, how hard, 0 to 1.
    fn begin_tap(&mut self, fret: usize, strength: f64, at: &mut Moment<impl GestureSink>) {
        let rising = self.tap_when_up(fret, strength, Technique::Tap, at);
        self.tremble_after(rising, at);
    }

    /// The left hand stops the string at a fret, and the right hand strikes it, how hard, 0 to 1, if need be after it has stilled it.
    fn begin_stroke(
        &mut self,
        start: &Start,
        fret: usize,
        strength: f64,
        stilling: Option<Stilling>,
        at: &mut Moment<impl GestureSink>,
    ) {
        let stop = start.articulation.stop;
        let haste = start.haste();
        let stilled = stilling.map(|stilling| stilling.stays(start.wait));
        let ahead = stilling.is_some_and(|stilling| stilling.ahead);
        let coming = Coming { strength: strength * haste, haste, stilled, ahead };
        // The little by which a string comes up to a lower fret is not heard under the hand that stills it; more is.
        let by_little = fret > self.fingers.capo();
        // A finger that still touches the string takes up what a light one lets through.
        let hinders = stop == Stop::Harmonic && !self.fingers.palm_rests();
        let leaves = match stilling {
            Some(stilling) if (by_little || hinders) && stilling.comes_at_once(start.wait) => QUICK_LIFT,
            // Under a palm a string that is let up would be louder than the stroke.
            _ if self.fingers.palm_rests() => self.fingers.letting_go(0.0),
            _ => self.fingers.letting_go(coming.strength),
        };
        let waits = self.fingers.stop(fret, stop, coming, leaves, at);
        self.fingers.count_from(start.fret);
        self.bend.tell_change(&self.fingers, at);
        self.touch_node(start.wait, at);
        if let Some(stilling) = stilling {
            self.still_before(start.wait, stilling, at);
        }
        let towards_antinode = self.towards_antinode();
        let Some(note) = &mut self.note else { return };
        if let Some([_, gone]) = stilled.filter(|_| waits) {
            note.met = at.after(gone);
        }
        note.struck.beside += towards_antinode;
        let struck = note.struck;
        if start.wait > 0.0 {
            self.deeds.plan(at.after(start.wait + start.deviation.delay), Deed::Strike(struck));
        } else {
            self.strike(struck, start.deviation.delay, at);
        }
        self.tremble_after(start.wait, at);
    }

    /// A tremolo goes on with the note if it has one: a stroke follows upon its first sound, so many seconds from now.
    fn tremble_after(&mut self, wait: f64, at: &Moment<impl GestureSink>) {
        if let Some(note) = self.note.filter(|_| self.tremolo > 0.0) {
            let lead = self.stilling(note.struck.stroke, note.fret, false, None).lead;
            self.deeds.plan(at.after(wait + 1.0 / self.tremolo - lead), Deed::Tremolo);
        }
    }

    /// Writes down that a note begins. Gives back how many strokes a second a tremolo had so far.
    pub(super) fn begin(&mut self, time: u64, start: &Start, strength: f64) -> f64 {
        let Articulation { slide, slide_time, stop, tremolo, palm, .. } = start.articulation;
        let moved = start.manner.place;
        let struck =
            Struck { stroke: start.stroke(), strength, beside: start.deviation.place + moved, moved };
        self.note = Some(Note {
            channel: start.channel,
            key: start.key,
            velocity: start.velocity,
            began: time,
            since: time + self.samples(start.wait),
            met: time,
            presses: start.presses,
            caught: start.caught,
            fret: start.fret,
            goes_late: start.deviation.late[1],
            struck,
            manner: start.manner,
            palm,
            bar: stop == Stop::Bar,
            partial: (stop == Stop::Harmonic).then_some(start.order),
            muted: stop == Stop::Mute,
            slide: (slide || stop == Stop::Bar).then_some(slide_time),
            bent_short: false,
        });
        self.bend.begin(start.channel);
        self.fingers.expect_beside(0.0);
        self.fingers.expect_palm(palm);
        self.plucked_at = Some(time);
        self.unheard = true;
        self.touched = None;
        self.set_tremolo(tremolo)
    }

    /// Bends the string as its new note has it.
    pub(super) fn follow(&mut self, time: u64, manner: &Manner) {
        self.bend.tune(time, manner.tuning);
        self.bend.set_vibrato(time, manner.vibrato);
    }
}
