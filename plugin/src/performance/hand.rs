//! Which string and fret a note goes to.
//!
//! The left hand covers [`SPAN`] frets from the one under its first finger. Notes that begin at
//! the same instant are placed together, each on a string of its own, where the whole costs least:
//! moving the hand and reaching out of it cost by the fret, an open string costs nothing to a hand
//! low on the neck and a little to one far up (its sound stands out), and lower frets are slightly
//! preferred. A key that still sounds is struck again where it is.
//!
//! **Who gives way** when no free string can give the note: a note kept only by the pedal, or else
//! one whose key is down; among several the one nearest to the hand, where each string with a
//! younger note counts half a fret farther. A note is never taken away at the very instant it
//! begins: of more simultaneous notes than can have a string each, the outer ones stay (the highest,
//! the lowest, the second highest, and so on, each unless it would need a string of those before)
//! and the rest are left out.
//!
//! Everything is a function of the hand's place and the strings' use, so the same notes always
//! fall on the same strings.

/// Frets under the hand without reaching: one for each finger.
const SPAN: usize = 4;
/// Most notes considered at one instant; of more, the last to arrive are left out.
pub(crate) const LARGEST_CHORD: usize = 128;
/// Nodes of the search for one place of the hand. Six notes on six strings take a few hundred
/// after pruning; the bound is for instruments with very many strings.
const SEARCH_LIMIT: usize = 2_000;

// Costs, in frets of hand movement. Only their order and rough size matter.
/// Moving the hand by a fret.
const MOVE: f64 = 1.0;
/// Reaching a fret beyond the hand, for the first fret and for each further one.
const REACH: (f64, f64) = (1.2, 2.5);
/// Preferring low frets among equals.
const HEIGHT: f64 = 0.02;
/// An open string, for each fret the hand is above the first, and at most.
const OPEN: (f64, f64) = (0.3, 2.0);
/// Striking a sounding key again where it is.
const AGAIN: f64 = -8.0;
/// Taking a string from a note kept by the pedal, and from one whose key is down; more than any
/// movement.
const STEAL_PEDAL: f64 = 100.0;
const STEAL_KEY: f64 = 1_000.0;
/// Taking a younger note's string, for each older one.
const STEAL_YOUNGER: f64 = 0.5;
/// Leaving a note out, more than anything else.
const LEAVE_OUT: f64 = 100_000.0;

/// The notes a string can give.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    /// Pitch of the open string, MIDI note number.
    pub open_pitch: f64,
    /// Number of frets.
    pub frets: usize,
}

