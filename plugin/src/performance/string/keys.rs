//! What keeps a note sounding, and lets it end: its key, the pedals, and the messages that stop everything.

use std::ops::Range;

use super::{Ending, Note, StringPlayer, UNDER};
use crate::performance::technique::SHORTEST_NOTE;
use crate::performance::{Annotation, GestureSink};

impl StringPlayer {
    /// Lets go of a key, if it is this string's: one note-off for each of its presses, as MIDI has it. A file whose notes of
    /// one key overlap would lose every second one otherwise. Under the pedal the note goes on.
    pub(crate) fn release(
        &mut self,
        time: u64,
        channel: u8,
        key: u8,
        pedal: bool,
        out: &mut impl GestureSink,
    ) -> bool {
        let Some(note) = self.note.as_mut().filter(|note| note.key_down() && note.is(channel, key)) else {
            return self.release_under(channel, key);
        };
        note.presses -= 1;
        let (up, kept) = (!note.key_down(), pedal || note.caught);
        if up {
            self.moment(time, out).tells(Annotation::Released);
        }
        if up && !kept {
            self.go_back_or_end(time, out);
        }
        true
    }

    /// Ends the note of a key, whatever keeps it: however often the key went down, and whatever the pedals say. `false` if it is
    /// not this string's.
    pub(crate) fn cut(&mut self, time: u64, channel: u8, key: u8, out: &mut impl GestureSink) -> bool {
        let mut found = false;
        while self.take_under(channel, key).is_some() {
            found = true;
        }
        let Some(note) = self.note.as_mut().filter(|note| note.is(channel, key)) else { return found };
        let down = note.key_down();
        (note.presses, note.caught) = (0, false);
        if down {
            self.moment(time, out).tells(Annotation::Released);
        }
        self.go_back_or_end(time, out);
        true
    }

    /// Whether a key is down of its note, or of one under that.
    pub(crate) fn has_key_down(&self) -> bool {
        self.note.iter().chain(self.under.iter().flatten()).any(Note::key_down)
    }

    /// Its note, if the key of that is down and it began at some sample or later.
    pub(crate) fn note_since(&self, since: u64) -> Option<Note> {
        self.note.filter(|note| note.key_down() && note.since >= since)
    }

    /// The note that began here in such a time, if its key is down and no pedal has caught it.
    pub(crate) fn begun_in(&self, time: Range<u64>) -> Option<Note> {
        let begun = self.plucked_at.is_some_and(|at| time.contains(&at));
        self.note.filter(|note| begun && note.key_down() && !note.caught)
    }

    /// A sostenuto pedal of such channels goes down: it catches notes whose keys are down, also under the one that sounds. What
    /// another one has caught, as in MPE, stays caught.
    pub(crate) fn catch(&mut self, is_meant: impl Fn(u8) -> bool) {
        self.notes().filter(|note| is_meant(note.channel)).for_each(|note| note.caught |= note.key_down());
    }

    /// It goes up: a note that only it kept ends.
    pub(crate) fn let_fall(&mut self, time: u64, channel: u8, pedal: bool, out: &mut impl GestureSink) {
        if let Some(note) = self.note.as_mut().filter(|note| note.channel == channel && note.caught) {
            note.caught = false;
            if !note.key_down() && !pedal {
                self.go_back_or_end(time, out);
            }
        }
    }

    /// It goes up on such channels for the keys under the one that sounds: they come back held by nothing but themselves, or not.
    pub(crate) fn let_fall_under(&mut self, fallen: impl Fn(u8) -> bool) {
        let fallen = |note: &Note| fallen(note.channel);
        self.under.iter_mut().flatten().filter(|note| fallen(note)).for_each(|note| note.caught = false);
        self.forget_under(|note| !note.key_down() && !note.caught);
    }

    /// Lets go of whatever key of a channel holds this string.
    pub(crate) fn release_channel(
        &mut self,
        time: u64,
        channel: u8,
        pedal: bool,
        out: &mut impl GestureSink,
    ) {
        if let Some(note) = self.note.as_mut().filter(|note| note.channel == channel) {
            let (down, kept) = (note.key_down(), pedal || note.caught);
            note.presses = 0;
            if down {
                self.moment(time, out).tells(Annotation::Released);
            }
            if !kept {
                self.go_back_or_end(time, out);
            }
        }
    }

    /// Such notes under the one that sounds are no more.
    pub(crate) fn forget_under(&mut self, is_meant: impl Fn(&Note) -> bool) {
        let kept = self.under.into_iter().flatten().filter(|note| !is_meant(note));
        let mut under = [None; UNDER];
        under.iter_mut().zip(kept).for_each(|(place, note)| *place = Some(note));
        self.under = under;
    }

    /// The pedal of a channel goes up: a note it kept ends.
    pub(crate) fn pedal_up(&mut self, time: u64, channel: u8, out: &mut impl GestureSink) {
        if self.note.is_some_and(|note| note.channel == channel && !note.key_down() && !note.caught) {
            self.go_back_or_end(time, out);
        }
    }

    /// Nothing keeps the note any longer: one whose key is still down under it comes back, or the string falls silent.
    fn go_back_or_end(&mut self, time: u64, out: &mut impl GestureSink) {
        if !self.go_back(time, out) {
            self.end(time);
        }
    }

    /// Ends the string's note, whoever holds it; `None` means any channel's.
    pub(crate) fn silence(&mut self, time: u64, channel: Option<u8>) {
        // (A tremolo that sounds awaits its next stroke, too.)
        let awaited = self.unheard && self.deeds.await_sound();
        let touched = self.touched.is_some() && channel.is_none();
        if touched || self.note.is_some_and(|note| channel.is_none_or(|channel| note.channel == channel)) {
            // A stroke that is still on its way does not come, and nobody waits to hear it.
            self.deeds.forget_strokes();
            self.called_off += u64::from(awaited);
            let heard = time.saturating_sub(self.samples(SHORTEST_NOTE));
            if let Some(note) = self.note.as_mut().filter(|note| note.since > time) {
                (note.since, note.met) = (heard, heard);
            }
            self.end(time);
        } else if let Some((damped, Ending::Damp)) = self.ending
            && damped > time
            && self.touched.is_none()
            && (channel.is_none() || channel == self.bend.channel())
        {
            // So it is where the key has gone up before.
            self.called_off += u64::from(awaited);
            self.deeds.forget_strokes();
            self.ending = Some((time, Ending::Damp));
        }
    }
}
