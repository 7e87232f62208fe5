//! What a host says, in the framework's words: what that does itself, and keeps to itself.

use nice_plug::midi::{Channel, Key, VoiceID};
use nice_plug::prelude::*;
use nice_plug::wrapper::vst3::vst3::ComRef;
use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::Event_::EventTypes_::*;
use nice_plug::wrapper::vst3::vst3::Steinberg::Vst::*;
use nice_plug::wrapper::vst3::vst3::Steinberg::kResultOk;

use crate::performance::controller;

/// What stands beside the 128 controllers of a channel.
const PRESSURE: u8 = 128;
const WHEEL: u8 = 129;

/// The parameters that stand for controllers, which are hidden: so many of each channel, one after another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hidden {
    first: ParamID,
    of_each: u32,
}

impl Hidden {
    /// Those of whoever knows which they are.
    pub fn of(mapping: &impl IMidiMappingTrait) -> Self {
        let first_of = |channel| {
            let mut id = 0;
            // SAFETY: there is room for a number.
            unsafe { mapping.getMidiControllerAssignment(0, channel, 0, &mut id) };
            id
        };
        let [first, second] = [0, 1].map(first_of);
        Self { first, of_each: second - first }
    }

    /// Channel and controller that a parameter stands for, if it does.
    fn place(&self, id: ParamID) -> Option<(u8, u8)> {
        let place = id.checked_sub(self.first).filter(|&place| place < 16 * self.of_each)?;
        Some(((place / self.of_each) as u8, (place % self.of_each) as u8))
    }

    /// The event that a change of a parameter is, if it stands for a controller.
    pub fn event(&self, id: ParamID, at: i32, value: ParamValue) -> Option<NoteEvent<()>> {
        let (channel, number) = self.place(id)?;
        let (timing, value) = (timing(at), value as f32);
        Some(match number {
            PRESSURE => NoteEvent::MidiChannelPressure { timing, channel, pressure: value },
            WHEEL => NoteEvent::MidiPitchBend { timing, channel, value },
            cc => NoteEvent::MidiCC { timing, channel, cc, value },
        })
    }

    /// What a parameter is where nothing was said, if it stands for a controller: what a channel is then.
    pub fn usual(&self, id: ParamID) -> Option<ParamValue> {
        use controller::{ACCENT, BREATH, BRIGHTNESS, EXPRESSION, PARAMETER_LOWER, PARAMETER_UPPER};
        self.place(id).map(|(_, number)| match number {
            WHEEL => 0.5,
            BREATH | EXPRESSION | PARAMETER_LOWER | PARAMETER_UPPER => 1.0,
            ACCENT | BRIGHTNESS => 64.0 / 127.0,
            _ => 0.0,
        })
    }
}

fn timing(offset: i32) -> u32 {
    u32::try_from(offset).unwrap_or(0)
}

/// All that a call brings for players.
///
/// # Safety
/// It is what a host has to bring.
pub(super) unsafe fn each(data: &ProcessData, hidden: Hidden, mut take: impl FnMut(NoteEvent<()>)) {
    // SAFETY: all of it lives until the host's call returns, and is as it says it is.
    unsafe {
        // Controllers of a sample come before its notes, as in the framework.
        if let Some(changes) = ComRef::from_raw(data.inputParameterChanges) {
            points(changes, |id, at, value| hidden.event(id, at, value).into_iter().for_each(&mut take));
        }
        if let Some(events) = ComRef::from_raw(data.inputEvents) {
            for index in 0..events.getEventCount() {
                // All bits of an event may be 0.
                let mut event = std::mem::zeroed();
                if events.getEvent(index, &mut event) == kResultOk {
                    note_event(&event).into_iter().for_each(&mut take);
                }
            }
        }
    }
}

/// All changes of parameters: whose, at which sample, to what.
///
/// # Safety
/// They must be what a host has to give.
unsafe fn points(changes: ComRef<'_, IParameterChanges>, mut take: impl FnMut(ParamID, i32, ParamValue)) {
    // SAFETY: they live, and there is room for both numbers.
    unsafe {
        let queues = (0..changes.getParameterCount()).map(|index| changes.getParameterData(index));
        for queue in queues.filter_map(|queue| ComRef::from_raw(queue)) {
            for index in 0..queue.getPointCount() {
                let (mut at, mut value) = (0, 0.0);
                if queue.getPoint(index, &mut at, &mut value) == kResultOk {
                    take(queue.getParameterId(), at, value);
                }
            }
        }
    }
}

/// An event, if it is one for players. What is said of a note has only its number, by which the plugin knows it, too.
///
/// # Safety
/// It must be of the type that it says.
unsafe fn note_event(event: &Event) -> Option<NoteEvent<()>> {
    let (timing, data) = (timing(event.sampleOffset), &event.__field0);
    let voice = |id: i32| if id >= 0 { VoiceID::ID(id) } else { VoiceID::Wildcard };
    let channel = |number: i16| match u8::try_from(number) {
        Ok(number @ ..16) => Channel::Number(number),
        _ => Channel::Wildcard,
    };
    let key = |number: i16| match u8::try_from(number) {
        Ok(number @ ..128) => Key::Number(number),
        _ => Key::Wildcard,
    };
    let kind = event.r#type;
    // SAFETY: it is of this type.
    unsafe {
        if kind == kNoteOnEvent as u16 {
            let NoteOnEvent { channel: of, pitch, velocity, noteId, .. } = data.noteOn;
            let (voice_id, channel, key) = (voice(noteId), channel(of), key(pitch));
            Some(NoteEvent::NoteOn { timing, voice_id, channel, key, velocity })
        } else if kind == kNoteOffEvent as u16 {
            let NoteOffEvent { channel: of, pitch, velocity, noteId, .. } = data.noteOff;
            let (voice_id, channel, key) = (voice(noteId), channel(of), key(pitch));
            Some(NoteEvent::NoteOff { timing, voice_id, channel, key, velocity })
        } else if kind == kPolyPressureEvent as u16 {
            let PolyPressureEvent { channel: of, pitch, pressure, noteId } = data.polyPressure;
            let (voice_id, channel, key) = (voice(noteId), channel(of), key(pitch));
            Some(NoteEvent::PolyPressure { timing, voice_id, channel, key, pressure })
        } else if kind == kNoteExpressionValueEvent as u16 {
            expression(timing, &data.noteExpressionValue)
        } else if kind == kDataEvent as u16 && data.data.r#type == 0 && !data.data.bytes.is_null() {
            let DataEvent { bytes, size, .. } = data.data;
            NoteEvent::from_midi(timing, std::slice::from_raw_parts(bytes, size as usize)).ok()
        } else {
            None
        }
    }
}

/// What is said of one note: by the numbers that VST3 gives volume, tuning, vibrato, expression and brightness.
fn expression(timing: u32, said: &NoteExpressionValueEvent) -> Option<NoteEvent<()>> {
    let (voice_id, channel, key) = (VoiceID::ID(said.noteId), Channel::Wildcard, Key::Wildcard);
    let value = said.value as f32;
    Some(match said.typeId {
        0 => NoteEvent::PolyVolume { timing, voice_id, channel, key, gain: 4.0 * value },
        2 => NoteEvent::PolyTuning { timing, voice_id, channel, key, tuning: 240.0 * (value - 0.5) },
        3 => NoteEvent::PolyVibrato { timing, voice_id, channel, key, vibrato: value },
        4 => NoteEvent::PolyExpression { timing, voice_id, channel, key, expression: value },
        5 => NoteEvent::PolyBrightness { timing, voice_id, channel, key, brightness: value },
        _ => return None,
    })
}
