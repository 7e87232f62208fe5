//! What keeps a note sounding, and lets it end: its key, the pedals, and the messages that stop everything.

use super::StringPlayer;
use crate::performance::GestureSink;
use crate::performance::technique::SHORTEST_NOTE;

impl StringPlayer {
    /// Lets go of a key, if it is this string's. Under the pedal the note goes on.
    pub(crate) fn release(
        &mut self,
        time: u64,
        channel: u8,
        key: u8,
        pedal: bool,
        out: &mut impl GestureSink,
    ) -> bool {
        let near = self.samples(SHORTEST_NOTE);
        let Some(note) =
            self.note.as_mut().filter(|note| note.key_down && (note.channel, note.key) == (channel, key))
        else {
            return self.release_under(channel, key);
        };
        if note.pressed_again.take().is_some_and(|pressed| time - pressed <= near) {
            return true;
        }
        note.key_down = false;
        if !pedal && !note.caught && !self.go_back(time, out) {
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

    /// Lets go of whatever key of a channel holds this string.
    pub(crate) fn release_channel(&mut self, time: u64, channel: u8, pedal: bool) {
        self.under = self.under.map(|note| note.filter(|note| note.channel != channel));
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
        let touched = self.touched && channel.is_none();
        if touched || self.note.is_some_and(|note| channel.is_none_or(|channel| note.channel == channel)) {
            self.end(time);
        }
    }
}
