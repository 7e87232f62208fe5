//! The promise: every note that sounds has one label, and its words say what hands do. What it has of numbers is what the
//! physics is given.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use low_action::midi_file::{Selection, Song};
use low_action::performance::PlayerEvent;
use low_action_tests::labelled::{Labelled, list, number, render, sample, song};
use serde_json::Value;

const PROGRAM: &str = env!("CARGO_BIN_EXE_low-action-command");
/// Labels do not depend on how exactly strings are computed.
const FAST: [&str; 6] = ["--quality", "draft", "--sample-rate", "8000", "--tail", "0.1"];

/// Names and bytes of the gestures' songs.
fn documented() -> Vec<(String, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/gestures");
    let entries = fs::read_dir(folder).expect("the folder is there");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    paths.sort();
    let read = |path: PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name, fs::read(path).expect("readable"))
    };
    paths.into_iter().map(read).collect()
}

#[test]
fn every_note_of_a_song_has_one_label() {
    let mut late = 0;
    let mut moved = 0;
    let mut songs = documented();
    // (Whose first keys make no sound.)
    songs.retain(|(name, _)| name != "keyswitches.mid");
    assert!(songs.len() > 10);
    for (name, bytes) in songs {
        let ([asked, told], played) = told(&bytes, &[]);
        assert_eq!(told, asked, "{name}");
        assert!(list(&played.labels, "unplayed").is_empty(), "{name}");
        for note in played.notes().iter().filter(|note| note["returned"] == false) {
            late += usize::from(number(note, "onset") - number(note, "asked") > 0.06);
            moved += usize::from(
                (number(note, "pitch") - number(note, "key")).abs() > 11.0 && note["partial"].is_null(),
            );
        }
        let onsets: Vec<usize> = played.notes().iter().map(|note| sample(note, "onset_sample")).collect();
        assert!(onsets.is_sorted(), "{name}");
        for note in played.notes() {
            let [asked, onset, end] =
                ["asked_sample", "onset_sample", "end_sample"].map(|key| sample(note, key));
            assert!(
                asked <= onset && onset <= end && end <= sample(&played.labels, "samples"),
                "{name}: {note}"
            );
        }
    }
    // Of chords with more notes than strings, and of strums.
    assert!(late > 20 && moved >= 4, "{late} late, {moved} moved");
}

/// All note-ons of a song, and what labels say of each that is no keyswitch: sample, channel, key and velocity.
fn told(bytes: &[u8], options: &[&str]) -> ([Vec<[u64; 4]>; 2], Labelled) {
    let asked = Song::from_midi(bytes, Selection::default()).expect("a song").events.into_iter();
    let asked = asked.filter_map(|event| match event.event {
        PlayerEvent::NoteOn { channel, key, velocity } => {
            let velocity = (velocity * 127.0).round() as u64;
            Some([event.time.sample(8000), u64::from(channel) + 1, u64::from(key), velocity])
        }
        _ => None,
    });
    let played = render(PROGRAM, bytes, &[&FAST[..], options].concat());
    let numbers =
        |note: &Value| ["asked_sample", "channel", "key", "velocity"].map(|key| sample(note, key) as u64);
    let first = played.notes().iter().filter(|note| note["returned"] == false);
    let told = first.chain(list(&played.labels, "unplayed")).map(numbers).collect();
    let mut both = [asked.collect(), told];
    both.iter_mut().for_each(|notes: &mut Vec<_>| notes.sort_unstable());
    (both, played)
}

#[test]
fn every_note_that_is_not_played_is_named() {
    let open = [40, 45, 50, 55, 59, 64];
    let strum = |time: u32| open.map(|key| (time, [0x90, key, 90]));
    let up = |time: u32| open.map(|key| (time, [0x80, key, 0]));
    // A strum that another overtakes, one that is called off, two notes in one, and one the sound ends before.
    let overtaken = [&[cc(21, 127)][..], &strum(0), &up(49), &strum(50), &up(900)].concat();
    let silenced = [&[cc(21, 127)][..], &strum(0), &[(200, [0xB0, 120, 0])], &up(900)].concat();
    let doubled = [(0, [0x90, 60, 90]), (0, [0x90, 60, 50]), (100, [0x80, 60, 0]), (100, [0x80, 60, 0])];
    let late = [&[cc(21, 127)][..], &strum(0)].concat();
    let strings: Vec<At> = (0..9).map(|channel| (0, [0x90 | channel, 60, 90])).collect();
    // So many that they wait for strings, and then all is to be silent.
    let crowd: Vec<At> = (30..90).map(|key| on(0, key)).chain([(150, [0xB0, 120, 0])]).collect();
    for (messages, options, expected) in [
        (&overtaken[..], &[][..], &[("overtaken", 5)][..]),
        (&silenced, &[], &[("left_out", 3)]),
        (&doubled, &[], &[("doubled", 1)]),
        (&late, &[], &[("file", 4)]),
        (&strings, &["--input", "strings"], &[("without_string", 3)]),
        (&crowd, &[], &[("left_out", 52)]),
        (&[on(0, 60), off(100, 60)], &[], &[]),
    ] {
        let ([asked, told], played) = told(&song(messages), options);
        assert_eq!(told, asked, "{messages:?}");
        let mut why: BTreeMap<&str, usize> = BTreeMap::new();
        for note in list(&played.labels, "unplayed") {
            *why.entry(note["why"].as_str().expect("a word")).or_default() += 1;
        }
        assert_eq!(why.into_iter().collect::<Vec<_>>(), expected, "{messages:?}");
        // As they are counted.
        for (word, notes) in expected.iter().filter(|(word, _)| *word != "file") {
            assert_eq!(sample(&played.labels["compromises"], word), *notes, "{messages:?}");
        }
    }
}

