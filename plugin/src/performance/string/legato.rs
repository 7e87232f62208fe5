//! One note after another on a string that goes on sounding.

use super::{Note, Start, StringPlayer};
use crate::performance::{Annotation, GestureSink, Moment, Technique};

impl StringPlayer {
    /// The note that sounds while its key is down, or while a pedal keeps it over one whose key is.
    pub(crate) fn held(&self) -> Option<Note> {
        self.note.filter(|note| (note.key_down() || self.lies_over_held()) && self.ending.is_none())
    }

    /// Whether the key of a note is down under the one that sounds.
    fn lies_over_held(&self) -> bool {
        self.under.iter().flatten().any(Note::key_down)
    }

    /// Whether the note that sounds is one of a trill, which a key begins anew: its own, or any if only a pedal keeps it.
    pub(crate) fn trills(&self, channel: u8, key: u8) -> bool {
        let own = self.note.is_some_and(|note| !note.key_down() || note.is(channel, key));
        own && self.lies_over_held()
    }

    /// A note takes over from the one that sounds, whose key stays down under it: by a hammer, a pull or a
    /// slide.
    pub(crate) fn connect(&mut self, time: u64, mut start: Start, out: &mut impl GestureSink) {
        // The stroke that was to begin the note before is yet to reach the string, and finds this one there.
        let in_time = self.strike_in_time(&mut self.moment(time, out));
        self.overtaken += u64::from(!in_time && self.note.is_some_and(|note| note.since > time));
        self.still_no_more(&mut self.moment(time, out));
        let strength = start.force();
        let again = self.note.is_some_and(|note| note.fret == start.fret);
        self.take_presses(&mut start);
        let before = self.note;
        if let Some(before) = before.filter(Note::key_down) {
            // Of too many the first is forgotten.
            if self.under.iter().all(Option::is_some) {
                self.under.rotate_left(1);
                self.under[self.under.len() - 1] = None;
            }
            if let Some(free) = self.under.iter_mut().find(|under| under.is_none()) {
                *free = Some(before);
            }
        }
        // A capo that comes with the new note lies over what is below it for good.
        let capo = self.fingers.capo();
        self.forget_under(|note| note.fret < capo);
        let tremolo = self.begin(time, &start, strength);
        // A tremolo goes on as it was under way.
        if let (Some(note), Some(before)) = (&mut self.note, before.filter(|_| tremolo > 0.0)) {
            note.struck = note.struck.in_turn_with(before.struck);
        }
        self.deeds.forget_touches();
        let (slide, bar) = self.note.map_or((None, false), |note| (note.slide, note.bar));
        let fret =
            self.bend.begin_slid(start.fret, start.wheel + start.manner.tuning, bar, &mut self.fingers);
        self.moment(time, out).tells(self.new_note(&start));
        let mut at = self.late(time, start.deviation.late[0], out);
        self.fingers.press(start.manner.firm(), &mut at);
        if again {
            self.begin_again(fret, strength, &mut at);
        } else {
            let (technique, gesture) = self.fingers.change(fret, slide, bar, strength, &mut at);
            self.fingers.count_from(start.fret);
            self.bend.tell_change(&self.fingers, &mut at);
            self.tells_sound(0.0, self.fingers.excitation(technique, gesture, None), &mut at);
        }
        self.fingers.set_palm(start.articulation.palm, &mut at);
        self.begin_tremolo(tremolo, &at);
        self.follow(time, &start.manner);
    }

