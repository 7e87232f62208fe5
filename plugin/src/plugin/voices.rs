//! The notes of a host that numbers them.

use std::ops::RangeInclusive;

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
    /// Whether its note-off is yet to come.
    down: bool,
    /// By how much parameters are moved for it alone, of the host's 0 to 1.
    moved: [Option<f32>; poly::COUNT],
}

/// All that have not ended, as far as there is room.
#[derive(Debug, Clone, Copy)]
pub(super) struct Voices {
    notes: [Option<Voice>; REMEMBERED],
    /// Those whose key was struck again before their note-off: the host knows that they have ended, but each is one of the
    /// presses that keep the key down.
    presses: [Option<Voice>; REMEMBERED],
    begun: u64,
}

impl Default for Voices {
    fn default() -> Self {
        Self { notes: [None; REMEMBERED], presses: [None; REMEMBERED], begun: 0 }
    }
}

impl Voices {
    /// A note begins. Where there is no room, the oldest is forgotten.
    pub fn begin(&mut self, id: i32, channel: u8, key: u8) {
        let voice = Voice { id, channel, key, age: self.begun, down: true, moved: [None; poly::COUNT] };
        self.begun += 1;
        remember(&mut self.notes, voice);
    }

    /// Forgets the notes that sound no more and those struck again under another number, telling of each at the last sample of
    /// the block: at an earlier one it might not have begun.
    pub fn end(
        &mut self,
        last: u32,
        sounds: impl Fn(u8, u8) -> bool,
        send: &mut impl FnMut(NoteEvent<()>) -> bool,
    ) {
        for press in &mut self.presses {
            *press = press.filter(|voice| voice.down && sounds(voice.channel, voice.key));
        }
        for index in 0..REMEMBERED {
            let Some(voice) = self.notes[index] else { continue };
            let Voice { id, channel, key, .. } = voice;
            let sounds = sounds(channel, key);
            if sounds && self.latest(channel, key) == Some(id) {
                continue;
            }
            let ended = NoteEvent::VoiceTerminated {
                timing: last,
                voice_id: VoiceID::ID(id),
                channel: Channel::Number(channel),
                key: Key::Number(key),
            };
            // A host whose queue is full is told after the next block.
            if send(ended) {
                self.notes[index] = None;
                if sounds && voice.down {
                    remember(&mut self.presses, voice);
                }
            }
        }
    }

    /// Number of the latest note of a key.
    fn latest(&self, channel: u8, key: u8) -> Option<i32> {
        self.last(|voice| (voice.channel, voice.key) == (channel, key)).map(|voice| voice.id)
    }

    /// Channel and key of a note, unless that key was struck again under another number; of the latest if its number was used
    /// again.
    pub fn find(&self, id: i32) -> Option<(u8, u8)> {
        let voice = self.last(|voice| voice.id == id)?;
        let (channel, key) = (voice.channel, voice.key);
        (self.latest(channel, key) == Some(id)).then_some((channel, key))
    }

    /// Whether what is said of a note with such a number and key cannot be meant for whatever note that key has: the number
    /// is that of a note which is known, or the key's note has another.
    pub fn is_another(&self, id: i32, channel: u8, key: u8) -> bool {
        let all = self.notes.iter().chain(&self.presses).flatten();
        self.latest(channel, key).is_some() || all.into_iter().any(|voice| voice.id == id)
    }

    /// A note-off that names a note: gives its channel and key, once for each time it began. The press of one whose key was
    /// struck again counts, too.
    pub fn lift(&mut self, id: i32) -> Option<(u8, u8)> {
        let held = |voice: &&mut Voice| voice.id == id && voice.down;
        let all = self.notes.iter_mut().chain(&mut self.presses).flatten();
        let voice = all.filter(held).max_by_key(|voice| voice.age)?;
        voice.down = false;
        Some((voice.channel, voice.key))
    }

    /// Every key is up: a note-off that comes after all is not one of a note that has the same key from now on.
    pub fn lift_all(&mut self) {
        self.lift_keys(&(0..=15), &(0..=127));
    }

    /// Every key of these channels is up, however often it went down.
    pub fn lift_keys(&mut self, channels: &RangeInclusive<u8>, keys: &RangeInclusive<u8>) {
        for voice in self.notes.iter_mut().chain(&mut self.presses).flatten() {
            voice.down &= !(channels.contains(&voice.channel) && keys.contains(&voice.key));
        }
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

/// Puts a note in a free place, which counts as older than all, or in that of the oldest.
fn remember(places: &mut [Option<Voice>], voice: Voice) {
    if let Some(place) = places.iter_mut().min_by_key(|place| place.map(|voice| voice.age)) {
        *place = Some(voice);
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
            voices.end(0, |_, key| key == 40, &mut |_| true);
            assert_eq!((voices.find(1000), voices.find(id)), (Some((0, 40)), None));
        }
    }

    /// Hosts take the events of a block in order: a note has begun, and a key was struck again, before that is told.
    #[test]
    fn a_note_ends_at_the_last_sample_of_its_block() {
        let mut voices = Voices::default();
        for (id, key) in [(1, 40), (2, 40), (3, 50)] {
            voices.begin(id, 0, key);
        }
        let mut told = Vec::new();
        voices.end(511, |_, key| key == 40, &mut |event| {
            told.push((event.timing(), event.voice_id()));
            true
        });
        assert_eq!(told, [(511, Some(VoiceID::ID(1))), (511, Some(VoiceID::ID(3)))]);
    }

    #[test]
    fn the_latest_counts_wherever_it_is_kept() {
        let mut voices = Voices::default();
        voices.begin(1, 0, 40);
        voices.begin(2, 0, 50);
        voices.end(0, |_, key| key != 40, &mut |_| true);
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
