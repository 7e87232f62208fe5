//! What it costs to play a note on a string with the hand at some place.

use super::{Hand, SPAN, Use, Wanted};

// Costs, in frets of hand movement. Only their order and rough size matter.
/// Moving the hand by a fret.
pub(super) const MOVE: f64 = 1.0;
/// Reaching a fret beyond the hand, for the first fret and for each further one.
const REACH: (f64, f64) = (1.2, 2.5);
/// Reaching a finger that holds a note, at most: all strings of a guitar together cost less than beginning a note again.
const STRETCH: f64 = 8.0;
/// Preferring low frets among equals.
const HEIGHT: f64 = 0.02;
/// An open string, for each fret the hand is above the first, and at most.
const OPEN: (f64, f64) = (0.3, 2.0);
/// So many semitones below all else it is a bass, which costs nothing: nobody compares their sound, and the hand is free.
const BASS: f64 = 12.0;
/// Striking a sounding key again where it is.
pub(super) const AGAIN: f64 = -8.0;
/// A harmonic that is hardly heard there; more than any movement.
const UNHEARD: f64 = 80.0;
/// Striking a note that has just begun once more on another string; more than any movement, too.
const BEGIN_AGAIN: f64 = 60.0;
/// Taking a string from a note kept by the pedal, and from one whose key is down; more than any
/// movement.
const STEAL_PEDAL: f64 = 100.0;
const STEAL_KEY: f64 = 1_000.0;
/// Taking a younger note's string, for each older one.
const STEAL_YOUNGER: f64 = 0.5;
/// Leaving a note out, more than anything else.
pub(super) const LEAVE_OUT: f64 = 100_000.0;

impl Hand {
    /// What the fingers that hold notes cost a hand at some place.
    pub(super) fn stretch(&self, position: usize, uses: &[Use]) -> f64 {
        let held = |usage: &Use| match *usage {
            Use::Taken { key_down: true, fret, .. } if fret > self.capo => Some(reach(position, fret)),
            _ => None,
        };
        uses.iter().filter_map(held).map(|cost| cost.min(STRETCH)).sum()
    }

    /// Whether a note is a bass under all else that sounds or begins with it.
    fn is_bass(&self, note: &Wanted, wanted: &[Wanted], uses: &[Use]) -> bool {
        let begin = self.order.iter().map(|&other| wanted[other].pitch);
        let sound = uses.iter().zip(&self.strings).filter_map(|(usage, string)| match usage {
            Use::Taken { fret, .. } => Some(string.open_pitch + *fret as f64),
            _ => None,
        });
        let others = begin.chain(sound).filter(|&pitch| pitch != note.pitch);
        let lowest = others.fold(f64::INFINITY, f64::min);
        lowest.is_finite() && lowest - note.pitch >= BASS
    }

    /// Fills in the cost of every chosen note on every string for one place of the hand.
    pub(super) fn tabulate(&mut self, position: usize, wanted: &[Wanted], uses: &[Use]) {
        let count = self.strings.len();
        for (row, &note) in self.order.iter().enumerate() {
            let open = match self.is_bass(&wanted[note], wanted, uses) {
                true => 0.0,
                false => (OPEN.0 * position.saturating_sub(self.capo + 1) as f64).min(OPEN.1),
            };
            for string in 0..count {
                self.costs[row * count + string] = self.cost((position, open), wanted[note], string, uses);
            }
        }
        self.bounds[self.order.len()] = 0.0;
        for row in (0..self.order.len()).rev() {
            let cheapest =
                self.costs[row * count..(row + 1) * count].iter().copied().fold(LEAVE_OUT, f64::min);
            self.bounds[row] = self.bounds[row + 1] + cheapest;
        }
        self.taken.fill(false);
    }

    /// Cost of one note on one string, infinite where it cannot be played; an open string has one of its own.
    fn cost(&self, (position, open): (usize, f64), note: Wanted, string: usize, uses: &[Use]) -> f64 {
        let Some(fret) = self.fret(&note, string) else { return f64::INFINITY };
        let steal = match uses[string] {
            Use::Free | Use::Begun { .. } => 0.0,
            Use::Untouchable => return f64::INFINITY,
            Use::Taken { channel, key, .. } if (channel, key) == (note.channel, note.key) => AGAIN,
            Use::Taken { since, key_down, .. } => {
                let older = uses
                    .iter()
                    .filter(|other| matches!(other, Use::Taken { since: began, .. } if *began < since))
                    .count();
                STEAL_YOUNGER * older as f64 + if key_down { STEAL_KEY } else { STEAL_PEDAL }
            }
        };
        let moved = uses.iter().enumerate().any(|(other, &usage)| {
            other != string && usage == Use::Begun { channel: note.channel, key: note.key }
        });
        let steal = if moved { steal + BEGIN_AGAIN } else { steal };
        if note.harmonic && self.strings[string].is_deaf_to(fret, self.order(string, note.pitch)) {
            return UNHEARD + steal;
        }
        if fret == self.capo {
            return steal + open;
        }
        steal + reach(position, fret) + HEIGHT * fret as f64
    }
}

/// Frets between a fret and those under a hand at some place.
pub(super) fn beyond(position: usize, fret: usize) -> usize {
    position.saturating_sub(fret).max((fret + 1).saturating_sub(position + SPAN))
}

/// What it costs a hand at some place to reach a fret.
fn reach(position: usize, fret: usize) -> f64 {
    match beyond(position, fret) {
        0 => 0.0,
        beyond => REACH.0 + REACH.1 * (beyond - 1) as f64,
    }
}
