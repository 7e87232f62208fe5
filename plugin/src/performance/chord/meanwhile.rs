//! What comes between the notes of a chord, at their own sample. A file has that in any order, so as little as can be tears a
//! chord apart: what is said of notes that sound is said of those that are yet to be placed, too, and keys that the chord has
//! to do with go up when it has been placed.

use super::{Articulation, CHANNELS, Channel, LARGEST_CHORD, MPE_MANAGER, Manner, Unplaced};
use crate::performance::channel::Request;
use crate::performance::controller;
use crate::performance::{Channels, GestureSink, Performance};

impl Performance {
    /// A key goes up, once the chord has been placed that it is of or that may take over from it, and that may be yet to come: what
    /// ends where another note begins is connected with it, whichever of the two a file has first.
    pub(in crate::performance) fn release(&mut self, channel: u8, key: u8, out: &mut impl GestureSink) {
        if self.chord_needs(channel, key) || self.may_go_on(channel, key) {
            if self.releases.len() < LARGEST_CHORD {
                return self.releases.push((channel, key));
            }
            self.begin_chord(out);
        }
        self.let_go(channel, key, out);
    }

    /// A key goes down that has gone up at this very sample: that was of the note before, which is over.
    pub(in crate::performance) fn release_before(
        &mut self,
        channel: u8,
        key: u8,
        out: &mut impl GestureSink,
    ) {
        if self.chord.iter().any(|note| note.is(channel, key)) {
            return;
        }
        while let Some(index) = self.releases.iter().position(|&release| release == (channel, key)) {
            self.releases.remove(index);
            self.let_go(channel, key, out);
        }
    }

    /// Keys go up at once that have waited for a chord which has nothing to do with them.
    pub(super) fn let_go_before(&mut self, out: &mut impl GestureSink) {
        let mut index = 0;
        while let Some(&(channel, key)) = self.releases.get(index) {
            if self.chord_needs(channel, key) {
                index += 1;
            } else {
                self.releases.remove(index);
                self.let_go(channel, key, out);
            }
        }
    }

    /// The keys go up that have waited for the chord.
    pub(super) fn let_go_after(&mut self, out: &mut impl GestureSink) {
        for index in 0..self.releases.len() {
            let (channel, key) = self.releases[index];
            self.let_go(channel, key, out);
        }
        self.releases.clear();
    }

    /// Whether notes that begin now have to be placed before this key goes up: it is one of them, or the one that they take
    /// over from.
    pub(in crate::performance) fn chord_needs(&self, channel: u8, key: u8) -> bool {
        let needs = |note: &Unplaced| {
            // Where each string has a channel, only its own key can be the one before.
            let before = !self.is_by_strings() || note.wanted.channel == channel;
            let connected = before && (note.articulation.connects() || self.touching.legato);
            connected || note.is(channel, key)
        };
        // Notes to come have to hear that a keyswitch asks for a string no more.
        !self.forces(channel, key) && self.chord.iter().any(needs)
    }

    /// Whether notes of a channel are connected, so that one which begins at this very sample may take over from a key of its.
    fn may_go_on(&self, channel: u8, key: u8) -> bool {
        let connects = |own: &Channel| own.articulation.connects() || self.touching.legato;
        let melody = self.of_one_hand(channel);
        let mut channels = (0..).zip(&self.channels).filter(|&(own, _)| melody.has(own));
        !self.forces(channel, key) && channels.any(|(_, own)| connects(own))
    }

    /// Whether notes that begin now have to be placed before a controller of some number moves. Most say how notes are played
    /// that come after it, and those that began before have that by themselves; what is said of those that sound they are
    /// told (`tell_chord`). Messages of other channels stand between the notes of one chord wherever notes have channels of
    /// their own.
    pub(in crate::performance) fn changes_chord(&self, channel: u8, number: u8) -> bool {
        if controller::is_of_all(number, self.is_mpe()) {
            return true;
        }
        let meant = match channel {
            // It may be about to say how many channels there are of MPE.
            MPE_MANAGER if number == controller::DATA_ENTRY => Channels::ALL,
            _ => Channels::one(channel).and(self.spoken().with(channel)),
        };
        let is_meant = |own: u8| meant.has(own);
        let notes = self.chord.iter().any(|note| is_meant(note.wanted.channel));
        let released = self.releases.iter().any(|&(own, _)| is_meant(own));
        // A pedal keeps what goes up after it, and what has gone up before it ends.
        (notes && controller::is_of_begun(number)) || (released && controller::keeps_or_ends(number))
    }

    /// What channels have said of notes that sound is said of those, too, that have begun now or come late.
    pub(in crate::performance) fn tell_chord(&mut self, request: Request, is_meant: impl Fn(u8) -> bool) {
        let (presses, swings, touches) = match request {
            Request::Press => (true, false, false),
            Request::Swing => (false, true, false),
            Request::Touch => (false, false, true),
            Request::Reset => (true, true, true),
            _ => return,
        };
        let manners: [Manner; CHANNELS] = std::array::from_fn(|channel| self.manner(channel as u8));
        let late = self.late.iter_mut().map(|late| &mut late.note);
        for note in self.chord.iter_mut().chain(late).filter(|note| is_meant(note.wanted.channel)) {
            let channel = usize::from(note.wanted.channel);
            let Articulation { palm, tremolo, .. } = self.channels[channel].articulation;
            if presses {
                note.manner.pressure = manners[channel].pressure;
            }
            if swings {
                note.manner.vibrato = manners[channel].vibrato;
            }
            if touches {
                (note.articulation.palm, note.articulation.tremolo) = (palm, tremolo);
            }
        }
    }
}
