//! Labels stand alone, are the same on every run, and change nothing.

use std::collections::BTreeSet;
use std::fs;

use low_action::engine::{Engine, EngineOptions, Record};
use low_action::midi_file::{Selection, Song};
use low_action_dsp::{Gesture, Setup, Touch};
use serde_json::Value;

use crate::room::{Room, midi, song};

/// What a room's labels say, as text and as a value.
fn read(room: &Room, name: &str) -> (String, Value) {
    let text = fs::read_to_string(room.path(name)).unwrap();
    let value = serde_json::from_str(&text).unwrap();
    (text, value)
}

#[test]
fn the_sound_is_the_same_with_labels_and_they_are_the_same_on_every_run() {
    let room = Room::new();
    room.renders(&["song.mid", "-o", "alone.wav"]);
    let said = room.renders(&["song.mid", "-o", "song.wav", "--labels", "song.json"]);
    assert!(said.starts_with("song.wav: ") && said.lines().count() == 1, "{said}");
    assert!(fs::read(room.path("alone.wav")).unwrap() == fs::read(room.path("song.wav")).unwrap());
    let labels = fs::read(room.path("song.json")).unwrap();
    // In place of what is there, with stems or without, wherever they go.
    fs::write(room.path("song.json"), "old").unwrap();
    room.renders(&["song.mid", "-o", "x.wav", "--stems", "stems", "--labels", "song.json"]);
    assert!(fs::read(room.path("song.json")).unwrap() == labels);
    let output = room.run(&["render", "song.mid", "-o", "x.wav", "--labels", "-"]);
    assert!(output.status.success() && output.stdout == labels);
    // Another seed is another performance.
    room.renders(&["song.mid", "-o", "x.wav", "--labels", "other.json", "--seed", "1"]);
    let [usual, other] = ["song.json", "other.json"].map(|name| read(&room, name).1);
    assert_eq!((&usual["seed"], &other["seed"]), (&0.into(), &1.into()));
    assert!(usual["notes"][0]["stroke_force"] != other["notes"][0]["stroke_force"]);
    assert_eq!(usual["notes"][0]["fret"], other["notes"][0]["fret"]);
}

#[test]
fn each_song_may_have_differences_of_its_own() {
    let room = Room::new();
    // The same notes, and a text that nobody plays.
    fs::write(room.path("other.mid"), [&song()[..], &b"XTRA\0\0\0\x01."[..]].concat()).unwrap();
    let labels = |song: &str, seed: &str| {
        room.renders(&[song, "-q", "draft", "--tail", "none", "--seed", seed, "--labels", "x.json"]);
        read(&room, "x.json").1
    };
    let [one, other] = ["song.mid", "other.mid"].map(|name| labels(name, "song"));
    assert_eq!(one["seed"], crc32(&song()));
    assert!(one["seed"] != other["seed"] && one["gestures"] != other["gestures"]);
    assert_eq!(labels("song.mid", "0")["gestures"], labels("other.mid", "0")["gestures"]);
    // What labels say makes it again.
    let again = labels("song.mid", &one["seed"].to_string());
    assert!(again == one && labels("song.mid", "song") == one);
}

