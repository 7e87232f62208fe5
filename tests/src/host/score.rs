//! What a host hands to the plugin: actions at samples, and the events they are to CLAP.

use clack_host::events::event_types::{
    MidiEvent, NoteChokeEvent, NoteExpressionEvent, NoteExpressionType, NoteOffEvent, NoteOnEvent,
    ParamModEvent, ParamValueEvent, TransportEvent, TransportFlags,
};
use clack_host::events::{EventFlags, EventHeader};
use clack_host::prelude::*;
use clack_host::utils::SecondsTime;

/// What a performer or a host does to the plugin.
#[derive(Clone, Copy, Debug)]
pub enum Action {
    /// A key goes down.
    NoteOn {
        /// MIDI channel, 0 to 15.
        channel: u8,
        /// MIDI key, 0 to 127.
        key: u8,
        /// How hard, 0 to 127; 0 is the softest a host can ask for, not a release.
        velocity: u8,
    },
    /// A key goes up.
    NoteOff {
        /// MIDI channel, 0 to 15.
        channel: u8,
        /// MIDI key, 0 to 127.
        key: u8,
    },
    /// A key goes down, and the host gives the note a number of its own.
    Begin {
        /// Number of the note.
        number: u32,
        /// MIDI channel, 0 to 15.
        channel: u8,
        /// MIDI key, 0 to 127.
        key: u8,
    },
    /// The key of a note goes up, which is named by its number alone.
    Lift {
        /// Number of the note.
        number: u32,
    },
    /// A note is cut short.
    Choke {
        /// MIDI channel, 0 to 15.
        channel: u8,
        /// MIDI key, 0 to 127.
        key: u8,
    },
    /// Every note is cut short.
    ChokeAll,
    /// Three bytes of MIDI.
    Midi([u8; 3]),
    /// A parameter is set, by its CLAP identifier, in the units CLAP shows to a host: 0 to 1, or 0 to the
    /// number of steps.
    Parameter(u32, f64),
    /// The same for one note alone, which the host has numbered by its key: added to what holds for all.
    Modulate {
        /// The parameter.
        parameter: u32,
        /// Number of the note.
        key: u8,
        /// What is added, 0 to 1.
        amount: f64,
    },
    /// The same for all notes.
    ModulateAll {
        /// The parameter.
        parameter: u32,
        /// What is added, 0 to 1.
        amount: f64,
    },
    /// A note expression.
    Express {
        /// What is expressed.
        what: NoteExpressionType,
        /// MIDI channel, 0 to 15.
        channel: u8,
        /// MIDI key, 0 to 127.
        key: u8,
        /// How much.
        value: f64,
    },
    /// The transport starts or stops.
    Transport(bool),
    /// The transport goes to this sample of the song, and runs on from there.
    Place(u64),
}

/// How the host's transport runs.
#[derive(Clone, Copy)]
pub(super) struct Running {
    is: bool,
    /// A sample of the performance and of the song, and the sample rate, if the host tells where in it.
    place: Option<(u64, u64, f64)>,
}

impl Running {
    /// As an action has it that comes at a sample, if it has to do with it.
    pub fn from(at: u64, action: Action, sample_rate: f64) -> Option<Self> {
        match action {
            Action::Transport(is) => Some(Self { is, place: None }),
            Action::Place(song) => Some(Self { is: true, place: Some((at, song, sample_rate)) }),
            _ => None,
        }
    }

    /// What it says at a sample, to an event at a time of its block.
    pub fn said(self, at: u64, time: u32) -> TransportEvent {
        let mut said = transport(time, self.is);
        if let Some((from, song, sample_rate)) = self.place {
            said.flags |= TransportFlags::HAS_SECONDS_TIMELINE | TransportFlags::HAS_TEMPO;
            said.song_pos_seconds = SecondsTime::from_float((song + at - from) as f64 / sample_rate);
            said.tempo = 120.0;
        }
        said
    }
}

