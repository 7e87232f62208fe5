//! Which string and fret a note goes to.
//!
//! The left hand covers [`SPAN`] frets from the one under its first finger. Notes that begin at
//! the same instant are placed together, each on a string of its own, where the whole costs least:
//! moving the hand and reaching out of it cost by the fret, also where a finger holds a note whose key is down. An open
//! string costs nothing to a hand low on the neck and a little to one far up (its sound stands out, but for a bass far below
//! all else), and lower frets are slightly preferred. A key that still sounds is struck again where it is, and a note that has just begun stays there unless
//! another needs its string. A hand that has been told where on the neck
//! to play moves from there for each of them, and not from where it went for the one before.
//!
//! **Who gives way** when no free string can give the note: a note kept only by the pedal, or else
//! one whose key is down; among several the one nearest to the hand, the older first: each older note
//! on the other strings makes one half a fret farther. A note is never taken away at the very instant it
//! begins: of more simultaneous notes than can have a string each, the outer ones stay (the highest,
//! the lowest, the second highest, and so on, each unless it would need a string of those before)
//! and the rest find none.
//!
//! Everything is a function of the hand's place and the strings' use, so the same notes always
//! fall on the same strings.

mod cost;
mod range;
mod search;

use low_action_dsp::neck::Neck;

use cost::{AGAIN, LEAVE_OUT, MOVE, beyond};
pub(crate) use range::{Range, octaves};
use search::Search;

/// Frets under the hand without reaching: one for each finger.
const SPAN: usize = 4;
/// Frets that a capo leaves at least: on strings a fourth apart every note has a place then, in some octave.
const OVER_CAPO: usize = 5;
/// The highest fret that any instrument has a capo on.
pub const HIGHEST_CAPO: usize = highest_capo(Neck::MOST_FRETS);
/// The highest fret that one with so many has a capo on, 0 for none.
pub const fn highest_capo(frets: usize) -> usize {
    frets.saturating_sub(OVER_CAPO)
}

/// Most notes considered at one instant, one for each key; of more, the last to arrive are left out.
pub(crate) const LARGEST_CHORD: usize = 128;

/// What a string is doing when notes begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Use {
    /// Nobody wants its note any more.
    Free,
    /// A note sounds that may give way.
    Taken {
        /// Its channel.
        channel: u8,
        /// Its key as sent.
        key: u8,
        /// When it is first heard, samples.
        since: u64,
        /// Whether its key is down (or only the pedal keeps it).
        key_down: bool,
        /// Its fret, 0 for the open string.
        fret: usize,
    },
    /// A note has just begun that looks for a string once more.
    Begun {
        /// Its channel.
        channel: u8,
        /// Its key as sent.
        key: u8,
    },
    /// A note began at this very instant.
    Untouchable,
}

/// A note looking for a string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wanted {
    /// Channel.
    pub channel: u8,
    /// Key as sent.
    pub key: u8,
    /// Pitch to sound, after any move by octaves, MIDI note number.
    pub pitch: f64,
    /// The one string it may be played on, if the player has no choice.
    pub only: Option<usize>,
    /// Whether it is to be a harmonic that sounds at this pitch.
    pub harmonic: bool,
}

impl Wanted {
    /// Whether it is another octave than the key's.
    pub(crate) fn is_moved(&self) -> bool {
        self.pitch != f64::from(self.key)
    }
}

/// Where a note is to be played.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Placement {
    /// String index.
    pub string: usize,
    /// Fret, 0 for the open string.
    pub fret: usize,
}

/// The left hand, with the scratch memory of its search.
#[derive(Debug)]
pub(crate) struct Hand {
    strings: Vec<Range>,
    highest_fret: usize,
    /// Fret of a capo, 0 for none: open strings sound from there.
    capo: usize,
    /// The fret that it was asked for.
    asked_capo: usize,
    /// Whether there can be one: none presses down what no finger reaches.
    takes_capo: bool,
    /// Fret under the first finger, 1 or more.
    position: usize,
    /// Fret that its first finger is to stay at, if anybody has said so.
    home: Option<u8>,
    /// Which of the wanted notes are placed, highest pitch first.
    order: Vec<usize>,
    /// Cost of each note (in `order`) on each string for one place of the hand.
    costs: Vec<f64>,
    /// Least cost of each note from here to the last: the bound that prunes the search.
    bounds: Vec<f64>,
    taken: Vec<bool>,
    /// Which notes are to be placed, and a string for each to show that it can be done.
    chosen: Vec<bool>,
    holders: Vec<Option<usize>>,
    path: Vec<Option<usize>>,
    best_path: Vec<Option<usize>>,
}

