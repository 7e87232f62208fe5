//! The notes of a host that numbers them.

use nice_plug::midi::{Channel, Key, VoiceID};
use nice_plug::prelude::NoteEvent;

use crate::params::poly;

/// How many notes are remembered by the number a host gave them; more than strings can sound.
const REMEMBERED: usize = 64;

/// A note.
#[derive(Debug, Clone, Copy)]
struct Voice {
    id: i32,
    channel: u8,
    key: u8,
    /// How many notes began before it.
    age: u64,
    /// By how much parameters are moved for it alone, of the host's 0 to 1.
    moved: [Option<f32>; poly::COUNT],
}

/// All that have not ended, as far as there is room.
#[derive(Debug, Clone, Copy)]
pub(super) struct Voices {
    notes: [Option<Voice>; REMEMBERED],
    begun: u64,
}

impl Default for Voices {
    fn default() -> Self {
        Self { notes: [None; REMEMBERED], begun: 0 }
    }
}

impl Voices {
    /// A note begins. Where there is no room, the oldest is forgotten.
    pub fn begin(&mut self, id: i32, channel: u8, key: u8) {
        let voice = Voice { id, channel, key, age: self.begun, moved: [None; poly::COUNT] };
        self.begun += 1;
        // A free place counts as older than all.
        if let Some(place) = self.notes.iter_mut().min_by_key(|note| note.map(|voice| voice.age)) {
            *place = Some(voice);
        }
    }

    /// Forgets the notes that sound no more and those struck again under another number, telling of each.
    pub fn end(&mut self, sounds: impl Fn(u8, u8) -> bool, send: &mut impl FnMut(NoteEvent<()>) -> bool) {
        for index in 0..REMEMBERED {
            let Some(Voice { id, channel, key, .. }) = self.notes[index] else { continue };
            if sounds(channel, key) && self.latest(channel, key) == Some(id) {
                continue;
            }
            let ended = NoteEvent::VoiceTerminated {
                timing: 0,
                voice_id: VoiceID::ID(id),
                channel: Channel::Number(channel),
                key: Key::Number(key),
            };
            // A host whose queue is full is told after the next block.
            if send(ended) {
                self.notes[index] = None;
            }
        }
    }

    /// Number of the latest note of a key.
    fn latest(&self, channel: u8, key: u8) -> Option<i32> {
        self.last(|voice| (voice.channel, voice.key) == (channel, key)).map(|voice| voice.id)
    }

    /// Channel and key of a note; the latest if its number was used again.
    pub fn find(&self, id: i32) -> Option<(u8, u8)> {
        self.last(|voice| voice.id == id).map(|voice| (voice.channel, voice.key))
    }

    /// A parameter is moved by so much, of the host's 0 to 1, for the note of a number alone.
    pub fn modulate(&mut self, id: i32, parameter: u32, offset: f32) {
        for voice in self.notes.iter_mut().flatten().filter(|voice| voice.id == id) {
            if let Some(moved) = voice.moved.get_mut(parameter as usize) {
                *moved = Some(offset);
            }
        }
    }

    /// Channel and key of all notes for which a parameter is moved, and by how much.
    pub fn modulated(&self, parameter: u32) -> impl Iterator<Item = (u8, u8, f32)> {
        self.notes.iter().flatten().filter_map(move |voice| {
            let moved = voice.moved.get(parameter as usize).copied().flatten()?;
            Some((voice.channel, voice.key, moved))
        })
    }

    /// The latest note of some kind.
    fn last(&self, wanted: impl Fn(&Voice) -> bool) -> Option<&Voice> {
        self.notes.iter().flatten().filter(|voice| wanted(voice)).max_by_key(|voice| voice.age)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_note_that_sounds_is_known_however_many_come_and_go() {
        let mut voices = Voices::default();
        voices.begin(1000, 0, 40);
        for id in 0..200 {
            voices.begin(id, 0, 50);
            voices.end(|_, key| key == 40, &mut |_| true);
            assert_eq!((voices.find(1000), voices.find(id)), (Some((0, 40)), None));
        }
    }

    #[test]
    fn the_latest_counts_wherever_it_is_kept() {
        let mut voices = Voices::default();
        voices.begin(1, 0, 40);
        voices.begin(2, 0, 50);
        voices.end(|_, key| key != 40, &mut |_| true);
        // Takes the place of the first.
        voices.begin(3, 0, 50);
        assert_eq!(voices.latest(0, 50), Some(3));
        voices.begin(2, 1, 60);
        assert_eq!(voices.find(2), Some((1, 60)));
    }

    #[test]
    fn without_room_the_oldest_is_forgotten() {
        let mut voices = Voices::default();
        for id in 0..=REMEMBERED as i32 {
            voices.begin(id, 0, id as u8);
        }
        assert_eq!((voices.find(0), voices.find(1)), (None, Some((0, 1))));
    }
}