#[test]
fn they_say_what_they_are_of() {
    let room = Room::new();
    let own = "name = \"own\"\nbased_on = \"electric\"\ntuning = -1.0\n";
    fs::write(room.path("own.toml"), own).unwrap();
    room.renders(&[
        "song.mid",
        "-o",
        "x.wav",
        "--labels",
        "x.json",
        "-i",
        "own.toml",
        "-q",
        "draft",
        "-r",
        "44100",
        "--variation",
        "0.5",
        "--seed",
        "18446744073709551615",
        "--tail",
        "none",
        "--track",
        "1",
        "--set",
        "finger_force=60",
        "--set",
        "velocity_curve=2",
    ]);
    let (text, labels) = read(&room, "x.json");
    for (key, expected) in [
        ("program", Value::from(concat!("low-action ", env!("CARGO_PKG_VERSION")))),
        ("song", "song.mid".into()),
        ("song_bytes", song().len().into()),
        ("song_crc32", crc32(&song()).into()),
        ("instrument", "own.toml".into()),
        ("quality", "draft".into()),
        ("sample_rate", 44_100.into()),
        ("samples", 11_025.into()),
        ("duration", 0.25.into()),
        ("variation", 0.5.into()),
        ("seed", u64::MAX.into()),
        ("track", 1.into()),
        ("channel", Value::Null),
        ("input", "auto".into()),
        ("ignore_rpn", false.into()),
        ("hand_position", Value::Null),
        ("capo", Value::Null),
        ("legato", "pedal".into()),
        ("set", serde_json::json!({ "finger_force": "60 %", "velocity_curve": "2.00" })),
        ("ignore_hand_controllers", false.into()),
        ("allow_truncated", false.into()),
        ("tail", "0".into()),
        ("bit_depth", "24".into()),
    ] {
        assert_eq!(labels[key], expected, "{key}");
    }
    // The set-up whole, and its strings as they sound: E2 a semitone lower.
    let setup: Setup = serde_json::from_value(labels["setup"].clone()).unwrap();
    assert_eq!(setup, Setup::from_toml(own).unwrap());
    let lowest = &labels["strings"][5];
    assert_eq!((lowest["string"].as_u64(), lowest["pitch"].as_f64()), (Some(6), Some(39.0)));
    let hertz = lowest["frequency"].as_f64().unwrap();
    assert!((hertz - 440.0 / 32_f64.sqrt()).abs() < 1e-9, "{hertz}");
    assert_eq!(lowest["frets"].as_array().unwrap().len(), setup.neck.frets as usize);
    // T = 4L²f²ρ, and some more for the coarse grid of a stiff string.
    let [length, tension] = ["length", "tension"].map(|key| lowest[key].as_f64().unwrap());
    let flexible = 4.0 * (length * hertz).powi(2) * setup.string[5].linear_density;
    assert!((tension / flexible - 1.0).abs() < 0.02, "{tension} N, {flexible} N");
    // What rings when the sound ends.
    assert_eq!(labels["notes"][0]["end_by"], "file");
    assert_eq!(labels["notes"][0]["end_sample"], 11_025);
    assert!(text.lines().any(|line| line.starts_with("{\"string\":6,")), "a record has a line of its own");
}

/// The CRC-32 of ZIP files, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 * (crc & 1)))
    };
    !bytes.iter().fold(!0, step)
}

#[test]
fn what_could_not_be_played_as_written_is_counted() {
    let room = Room::new();
    let events: [(u8, &[u8]); 4] =
        [(0, &[0x90, 20, 90]), (0, &[0x92, 64, 90]), (48, &[0x80, 20, 0]), (0, &[0x82, 64, 0])];
    fs::write(room.path("odd.mid"), midi(&events)).unwrap();
    // The first string's octave over its lowest note, and a string that there is not.
    let strings = ["--input", "strings", "--first-channel", "16", "--labels", "odd.json"];
    let said = room.renders(&[&["odd.mid", "--tail", "0.2"][..], &strings].concat());
    assert!(said.contains("2 notes were left out"), "{said}");
    let labels = read(&room, "odd.json").1;
    assert_eq!(labels["compromises"]["without_string"], 2);
    assert_eq!(labels["notes"].as_array().unwrap().len(), 0);
    room.renders(&["odd.mid", "--tail", "0.2", "--labels", "odd.json"]);
    let labels = read(&room, "odd.json").1;
    assert_eq!(labels["compromises"]["moved_by_octaves"], 1);
    let pitches =
        labels["notes"].as_array().unwrap().iter().map(|note| (note["key"].as_u64(), note["pitch"].as_f64()));
    assert_eq!(pitches.collect::<Vec<_>>(), [(Some(20), Some(44.0)), (Some(64), Some(64.0))]);
}

#[test]
fn the_same_notes_are_played_where_the_hand_is_told_to() {
    let room = Room::new();
    let fret = |name: &str, said: &[u8], options: &[&str]| {
        let events: [(u8, &[u8]); 3] = [(0, said), (0, &[0x90, 67, 90]), (48, &[0x80, 67, 0])];
        fs::write(room.path("note.mid"), midi(&events)).unwrap();
        room.renders(&[&["note.mid", "--tail", "none", "--labels", name][..], options].concat());
        let labels = read(&room, name).1;
        (labels["hand_position"].clone(), labels["notes"][0]["fret"].as_u64())
    };
    // (Nobody listens to the first of these controllers.)
    let (nothing, twelfth) = ([0xB0, 3, 0], [0xB0, 28, 12]);
    assert_eq!(fret("usual.json", &nothing, &[]), (Value::Null, Some(3)));
    assert_eq!(fret("told.json", &nothing, &["--hand-position", "7"]), (7.into(), Some(8)));
    assert_eq!(fret("song.json", &twelfth, &["--hand-position", "7"]), (7.into(), Some(12)));
}

