//! The promise: a sequence of format 2 is played in the whole file as it is alone: what another one before it has left pressed,
//! turned or announced is nothing to it.

use low_action::midi_file::{Selection, Song, SongWarning};
use low_action::performance::PlayerEvent;
use low_action_tests::labelled::{list, number, render, sample};
use low_action_tests::midi::{END, file, track};
use serde_json::Value;

const PROGRAM: &str = env!("CARGO_BIN_EXE_low-action-command");
const ALL: Selection = Selection { track: None, channel: None, tenth: false, truncated: false };

/// All that outlasts a note, and a note that nobody lets go of: a second of it.
fn first() -> Vec<u8> {
    track(&[
        // Members of MPE, and how far wheels reach: theirs, and everybody's.
        (0, &[0xB0, 101, 0]),
        (0, &[0xB0, 100, 6]),
        (0, &[0xB0, 6, 15]),
        (0, &[0xB1, 101, 0]),
        (0, &[0xB1, 100, 0]),
        (0, &[0xB1, 6, 5]),
        (0, &[0x91, 42, 100]),
        // Vibrato, force, palm, sustain, sostenuto, slides, legato, place; the wheel; pressure; the capo.
        (0, &[0xB1, 1, 127]),
        (0, &[0xB1, 11, 40]),
        (0, &[0xB1, 20, 90]),
        (0, &[0xB1, 64, 127]),
        (0, &[0xB1, 66, 127]),
        (0, &[0xB1, 65, 127]),
        (0, &[0xB1, 68, 127]),
        (0, &[0xB1, 74, 127]),
        (0, &[0xE1, 127, 127]),
        (0, &[0xD1, 127]),
        (0, &[0xB1, 26, 2]),
        (191, &[0xB1, 64, 127]),
        // At the very end.
        (1, &[0xB2, 101, 0]),
        (0, &[0xB2, 100, 0]),
        (0, &[0xB2, 6, 12]),
    ])
}

/// One note when all is still, bent a little and let go of.
fn second(channel: u8) -> Vec<u8> {
    track(&[
        (480, &[0xE0 | channel, 0, 80]),
        (0, &[0x90 | channel, 43, 80]),
        (96, &[0x80 | channel, 43, 0]),
        (96, END),
    ])
}

/// What is said of notes that are asked for after a sample and of bends from them on, times counted from there.
fn labelled(labels: &Value, start: usize) -> (Vec<Value>, Vec<String>) {
    let mut notes: Vec<Value> = list(labels, "notes").to_vec();
    notes.retain(|note| sample(note, "asked_sample") >= start);
    for note in &mut notes {
        for time in ["asked_sample", "onset_sample", "released_sample", "end_sample"] {
            note[time] = (sample(note, time) - start).into();
        }
        for time in ["asked", "onset", "released", "end"] {
            note[time] = Value::Null;
        }
    }
    let asked = start + notes.iter().map(|note| sample(note, "asked_sample")).min().unwrap_or(0);
    let bends = list(labels, "bends").iter().filter(|bend| sample(bend, "sample") >= asked);
    let said = |bend: &Value| {
        let [to, lasts] = ["semitones", "duration"].map(|key| number(bend, key));
        format!("{} {} {to} {lasts}", bend["string"], sample(bend, "sample") - start)
    };
    (notes, bends.map(said).collect())
}

#[test]
fn a_sequence_sounds_in_the_whole_as_alone() {
    let usual = ["--quality", "draft", "--sample-rate", "8000", "--tail", "0.1", "--variation", "0"];
    for (input, channel) in [
        (&["--input", "auto"][..], 1),
        (&["--input", "auto"], 2),
        (&["--input", "keyboard"], 1),
        (&["--input", "keyboard", "--bend-range", "3.25"], 2),
        (&["--input", "keyboard", "--ignore-rpn"], 2),
        (&["--input", "strings", "--string-order", "last_first"], 1),
        (&["--input", "mpe"], 1),
        (&["--input", "mpe"], 2),
    ] {
        let options = [&usual[..], input].concat();
        let sequences = [first(), second(channel)];
        let whole = render(PROGRAM, &file(2, 96, &sequences), &options).labels;
        let alone =
            render(PROGRAM, &file(2, 96, &sequences), &[&options[..], &["--track", "2"]].concat()).labels;
        assert_eq!(list(&whole, "notes").len(), 2, "{input:?}");
        // The first note ends with its sequence, whatever holds it.
        let ends = &list(&whole, "notes")[0];
        assert_eq!((sample(ends, "end_sample"), ends["end_by"].as_str()), (8_000, Some("damped")), "{ends}");
        let (whole, alone) = (labelled(&whole, 8_000), labelled(&alone, 0));
        assert_eq!(whole, alone, "{input:?}, channel {}", channel + 1);
        assert_eq!(whole.0.len(), 1);
        assert!(!whole.1.is_empty(), "it is bent");
    }
}

/// Three sequences of a second, in each of which a key is let go of at the very end; that of the last has no other after it.
#[test]
fn a_key_let_go_of_at_the_end_of_a_sequence_is_so_at_its_sample() {
    let one = |key| track(&[(0, &[0x90, key, 100]), (192, &[0x80, key, 0])]);
    for rate in [8_000, 11_025] {
        let options = ["--quality", "draft", "--sample-rate", &rate.to_string(), "--tail", "0.1"];
        let labels = render(PROGRAM, &file(2, 96, &[one(45), one(52), one(45)]), &options).labels;
        let at =
            |key| -> Vec<usize> { list(&labels, "notes").iter().map(|note| sample(note, key)).collect() };
        for key in ["released_sample", "end_sample"] {
            assert_eq!(at(key), [rate, 2 * rate, 3 * rate], "{key}");
        }
        assert_eq!(at("asked_sample"), [0, rate, 2 * rate]);
    }
}

#[test]
fn a_key_struck_at_the_end_of_a_sequence_is_not_heard() {
    // The second begins with the same key.
    let ends = track(&[(0, &[0x90, 45, 100]), (192, &[0x90, 45, 100]), (0, &[0x90, 52, 100])]);
    let next = track(&[(0, &[0x90, 45, 80]), (96, &[0x80, 45, 0])]);
    let options = ["--quality", "draft", "--sample-rate", "8000", "--tail", "0.1", "--variation", "0"];
    let labels = render(PROGRAM, &file(2, 96, &[ends, next]), &options).labels;
    let notes =
        list(&labels, "notes").iter().map(|note| (sample(note, "velocity"), sample(note, "asked_sample")));
    assert_eq!(notes.collect::<Vec<_>>(), [(100, 0), (80, 8_000)]);
    assert!(list(&labels, "unplayed").is_empty());
}

#[test]
fn sequences_say_nothing_of_each_others_drums() {
    let drum = track(&[(0, &[0x99, 38, 100]), (96, &[0x89, 38, 0])]);
    // The first announces channel 10 as one of MPE; the second does not.
    let song = Song::from_midi(&file(2, 96, &[first(), drum.clone()]), ALL).expect("good");
    assert_eq!(song.warnings, [SongWarning::DrumsSkipped { notes: 1 }]);
    // Where nothing is left of a sequence, nothing is let go of for it.
    assert!(!song.events.iter().any(|event| event.event == PlayerEvent::AllNotesOff));
    // Tracks that play together do.
    let song = Song::from_midi(&file(1, 96, &[first(), drum]), ALL).expect("good");
    assert_eq!(song.warnings, []);
}
