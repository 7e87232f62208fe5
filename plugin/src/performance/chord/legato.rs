//! **Legato**: a note that begins alone while the latest one of its channel is held is played on that note's string, if it is
//! there and near enough; so is one that begins anew over a held one, as a pedal has kept it. It is alone that begins alone of its
//! channel; in MPE, where each note has one, alone of all of its channels. So where each string has a channel, several are
//! hammered, pulled or slid at once as one is.

use super::{Articulation, HAMMER_REACH, Placement, SLIDE_REACH, Stop, Unplaced, Use};
use crate::performance::string::StringPlayer;
use crate::performance::{GestureSink, InputMode, Performance};

impl Performance {
    /// Whether each string has a channel.
    pub(in crate::performance) fn is_by_strings(&self) -> bool {
        matches!(self.input, InputMode::Strings { .. })
    }

    /// Notes of the chord that take over from held ones do so, and are no longer of the chord.
    pub(super) fn take_over_notes(&mut self, out: &mut impl GestureSink) {
        let mut index = 0;
        while index < self.chord.len() {
            if self.begins_alone(index) && self.take_over_note(index, out) {
                self.chord.remove(index);
            } else {
                index += 1;
            }
        }
    }

    /// Whether no other note of its channel begins with one of the chord.
    fn begins_alone(&self, index: usize) -> bool {
        let melody = self.of_one_hand(self.chord[index].wanted.channel);
        let beside = |other: &&Unplaced| melody.has(other.wanted.channel);
        self.chord.iter().filter(beside).count() == 1
    }

    /// A note that begins alone takes over from the latest one of its channel, if that is held, notes are
    /// to be connected, and its string gives the new one within reach.
    fn take_over_note(&mut self, index: usize, out: &mut impl GestureSink) -> bool {
        let wanted = self.chord[index].wanted;
        let articulation = self.articulation(index);
        let Articulation { slide, stop, .. } = articulation;
        let connected = articulation.connects() || self.touching.legato;
        // One that comes late, when its key is up, would stay on the held one's string for no longer than it takes to be heard.
        if !connected || self.gives_way() || stop == Stop::Harmonic || stop == Stop::Mute {
            return false;
        }
        let melody = self.of_one_hand(wanted.channel);
        // What has been placed at this very sample begins with it.
        let begun = |string: &StringPlayer| {
            string.channel().is_some_and(|own| melody.has(own)) && string.usage(self.now) == Use::Untouchable
        };
        if self.strings.iter().any(begun) || self.follows_just_begun(melody) {
            return false;
        }
        let held = self.strings.iter().enumerate().filter_map(|(index, string)| {
            let note = string.held().filter(|note| melody.has(note.channel))?;
            Some((index, note))
        });
        let Some((string, before)) = held.max_by_key(|(_, note)| (note.began, note.since)) else {
            return false;
        };
        let from = before.fret;
        let slides = slide || stop == Stop::Bar;
        let there = |fret: &usize| {
            let open = from.min(*fret) <= self.hand.capo();
            let reach = if slides || open { SLIDE_REACH } else { HAMMER_REACH };
            !before.touched() && fret.abs_diff(from) <= reach
        };
        let Some(fret) = self.hand.fret(&wanted, string).filter(there) else {
            self.compromises.not_slid += u64::from(slides);
            return false;
        };
        if fret == from && !self.strings[string].trills(wanted.channel, wanted.key) {
            return false;
        }
        let start = self.start(index, Placement { string, fret }, None);
        let (time, bend) = (self.now, self.bend(wanted.channel));
        self.hand.follow(fret);
        self.strings[string].connect(time, start, out);
        self.strings[string].bend(time, wanted.channel, bend);
        // Others may follow upon it that are of one chord with it.
        self.count_chord();
        self.just_begun.note(string, self.chord[index]);
        true
    }
}
