//! A host's events in the player's words.

use std::ops::RangeInclusive;

use nice_plug::midi::{Channel, Key, VoiceID};
use nice_plug::prelude::*;

use super::voices::Voices;
use crate::params::{LowActionParams, poly};
use crate::performance::{Expression, PlayerEvent};

/// The softest note there is, as a velocity: the smallest of MIDI's that is not a note-off.
const SOFTEST: f32 = 1.0 / 127.0;

/// Whom an event is meant for.
struct Address {
    voice: VoiceID,
    channel: Channel,
    key: Key,
}

impl Address {
    /// The number of a note that nothing else names.
    fn number(&self) -> Option<i32> {
        match (self.voice, self.channel, self.key) {
            (VoiceID::ID(id), Channel::Wildcard, _) | (VoiceID::ID(id), _, Key::Wildcard) => Some(id),
            _ => None,
        }
    }

    /// All channels and keys meant; a host may name a note by its number alone, which `find` looks up. A number that
    /// nobody has any more means nobody.
    fn notes(
        &self,
        find: impl FnOnce(i32) -> Option<(u8, u8)>,
    ) -> Option<(RangeInclusive<u8>, RangeInclusive<u8>)> {
        let (channel, key) = match self.number() {
            Some(id) => {
                let (channel, key) = find(id)?;
                (Channel::Number(channel), Key::Number(key))
            }
            None => (self.channel, self.key),
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

    /// Says something of every note meant.
    fn each(&self, find: impl FnOnce(i32) -> Option<(u8, u8)>, mut say: impl FnMut(u8, u8)) {
        let Some((channels, keys)) = self.notes(find) else { return };
        channels.for_each(|channel| keys.clone().for_each(|key| say(channel, key)));
    }
}

/// The only number of a range, if it has no other.
fn single(range: &RangeInclusive<u8>) -> Option<u8> {
    (range.start() == range.end()).then_some(*range.start())
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
        let Some((channels, keys)) = address.notes(|id| voices.find(id)) else { return };
        let [channel, key] = [single(&channels), single(&keys)];
        // One event, however many notes are meant: there is room for so many.
        send(
            at,
            match (channel, key) {
                (Some(channel), Some(key)) => PlayerEvent::Note { channel, key, expression },
                _ => PlayerEvent::Notes { channel, key, expression },
            },
        );
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
            voices.lift_all();
            send(at, PlayerEvent::AllNotesOff);
        }
        NoteEvent::NoteOff { voice_id: voice, channel, key, .. } => {
            let lifted = if let VoiceID::ID(id) = voice { voices.lift(id) } else { None };
            let address = Address { voice, channel, key };
            address.each(|_| lifted, |channel, key| send(at, PlayerEvent::NoteOff { channel, key }));
        }
        // A string has no faster way to stop than a finger put on it, so a choke is a note-off for every press, and for pedals.
        NoteEvent::Choke { voice_id: voice, channel, key, .. } => {
            let address = Address { voice, channel, key };
            if let Some((channels, keys)) = address.notes(|id| voices.find(id)) {
                voices.lift_keys(&channels, &keys);
                for channel in channels {
                    keys.clone().for_each(|key| send(at, PlayerEvent::NoteEnd { channel, key }));
                }
            } else if let Some((channel, key)) = address.number().and_then(|id| voices.lift(id)) {
                // It was struck again: what sounds is another note's.
                send(at, PlayerEvent::NoteOff { channel, key });
            }
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
            voices.modulate(voice_id, poly_modulation_id, normalized_offset);
            if let Some(expression) = modulated(params, poly_modulation_id, normalized_offset) {
                express(voices, address, expression);
            }
        }
        // What holds for all has changed, and with it what the same offset means for one.
        NoteEvent::MonoAutomation { poly_modulation_id, .. } => {
            for (channel, key, offset) in voices.modulated(poly_modulation_id) {
                if let Some(expression) = modulated(params, poly_modulation_id, offset) {
                    send(at, PlayerEvent::Note { channel, key, expression });
                }
            }
        }
        NoteEvent::MidiCC { channel, cc: number, value, .. } => {
            // All sound off, all notes off, and the four mode messages that imply it.
            if matches!(number, 120 | 123..=127) {
                voices.lift_keys(&(channel..=channel), &(0..=127));
            }
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
    use super::*;

    /// What becomes of a note's end that names the note by its number alone.
    fn ended(voices: &mut Voices, id: i32) -> Vec<PlayerEvent> {
        let (voice_id, channel, key) = (VoiceID::ID(id), Channel::Wildcard, Key::Wildcard);
        translated(voices, NoteEvent::NoteOff { timing: 0, voice_id, channel, key, velocity: 0.0 })
    }

    /// The same of a choke.
    fn choked(voices: &mut Voices, id: i32) -> Vec<PlayerEvent> {
        let (voice_id, channel, key) = (VoiceID::ID(id), Channel::Wildcard, Key::Wildcard);
        translated(voices, NoteEvent::Choke { timing: 0, voice_id, channel, key })
    }

    fn translated(voices: &mut Voices, event: NoteEvent<()>) -> Vec<PlayerEvent> {
        let mut sent = Vec::new();
        translate(event, &LowActionParams::default(), voices, |_, event| sent.push(event));
        sent
    }

    #[test]
    fn a_number_that_nobody_has_means_nobody() {
        let mut voices = Voices::default();
        voices.begin(7, 2, 45);
        assert_eq!(ended(&mut voices, 8), []);
        assert_eq!(ended(&mut voices, 7), [PlayerEvent::NoteOff { channel: 2, key: 45 }]);
    }

    /// However many notes are meant: many events would leave no room for others.
    #[test]
    fn what_is_said_of_all_notes_is_one_event() {
        let mut voices = Voices::default();
        let mut said = |channel, key| {
            let (timing, voice_id, tuning) = (0, VoiceID::Wildcard, 0.5);
            translated(&mut voices, NoteEvent::PolyTuning { timing, voice_id, channel, key, tuning })
        };
        let expression = Expression::Tuning(0.5);
        let all = PlayerEvent::Notes { channel: None, key: None, expression };
        assert_eq!(said(Channel::Wildcard, Key::Wildcard), [all]);
        let some = PlayerEvent::Notes { channel: Some(3), key: None, expression };
        assert_eq!(said(Channel::Number(3), Key::Wildcard), [some]);
        let one = PlayerEvent::Note { channel: 3, key: 60, expression };
        assert_eq!(said(Channel::Number(3), Key::Number(60)), [one]);
    }

    #[test]
    fn a_number_that_was_struck_again_still_has_its_note_off() {
        let lifted = [PlayerEvent::NoteOff { channel: 2, key: 45 }];
        let mut voices = Voices::default();
        let mut told = Vec::new();
        let mut block = |voices: &mut Voices, sounds| {
            voices.end(0, |_, _| sounds, &mut |event| {
                told.push(event.voice_id());
                true
            });
        };
        for id in [1, 2, 3] {
            voices.begin(id, 2, 45);
            block(&mut voices, true);
        }
        // In any order, each once.
        for id in [2, 1, 3] {
            assert_eq!(ended(&mut voices, id), lifted, "{id}");
            assert_eq!(ended(&mut voices, id), [], "{id} again");
            block(&mut voices, true);
        }
        // What is over is forgotten.
        voices.begin(4, 2, 45);
        block(&mut voices, true);
        block(&mut voices, false);
        block(&mut voices, false);
        assert_eq!(ended(&mut voices, 4), []);
        assert_eq!(told, [1, 2, 3, 4].map(|id| Some(VoiceID::ID(id))));
    }

    /// The note-off of one that was let go of with all others lifts no key that has been struck since.
    #[test]
    fn what_was_let_go_of_with_all_others_is_let_go_of_once() {
        let controller = |channel, cc| NoteEvent::MidiCC { timing: 0, channel, cc, value: 0.0 };
        let (voice_id, key) = (VoiceID::Wildcard, Key::Wildcard);
        let wildcard =
            NoteEvent::NoteOff { timing: 0, voice_id, channel: Channel::Wildcard, key, velocity: 0.0 };
        for all in [controller(2, 120), controller(2, 123), controller(2, 127), wildcard] {
            let mut voices = Voices::default();
            voices.begin(1, 2, 45);
            assert_eq!(translated(&mut voices, all).len(), 1);
            voices.begin(2, 2, 45);
            assert_eq!(ended(&mut voices, 1), [], "{all:?}");
            assert_eq!(ended(&mut voices, 2), [PlayerEvent::NoteOff { channel: 2, key: 45 }], "{all:?}");
        }
        for other in [controller(3, 123), controller(2, 121)] {
            let mut voices = Voices::default();
            voices.begin(1, 2, 45);
            assert_eq!(translated(&mut voices, other).len(), 1);
            assert_eq!(ended(&mut voices, 1), [PlayerEvent::NoteOff { channel: 2, key: 45 }], "{other:?}");
        }
    }

    #[test]
    fn a_choke_ends_its_own_note_alone() {
        let mut voices = Voices::default();
        for id in [1, 2] {
            voices.begin(id, 2, 45);
            voices.end(0, |_, _| true, &mut |_| true);
        }
        let mut other = voices;
        // Of the one that was struck again, only its press is left.
        assert_eq!(choked(&mut voices, 1), [PlayerEvent::NoteOff { channel: 2, key: 45 }]);
        assert_eq!(ended(&mut voices, 2), [PlayerEvent::NoteOff { channel: 2, key: 45 }]);
        // The one that sounds takes all presses with it.
        assert_eq!(choked(&mut other, 2), [PlayerEvent::NoteEnd { channel: 2, key: 45 }]);
        assert_eq!(ended(&mut other, 1), []);
    }

    #[test]
    fn automation_moves_what_a_note_has_for_itself_along() {
        let (params, mut voices) = (LowActionParams::default(), Voices::default());
        voices.begin(7, 2, 45);
        voices.begin(8, 2, 50);
        let poly_modulation_id = poly::FINGER_FORCE;
        let moved =
            NoteEvent::PolyModulation { timing: 0, voice_id: 7, poly_modulation_id, normalized_offset: 0.2 };
        let mut factor = |event| {
            let mut sent = Vec::new();
            translate(event, &params, &mut voices, |_, event| sent.push(event));
            match sent[..] {
                [PlayerEvent::Note { channel: 2, key: 45, expression: Expression::FingerForce(factor) }] => {
                    factor
                }
                _ => panic!("{sent:?}"),
            }
        };
        let before = factor(moved);
        // SAFETY: the parameter lives on.
        unsafe { params.player.finger_force.as_ptr()._internal_set_normalized_value(0.9) };
        let after =
            factor(NoteEvent::MonoAutomation { timing: 0, poly_modulation_id, normalized_value: 0.9 });
        // There is hardly room for more.
        assert!(before > 1.2 && after > 1.0 && after < before, "{before}, {after}");
    }

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
