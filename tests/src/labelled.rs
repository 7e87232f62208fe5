//! Rendering with labels as a user does, and reading them.

use std::fs;

use hound::WavReader;
use serde_json::Value;

use crate::command::Workplace;
use crate::midi::{file, tempo, track};

/// Samples a second, Hz.
pub const RATE: f64 = 48_000.0;

/// Samples of so many seconds.
pub fn samples(seconds: f64) -> usize {
    (seconds * RATE) as usize
}

/// A song with its labels, and the sound of each string if that was asked for.
#[derive(Debug)]
pub struct Labelled {
    /// All labels.
    pub labels: Value,
    /// The sound of each string.
    pub strings: Vec<Vec<f32>>,
}

/// Renders a song with labels and stems by the program, `env!("CARGO_BIN_EXE_low-action-command")`.
pub fn render(program: &str, song: &[u8], options: &[&str]) -> Labelled {
    let place = Workplace::new(program);
    place.write("song.mid", song);
    let usual = ["render", "song.mid", "--labels", "labels.json", "--stems", "stems", "--bit-depth", "32f"]
        .as_slice();
    let finished = place.run(&[usual, options].concat());
    assert_eq!(finished.code, 0, "{}", finished.error);
    let text = fs::read_to_string(place.path("labels.json")).expect("it was written");
    let labels: Value = serde_json::from_str(&text).expect("it is JSON");
    let stem = |string: &Value| {
        let path = format!("stems/{}-{}.wav", string["string"], string["name"].as_str().expect("a name"));
        let mut reader = WavReader::open(place.path(&path)).expect("each string has a stem");
        reader.samples::<f32>().map(|sample| sample.expect("a sample")).collect()
    };
    let strings = list(&labels, "strings").iter().map(stem).collect();
    Labelled { labels, strings }
}

impl Labelled {
    /// The notes.
    pub fn notes(&self) -> &[Value] {
        list(&self.labels, "notes")
    }

    /// The sound of a note's string.
    pub fn string_of(&self, note: &Value) -> &[f32] {
        &self.strings[sample(note, "string") - 1]
    }
}

/// A list of records.
pub fn list<'a>(labels: &'a Value, key: &str) -> &'a [Value] {
    labels[key].as_array().unwrap_or_else(|| panic!("{key} is a list"))
}

/// A number of a record.
pub fn number(record: &Value, key: &str) -> f64 {
    record[key].as_f64().unwrap_or_else(|| panic!("{key} is a number in {record}"))
}

/// A whole number of a record.
pub fn sample(record: &Value, key: &str) -> usize {
    record[key].as_u64().unwrap_or_else(|| panic!("{key} is a whole number in {record}")) as usize
}

/// A song of messages, each at its time in ms.
pub fn song(messages: &[(u32, [u8; 3])]) -> Vec<u8> {
    let mut last = 0;
    let second = tempo(1_000_000);
    let mut events: Vec<(u32, &[u8])> = vec![(0, &second)];
    for (time, message) in messages {
        events.push((time - last, message));
        last = *time;
    }
    // A beat takes a second, a tick a thousandth of it.
    file(0, 1000, &[track(&events)])
}

/// A pluck and its end.
pub fn held(key: u8, velocity: u8, from: u32, to: u32) -> [(u32, [u8; 3]); 2] {
    [(from, [0x90, key, velocity]), (to, [0x80, key, 0])]
}
