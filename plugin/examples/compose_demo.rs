//! Writes the demo piece, `plugin/src/demo/demo.mid`:
//! `cargo run -p low-action --example compose_demo`.
//!
//! Nine bars in E minor for a six-string guitar: four of arpeggios that ring, a run up the
//! pentatonic scale, a note bent by a tone and let down again, a bar of low notes struck so hard that
//! they rattle on the frets, and a last chord, strummed. The lead is on channel 2, so that its bend
//! leaves the chords alone.

use std::path::Path;

use midly::num::{u4, u7, u15, u24, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, PitchBend, Smf, Timing, TrackEvent, TrackEventKind};

/// Ticks a quarter note.
const QUARTER: u32 = 480;
const EIGHTH: u32 = QUARTER / 2;
const SIXTEENTH: u32 = QUARTER / 4;
const BAR: u32 = 4 * QUARTER;
/// Microseconds a quarter note: 100 beats a minute.
const TEMPO: u32 = 600_000;

/// Channels, from 0.
const CHORDS: u8 = 0;
const LEAD: u8 = 1;

/// Eight eighths a bar, each held to the bar's end: Em(add9), Cmaj7, G, D(add9)/F♯.
const ARPEGGIOS: [[u8; 8]; 4] = [
    [40, 47, 54, 55, 59, 64, 59, 55],
    [48, 52, 55, 59, 64, 59, 55, 52],
    [43, 50, 55, 62, 67, 62, 55, 50],
    [42, 50, 57, 62, 64, 62, 57, 50],
];

/// How hard each eighth of a bar is plucked: the bass, then a swell to the top.
const SWELL: [u8; 8] = [92, 70, 74, 80, 88, 76, 70, 66];

/// Sixteenths of the run, E minor pentatonic.
const RUN: [u8; 16] = [64, 67, 69, 71, 74, 71, 69, 67, 69, 71, 74, 76, 79, 76, 74, 71];

/// The hard low bar: key, start and length in eighths.
const RIFF: [(u8, u32, u32); 7] =
    [(40, 0, 1), (40, 1, 1), (43, 2, 1), (40, 3, 1), (45, 4, 1), (40, 5, 1), (46, 6, 1)];

/// The last chord, Em, bass first.
const LAST_CHORD: [u8; 6] = [40, 47, 52, 55, 59, 64];

/// The piece as it grows: messages at ticks.
#[derive(Default)]
struct Score {
    messages: Vec<(u32, u8, MidiMessage)>,
}

impl Score {
    fn note(&mut self, channel: u8, key: u8, velocity: u8, start: u32, length: u32) {
        let (key, vel) = (u7::new(key), u7::new(velocity));
        self.messages.push((start, channel, MidiMessage::NoteOn { key, vel }));
        self.messages.push((start + length, channel, MidiMessage::NoteOff { key, vel: u7::new(64) }));
    }

    /// Turns the lead's wheel; 1 is a full turn up, a tone.
    fn bend(&mut self, tick: u32, turn: f64) {
        let bend = PitchBend::from_f64(turn);
        self.messages.push((tick, LEAD, MidiMessage::PitchBend { bend }));
    }

    /// Turns the wheel from one place to another in steps of a sixty-fourth.
    fn glide(&mut self, start: u32, length: u32, from: f64, to: f64) {
        let step = SIXTEENTH / 4;
        for tick in (step..=length).step_by(step as usize) {
            self.bend(start + tick, from + (to - from) * f64::from(tick) / f64::from(length));
        }
    }

    /// The bytes of a file of format 0.
    fn into_bytes(mut self) -> Vec<u8> {
        // Keys go up before others go down at the same tick, as hands do it.
        self.messages
            .sort_by_key(|&(tick, _, message)| (tick, matches!(message, MidiMessage::NoteOn { .. })));
        let event = |delta: u32, kind| TrackEvent { delta: u28::new(delta), kind };
        let mut track = vec![
            event(0, TrackEventKind::Meta(MetaMessage::TrackName(b"Low Action demo"))),
            event(0, TrackEventKind::Meta(MetaMessage::Tempo(u24::new(TEMPO)))),
        ];
        let mut now = 0;
        for (tick, channel, message) in self.messages {
            track.push(event(tick - now, TrackEventKind::Midi { channel: u4::new(channel), message }));
            now = tick;
        }
        track.push(event(0, TrackEventKind::Meta(MetaMessage::EndOfTrack)));
        let header = Header::new(Format::SingleTrack, Timing::Metrical(u15::new(QUARTER as u16)));
        let file = Smf { header, tracks: vec![track] };
        let mut bytes = Vec::new();
        file.write_std(&mut bytes).expect("memory takes every byte");
        bytes
    }
}

/// The whole piece as a MIDI file.
pub fn compose() -> Vec<u8> {
    let mut score = Score::default();
    for (bar, keys) in (0..).zip(ARPEGGIOS) {
        for (eighth, (key, velocity)) in (0..).zip(keys.into_iter().zip(SWELL)) {
            let start = bar * BAR + eighth * EIGHTH;
            // A key that comes again in the bar is let go just before.
            let again = (eighth + 1..8).find(|&later| keys[later as usize] == key);
            let length = again.map_or((8 - eighth) * EIGHTH, |later| (later - eighth) * EIGHTH - 10);
            score.note(CHORDS, key, velocity, start, length);
        }
    }

    let run = 4 * BAR;
    score.note(CHORDS, 40, 84, run, BAR);
    score.note(CHORDS, 47, 60, run + 30, BAR - 30);
    for (sixteenth, key) in (0..).zip(RUN) {
        let velocity = if sixteenth % 4 == 0 { 96 } else { 78 };
        score.note(LEAD, key, velocity, run + sixteenth * SIXTEENTH, SIXTEENTH);
    }

    let bent = 5 * BAR;
    for (delay, key) in (0..).step_by(12).zip([48, 52, 55]) {
        score.note(CHORDS, key, 72, bent + delay, BAR - delay);
    }
    // D5 up to E5, held with a slow shake, and down again.
    score.note(LEAD, 74, 108, bent, 5 * EIGHTH);
    score.glide(bent + SIXTEENTH, EIGHTH, 0.0, 1.0);
    for shake in 0..4 {
        let start = bent + QUARTER + shake * SIXTEENTH;
        score.glide(start, SIXTEENTH / 2, 1.0, 0.85);
        score.glide(start + SIXTEENTH / 2, SIXTEENTH / 2, 0.85, 1.0);
    }
    score.glide(bent + 4 * EIGHTH, EIGHTH - SIXTEENTH / 2, 1.0, 0.0);
    for (eighth, key) in (5..).zip([71, 69, 67]) {
        score.note(LEAD, key, 84, bent + eighth * EIGHTH, EIGHTH);
    }

    let riff = 6 * BAR;
    for (key, start, length) in RIFF {
        score.note(CHORDS, key, 127, riff + start * EIGHTH, length * EIGHTH - SIXTEENTH / 2);
    }
    score.note(CHORDS, 47, 118, riff + 7 * EIGHTH, EIGHTH);

    let last = 7 * BAR;
    for (place, key) in (0..).zip(LAST_CHORD) {
        // 12 ticks are 15 ms from string to string.
        let delay = place * 12;
        let velocity = if place == 0 { 127 } else { 104 };
        score.note(CHORDS, key, velocity, last + delay, 2 * BAR - delay);
    }
    score.into_bytes()
}

/// Writes the file into the source folder.
#[allow(dead_code, reason = "the test that compares the committed file includes this one as a module")]
fn main() -> std::io::Result<()> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/demo/demo.mid");
    std::fs::write(path, compose())
}