impl Range {
    /// The fret (0: open) that sounds a key, if there is one.
    pub(crate) fn fret(&self, key: f64) -> Option<usize> {
        let fret = (key - self.open_pitch).round();
        (0.0..=self.frets as f64).contains(&fret).then_some(fret as usize)
    }
}

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
        /// When it began, samples.
        since: u64,
        /// Whether its key is down (or only the pedal keeps it).
        key_down: bool,
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
#[derive(Debug, Clone)]
pub(crate) struct Hand {
    strings: Vec<Range>,
    highest_fret: usize,
    /// Fret under the first finger, 1 or more.
    position: usize,
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
    pub(crate) fn new(strings: Vec<Range>) -> Self {
        let count = strings.len();
        Self {
            highest_fret: strings.iter().map(|range| range.frets).max().unwrap_or(0),
            strings,
            position: 1,
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

    /// Back to the first fret.
    pub(crate) fn reset(&mut self) {
        self.position = 1;
    }

    /// The pitch at which a key is played: its own, or the nearest octave that a string can give.
    pub(crate) fn playable_pitch(&self, key: u8) -> Option<f64> {
        let playable = |pitch: f64| self.strings.iter().any(|range| range.fret(pitch).is_some());
        (0..=10)
            .flat_map(|octave| {
                [f64::from(key) + 12.0 * f64::from(octave), f64::from(key) - 12.0 * f64::from(octave)]
            })
            .find(|&pitch| playable(pitch))
    }

    /// Finds strings for notes that begin together and moves the hand there. `placements` receives
    /// one entry for each wanted note, `None` for those left out.
    pub(crate) fn place(&mut self, wanted: &[Wanted], uses: &[Use], placements: &mut [Option<Placement>]) {
        placements.fill(None);
        self.choose(wanted, uses);
        let mut best_cost = f64::INFINITY;
        let mut best_position = self.position;
        // Nearest places first, so that among equals the hand stays where it is.
        for distance in 0..=self.highest_fret {
            if MOVE * distance as f64 + AGAIN * self.order.len() as f64 >= best_cost {
                break;
            }
            let below = self.position.checked_sub(distance).filter(|&place| place >= 1);
            let above = (distance > 0).then_some(self.position + distance);
            for position in [below, above].into_iter().flatten() {
                if position > self.highest_fret.max(1) {
                    continue;
                }
                self.tabulate(position, wanted, uses);
                let so_far = MOVE * distance as f64;
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
            placements[note] = string.and_then(|string| {
                self.strings[string].fret(wanted[note].pitch).map(|fret| Placement { string, fret })
            });
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
            let possible =
                uses[string] != Use::Untouchable && self.strings[string].fret(wanted[note].pitch).is_some();
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

    /// Fills in the cost of every chosen note on every string for one place of the hand.
    fn tabulate(&mut self, position: usize, wanted: &[Wanted], uses: &[Use]) {
        let count = self.strings.len();
        for (row, &note) in self.order.iter().enumerate() {
            for string in 0..count {
                self.costs[row * count + string] = self.cost(position, wanted[note], string, uses);
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

    /// Cost of one note on one string, infinite where it cannot be played.
    fn cost(&self, position: usize, note: Wanted, string: usize, uses: &[Use]) -> f64 {
        let Some(fret) = self.strings[string].fret(note.pitch) else { return f64::INFINITY };
        let steal = match uses[string] {
            Use::Free => 0.0,
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
        if fret == 0 {
            return steal + (OPEN.0 * (position - 1) as f64).min(OPEN.1);
        }
        let beyond = (position.saturating_sub(fret)).max((fret + 1).saturating_sub(position + SPAN));
        let reach = match beyond {
            0 => 0.0,
            more => REACH.0 + REACH.1 * (more - 1) as f64,
        };
        steal + reach + HEIGHT * fret as f64
    }
}

/// Depth-first search for the cheapest assignment, pruned by the least the rest can cost.
struct Search<'a> {
    strings: usize,
    costs: &'a [f64],
    bounds: &'a [f64],
    taken: &'a mut [bool],
    path: &'a mut [Option<usize>],
    best_path: &'a mut [Option<usize>],
    best_cost: f64,
    visits: usize,
}

impl Search<'_> {
    fn descend(&mut self, row: usize, cost: f64) {
        self.visits += 1;
        if cost + self.bounds[row] >= self.best_cost || self.visits > SEARCH_LIMIT {
            return;
        }
        if row == self.path.len() {
            self.best_cost = cost;
            self.best_path.copy_from_slice(self.path);
            return;
        }
        for string in 0..self.strings {
            let step = self.costs[row * self.strings + string];
            if !self.taken[string] && step < LEAVE_OUT {
                self.taken[string] = true;
                self.path[row] = Some(string);
                self.descend(row + 1, cost + step);
                self.taken[string] = false;
            }
        }
        self.path[row] = None;
        self.descend(row + 1, cost + LEAVE_OUT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// E4 B3 G3 D3 A2 E2 with 22 frets, string 0 the highest.
    fn guitar() -> Hand {
        let pitches = [64.0, 59.0, 55.0, 50.0, 45.0, 40.0];
        Hand::new(pitches.map(|open_pitch| Range { open_pitch, frets: 22 }).to_vec())
    }

    fn play(hand: &mut Hand, keys: &[u8], uses: &[Use]) -> Vec<Option<(usize, usize)>> {
        let wanted: Vec<Wanted> =
            keys.iter().map(|&key| Wanted { channel: 0, key, pitch: f64::from(key) }).collect();
        let mut placements = vec![None; keys.len()];
        hand.place(&wanted, uses, &mut placements);
        placements.iter().map(|place| place.map(|place| (place.string, place.fret))).collect()
    }

    const FREE: [Use; 6] = [Use::Free; 6];

    #[test]
    fn open_chords_take_their_usual_shape() {
        let c_major = play(&mut guitar(), &[48, 52, 55, 60, 64], &FREE);
        assert_eq!(c_major, [Some((4, 3)), Some((3, 2)), Some((2, 0)), Some((1, 1)), Some((0, 0))]);
        let f_major = play(&mut guitar(), &[65, 60, 57, 53, 48, 41], &FREE);
        let barre = [(0, 1), (1, 1), (2, 2), (3, 3), (4, 3), (5, 1)].map(Some);
        assert_eq!(f_major, barre);
    }

    #[test]
    fn an_order_of_arrival_that_traps_a_greedy_hand() {
        // The E4 must leave the first string to the E5.
        let placed = play(&mut guitar(), &[64, 67, 71, 76], &FREE);
        let mut strings: Vec<usize> = placed.iter().map(|place| place.expect("all fit").0).collect();
        strings.dedup();
        assert_eq!(strings.len(), 4, "{placed:?}");
    }

    #[test]
    fn a_melody_stays_in_position() {
        let mut hand = guitar();
        play(&mut hand, &[69], &FREE);
        play(&mut hand, &[72], &FREE);
        let here = hand.position;
        assert_eq!(play(&mut hand, &[67], &FREE), [Some((1, 8))]);
        assert_eq!(hand.position, here);
    }

    #[test]
    fn a_pedal_note_gives_way_before_any_held_key() {
        let taken = |key, since, key_down| Use::Taken { channel: 0, key, since, key_down };
        let mut uses = [
            taken(64, 10, true),
            taken(59, 2, true),
            taken(55, 30, false),
            taken(50, 20, true),
            taken(45, 5, true),
            taken(40, 6, true),
        ];
        // G4 is nearest on string 0, but only the third string's note is kept by the pedal alone.
        assert_eq!(play(&mut guitar(), &[67], &uses), [Some((2, 12))]);
        uses[2] = taken(55, 30, true);
        assert_eq!(play(&mut guitar(), &[67], &uses), [Some((0, 3))]);
        // Of two notes equally near, the older one.
        uses[0] = Use::Untouchable;
        uses[1] = taken(59, 40, false);
        uses[2] = taken(55, 39, false);
        assert_eq!(play(&mut guitar(), &[64], &uses), [Some((1, 5))]);
        uses[1] = Use::Untouchable;
        assert_eq!(play(&mut guitar(), &[64], &uses), [Some((2, 9))]);
    }

    #[test]
    fn a_sounding_key_is_struck_again_where_it_is() {
        let mut uses = FREE;
        uses[2] = Use::Taken { channel: 0, key: 64, since: 0, key_down: true };
        assert_eq!(play(&mut guitar(), &[64], &uses), [Some((2, 9))]);
    }

    #[test]
    fn of_too_many_notes_the_outer_ones_stay() {
        let keys: Vec<u8> = (45..77).collect();
        let placed = play(&mut guitar(), &keys, &FREE);
        let played: Vec<u8> =
            keys.iter().zip(&placed).filter_map(|(&key, place)| place.map(|_| key)).collect();
        assert!(played.contains(&76) && played.contains(&45), "{played:?}");
        assert!(played.len() <= 6);
    }

    #[test]
    fn keys_out_of_range_move_by_octaves() {
        let hand = guitar();
        assert_eq!(hand.playable_pitch(60), Some(60.0));
        assert_eq!(hand.playable_pitch(39), Some(51.0));
        assert_eq!(hand.playable_pitch(0), Some(48.0));
        assert_eq!(hand.playable_pitch(127), Some(79.0));
        assert_eq!(hand.playable_pitch(87), Some(75.0));
    }

    #[test]
    fn an_instant_never_takes_a_string_twice() {
        let mut uses = FREE;
        uses[0] = Use::Untouchable;
        let placed = play(&mut guitar(), &[86], &uses);
        assert_eq!(placed, [None]);
    }
}