#[test]
fn notes_that_are_bent_short_are_marked() {
    let wide = [(0, [0xB0, 101, 0]), (0, [0xB0, 100, 0]), (0, [0xB0, 6, 24])];
    let bent =
        [on(0, 64), (100, [0xE0, 127, 127]), (400, [0xE0, 0, 64]), off(500, 64), on(1000, 64), off(1200, 64)];
    let played = render(PROGRAM, &song(&[&wide[..], &bent].concat()), &FAST);
    let marked: Vec<_> = played.notes().iter().map(|note| note["bent_short"].as_bool()).collect();
    assert_eq!(marked, [Some(true), Some(false)]);
    assert_eq!(played.labels["compromises"]["bent_short"], 1);
}

/// What is said of a note: key, technique, stop, whether it is a partial, whether it came back, how it ended.
type Said<'a> = (u64, &'a str, &'a str, Option<u64>, bool, &'a str);

fn said(note: &Value) -> Said<'_> {
    let word = |key: &str| note[key].as_str().expect("a word");
    let returned = note["returned"].as_bool().expect("yes or no");
    (
        sample(note, "key") as u64,
        word("technique"),
        word("stop"),
        note["partial"].as_u64(),
        returned,
        word("end_by"),
    )
}

/// A message at its time, ms.
type At = (u32, [u8; 3]);

/// A controller at the beginning.
fn cc(number: u8, value: u8) -> At {
    (0, [0xB0, number, value])
}

fn on(time: u32, key: u8) -> At {
    (time, [0x90, key, 100])
}

fn off(time: u32, key: u8) -> At {
    (time, [0x80, key, 0])
}

#[test]
fn strokes_and_stops_have_their_words() {
    for (controllers, key, technique, stop, partial) in [
        (&[][..], 57, "pluck", "finger", None),
        (&[], 64, "pluck", "open", None),
        (&[cc(22, 1)], 57, "up_stroke", "finger", None),
        (&[cc(22, 2)], 57, "pluck", "finger", None),
        (&[cc(22, 3)], 57, "rest_stroke", "finger", None),
        (&[cc(22, 4)], 57, "slap", "finger", None),
        (&[cc(22, 5)], 57, "pop", "finger", None),
        // 0.577 m from the finger to the saddle, 0.12 m to the pluck.
        (&[cc(22, 6)], 57, "pinch", "finger", Some(5)),
        // With the hand 45 mm nearer to it.
        (&[cc(74, 100), cc(22, 6)], 57, "pinch", "finger", Some(8)),
        (&[cc(22, 7)], 57, "tap", "finger", None),
        // What no finger presses to a fret is plucked.
        (&[cc(22, 7)], 64, "pluck", "open", None),
        // The second partial of E4, the sixth of B3.
        (&[cc(23, 1)], 76, "pluck", "harmonic", Some(2)),
        (&[cc(23, 1), cc(22, 1)], 90, "up_stroke", "harmonic", Some(6)),
        (&[cc(23, 2)], 57, "pluck", "muted", None),
        (&[cc(23, 2), cc(22, 4)], 64, "slap", "muted", None),
        (&[cc(23, 3)], 57, "pluck", "bar", None),
        (&[cc(26, 3)], 67, "pluck", "capo", None),
        (&[cc(26, 3)], 68, "pluck", "finger", None),
    ] {
        let song = song(&[controllers, &[on(0, key), off(300, key)]].concat());
        let played = render(PROGRAM, &song, &FAST);
        let expected = (u64::from(key), technique, stop, partial, false, "damped");
        assert_eq!(played.notes().iter().map(said).collect::<Vec<_>>(), [expected], "{controllers:?}");
    }
}

