//! A host's events in the player's words.

#[cfg(test)]
mod tests;

use std::ops::RangeInclusive;

use nice_plug::midi::{Channel, Key, VoiceID};
use nice_plug::prelude::*;

use super::voices::Voices;
use crate::params::{LowActionParams, poly};
use crate::performance::controller::{KEYS_OFF, LAST, SILENCE};
use crate::performance::{Expression, PlayerEvent, Spoken};
use crate::pitch_wheel;

/// The softest note there is, as a velocity: the smallest of MIDI's that is not a note-off.
const SOFTEST: f32 = 1.0 / 127.0;

/// Whom an event is meant for.
struct Address {
    voice: VoiceID,
    channel: Channel,
    key: Key,
}

impl Address {
    /// All channels and keys meant. A number means its note, which is at `found`, whatever else is said. One that nobody has
    /// any more means nobody, or the note of the key that is named with it, if that has no other number.
    fn notes(
        &self,
        voices: &Voices,
        found: Option<(u8, u8)>,
    ) -> Option<(RangeInclusive<u8>, RangeInclusive<u8>)> {
        let (channel, key) = match (self.voice, found) {
            (VoiceID::ID(_), Some((channel, key))) => (Channel::Number(channel), Key::Number(key)),
            (VoiceID::ID(id), None) => match (self.channel, self.key) {
                (Channel::Number(channel), Key::Number(key)) if voices.is_another(id, channel, key) => {
                    return None;
                }
                (Channel::Number(_), Key::Number(_)) => (self.channel, self.key),
                _ => return None,
            },
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
        Some((channels, keys))
    }

    /// The same of the note that its number has now.
    fn present(&self, voices: &Voices) -> Option<(RangeInclusive<u8>, RangeInclusive<u8>)> {
        let found = self.voice.id().and_then(|id| voices.find(id));
        self.notes(voices, found)
    }
}

/// The only number of a range, if it has no other.
fn single(range: &RangeInclusive<u8>) -> Option<u8> {
    (range.start() == range.end()).then_some(*range.start())
}

/// Hands an event on, at its sample. A channel may speak for others, as in MPE the first one for its members.
pub(super) fn translate(
    event: NoteEvent<()>,
    params: &LowActionParams,
    spoken: Spoken,
    voices: &mut Voices,
    mut send: impl FnMut(u32, PlayerEvent),
) {
    let at = event.timing();
    let mut send = |event| send(at, event);
    if let Some((address, expression)) = expression(&event) {
        return express(address, expression, voices, send);
    }
    match event {
        NoteEvent::NoteOn { voice_id, channel, key: Key::Number(key), velocity, .. } => {
            let channel = channel.number().unwrap_or(0);
            if let VoiceID::ID(id) = voice_id {
                voices.begin(id, channel, key);
            }
            // A host's velocity of 0 is a very soft note; only in MIDI's bytes it lifts the key, and
            // the framework has turned those into note-offs. `max` also catches what is not a number.
            let velocity = velocity.max(SOFTEST);
            send(PlayerEvent::NoteOn { channel, key, velocity });
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
            voices.lift_all();
            send(PlayerEvent::AllNotesOff);
        }
        NoteEvent::NoteOff { voice_id: voice, channel, key, .. } => {
            lift(Address { voice, channel, key }, voices, send);
        }
        NoteEvent::Choke { voice_id: voice, channel, key, .. } => {
            choke(Address { voice, channel, key }, voices, send);
        }
        NoteEvent::PolyModulation { voice_id, poly_modulation_id, normalized_offset, .. } => {
            let address =
                Address { voice: VoiceID::ID(voice_id), channel: Channel::Wildcard, key: Key::Wildcard };
            voices.modulate(voice_id, poly_modulation_id, normalized_offset);
            if let Some(expression) = modulated(params, poly_modulation_id, normalized_offset) {
                express(address, expression, voices, send);
            }
        }
        // What holds for all has changed, and with it what the same offset means for one.
        NoteEvent::MonoAutomation { poly_modulation_id, .. } => {
            for (channel, key, offset) in voices.modulated(poly_modulation_id) {
                if let Some(expression) = modulated(params, poly_modulation_id, offset) {
                    send(PlayerEvent::Note { channel, key, expression });
                }
            }
        }
        NoteEvent::MidiCC { channel, cc: number, value, .. } => {
            // All sound off, all notes off, and the four mode messages that imply it.
            if matches!(number, SILENCE | KEYS_OFF..=LAST) {
                let others = spoken.with(channel);
                let meant = |&own: &u8| own == channel || others.has(own);
                (0..=15).filter(meant).for_each(|own| voices.lift_keys(&(own..=own), &(0..=127)));
            }
            send(PlayerEvent::Controller { channel, number, value });
        }
        NoteEvent::MidiPitchBend { channel, value, .. } => {
            send(PlayerEvent::PitchBend { channel, value: signed_bend(value) });
        }
        NoteEvent::MidiChannelPressure { channel, pressure, .. } => {
            send(PlayerEvent::ChannelPressure { channel, pressure });
        }
        _ => {}
    }
}

/// Lifts the keys meant: of one key a press, of all keys of a channel every one.
fn lift(address: Address, voices: &mut Voices, mut send: impl FnMut(PlayerEvent)) {
    let lifted = address.voice.id().and_then(|id| voices.lift(id));
    let Some((channels, keys)) = address.notes(voices, lifted) else { return };
    if single(&keys).is_none() {
        voices.lift_keys(&channels, &keys);
    }
    for channel in channels {
        send(match single(&keys) {
            Some(key) => PlayerEvent::NoteOff { channel, key },
            // No controller: in MPE the first channel's would lift the keys of all.
            None => PlayerEvent::KeysOff { channel },
        });
    }
}

/// Ends the notes meant. A string has no faster way to stop than a finger put on it, so a choke is a note-off for every press,
/// and for pedals.
fn choke(address: Address, voices: &mut Voices, mut send: impl FnMut(PlayerEvent)) {
    if let Some((channels, keys)) = address.present(voices) {
        voices.lift_keys(&channels, &keys);
        for channel in channels {
            keys.clone().for_each(|key| send(PlayerEvent::NoteEnd { channel, key }));
        }
    } else if let Some((channel, key)) = address.voice.id().and_then(|id| voices.lift(id)) {
        // It was struck again: what sounds is another note's.
        send(PlayerEvent::NoteOff { channel, key });
    }
}

/// What an event says of notes that there are, and of which.
fn expression(event: &NoteEvent<()>) -> Option<(Address, Expression)> {
    let (voice, channel, key, expression) = match *event {
        NoteEvent::PolyPressure { voice_id, channel, key, pressure, .. } => {
            (voice_id, channel, key, Expression::Pressure(pressure))
        }
        NoteEvent::PolyTuning { voice_id, channel, key, tuning, .. } => {
            (voice_id, channel, key, Expression::Tuning(tuning))
        }
        NoteEvent::PolyVibrato { voice_id, channel, key, vibrato, .. } => {
            (voice_id, channel, key, Expression::Vibrato(vibrato))
        }
        NoteEvent::PolyBrightness { voice_id, channel, key, brightness, .. } => {
            (voice_id, channel, key, Expression::Brightness(brightness))
        }
        NoteEvent::PolyExpression { voice_id, channel, key, expression, .. } => {
            (voice_id, channel, key, Expression::Swell(expression))
        }
        NoteEvent::PolyVolume { voice_id, channel, key, gain, .. } => {
            (voice_id, channel, key, Expression::Gain(gain))
        }
        _ => return None,
    };
    Some((Address { voice, channel, key }, expression))
}

/// Says something of the notes meant, in one event however many they are: there is room for so many.
fn express(address: Address, expression: Expression, voices: &Voices, mut send: impl FnMut(PlayerEvent)) {
    let Some((channels, keys)) = address.present(voices) else { return };
    let [channel, key] = [single(&channels), single(&keys)];
    send(match (channel, key) {
        (Some(channel), Some(key)) => PlayerEvent::Note { channel, key, expression },
        _ => PlayerEvent::Notes { channel, key, expression },
    });
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
/// The centre of MIDI's 14 bits is not the middle of 0 to 1: going back to them makes it exactly no bend, and every position
/// the same number as in a MIDI file.
fn signed_bend(value: f32) -> f32 {
    pitch_wheel::turn((value * 16383.0).round())
}
