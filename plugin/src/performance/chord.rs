//! Notes that begin together, and notes that take over from one another.
//!
//! **Chords** are placed as a whole (`hand`). Of a chord that does not fit on the strings, a note that found none
//! is moved to the nearest octave that a free string gives, the string nearest to the hand. If no string is left
//! it comes a moment later, one after another, and takes the string of a note that has been heard, or if its own key is up
//! by then, of one whose key is up, too. As many wait as there are keys; what comes on top of that is left out, and counted,
//! and so is what finds none but strings of held notes when its key is up.
//!
//! **Strums**: the right hand goes over the strings at one speed, towards the high ones or back, and reaches
//! the first at once. Notes that are told the same way and time are one strum, whatever their channels.
//!
//! Notes that begin a moment after others are of their chord, too, as in a strum that a keyboard plays (`just_begun`).
//!
//! What notes do that overlap is in `legato`, what is known of one until it is placed in `waiting`, what comes between them
//! in `meanwhile`.

mod just_begun;
mod legato;
mod meanwhile;
mod waiting;

use super::articulation::{Articulation, Stop, Stroke};
use super::channel::Channel;
use super::control::MPE_MANAGER;
use super::hand::{LARGEST_CHORD, Placement, Use, Wanted, octaves};
use super::string::{Manner, Start};
use super::technique::*;
use super::{CHANNELS, GestureSink, Performance, Unplayed, Why};
pub(super) use just_begun::JustBegun;
use waiting::leave_out;
pub(super) use waiting::{Late, OwnPluck, Unplaced};

/// The way of the right hand over the strings of a chord.
struct Strum {
    /// The strings at both ends, the one struck first first.
    ends: [usize; 2],
    /// Time from one string to the next, s.
    step: f64,
}

impl Performance {
    /// Notes a struck key; it is placed with all others of the same instant.
    pub(super) fn strike(&mut self, channel: u8, key: u8, velocity: f64) {
        if usize::from(channel) < CHANNELS {
            self.ask_for(channel, key, velocity, 1);
        }
    }

    /// Asks for the note of a key that went down so often.
    fn ask_for(&mut self, channel: u8, key: u8, velocity: f64, presses: u32) {
        let twin = self.chord.iter_mut().find(|other| other.is(channel, key));
        let unplayed = |velocity, why| Unplayed { channel, key, velocity, asked: self.now, why };
        if let Some(twin) = twin {
            let softer = unplayed(twin.velocity.min(velocity), Why::Doubled);
            twin.velocity = twin.velocity.max(velocity);
            twin.presses = twin.presses.saturating_add(presses);
            self.compromises.doubled += 1;
            leave_out(&mut self.unplayed, softer);
            return;
        }
        match self.wanted(channel, key) {
            Some(wanted) if self.chord.len() < LARGEST_CHORD => {
                self.count_move(false, wanted.is_moved());
                let (manner, articulation) =
                    (self.manner(channel), self.channels[usize::from(channel)].articulation);
                self.chord.push(Unplaced {
                    wanted,
                    velocity,
                    asked: self.now,
                    presses,
                    manner,
                    own: OwnPluck::PLAIN,
                    articulation,
                    waited: false,
                    caught: false,
                    let_go: false,
                    on: None,
                });
            }
            Some(_) => {
                self.compromises.left_out += 1;
                leave_out(&mut self.unplayed, unplayed(velocity, Why::LeftOut));
            }
            None => {
                self.compromises.without_string += 1;
                leave_out(&mut self.unplayed, unplayed(velocity, Why::WithoutString));
            }
        }
    }

    /// What a key of a channel asks the hand for, as hands are told to play now; `None` if no string has it.
    fn wanted(&self, channel: u8, key: u8) -> Option<Wanted> {
        let Channel { articulation: Articulation { stop, .. }, forced, .. } =
            self.channels[usize::from(channel)];
        let harmonic = stop == Stop::Harmonic;
        let only = if self.is_by_strings() {
            Some(self.input.string_of(channel, self.strings.len())?)
        } else {
            forced
                .map(|(string, _)| string)
                .filter(|&string| self.hand.reaches(string, f64::from(key), harmonic))
        };
        let pitch = self.hand.playable_pitch(key, only, harmonic)?;
        Some(Wanted { channel, key, pitch, only, harmonic })
    }

