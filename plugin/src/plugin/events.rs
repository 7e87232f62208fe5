//! A host's events in the player's words.

use std::ops::RangeInclusive;

use nice_plug::midi::{Channel, Key, VoiceID};
use nice_plug::prelude::*;

use crate::params::{LowActionParams, poly};
use crate::performance::{Expression, PlayerEvent};

/// The softest note there is, as a velocity: the smallest of MIDI's that is not a note-off.
const SOFTEST: f32 = 1.0 / 127.0;

/// How many notes are remembered by the number a host gave them; more than strings can sound.
const REMEMBERED: usize = 64;

/// The notes of a host that numbers them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Voices {
    /// Number, channel and key, the latest overwriting the oldest.
    notes: [Option<(i32, u8, u8)>; REMEMBERED],
    next: usize,
}

impl Default for Voices {
    fn default() -> Self {
        Self { notes: [None; REMEMBERED], next: 0 }
    }
}

impl Voices {
    fn begin(&mut self, id: i32, channel: u8, key: u8) {
        self.notes[self.next] = Some((id, channel, key));
        self.next = (self.next + 1) % REMEMBERED;
    }

    /// Forgets the notes that sound no more and those struck again under another number, telling of each.
    pub fn end(&mut self, sounds: impl Fn(u8, u8) -> bool, send: &mut impl FnMut(NoteEvent<()>) -> bool) {
        for index in 0..REMEMBERED {
            let Some((id, channel, key)) = self.notes[index] else { continue };
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
        (1..=REMEMBERED)
            .filter_map(|back| self.notes[(self.next + REMEMBERED - back) % REMEMBERED])
            .find(|note| (note.1, note.2) == (channel, key))
            .map(|(id, ..)| id)
    }

    /// Channel and key of a note; the latest if its number was used again.
    fn find(&self, id: i32) -> Option<(u8, u8)> {
        (1..=REMEMBERED)
            .filter_map(|back| self.notes[(self.next + REMEMBERED - back) % REMEMBERED])
            .find(|(other, ..)| *other == id)
            .map(|(_, channel, key)| (channel, key))
    }
}

/// Whom an event is meant for.
struct Address {
    voice: VoiceID,
    channel: Channel,
    key: Key,
}

impl Address {
    /// All channels and keys meant; a host may name a note by its number alone.
    fn notes(&self, voices: &Voices) -> (RangeInclusive<u8>, RangeInclusive<u8>) {
        let (channel, key) = match (self.voice, self.channel, self.key) {
            (VoiceID::ID(id), Channel::Wildcard, _) | (VoiceID::ID(id), _, Key::Wildcard) => {
                match voices.find(id) {
                    Some((channel, key)) => (Channel::Number(channel), Key::Number(key)),
                    None => (self.channel, self.key),
                }
            }
            _ => (self.channel, self.key),
        };
        let channels = match channel {
            Channel::Number(number) => number..=number,
            Channel::Wildcard => 0..=15,
        };
        let keys = match key {
            Key::Number(number) => number..=number,
            Key::Wildcard => 0..=127,
        };
        (channels, keys)
    }

