//! What a CLAP host says to players, in the framework's words: what that does itself, and keeps to itself.

use clap_sys::events::*;
use nice_plug::midi::{Channel, Key, VoiceID};
use nice_plug::prelude::*;

use super::in_order::events;
use super::modulated::Modulated;

/// All that a list brings for players.
///
/// # Safety
/// It must be null or a host's.
pub(super) unsafe fn each(
    list: *const clap_input_events,
    modulated: &Modulated,
    take: impl FnMut(NoteEvent<()>),
) {
    // SAFETY: as above; hosts give pointers to events, or none.
    unsafe {
        let events = list.as_ref().into_iter().flat_map(|list| events(list));
        events.filter_map(|event| note_event(event.as_ref()?, modulated)).for_each(take);
    }
}

/// Whom a host means by numbers of which those below zero mean all.
fn address(note: i32, channel: i16, key: i16) -> (VoiceID, Channel, Key) {
    let number = |number: i16, count: u8| u8::try_from(number).ok().filter(|&number| number < count);
    (
        if note >= 0 { VoiceID::ID(note) } else { VoiceID::Wildcard },
        number(channel, 16).map_or(Channel::Wildcard, Channel::Number),
        number(key, 128).map_or(Key::Wildcard, Key::Number),
    )
}

/// An event, if it is one for players.
///
/// # Safety
/// It must be of the type that it says.
unsafe fn note_event(event: &clap_event_header, modulated: &Modulated) -> Option<NoteEvent<()>> {
    if event.space_id != CLAP_CORE_EVENT_SPACE_ID {
        return None;
    }
    let (timing, event) = (event.time, &raw const *event);
    // SAFETY: it is of this type, each time.
    unsafe {
        match (*event).type_ {
            kind @ (CLAP_EVENT_NOTE_ON | CLAP_EVENT_NOTE_OFF | CLAP_EVENT_NOTE_CHOKE) => {
                let note = &*event.cast::<clap_event_note>();
                let (voice_id, channel, key) = address(note.note_id, note.channel, note.key);
                let velocity = note.velocity as f32;
                Some(match kind {
                    CLAP_EVENT_NOTE_ON => NoteEvent::NoteOn { timing, voice_id, channel, key, velocity },
                    CLAP_EVENT_NOTE_OFF => NoteEvent::NoteOff { timing, voice_id, channel, key, velocity },
                    _ => NoteEvent::Choke { timing, voice_id, channel, key },
                })
            }
            CLAP_EVENT_NOTE_EXPRESSION => expression(&*event.cast::<clap_event_note_expression>()),
            CLAP_EVENT_MIDI => NoteEvent::from_midi(timing, &(*event.cast::<clap_event_midi>()).data).ok(),
            CLAP_EVENT_PARAM_MOD => {
                let said = &*event.cast::<clap_event_param_mod>();
                let (poly_modulation_id, steps) = modulated.by_note(said.param_id)?;
                let normalized_offset = said.amount as f32 / steps;
                let voice_id = said.note_id;
                (voice_id != -1).then_some(NoteEvent::PolyModulation {
                    timing,
                    voice_id,
                    poly_modulation_id,
                    normalized_offset,
                })
            }
            CLAP_EVENT_PARAM_VALUE => {
                let said = &*event.cast::<clap_event_param_value>();
                let (poly_modulation_id, steps) = modulated.by_note(said.param_id)?;
                let normalized_value = said.value as f32 / steps;
                Some(NoteEvent::MonoAutomation { timing, poly_modulation_id, normalized_value })
            }
            _ => None,
        }
    }
}

/// What is said of one note.
fn expression(said: &clap_event_note_expression) -> Option<NoteEvent<()>> {
    let (voice_id, channel, key) = address(said.note_id, said.channel, said.key);
    let (timing, value) = (said.header.time, said.value as f32);
    Some(match said.expression_id {
        CLAP_NOTE_EXPRESSION_PRESSURE => {
            NoteEvent::PolyPressure { timing, voice_id, channel, key, pressure: value }
        }
        CLAP_NOTE_EXPRESSION_VOLUME => NoteEvent::PolyVolume { timing, voice_id, channel, key, gain: value },
        CLAP_NOTE_EXPRESSION_TUNING => {
            NoteEvent::PolyTuning { timing, voice_id, channel, key, tuning: value }
        }
        CLAP_NOTE_EXPRESSION_VIBRATO => {
            NoteEvent::PolyVibrato { timing, voice_id, channel, key, vibrato: value }
        }
        CLAP_NOTE_EXPRESSION_EXPRESSION => {
            NoteEvent::PolyExpression { timing, voice_id, channel, key, expression: value }
        }
        CLAP_NOTE_EXPRESSION_BRIGHTNESS => {
            NoteEvent::PolyBrightness { timing, voice_id, channel, key, brightness: value }
        }
        _ => return None,
    })
}