/// All kinds of notes and gestures, in five eighths of a second.
const ALL: [(u8, &[u8]); 11] = [
    (0, &[0xB0, 68, 127]),
    (0, &[0x90, 57, 90]),
    (24, &[0x90, 59, 90]),
    (24, &[0xB0, 65, 127]),
    (0, &[0x90, 62, 90]),
    (24, &[0xE0, 0, 80]),
    (24, &[0x80, 62, 0]),
    (0, &[0x80, 59, 0]),
    (0, &[0x80, 57, 0]),
    (24, &[0xB0, 22, 4]),
    (0, &[0x90, 40, 90]),
];

/// A song as the program plays it, kept.
fn record(song: &[u8], rate: u32, seconds: f64) -> Record {
    let options = EngineOptions::new(Setup::shipped("electric").unwrap(), f64::from(rate));
    let mut engine = Engine::new(&options).unwrap();
    engine.record();
    for event in Song::from_midi(song, Selection::default()).unwrap().events {
        engine.event(event.time.sample(rate) as u32, event.event);
    }
    let [mut left, mut right] = [(); 2].map(|()| vec![0.0; (seconds * f64::from(rate)) as usize]);
    engine.process(&mut left, &mut right);
    engine.take_record()
}

#[test]
fn numbers_are_to_the_last_bit_what_the_strings_are_given() {
    let room = Room::new();
    fs::write(room.path("all.mid"), midi(&ALL)).unwrap();
    let number = |line: &str, key: &str| {
        let (_, rest) = line.split_once(&format!("\"{key}\":"))?;
        rest.split([',', '}']).next()?.parse::<f64>().ok()
    };
    let mut kinds = BTreeSet::new();
    for (name, song, seconds) in [("song.mid", song(), 2.25), ("all.mid", midi(&ALL), 2.625)] {
        room.renders(&[name, "--tail", "2", "--labels", "song.json"]);
        let text = read(&room, "song.json").0;
        let mut given = record(&song, 48_000, seconds).gestures;
        given.sort_by_key(|gesture| (gesture.time, gesture.string));
        let (_, written) = text.split_once("\"gestures\":[").unwrap();
        let lines: Vec<&str> = written.lines().filter(|line| line.starts_with("{\"string\"")).collect();
        assert!(lines.len() > 15 && lines.len() == given.len(), "{} and {}", lines.len(), given.len());
        for (line, given) in lines.iter().zip(&given) {
            assert_eq!(number(line, "sample"), Some(given.time as f64), "{line}");
            assert_eq!(number(line, "string"), Some(given.string as f64 + 1.0), "{line}");
            let (kind, numbers) = said_of(given.gesture);
            assert!(line.contains(&format!("\"gesture\":\"{kind}\"")), "{kind}: {line}");
            for (key, value) in numbers {
                assert_eq!(number(line, key).map(f64::to_bits), Some(value.to_bits()), "{key} of {line}");
            }
            kinds.insert(kind);
        }
    }
    assert!(kinds.into_iter().eq(KINDS), "not all kinds of gestures");
}

/// All kinds of gestures.
const KINDS: [&str; 8] = ["bend", "lift", "place", "pluck", "press", "slide", "still", "throw"];

/// What labels call a gesture, and its numbers as they have them.
fn said_of(gesture: Gesture) -> (&'static str, Vec<(&'static str, f64)>) {
    let finger = |finger| ("finger", finger as f64 + 1.0);
    let touched = |touch: Touch| {
        [
            ("mass", touch.mass),
            ("stiffness", touch.stiffness),
            ("exponent", touch.exponent),
            ("damping", touch.damping),
            ("hand_damping", touch.hand_damping),
        ]
    };
    match gesture {
        Gesture::Pluck { position, force, duration, release } => (
            "pluck",
            vec![("position", position), ("force", force), ("duration", duration), ("release", release)],
        ),
        Gesture::Place { finger: slot, touch, position, clearance } => {
            let where_it_is = [finger(slot), ("position", position), ("clearance", clearance)];
            ("place", [&where_it_is[..], &touched(touch)].concat())
        }
        Gesture::Throw { finger: slot, touch, position, clearance, speed } => {
            let thrown = [finger(slot), ("position", position), ("clearance", clearance), ("speed", speed)];
            ("throw", [&thrown[..], &touched(touch)].concat())
        }
        Gesture::Press { finger: slot, force, duration } => {
            ("press", vec![finger(slot), ("force", force), ("duration", duration)])
        }
        Gesture::Lift { finger: slot, force, duration } => {
            ("lift", vec![finger(slot), ("force", force), ("duration", duration)])
        }
        Gesture::Slide { finger: slot, position, duration } => {
            ("slide", vec![finger(slot), ("position", position), ("duration", duration)])
        }
        Gesture::Still { loss, duration } => ("still", vec![("loss", loss), ("duration", duration)]),
        Gesture::Bend { tension_ratio, duration } => {
            ("bend", vec![("tension_ratio", tension_ratio), ("duration", duration)])
        }
    }
}

