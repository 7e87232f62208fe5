//! Whom events are meant for, and what they become.

use super::*;
use crate::performance::Channels;

/// No channel speaks for others.
const NOBODY: Spoken = Spoken { by: 0, of: Channels::NONE };

/// What becomes of a note's end that names the note by its number alone.
fn ended(voices: &mut Voices, id: i32) -> Vec<PlayerEvent> {
    ended_at(voices, id, Channel::Wildcard, Key::Wildcard)
}

fn ended_at(voices: &mut Voices, id: i32, channel: Channel, key: Key) -> Vec<PlayerEvent> {
    let voice_id = VoiceID::ID(id);
    translated(voices, NoteEvent::NoteOff { timing: 0, voice_id, channel, key, velocity: 0.0 })
}

/// The same of a choke.
fn choked(voices: &mut Voices, id: i32) -> Vec<PlayerEvent> {
    choked_at(voices, id, Channel::Wildcard, Key::Wildcard)
}

fn choked_at(voices: &mut Voices, id: i32, channel: Channel, key: Key) -> Vec<PlayerEvent> {
    translated(voices, NoteEvent::Choke { timing: 0, voice_id: VoiceID::ID(id), channel, key })
}

fn translated(voices: &mut Voices, event: NoteEvent<()>) -> Vec<PlayerEvent> {
    translated_in(NOBODY, voices, event)
}

/// Where channels are notes of MPE, or not.
fn translated_in(spoken: Spoken, voices: &mut Voices, event: NoteEvent<()>) -> Vec<PlayerEvent> {
    let mut sent = Vec::new();
    translate(event, &LowActionParams::default(), spoken, voices, |_, event| sent.push(event));
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
    let wildcard = NoteEvent::NoteOff { timing: 0, voice_id, channel: Channel::Wildcard, key, velocity: 0.0 };
    let channel = Channel::Number(2);
    let of_channel = NoteEvent::NoteOff { timing: 0, voice_id, channel, key, velocity: 0.0 };
    for all in [controller(2, 120), controller(2, 123), controller(2, 127), wildcard, of_channel] {
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

/// A host's note-off means the channel that it names; a controller of one that speaks for others, as the first one in MPE, all these.
#[test]
fn only_controllers_of_the_channel_that_speaks_for_all_let_go_of_all() {
    let (voice_id, key) = (VoiceID::Wildcard, Key::Wildcard);
    let of_channel = |channel| {
        let channel = Channel::Number(channel);
        NoteEvent::NoteOff { timing: 0, voice_id, channel, key, velocity: 0.0 }
    };
    let few = |count| Channels::announced(Some(count), None);
    let speaks = [(0, Channels::NONE), (0, few(1)), (0, few(2)), (0, Channels::MEMBERS), (15, few(2))];
    for (by, of) in speaks {
        let spoken = Spoken { by, of };
        // Whether a note of another channel is still known as one whose note-off is to come.
        let left = |event: NoteEvent<()>| {
            let mut voices = Voices::default();
            voices.begin(1, 2, 45);
            translated_in(spoken, &mut voices, event);
            // Its key goes down again in the same block.
            voices.begin(2, 2, 45);
            !ended(&mut voices, 1).is_empty()
        };
        for cc in [120, 123, 127] {
            let controller = |channel| NoteEvent::MidiCC { timing: 0, channel, cc, value: 0.0 };
            assert_eq!(left(controller(by)), !of.has(2), "{cc}, {spoken:?}");
            assert!(left(controller(15 - by)), "{cc}, {spoken:?}");
            assert!(left(controller(3)) && !left(controller(2)), "{cc}");
        }
        assert!(left(of_channel(by)) && !left(of_channel(2)));
        let sent = translated_in(spoken, &mut Voices::default(), of_channel(0));
        assert_eq!(sent, [PlayerEvent::KeysOff { channel: 0 }]);
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

/// A number says which of the notes of a key is meant, also where the key is named with it.
#[test]
fn a_number_counts_before_the_key_that_is_named_with_it() {
    let (channel, key) = (Channel::Number(2), Key::Number(45));
    let lifted = [PlayerEvent::NoteOff { channel: 2, key: 45 }];
    // The first was let go of with all others, and its note-off comes in the same block as the next note, or later.
    for told in [false, true] {
        let mut voices = Voices::default();
        voices.begin(1, 2, 45);
        translated(&mut voices, NoteEvent::MidiCC { timing: 0, channel: 2, cc: 123, value: 0.0 });
        if told {
            voices.end(0, |_, _| false, &mut |_| true);
        }
        voices.begin(2, 2, 45);
        assert_eq!(ended_at(&mut voices, 1, channel, key), [], "told {told}");
        assert_eq!(choked_at(&mut voices, 1, channel, key), [], "told {told}");
        assert_eq!(ended_at(&mut voices, 2, channel, key), lifted, "told {told}");
        assert_eq!(ended_at(&mut voices, 2, channel, key), [], "told {told}, again");
    }
    // It was struck again: its choke lifts its own press, and what is expressed for it is past.
    for told in [false, true] {
        let mut voices = Voices::default();
        for id in [1, 2] {
            voices.begin(id, 2, 45);
            if told {
                voices.end(0, |_, _| true, &mut |_| true);
            }
        }
        let pressure =
            |voice_id| NoteEvent::PolyPressure { timing: 0, voice_id, channel, key, pressure: 1.0 };
        assert_eq!(translated(&mut voices, pressure(VoiceID::ID(1))), [], "told {told}");
        assert_eq!(translated(&mut voices, pressure(VoiceID::ID(2))).len(), 1, "told {told}");
        assert_eq!(choked_at(&mut voices, 1, channel, key), lifted, "told {told}");
        assert_eq!(choked_at(&mut voices, 2, channel, key), [PlayerEvent::NoteEnd { channel: 2, key: 45 }]);
    }
    // Where nobody knows it, and no other note has the key, the key counts.
    let mut voices = Voices::default();
    assert_eq!(ended_at(&mut voices, 1, channel, key), lifted);
    assert_eq!(choked_at(&mut voices, 1, channel, key), [PlayerEvent::NoteEnd { channel: 2, key: 45 }]);
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
        translate(event, &params, NOBODY, &mut voices, |_, event| sent.push(event));
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
    let after = factor(NoteEvent::MonoAutomation { timing: 0, poly_modulation_id, normalized_value: 0.9 });
    // There is hardly room for more.
    assert!(before > 1.2 && after > 1.0 && after < before, "{before}, {after}");
}

#[test]
fn bends_are_those_of_a_midi_file() {
    for raw in 0..16384_u16 {
        assert_eq!(signed_bend(f32::from(raw) / 16383.0), pitch_wheel::turn(f32::from(raw)));
    }
    // A VST3 host's centre.
    assert_eq!(signed_bend(0.5), 0.0);
}