    /// Hands have been told otherwise at the very sample of a chord: its notes are asked for anew.
    pub(super) fn want_again(&mut self) {
        for index in 0..self.chord.len() {
            let Wanted { channel, key, .. } = self.chord[index].wanted;
            if let Some(wanted) = self.wanted(channel, key) {
                let before = std::mem::replace(&mut self.chord[index].wanted, wanted);
                self.count_move(before.is_moved(), wanted.is_moved());
            }
        }
    }

    /// A note that was in another octave than its key, or not, is so now: however often it moves, it is one.
    fn count_move(&mut self, before: bool, after: bool) {
        self.compromises.moved_by_octaves += u64::from(after);
        self.compromises.moved_by_octaves -= u64::from(before);
    }

    /// Places and plays the notes that began together at `now`, and lets go of the keys that have waited for that.
    pub(super) fn begin_chord(&mut self, out: &mut impl GestureSink) {
        if !self.chord.is_empty() {
            self.go_back_if_anew();
        }
        self.let_go_before(out);
        self.take_over_notes(out);
        if !self.chord.is_empty() {
            self.place_chord(out);
        }
        self.let_go_after(out);
    }

    /// Plays the notes of the chord, each on a string of its own.
    fn place_chord(&mut self, out: &mut impl GestureSink) {
        let time = self.now;
        self.uses.clear();
        self.uses.extend(self.strings.iter().map(|string| string.usage(time)));
        self.go_on_late();
        if self.gives_way() {
            self.spare_held();
        } else {
            self.join_just_begun();
        }
        self.count_chord();
        let position = self.hand.position();
        self.find_places();
        self.stay_just_begun();
        if self.displaces_just_begun() {
            self.leave_just_begun();
            self.hand.return_to(position);
            self.find_places();
        }
        self.find_other_ways();
        self.make_room();
        for index in 0..self.chord.len() {
            let Some(placement) = self.placements[index] else { continue };
            if self.chord[index].on.is_some_and(|on| on.string == placement.string) {
                continue;
            }
            let strum = self.strum(index);
            let start = self.start(index, placement, strum.as_ref());
            let (channel, string) = (start.channel, placement.string);
            let bend = self.bend(channel);
            self.strings[string].start(time, start, out);
            self.strings[string].bend(time, channel, bend);
            self.just_begun.note(string, self.chord[index]);
        }
        self.turn_stroke();
        self.chord.clear();
    }

    /// Finds the hand a place, and each note of the chord a string, as the strings may be used.
    fn find_places(&mut self) {
        for note in &self.chord {
            if let Unplaced { on: Some(on), wanted: Wanted { channel, key, .. }, .. } = *note {
                self.uses[on.string] = Use::Begun { channel, key };
            }
        }
        self.wanted.clear();
        self.wanted.extend(self.chord.iter().map(|note| note.wanted));
        self.placements.clear();
        self.placements.resize(self.wanted.len(), None);
        self.hand.place(&self.wanted, &self.uses, &mut self.placements);
    }

    /// How a note of the chord is to be played, with the usual way to stop strings on this instrument.
    fn articulation(&self, index: usize) -> Articulation {
        let asked = self.chord[index].articulation;
        let stop = if asked.stop == Stop::Press { self.usual_stop } else { asked.stop };
        Articulation { stop, ..asked }
    }

    /// What a string is told of the note of the chord that is placed there.
    fn start(&mut self, index: usize, placement: Placement, strum: Option<&Strum>) -> Start {
        let Unplaced { wanted, velocity, asked, presses, manner, own, caught, .. } = self.chord[index];
        let mut articulation = self.articulation(index);
        if articulation.stroke == Stroke::Alternate {
            articulation.stroke = if self.goes_back() { Stroke::Up } else { Stroke::Down };
        }
        let Placement { string, fret } = placement;
        let (mut wait, mut accent) = (0.0, 1.0);
        if let Some(&Strum { ends: [first, last], step }) = strum {
            let way = first.abs_diff(string) as f64;
            wait = step * way;
            let part = way / first.abs_diff(last).max(1) as f64;
            accent += STRUM_ACCENT * articulation.accent * (2.0 * part - 1.0);
        }
        Start {
            channel: wanted.channel,
            key: wanted.key,
            velocity,
            asked,
            presses,
            caught,
            fret,
            strength: self.touching.strength(velocity),
            deviation: self.variation.next(),
            manner: own.with(manner),
            wheel: self.bend(wanted.channel),
            articulation,
            order: self.hand.order(string, wanted.pitch),
            wait,
            accent,
        }
    }