#[test]
fn what_connects_notes_and_what_ends_them_has_its_word() {
    let legato = cc(68, 127);
    let pluck = |key, end_by| (key, "pluck", "finger", None, false, end_by);
    let cases: [(&[At], &[Said]); 9] = [
        // A trill: the note below comes back each time.
        (
            &[legato, on(0, 57), on(200, 59), off(400, 59), on(600, 59), off(800, 59), off(1000, 57)],
            &[
                pluck(57, "note"),
                (59, "hammer_on", "finger", None, false, "note"),
                (57, "pull_off", "finger", None, true, "note"),
                (59, "hammer_on", "finger", None, false, "note"),
                (57, "pull_off", "finger", None, true, "damped"),
            ],
        ),
        (
            &[legato, on(0, 57), on(200, 55), off(300, 57), off(400, 55)],
            &[pluck(57, "note"), (55, "pull_off", "open", None, false, "damped")],
        ),
        (
            &[legato, cc(65, 127), on(0, 57), on(200, 64), off(300, 57), off(400, 64)],
            &[pluck(57, "note"), (64, "slide", "finger", None, false, "damped")],
        ),
        (
            &[legato, cc(23, 3), on(0, 57), on(200, 60), off(300, 57), off(400, 60)],
            &[(57, "pluck", "bar", None, false, "note"), (60, "slide", "bar", None, false, "damped")],
        ),
        // A bar is laid on the open string.
        (
            &[legato, cc(23, 3), on(0, 55), on(200, 60), off(300, 55), off(400, 60)],
            &[(55, "pluck", "open", None, false, "note"), (60, "hammer_on", "bar", None, false, "damped")],
        ),
        // Without legato, notes of one string are plucked.
        (&[on(0, 41), off(100, 41), on(200, 42), off(400, 42)], &[pluck(41, "damped"), pluck(42, "damped")]),
        (&[on(0, 41), off(200, 41), on(200, 42), off(400, 42)], &[pluck(41, "note"), pluck(42, "damped")]),
        // The pedal keeps it to the end of the file.
        (&[cc(64, 127), on(0, 57), off(200, 57)], &[pluck(57, "file")]),
        (&[cc(64, 127), on(0, 57), off(200, 57), (400, [0xB0, 64, 0])], &[pluck(57, "damped")]),
    ];
    for (messages, expected) in cases {
        let played = render(PROGRAM, &song(messages), &FAST);
        assert_eq!(played.notes().iter().map(said).collect::<Vec<_>>(), expected, "{messages:?}");
    }
    // Keys, pedals and hands at their times.
    let played = render(PROGRAM, &song(&[cc(64, 127), on(0, 57), off(200, 57), (400, [0xB0, 64, 0])]), &FAST);
    let note = &played.notes()[0];
    assert_eq!((note["released"].as_f64(), note["end"].as_f64()), (Some(0.2), Some(0.4)));
    // A tremolo is one note of many strokes, 20 a second.
    let played = render(PROGRAM, &song(&[cc(25, 127), on(0, 57), off(1000, 57)]), &FAST);
    assert_eq!((played.notes().len(), sample(&played.notes()[0], "strokes")), (1, 20));
}

#[test]
fn numbers_of_a_note_are_those_of_the_gesture_that_makes_it_sound() {
    // How many notes of each technique there are to look at, and by what gesture.
    let mut checked: BTreeMap<(String, String), usize> = BTreeMap::new();
    for (name, bytes) in documented() {
        let played = render(PROGRAM, &bytes, &FAST);
        let gestures = list(&played.labels, "gestures");
        let order = |gesture: &Value| (sample(gesture, "sample"), sample(gesture, "string"));
        assert!(gestures.is_sorted_by_key(order), "{name}");
        for note in played.notes().iter().filter(|note| !note["stroke_position"].is_null()) {
            let made_by = gestures.iter().find(|gesture| {
                order(gesture) == (sample(note, "onset_sample"), sample(note, "string"))
                    && ["pluck", "throw", "slide"].contains(&gesture["gesture"].as_str().expect("a word"))
                    && ["position", "force", "speed", "duration"]
                        .iter()
                        .all(|&key| gesture[key].as_f64() == note[format!("stroke_{key}")].as_f64())
            });
            let made_by = made_by.unwrap_or_else(|| panic!("{name}: {note}"));
            let [technique, gesture] = [&note["technique"], &made_by["gesture"]]
                .map(|word| word.as_str().expect("a word").to_owned());
            *checked.entry((technique, gesture)).or_default() += 1;
        }
    }
    println!("{checked:?}");
    let kinds = [
        ("hammer_on", "throw"),
        ("pinch", "pluck"),
        ("pluck", "pluck"),
        ("pop", "pluck"),
        ("pull_off", "pluck"),
        ("rest_stroke", "pluck"),
        ("slap", "throw"),
        ("slide", "slide"),
        ("tap", "throw"),
        ("up_stroke", "pluck"),
    ];
    let found = checked.keys().map(|(technique, gesture)| (technique.as_str(), gesture.as_str()));
    assert!(found.eq(kinds), "{checked:?}");
    assert!(
        checked.values().all(|&notes| notes >= 5) && checked.values().sum::<usize>() > 500,
        "{checked:?}"
    );
}
