//! Notes that have just begun. Hands play the notes of a chord some milliseconds apart, and nobody knows after the first of them
//! what is to come: so those that began a moment ago, and whose keys are down, are placed anew with the next. They stay where they
//! are unless another needs their string; then they are struck once more on one of their own. None is lost to it.

use super::{Manner, Stroke, Unplaced, Use};
use crate::performance::Performance;
use crate::performance::hand::LARGEST_CHORD;
use crate::performance::technique::{LONGEST_CHORD, TOGETHER};

impl Performance {
    /// The sample so many seconds before now.
    fn before(&self, seconds: f64) -> u64 {
        self.now.saturating_sub((seconds * self.sample_rate).round() as u64)
    }

    /// The note of a chord that a string has begun at some sample or later, as it is now; `None` if there is none, or it is to begin
    /// again.
    fn begun_since(&self, string: usize, since: u64) -> Option<Unplaced> {
        // Where each string has a channel there is nothing to choose.
        if self.is_by_strings() {
            return None;
        }
        let begun = self.begun[string]?;
        let note = self.strings[string].begun_in(since..self.now)?;
        let (channel, key) = (note.channel, note.key);
        if !begun.is(channel, key) || self.chord.iter().any(|other| other.is(channel, key)) {
            return None;
        }
        let (tuning, pressure, vibrato) = (note.tuning, note.pressure, note.vibrato);
        let manner = Manner { tuning, pressure, vibrato, ..begun.manner };
        Some(Unplaced { presses: note.presses, manner, on: Some(string), ..begun })
    }

    /// The same of a moment ago.
    fn just_begun(&self, string: usize) -> Option<Unplaced> {
        self.begun_since(string, self.before(TOGETHER))
    }

    /// Notes begin now: with those before them, if they come in time.
    pub(super) fn count_chord(&mut self) {
        if self.chord_went_on < self.before(TOGETHER) {
            self.chord_began = self.now;
        }
        self.chord_went_on = self.now;
    }

    /// Whether a note that begins now is of a chord some of whose notes have just begun.
    pub(super) fn follows_just_begun(&self) -> bool {
        (0..self.strings.len()).any(|string| self.just_begun(string).is_some())
    }

    /// Notes that have just begun are placed with the chord, and so are those before them that each came in time for the next, as
    /// those of a strum do.
    pub(super) fn join_just_begun(&mut self) {
        if self.chord_went_on < self.before(TOGETHER) {
            return;
        }
        let since = self.chord_began.max(self.before(LONGEST_CHORD));
        for string in 0..self.strings.len() {
            let begun = self.begun_since(string, since);
            if let Some(note) = begun.filter(|_| self.chord.len() < LARGEST_CHORD) {
                self.chord.push(note);
            }
        }
    }

    /// Whether one of them finds no string any more.
    pub(super) fn displaces_just_begun(&self) -> bool {
        let placed = self.chord.iter().zip(&self.placements);
        placed.filter(|(note, _)| note.on.is_some()).any(|(_, placement)| placement.is_none())
    }

    /// They are left where they are, and nobody takes the strings of the last of them who is not bound to that very one.
    pub(super) fn leave_just_begun(&mut self) {
        self.chord.retain(|note| note.on.is_none());
        for string in 0..self.strings.len() {
            let bound = self.chord.iter().any(|note| note.wanted.only == Some(string));
            if !bound && self.just_begun(string).is_some() {
                self.uses[string] = Use::Untouchable;
            } else {
                self.uses[string] = self.strings[string].usage(self.now);
            }
        }
    }

    /// Those that are to be played on another string leave theirs; if they have been heard there, that is counted.
    pub(super) fn make_room(&mut self) {
        for (note, placement) in self.chord.iter().zip(&self.placements) {
            let to = placement.map(|placement| placement.string);
            if let Some(from) = note.on.filter(|_| note.on != to) {
                let heard = !self.strings[from].give_up_stroke();
                self.compromises.moved_strings += u64::from(heard);
            }
        }
    }

    /// Whether a stroke back and forth that begins now goes back: as that of those that have just begun, which it is part of.
    pub(super) fn goes_back(&self) -> bool {
        self.upward != self.goes_on()
    }

    /// Whether the chord goes on with a stroke back and forth that has just begun.
    pub(super) fn goes_on(&self) -> bool {
        self.chord.iter().any(|note| note.on.is_some() && note.articulation.stroke == Stroke::Alternate)
    }
}
