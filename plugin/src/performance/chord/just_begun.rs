//! Notes that have just begun. Hands play the notes of a chord some milliseconds apart, and nobody knows after the first of them
//! what is to come: so those that began a moment ago, and whose keys are down, are placed anew with the next. They stay where they
//! are unless another needs their string; then they are struck once more on one of their own. None is lost to it.

use super::{Articulation, Placement, Stroke, Unplaced, Use, Wanted};
use crate::performance::hand::LARGEST_CHORD;
use crate::performance::technique::{LONGEST_CHORD, TOGETHER};
use crate::performance::{Channels, Performance};

/// The last chord, as it has begun.
#[derive(Debug)]
pub(in crate::performance) struct JustBegun {
    /// Its note that each string began last.
    notes: Vec<Option<Unplaced>>,
    /// When it began, and when it went on, samples.
    began: u64,
    went_on: u64,
    /// Whether what is being placed goes on with its stroke back and forth.
    goes_on: bool,
}

impl JustBegun {
    /// None has begun on so many strings.
    pub fn new(strings: usize) -> Self {
        Self { notes: vec![None; strings], began: 0, went_on: 0, goes_on: false }
    }

    /// None has begun.
    pub fn reset(&mut self) {
        self.notes.fill(None);
        (self.began, self.went_on, self.goes_on) = (0, 0, false);
    }

    /// As another has begun: on its strings, if these go on, or on strings that are no more.
    pub fn take_over(&mut self, old: &Self, strings_go_on: bool) {
        self.reset();
        (self.began, self.went_on) = (old.began, old.went_on);
        if strings_go_on {
            self.notes.iter_mut().zip(&old.notes).for_each(|(note, old)| *note = *old);
        }
    }

    /// A note of it begins on a string.
    pub(super) fn note(&mut self, string: usize, note: Unplaced) {
        self.notes[string] = Some(note);
    }
}

impl Performance {
    /// The sample so many seconds before now.
    fn before(&self, seconds: f64) -> u64 {
        self.now.saturating_sub((seconds * self.sample_rate).round() as u64)
    }

    /// The note of a chord that a string has begun at some sample or later, as it is now, and that may be placed anew; `None` if there
    /// is none, or it is to begin again.
    fn begun_since(&self, string: usize, since: u64) -> Option<Unplaced> {
        // Where each string has a channel there is nothing to choose.
        if self.is_by_strings() { None } else { self.sounds_since(string, since) }
    }

    /// The same whether it may be placed anew or not.
    fn sounds_since(&self, string: usize, since: u64) -> Option<Unplaced> {
        let begun = self.just_begun.notes[string]?;
        let note = self.strings[string].begun_in(since..self.now)?;
        let (channel, key) = (note.channel, note.key);
        if !begun.is(channel, key) || self.chord.iter().any(|other| other.is(channel, key)) {
            return None;
        }
        let manner = begun.manner.by_now(&note.manner);
        let Articulation { palm, tremolo, .. } = self.channels[usize::from(channel)].articulation;
        let articulation = Articulation { palm, tremolo, ..begun.articulation };
        let on = Some(Placement { string, fret: note.fret });
        let (presses, caught) = (note.presses, note.caught);
        Some(Unplaced { presses, caught, let_go: false, manner, articulation, on, ..begun })
    }

    /// The same of a moment ago.
    fn begun_a_moment_ago(&self, string: usize) -> Option<Unplaced> {
        self.begun_since(string, self.before(TOGETHER))
    }

    /// The string on which a note begins at this very sample whose key has gone up before.
    pub(super) fn begins_let_go(&self, note: &Unplaced) -> Option<usize> {
        let Wanted { channel, key, .. } = note.wanted;
        let is_it = |begun: Unplaced| begun.let_go && begun.is(channel, key) && begun.asked == note.asked;
        (0..self.strings.len()).find(|&string| {
            let begins = self.strings[string].usage(self.now) == Use::Untouchable;
            begins
                && self.strings[string].is_of(channel, key)
                && self.just_begun.notes[string].is_some_and(is_it)
        })
    }

    /// Notes begin now: with those before them, if they come in time.
    pub(super) fn count_chord(&mut self) {
        if self.just_begun.went_on < self.before(TOGETHER) {
            self.just_begun.began = self.now;
        }
        self.just_begun.went_on = self.now;
    }

    /// Whether a note that begins now is of a chord some of whose notes, of such channels, have just begun.
    pub(super) fn follows_just_begun(&self, channels: Channels) -> bool {
        let mut begun = (0..self.strings.len()).filter_map(|string| self.begun_a_moment_ago(string));
        begun.any(|note| channels.has(note.wanted.channel))
    }

    /// Notes that have just begun are placed with the chord, and so are those before them that each came in time for the next, as
    /// those of a strum do. The right hand goes on with its stroke over them wherever they are.
    pub(super) fn join_just_begun(&mut self) {
        if self.just_begun.went_on < self.before(TOGETHER) {
            return;
        }
        let since = self.just_begun.began.max(self.before(LONGEST_CHORD));
        for string in 0..self.strings.len() {
            let begun = self.sounds_since(string, since);
            if let Some(note) = begun.filter(|_| self.chord.len() < LARGEST_CHORD) {
                self.just_begun.goes_on |= is_stroke(&note);
                if !self.is_by_strings() {
                    self.chord.push(note);
                }
            }
        }
    }

    /// They stay where they are unless another takes their string, and whatever hands have been told since.
    pub(super) fn stay_just_begun(&mut self) {
        let left = |performance: &Self| {
            performance.chord.iter().enumerate().find_map(|(index, note)| {
                let is_taken = |own: &Placement| {
                    performance.placements.iter().flatten().any(|other| other.string == own.string)
                };
                Some((index, note.on.filter(|own| !is_taken(own))?))
            })
        };
        while let Some((index, own)) = left(self) {
            self.placements[index] = Some(own);
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
            if !bound && self.begun_a_moment_ago(string).is_some() {
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
            if let Some(from) = note.on.map(|from| from.string).filter(|&from| to != Some(from)) {
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
    fn goes_on(&self) -> bool {
        self.just_begun.goes_on
    }

    /// The chord has been placed: the next stroke back and forth goes the other way, if it was one.
    pub(super) fn turn_stroke(&mut self) {
        let goes_on = std::mem::take(&mut self.just_begun.goes_on);
        self.upward ^= !goes_on && self.chord.iter().any(is_stroke);
    }

    /// What comes late goes the way of the chord that it was one of.
    pub(super) fn go_on_late(&mut self) {
        self.just_begun.goes_on |= self.chord.iter().any(|note| note.waited);
    }
}

/// Whether a note is struck forth and back in turn with others. One that has waited is not: its chord has had its stroke.
fn is_stroke(note: &Unplaced) -> bool {
    note.articulation.stroke == Stroke::Alternate && !note.waited
}
