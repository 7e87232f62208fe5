//! Music as it grows: tracks of messages at ticks, and the file they become.

pub use low_action::performance::controller::*;
use midly::num::{u4, u7, u15, u24, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, PitchBend, Smf, Timing, TrackEvent, TrackEventKind};

/// Ticks a quarter note.
pub const QUARTER: u32 = 480;
pub const EIGHTH: u32 = QUARTER / 2;
pub const SIXTEENTH: u32 = QUARTER / 4;

/// A piece: its tempo, and its tracks.
pub struct Score {
    /// Quarter notes a minute.
    tempo: u32,
    tracks: Vec<Track>,
}

/// One track on one channel.
pub struct Track {
    name: &'static str,
    channel: u8,
    messages: Vec<(u32, MidiMessage)>,
}

impl Score {
    /// An empty piece at so many quarter notes a minute.
    pub fn new(tempo: u32) -> Self {
        Self { tempo, tracks: Vec::new() }
    }

    /// A piece of one track on channel 1.
    pub fn solo(tempo: u32, write: impl FnOnce(&mut Track)) -> Self {
        let mut score = Self::new(tempo);
        write(score.track("solo", 1));
        score
    }

    /// Another track, on a channel from 1 to 16.
    pub fn track(&mut self, name: &'static str, channel: u8) -> &mut Track {
        self.tracks.push(Track { name, channel: channel - 1, messages: Vec::new() });
        let last = self.tracks.len() - 1;
        &mut self.tracks[last]
    }

    /// The bytes of a file of format 1.
    pub fn into_bytes(self) -> Vec<u8> {
        let event = |delta: u32, kind| TrackEvent { delta: u28::new(delta), kind };
        let tempo = u24::new(60_000_000 / self.tempo);
        let mut tracks = vec![vec![
            event(0, TrackEventKind::Meta(MetaMessage::Tempo(tempo))),
            event(0, TrackEventKind::Meta(MetaMessage::EndOfTrack)),
        ]];
        for Track { name, channel, mut messages } in self.tracks {
            // At one tick keys go up first, then controllers move, then keys go down.
            messages.sort_by_key(|&(tick, message)| (tick, turn(message)));
            let mut track = vec![event(0, TrackEventKind::Meta(MetaMessage::TrackName(name.as_bytes())))];
            let mut now = 0;
            for (tick, message) in messages {
                track.push(event(tick - now, TrackEventKind::Midi { channel: u4::new(channel), message }));
                now = tick;
            }
            track.push(event(0, TrackEventKind::Meta(MetaMessage::EndOfTrack)));
            tracks.push(track);
        }
        let header = Header::new(Format::Parallel, Timing::Metrical(u15::new(QUARTER as u16)));
        let mut bytes = Vec::new();
        Smf { header, tracks }.write_std(&mut bytes).expect("memory takes every byte");
        bytes
    }
}

fn turn(message: MidiMessage) -> u8 {
    match message {
        MidiMessage::NoteOff { .. } => 0,
        MidiMessage::NoteOn { .. } => 2,
        _ => 1,
    }
}

impl Track {
    /// A note.
    pub fn note(&mut self, key: u8, velocity: u8, start: u32, length: u32) {
        let (key, vel) = (u7::new(key), u7::new(velocity));
        self.messages.push((start, MidiMessage::NoteOn { key, vel }));
        self.messages.push((start + length, MidiMessage::NoteOff { key, vel: u7::new(64) }));
    }

    /// Notes that begin and end together.
    pub fn chord(&mut self, keys: &[u8], velocity: u8, start: u32, length: u32) {
        keys.iter().for_each(|&key| self.note(key, velocity, start, length));
    }

    /// Notes one after another, each as long as the step between them and a little more, if they overlap.
    pub fn line(&mut self, keys: &[u8], velocity: u8, start: u32, step: u32, overlap: u32) -> u32 {
        let mut now = start;
        for &key in keys {
            self.note(key, velocity, now, step + overlap);
            now += step;
        }
        now
    }

    /// Moves a controller.
    pub fn set(&mut self, tick: u32, controller: u8, value: u8) {
        let message = MidiMessage::Controller { controller: u7::new(controller), value: u7::new(value) };
        self.messages.push((tick, message));
    }

    /// Moves a controller from one value to another.
    pub fn sweep(&mut self, tick: u32, length: u32, controller: u8, [from, to]: [u8; 2]) {
        let (from, to) = (f64::from(from), f64::from(to));
        for step in 0..=16 {
            let part = f64::from(step) / 16.0;
            self.set(tick + length * step / 16, controller, (from + (to - from) * part).round() as u8);
        }
    }

    /// Turns the wheel from one place to another; 1 is a full turn up.
    pub fn bend(&mut self, tick: u32, length: u32, [from, to]: [f64; 2]) {
        for step in 0..=16 {
            let bend = PitchBend::from_f64(from + (to - from) * f64::from(step) / 16.0);
            self.messages.push((tick + length * step / 16, MidiMessage::PitchBend { bend }));
        }
    }
}