    /// What a finger does that is so many seconds late. Its note is heard no sooner.
    fn late<'a, S: GestureSink>(&mut self, time: u64, seconds: f64, out: &'a mut S) -> Moment<'a, S> {
        self.late = self.late.max(time + self.samples(seconds));
        if let Some(note) = &mut self.note {
            note.since = self.late;
        }
        self.moment(time, out)
    }

    /// The note of a fret that is stopped already begins anew: its finger comes down once more, how hard, 0 to 1, or the right hand
    /// strikes where none has anything to strike the string against, or moves along it instead.
    fn begin_again(&mut self, fret: usize, strength: f64, at: &mut Moment<impl GestureSink>) {
        let Some(note) = self.note else { return };
        if note.bar || note.slide.is_some() || fret <= self.fingers.capo() {
            self.fingers.count_from(note.fret);
            self.bend.tell_change(&self.fingers, at);
            self.strike(note.struck, 0.0, at);
        } else {
            self.tap_when_up(fret, strength, Technique::HammerOn, at);
        }
    }

    /// Channel of the note that has come back since this was last asked, if one has: that channel's wheel is for it.
    pub(crate) fn take_gone_back(&mut self) -> Option<u8> {
        let note = self.note?;
        std::mem::take(&mut self.gone_back).then_some(note.channel)
    }

    /// Lets go of a key under the one that sounds; `false` if it is not there.
    pub(super) fn release_under(&mut self, channel: u8, key: u8) -> bool {
        let down = |note: &&mut Note| note.key_down() && note.is(channel, key);
        let Some(note) = self.under.iter_mut().flatten().find(down) else { return false };
        note.presses -= 1;
        if !note.key_down() && !note.caught {
            self.take_under(channel, key);
        }
        true
    }

    /// What the string remembers of a key that is struck again is of the new note: how often it went down and not up again, and
    /// whether the sostenuto pedal holds it.
    pub(super) fn take_presses(&mut self, start: &mut Start) {
        let (channel, key) = (start.channel, start.key);
        let mut before = self.note.take_if(|note| note.is(channel, key));
        while let Some(note) = before.or_else(|| self.take_under(channel, key)) {
            start.presses = start.presses.saturating_add(note.presses);
            start.caught |= note.caught;
            before = None;
        }
    }

    /// Takes out a key under the one that sounds.
    pub(super) fn take_under(&mut self, channel: u8, key: u8) -> Option<Note> {
        let same = |note: &Option<Note>| note.is_some_and(|note| note.is(channel, key));
        let found = self.under.iter().position(same)?;
        let taken = self.under[found].take();
        self.under[found..].rotate_left(1);
        taken
    }

    /// Goes back to the latest note whose key is still down, or caught by a pedal; `false` if there is none.
    pub(super) fn go_back(&mut self, time: u64, out: &mut impl GestureSink) -> bool {
        let Some(latest) = self.under.iter().rposition(Option::is_some) else { return false };
        let (Some(back), Some(from)) = (self.under[latest].take(), self.note) else { return false };
        self.note =
            Some(Note { began: time, since: time, struck: back.struck.in_turn_with(from.struck), ..back });
        // A capo that is to come over it waits for the next note that begins.
        let capo = self.fingers.capo();
        if back.fret < capo {
            self.fingers.keep_capo();
        }
        let asked = self.bend.asked_by(back.channel, back.manner.tuning);
        self.bend.begin(back.channel);
        self.fingers.expect_palm(back.palm);
        let fret = self.bend.begin_slid(back.fret, asked, from.bar, &mut self.fingers);
        self.deeds.forget_touches();
        let mut at = self.moment(time, out);
        at.tells(self.returning_note(&back, time));
        if !back.key_down() {
            at.tells(Annotation::Released);
        }
        let mut at = self.late(time, from.goes_late, out);
        let (technique, gesture) =
            self.fingers.change(fret, from.slide, from.bar, from.struck.strength, &mut at);
        self.fingers.count_from(back.fret);
        self.fingers.set_capo(capo);
        self.bend.tell_change(&self.fingers, &mut at);
        self.tells_sound(0.0, self.fingers.excitation(technique, gesture, None), &mut at);
        self.fingers.press(back.manner.firm(), &mut at);
        self.fingers.set_palm(back.palm, &mut at);
        self.follow(time, &back.manner);
        self.gone_back = true;
        true
    }
}