#[test]
fn every_key_is_documented() {
    let room = Room::new();
    fs::write(room.path("all.mid"), midi(&ALL)).unwrap();
    room.renders(&["all.mid", "--labels", "all.json"]);
    let mut labels = read(&room, "all.json").1;
    // Of this song all notes are played.
    assert_eq!(labels["unplayed"].as_array().unwrap().len(), 0);
    let twice: [(u8, &[u8]); 3] = [(0, &[0x90, 60, 90]), (0, &[0x90, 60, 80]), (24, &[0x80, 60, 0])];
    fs::write(room.path("twice.mid"), midi(&twice)).unwrap();
    room.renders(&["twice.mid", "-q", "draft", "--tail", "none", "--labels", "twice.json"]);
    labels["unplayed"] = read(&room, "twice.json").1["unplayed"].take();
    assert_eq!(labels["unplayed"][0]["velocity"], 80);
    let page = include_str!("../../../docs/formats.md");
    let (_, section) = page.split_once("\n## Labels\n").unwrap();
    let section = section.split("\n## ").next().unwrap();
    let documented = |word: &str| section.contains(&format!("`{word}`"));
    for (key, value) in labels.as_object().unwrap() {
        assert!(documented(key), "{key}");
        for record in value.as_array().into_iter().flatten().filter(|record| !record.is_string()) {
            record.as_object().unwrap().keys().for_each(|key| assert!(documented(key), "{key}"));
        }
    }
    let words = |list: &str, key: &str| -> Vec<String> {
        let records = labels[list].as_array().unwrap();
        records.iter().map(|record| record[key].as_str().unwrap().to_owned()).collect()
    };
    let mut used = words("gestures", "gesture");
    used.sort();
    used.dedup();
    assert_eq!(used, KINDS);
    let told = [words("notes", "technique"), words("notes", "stop"), words("notes", "end_by"), used].concat();
    told.iter()
        .for_each(|word| assert!(documented(word) || section.contains(&format!("`\"{word}\"`")), "{word}"));
}

#[test]
fn they_take_nobodys_place_and_leave_nothing() {
    let room = Room::new();
    fs::write(room.path("own.toml"), "name = \"own\"\nbased_on = \"electric\"\n").unwrap();
    fs::create_dir(room.path("folder")).unwrap();
    for (arguments, expected) in [
        (&["--labels", "song.mid"][..], ["the song and the labels", "song.mid"]),
        (&["--labels", "./own.toml", "-i", "own.toml"], ["the instrument and the labels", "own.toml"]),
        (&["-o", "x", "--labels", "folder/../x"], ["the sound and the labels", "x"]),
        (
            &["--stems", "new", "--labels", "new/1-E4.wav"],
            ["the sound of string E4 and the labels", "1-E4.wav"],
        ),
        (&["-o", "-", "--labels", "-"], ["the sound and the labels", "-"]),
    ] {
        let said = room.refuses(2, &[&["render", "song.mid"], arguments].concat());
        let all = expected.iter().chain(&["name the same file"]).all(|word| said.contains(word));
        assert!(all, "{arguments:?}: {said}");
    }
    for (labels, expected) in [
        ("folder", "cannot write folder: it is a folder"),
        ("no/such/x.json", "cannot write no/such/x.json: the folder no/such does not exist"),
    ] {
        let said = room.refuses(1, &["render", "song.mid", "--labels", labels, "--stems", "new"]);
        assert!(said.contains(expected), "{said}");
    }
    assert_eq!(fs::read(room.path("song.mid")).unwrap(), song());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_neither_sound_nor_labels() {
    let room = Room::new();
    let said = room.refuses(1, &["render", "song.mid", "-o", "x.wav", "--labels", "/dev/full"]);
    assert!(said.contains("cannot write /dev/full") && said.contains("space"), "{said}");
    room.renders(&["song.mid", "-o", "x.wav", "--labels", "/dev/null"]);
}