    /// How the hand goes over the strings of a note of the chord and of those it is strummed with, if that takes time.
    fn strum(&self, index: usize) -> Option<Strum> {
        let way = |articulation: &Articulation| match articulation.stroke {
            Stroke::Up => true,
            Stroke::Alternate => self.goes_back(),
            _ => false,
        };
        let told = self.chord[index].articulation;
        let back = way(&told);
        let together = |note: &Unplaced| {
            let Unplaced { articulation, .. } = note;
            articulation.strum == told.strum && way(articulation) == back
        };
        let strummed = self.chord.iter().zip(&self.placements).filter(|(note, _)| together(note));
        let strings = strummed.filter_map(|(_, placement)| placement.map(|placement| placement.string));
        let (high, low) = (strings.clone().min()?, strings.max()?);
        if told.strum <= 0.0 || high == low {
            return None;
        }
        let ends = if back { [high, low] } else { [low, high] };
        Some(Strum { ends, step: told.strum / self.strings.len().saturating_sub(1).max(1) as f64 })
    }

    /// Finds other ways for notes of the chord that have no string: another octave, or another time.
    fn find_other_ways(&mut self) {
        for placement in self.placements.iter().flatten() {
            self.uses[placement.string] = Use::Untouchable;
        }
        let mut late = 0;
        for index in 0..self.chord.len() {
            if self.placements[index].is_some() {
                continue;
            }
            let note = self.chord[index];
            let before = note.wanted.is_moved();
            if let Some(placement) = self.revoiced(index) {
                self.uses[placement.string] = Use::Untouchable;
                self.placements[index] = Some(placement);
                self.count_move(before, self.chord[index].wanted.is_moved());
            } else if self.late.len() < LARGEST_CHORD
                && !note.let_go
                && let Some(wanted) = self.to_come(&note.wanted)
            {
                late += 1;
                let time = self.now + (f64::from(late) * ARPEGGIO * self.sample_rate).round() as u64;
                self.count_move(before, wanted.is_moved());
                self.compromises.arpeggiated += u64::from(!note.waited);
                let note = Unplaced { wanted, waited: true, ..note };
                self.late.push(Late { time, note, releases: 0, cut: false });
            } else {
                self.count_move(before, false);
                self.compromises.arpeggiated -= u64::from(note.waited);
                self.compromises.left_out += 1;
                leave_out(&mut self.unplayed, note.left_out());
            }
        }
    }

    /// A note in the nearest octave that any string gives, free or not: a capo, or the instrument, may have changed since it was
    /// asked for, and one that no string gives would wait for ever.
    fn to_come(&self, wanted: &Wanted) -> Option<Wanted> {
        let given =
            |moved: &Wanted| (0..self.strings.len()).any(|string| self.hand.fret(moved, string).is_some());
        octaves(wanted.pitch).map(|pitch| Wanted { pitch, ..*wanted }).find(given)
    }

    /// The nearest octave of a note that a free string gives, on the one nearest to the hand.
    fn revoiced(&mut self, index: usize) -> Option<Placement> {
        if self.uses.iter().all(|&string| string != Use::Free) {
            return None;
        }
        let wanted = self.chord[index].wanted;
        octaves(wanted.pitch).find_map(|pitch| {
            let moved = Wanted { pitch, ..wanted };
            let free = |string: &usize| self.uses[*string] == Use::Free;
            let placed = |string: usize| Some(Placement { string, fret: self.hand.fret(&moved, string)? });
            let found = (0..self.strings.len())
                .filter(free)
                .filter_map(placed)
                .min_by_key(|placement| self.hand.distance(placement.fret))?;
            self.chord[index].wanted = moved;
            Some(found)
        })
    }
}