    /// Says something of every note meant.
    fn each(&self, voices: &Voices, mut say: impl FnMut(u8, u8)) {
        let (channels, keys) = self.notes(voices);
        channels.for_each(|channel| keys.clone().for_each(|key| say(channel, key)));
    }
}

/// Hands an event on, at its sample.
pub(super) fn translate(
    event: NoteEvent<()>,
    params: &LowActionParams,
    voices: &mut Voices,
    mut send: impl FnMut(u32, PlayerEvent),
) {
    let at = event.timing();
    let mut express = |voices: &Voices, address: Address, expression| {
        address.each(voices, |channel, key| send(at, PlayerEvent::Note { channel, key, expression }));
    };
    match event {
        NoteEvent::NoteOn { voice_id, channel, key: Key::Number(key), velocity, .. } => {
            let channel = channel.number().unwrap_or(0);
            if let VoiceID::ID(id) = voice_id {
                voices.begin(id, channel, key);
            }
            // A host's velocity of 0 is a very soft note; only in MIDI's bytes it lifts the key, and
            // the framework has turned those into note-offs. `max` also catches what is not a number.
            let velocity = velocity.max(SOFTEST);
            send(at, PlayerEvent::NoteOn { channel, key, velocity });
        }
        NoteEvent::NoteOff {
            voice_id: VoiceID::Wildcard,
            channel: Channel::Wildcard,
            key: Key::Wildcard,
            ..
        }
        | NoteEvent::Choke {
            voice_id: VoiceID::Wildcard,
            channel: Channel::Wildcard,
            key: Key::Wildcard,
            ..
        } => {
            send(at, PlayerEvent::AllNotesOff);
        }
        // A string has no faster way to stop than a finger put on it, so a choke is a note-off.
        NoteEvent::NoteOff { voice_id: voice, channel, key, .. }
        | NoteEvent::Choke { voice_id: voice, channel, key, .. } => {
            let address = Address { voice, channel, key };
            address.each(voices, |channel, key| send(at, PlayerEvent::NoteOff { channel, key }));
        }
        NoteEvent::PolyPressure { voice_id: voice, channel, key, pressure, .. } => {
            express(voices, Address { voice, channel, key }, Expression::Pressure(pressure));
        }
        NoteEvent::PolyTuning { voice_id: voice, channel, key, tuning, .. } => {
            express(voices, Address { voice, channel, key }, Expression::Tuning(tuning));
        }
        NoteEvent::PolyVibrato { voice_id: voice, channel, key, vibrato, .. } => {
            express(voices, Address { voice, channel, key }, Expression::Vibrato(vibrato));
        }
        NoteEvent::PolyBrightness { voice_id: voice, channel, key, brightness, .. } => {
            express(voices, Address { voice, channel, key }, Expression::Brightness(brightness));
        }
        NoteEvent::PolyExpression { voice_id: voice, channel, key, expression, .. } => {
            express(voices, Address { voice, channel, key }, Expression::PluckForce(expression));
        }
        NoteEvent::PolyModulation { voice_id, poly_modulation_id, normalized_offset, .. } => {
            let address =
                Address { voice: VoiceID::ID(voice_id), channel: Channel::Wildcard, key: Key::Wildcard };
            if voices.find(voice_id).is_some()
                && let Some(expression) = modulated(params, poly_modulation_id, normalized_offset)
            {
                express(voices, address, expression);
            }
        }
        NoteEvent::MidiCC { channel, cc: number, value, .. } => {
            send(at, PlayerEvent::Controller { channel, number, value });
        }
        NoteEvent::MidiPitchBend { channel, value, .. } => {
            send(at, PlayerEvent::PitchBend { channel, value: signed_bend(value) });
        }
        NoteEvent::MidiChannelPressure { channel, pressure, .. } => {
            send(at, PlayerEvent::ChannelPressure { channel, pressure });
        }
        _ => {}
    }
}

/// What a note has for itself when a parameter is moved by `offset` (of the host's 0 to 1) for it alone.
fn modulated(params: &LowActionParams, id: u32, offset: f32) -> Option<Expression> {
    let player = &params.player;
    let value = |param: &FloatParam| {
        param.preview_plain((param.unmodulated_normalized_value() + offset).clamp(0.0, 1.0))
    };
    // Relative to what holds for all, which the player adds.
    Some(match id {
        poly::PLUCK_POSITION => {
            let param = &player.pluck_position;
            Expression::PluckPlace(1e-3 * (value(param) - param.value()))
        }
        poly::PLUCK_FORCE => Expression::PluckForce(value(&player.pluck_force) / player.pluck_force.value()),
        poly::FINGER_FORCE => {
            Expression::FingerForce(value(&player.finger_force) / player.finger_force.value())
        }
        _ => return None,
    })
}

/// A pitch bend of −1 to 1 out of the framework's 0 to 1.
///
/// MIDI's 14 bits have their centre at 8192 of 0 to 16383, which is not the middle of 0 to 1: going back to
/// the 14 bits makes the centre exactly no bend, and every position the same number as in a MIDI file.
fn signed_bend(value: f32) -> f32 {
    let steps = (value * 16383.0).round() - 8192.0;
    if steps < 0.0 { steps / 8192.0 } else { steps / 8191.0 }
}

#[cfg(test)]
mod tests {
    use super::signed_bend;

    #[test]
    fn bends_are_those_of_a_midi_file() {
        for raw in 0..16384_u16 {
            let steps = f32::from(raw) - 8192.0;
            let expected = if steps < 0.0 { steps / 8192.0 } else { steps / 8191.0 };
            assert_eq!(signed_bend(f32::from(raw) / 16383.0), expected);
        }
        // A VST3 host's centre.
        assert_eq!(signed_bend(0.5), 0.0);
    }
}