/// The number under which CLAP hosts know the parameter that is saved as `id`: the framework's hash.
pub fn parameter(id: &str) -> u32 {
    let hash = id.bytes().fold(0_u32, |hash, byte| hash.wrapping_mul(31).wrapping_add(u32::from(byte)));
    hash & !(1 << 31)
}

/// An action and the sample at which it happens, counted from the start of the performance.
pub type Score = Vec<(u64, Action)>;

/// The events of the samples from `start` up to `end`, in the order of the score, timed from `start` as `clock`
/// says.
pub(super) fn events_between(
    score: &Score,
    [start, end]: [u64; 2],
    clock: fn(u32) -> u32,
    sample_rate: f64,
) -> EventBuffer {
    let mut events = EventBuffer::new();
    for &(at, action) in score.iter().filter(|(at, _)| (start..end).contains(at)) {
        let time = clock((at - start) as u32);
        match action {
            Action::NoteOn { channel, key, velocity } => {
                let velocity = f64::from(velocity) / 127.0;
                events.push(&NoteOnEvent::new(time, note(channel, key), velocity));
            }
            Action::NoteOff { channel, key } => {
                events.push(&NoteOffEvent::new(time, note(channel, key), 0.0));
            }
            Action::Begin { number, channel, key } => {
                let address = Pckn::new(0_u16, u16::from(channel), u16::from(key), number);
                events.push(&NoteOnEvent::new(time, address, 0.7));
            }
            Action::Lift { number } => {
                use clack_host::events::Match::All;
                events.push(&NoteOffEvent::new(time, Pckn::new(All, All, All, number), 0.0));
            }
            Action::Choke { channel, key } => events.push(&NoteChokeEvent::new(time, note(channel, key))),
            Action::ChokeAll => events.push(&NoteChokeEvent::new(time, Pckn::match_all())),
            Action::Midi(bytes) => events.push(&MidiEvent::new(time, 0, bytes)),
            Action::Parameter(id, value) => {
                events.push(&ParamValueEvent::new(time, ClapId::new(id), Pckn::match_all(), value));
            }
            Action::Modulate { parameter, key, amount } => {
                use clack_host::events::Match::All;
                let address = Pckn::new(All, All, All, u32::from(key));
                events.push(&ParamModEvent::new(time, ClapId::new(parameter), address, amount));
            }
            Action::ModulateAll { parameter, amount } => {
                events.push(&ParamModEvent::new(time, ClapId::new(parameter), Pckn::match_all(), amount));
            }
            Action::Express { what, channel, key, value } => {
                events.push(&NoteExpressionEvent::new(time, note(channel, key), what, value));
            }
            Action::Transport(_) | Action::Place(_) => {
                let running = Running::from(at, action, sample_rate);
                running.into_iter().for_each(|running| events.push(&running.said(at, time)));
            }
        }
    }
    events
}

/// A transport that tells nothing but whether it runs.
fn transport(time: u32, playing: bool) -> TransportEvent {
    TransportEvent {
        header: EventHeader::new_core(time, EventFlags::empty()),
        flags: if playing { TransportFlags::IS_PLAYING } else { TransportFlags::empty() },
        song_pos_beats: Default::default(),
        song_pos_seconds: Default::default(),
        tempo: 0.0,
        tempo_inc: 0.0,
        loop_start_beats: Default::default(),
        loop_end_beats: Default::default(),
        loop_start_seconds: Default::default(),
        loop_end_seconds: Default::default(),
        bar_start: Default::default(),
        bar_number: 0,
        time_signature_numerator: 0,
        time_signature_denominator: 0,
    }
}

/// CLAP's address of a key on a channel. This host numbers notes by their keys.
fn note(channel: u8, key: u8) -> Pckn {
    Pckn::new(0_u16, u16::from(channel), u16::from(key), u32::from(key))
}