impl Hand {
    /// A hand at the first fret of an instrument.
    pub(crate) fn new(strings: Vec<Range>, takes_capo: bool) -> Self {
        let count = strings.len();
        Self {
            highest_fret: strings.iter().map(|range| range.frets).max().unwrap_or(0),
            strings,
            capo: 0,
            asked_capo: 0,
            takes_capo,
            position: 1,
            home: None,
            order: Vec::with_capacity(LARGEST_CHORD),
            costs: vec![0.0; count * count],
            bounds: vec![0.0; count + 1],
            taken: vec![false; count],
            chosen: vec![false; LARGEST_CHORD],
            holders: vec![None; count],
            path: vec![None; count],
            best_path: vec![None; count],
        }
    }

    /// Back to the first fret, with no capo there; where it has been told to play counts on.
    pub(crate) fn reset(&mut self) {
        (self.capo, self.asked_capo) = (0, 0);
        self.position = 1;
    }

    /// Back to the first fret, or the first behind the capo.
    pub(crate) fn go_back(&mut self) {
        self.position = 1;
        self.set_capo(self.asked_capo);
    }

    /// Plays about this fret from the next notes on, or wherever it has the least to move. No fret is too high: past the last one
    /// it stays there, and behind a capo beside it.
    pub(crate) fn set_home(&mut self, home: Option<u8>) {
        self.home = home;
    }

    /// The fret that it has been told to play about.
    pub(crate) fn home(&self) -> Option<u8> {
        self.home
    }

    /// Puts a capo on a fret, 0 for none, but no farther up than leaves [`OVER_CAPO`] frets; on strings that no finger presses down,
    /// nowhere.
    pub(crate) fn set_capo(&mut self, fret: usize) {
        self.asked_capo = fret;
        let highest = if self.takes_capo { highest_capo(self.highest_fret) } else { 0 };
        self.capo = fret.min(highest);
        self.position = self.position.max(self.capo + 1).min(self.highest_fret.max(1));
    }

    /// Fret of the capo, 0 for none.
    pub(crate) fn capo(&self) -> usize {
        self.capo
    }

    /// The fret that it was asked for, wherever it is on this instrument.
    pub(crate) fn asked_capo(&self) -> usize {
        self.asked_capo
    }

    /// Follows a finger that went to a fret without being told where.
    pub(crate) fn follow(&mut self, fret: usize) {
        if fret > self.capo {
            let nearest = self.position.min(fret).max((fret + 1).saturating_sub(SPAN));
            self.position = nearest.max(1);
        }
    }

    /// The fret under its first finger.
    pub(crate) fn position(&self) -> usize {
        self.position
    }

    /// Goes back to where it was.
    pub(crate) fn return_to(&mut self, position: usize) {
        self.position = position;
    }

    /// Frets between a fret and those under the hand.
    pub(crate) fn distance(&self, fret: usize) -> usize {
        if fret <= self.capo {
            return 0;
        }
        beyond(self.position, fret)
    }

    /// Stays where another hand is, on the neck of another model of the instrument.
    pub(crate) fn take_over(&mut self, old: &Self) {
        self.set_capo(old.asked_capo);
        self.position = old.position.min(self.highest_fret.max(1));
    }

    /// The fret that gives a note on a string, if it may be played there.
    pub(crate) fn fret(&self, note: &Wanted, string: usize) -> Option<usize> {
        if note.only.is_some_and(|only| only != string) {
            return None;
        }
        self.fret_at(string, note.pitch, note.harmonic)
    }

    fn fret_at(&self, string: usize, pitch: f64, harmonic: bool) -> Option<usize> {
        let range = self.strings.get(string)?;
        match harmonic {
            true => range.harmonic(pitch, self.capo).map(|(fret, _)| fret),
            false => range.fret(pitch).filter(|&fret| fret >= self.capo),
        }
    }

    /// Whether a string gives a pitch.
    pub(crate) fn reaches(&self, string: usize, pitch: f64, harmonic: bool) -> bool {
        self.fret_at(string, pitch, harmonic).is_some()
    }

