//! Notes on their way to a string: struck and not placed yet, or waiting until one is free.

use super::{Articulation, Manner, Placement, Use, Wanted};
use crate::performance::{GestureSink, Performance, Unplayed, Why};

/// A note of a chord as it was asked for: it has no string yet, or waits for one, or has just begun and is placed once more with
/// those that follow.
#[derive(Debug, Clone, Copy)]
pub(in crate::performance) struct Unplaced {
    pub wanted: Wanted,
    pub velocity: f64,
    /// Sample at which its key went down.
    pub asked: u64,
    /// How often that was.
    pub presses: u32,
    /// How its channel's notes are played, and how it is bent and pressed itself: there the last word counts.
    pub manner: Manner,
    /// What its own pluck has beside its channel's.
    pub own: OwnPluck,
    pub articulation: Articulation,
    /// Whether it has waited for a string.
    pub waited: bool,
    /// Whether a sostenuto pedal has caught its key meanwhile.
    pub caught: bool,
    /// Whether its key has gone up meanwhile.
    pub let_go: bool,
    /// Where it has just begun, if it has.
    pub on: Option<Placement>,
}

impl Unplaced {
    /// Whether it is the note of a key of a channel.
    pub fn is(&self, channel: u8, key: u8) -> bool {
        (self.wanted.channel, self.wanted.key) == (channel, key)
    }

    /// What there is to tell of it where it is left out.
    pub(super) fn left_out(&self) -> Unplayed {
        let Self { wanted: Wanted { channel, key, .. }, velocity, asked, .. } = *self;
        Unplayed { channel, key, velocity, asked, why: Why::LeftOut }
    }
}

/// Has it told that a note is not played, as far as there is room: no event leaves out as many as there is room for.
pub(super) fn leave_out(unplayed: &mut Vec<Unplayed>, note: Unplayed) {
    if unplayed.len() < unplayed.capacity() {
        unplayed.push(note);
    }
}

/// What a note has for its own pluck; each thing that can be said of it is kept apart from the others.
#[derive(Debug, Clone, Copy)]
pub(in crate::performance) struct OwnPluck {
    /// Moves the pluck away from the saddle, m.
    pub place: f64,
    /// Its brightness does so, too, m.
    pub brightness: f64,
    /// Factors of the pluck's force.
    pub force: f64,
    pub swell: f64,
    pub gain: f64,
}

impl OwnPluck {
    /// Nothing special.
    pub(super) const PLAIN: Self = Self { place: 0.0, brightness: 0.0, force: 1.0, swell: 1.0, gain: 1.0 };

    /// With what the channel says.
    pub(super) fn with(&self, channel: Manner) -> Manner {
        let place = channel.place + self.place + self.brightness;
        let force = channel.force * self.force * self.swell * self.gain;
        Manner { place, force, ..channel }
    }
}

/// A note that comes late.
#[derive(Debug, Clone, Copy)]
pub(in crate::performance) struct Late {
    pub time: u64,
    pub note: Unplaced,
    /// How often its key has gone up already.
    pub releases: u32,
    /// Whether it is to end at once, whatever the pedals say.
    pub cut: bool,
}

impl Late {
    /// Whether its key is down.
    pub fn key_down(&self) -> bool {
        self.releases < self.note.presses
    }

    /// Whether it is the note of a key of a channel.
    pub fn is(&self, channel: u8, key: u8) -> bool {
        self.note.is(channel, key)
    }
}

impl Performance {
    /// Strikes the notes again that have begun since some sample under the player whom this one has taken over from, and whose
    /// keys are down: on strings that are no more they would be lost.
    pub fn strike_again(&mut self, old: &Self, since: u64) {
        for note in old.strings.iter().filter_map(|string| string.note_since(since)) {
            let count = self.chord.len();
            self.ask_for(note.channel, note.key, note.velocity, note.presses);
            if let Some(Unplaced { manner, caught, .. }) = self.chord.get_mut(count) {
                *manner = manner.by_now(&note.manner);
                *caught = note.caught;
            }
        }
    }

    /// Whether what is placed is a note that comes late and whose key is up: it gives way to all whose keys are down. No other is
    /// placed with it.
    pub(super) fn gives_way(&self) -> bool {
        self.chord.iter().any(|note| note.let_go)
    }

    /// It takes no string from a note whose key is down, not even from the next of its own key.
    pub(super) fn spare_held(&mut self) {
        let held = |string: &&mut Use| matches!(string, Use::Taken { key_down: true, .. });
        self.uses.iter_mut().filter(held).for_each(|string| *string = Use::Untouchable);
    }

    /// Notes of such channels that wait for a string do not come.
    pub(in crate::performance) fn leave_out_late(&mut self, is_meant: impl Fn(u8) -> bool) {
        let Self { late, compromises, unplayed, .. } = self;
        late.retain(|Late { note: note @ Unplaced { wanted, waited, .. }, .. }| {
            let meant = is_meant(wanted.channel);
            if meant {
                compromises.moved_by_octaves -= u64::from(wanted.is_moved());
                compromises.arpeggiated -= u64::from(*waited);
                compromises.left_out += 1;
                leave_out(unplayed, note.left_out());
            }
            !meant
        });
    }

    /// Plays the notes that come late and are due before sample `until`.
    pub(in crate::performance) fn begin_late(&mut self, until: u64, out: &mut impl GestureSink) {
        loop {
            let due = self.late.iter().enumerate().filter(|(_, late)| late.time < until);
            let Some((index, &late)) = due.min_by_key(|(_, late)| late.time) else { return };
            self.late.remove(index);
            self.advance_strings(late.time.max(self.now), out);
            let Wanted { channel, key, .. } = late.note.wanted;
            let let_go = !late.key_down();
            // One that ends at once has all its presses until it has begun.
            let presses = if let_go { late.note.presses } else { late.note.presses - late.releases };
            self.chord.push(Unplaced { presses, let_go, ..late.note });
            self.begin_chord(out);
            // Where it has come to: its key may have gone down again since, for another note, which goes on.
            let Some(string) = self.begins_let_go(&late.note) else { continue };
            let pedal = self.pedal(channel) && !late.cut;
            for _ in 0..presses {
                self.strings[string].release(self.now, channel, key, pedal, out);
            }
        }
    }
}