    /// The partial that a harmonic of a pitch is on a string.
    pub(crate) fn order(&self, string: usize, pitch: f64) -> u32 {
        self.strings.get(string).and_then(|range| range.harmonic(pitch, self.capo)).map_or(2, |found| found.1)
    }

    /// The pitch at which a key is played: its own, or the nearest octave that a string (or the only one
    /// allowed) can give.
    pub(crate) fn playable_pitch(&self, key: u8, only: Option<usize>, harmonic: bool) -> Option<f64> {
        let strings = match only {
            Some(string) => string..string.checked_add(1)?,
            None => 0..self.strings.len(),
        };
        let playable =
            |pitch: f64| strings.clone().any(|string| self.fret_at(string, pitch, harmonic).is_some());
        octaves(f64::from(key)).find(|&pitch| playable(pitch))
    }

    /// Finds strings for notes that begin together and moves the hand there. `placements` receives
    /// one entry for each wanted note, `None` for those left out.
    pub(crate) fn place(&mut self, wanted: &[Wanted], uses: &[Use], placements: &mut [Option<Placement>]) {
        placements.fill(None);
        self.choose(wanted, uses);
        let mut best_cost = f64::INFINITY;
        let from = match self.home {
            Some(fret) => usize::from(fret).max(self.capo + 1).min(self.highest_fret.max(1)),
            None => self.position,
        };
        let mut best_position = from;
        // Nearest places first, so that among equals the hand stays where it is.
        for distance in 0..=self.highest_fret {
            if MOVE * distance as f64 + AGAIN * self.order.len() as f64 >= best_cost {
                break;
            }
            let below = from.checked_sub(distance).filter(|&place| place >= 1);
            let above = (distance > 0).then_some(from + distance);
            for position in [below, above].into_iter().flatten() {
                if position > self.highest_fret.max(1) {
                    continue;
                }
                self.tabulate(position, wanted, uses);
                let so_far = MOVE * distance as f64 + self.stretch(position, uses);
                let mut search = Search {
                    strings: self.strings.len(),
                    costs: &self.costs,
                    bounds: &self.bounds,
                    taken: &mut self.taken,
                    path: &mut self.path[..self.order.len()],
                    best_path: &mut self.best_path[..self.order.len()],
                    best_cost,
                    visits: 0,
                };
                search.descend(0, so_far);
                if search.best_cost < best_cost {
                    best_cost = search.best_cost;
                    best_position = position;
                }
            }
        }
        self.position = best_position;
        for (&note, string) in self.order.iter().zip(&self.best_path) {
            placements[note] = string
                .and_then(|string| self.fret(&wanted[note], string).map(|fret| Placement { string, fret }));
        }
    }

    /// Picks the notes to be placed, as many as can have a string each, and sorts them.
    fn choose(&mut self, wanted: &[Wanted], uses: &[Use]) {
        self.order.clear();
        self.order.extend(0..wanted.len().min(LARGEST_CHORD));
        // Ties in pitch keep the order of arrival (a stable sort would allocate).
        self.order.sort_unstable_by(|&a, &b| wanted[b].pitch.total_cmp(&wanted[a].pitch).then(a.cmp(&b)));
        self.holders.fill(None);
        self.chosen.fill(false);
        let count = self.order.len();
        for turn in 0..count {
            // From outside in: highest, lowest, second highest, …
            let place = if turn % 2 == 0 { turn / 2 } else { count - 1 - turn / 2 };
            let note = self.order[place];
            self.taken.fill(false);
            self.chosen[note] = self.find_string(note, wanted, uses);
        }
        let chosen = &self.chosen;
        self.order.retain(|&note| chosen[note]);
        self.best_path[..self.order.len()].fill(None);
    }

    /// Finds a note a string of its own, moving notes that have one to others if need be: the step of
    /// Kuhn's algorithm for matchings.
    fn find_string(&mut self, note: usize, wanted: &[Wanted], uses: &[Use]) -> bool {
        for string in 0..self.strings.len() {
            let possible = uses[string] != Use::Untouchable && self.fret(&wanted[note], string).is_some();
            if !possible || std::mem::replace(&mut self.taken[string], true) {
                continue;
            }
            if self.holders[string].is_none_or(|holder| self.find_string(holder, wanted, uses)) {
                self.holders[string] = Some(note);
                return true;
            }
        }
        false
    }
}

#[cfg(test)]
mod tests;
