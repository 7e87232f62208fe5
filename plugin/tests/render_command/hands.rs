//! What hands are told by options is what a song tells them.

use std::fs;

use serde_json::Value;

use crate::room::{Room, midi, song};

/// The shortest rendering with labels.
const BRIEF: [&str; 8] = ["-q", "draft", "-r", "8000", "--tail", "none", "--labels", "x.json"];

/// The sound of a song of the room with such options, and its labels.
fn rendered(room: &Room, song: &str, options: &[&str]) -> (Vec<u8>, Value) {
    room.renders(&[&[song, "-o", "x.wav"], &BRIEF[..], options].concat());
    let labels = fs::read_to_string(room.path("x.json")).unwrap();
    (fs::read(room.path("x.wav")).unwrap(), serde_json::from_str(&labels).unwrap())
}

/// Writes the usual song with messages before it.
fn write_after(room: &Room, name: &str, messages: &[[u8; 3]]) {
    let notes: [(u8, &[u8]); 4] =
        [(0, &[0x90, 52, 90]), (24, &[0x90, 59, 90]), (24, &[0x80, 52, 0]), (0, &[0x80, 59, 0])];
    assert_eq!(midi(&notes), song());
    let before = messages.iter().map(|message| (0, &message[..]));
    fs::write(room.path(name), midi(&before.chain(notes).collect::<Vec<_>>())).unwrap();
}

#[test]
fn a_capo_is_that_of_its_controller() {
    let room = Room::new();
    write_after(&room, "told.mid", &[[0xB0, 26, 2]]);
    write_after(&room, "none.mid", &[[0xB0, 26, 0]]);
    write_after(&room, "off.mid", &[[0xB0, 26, 2], [0xB0, 26, 0]]);
    let [told, usual] = ["told.mid", "song.mid"].map(|song| rendered(&room, song, &[]));
    let asked = rendered(&room, "song.mid", &["--capo", "2"]);
    assert!(asked.0 == told.0 && asked.0 != usual.0);
    // E on the open string over it, of which the labels say what they say of the controller's.
    assert_eq!((&asked.1["capo"], &told.1["capo"]), (&Value::from(2), &Value::Null));
    assert_eq!(asked.1["notes"], told.1["notes"]);
    assert!(
        asked.1["notes"].as_array().unwrap().iter().any(|note| note["stop"] == "capo"),
        "{}",
        asked.1["notes"]
    );
    // The song has the last word. (The hand has gone up the neck for it, and stays there.)
    let off = rendered(&room, "off.mid", &[]).0;
    assert!(rendered(&room, "none.mid", &["--capo", "2"]).0 == off && off != told.0);
}

#[test]
fn controllers_of_hands_are_passed_over_where_that_is_asked_for() {
    let room = Room::new();
    write_after(&room, "told.mid", &[[0xB0, 20, 100]]);
    let [told, usual] = ["told.mid", "song.mid"].map(|song| rendered(&room, song, &[]));
    let passed = rendered(&room, "told.mid", &["--ignore-hand-controllers"]);
    assert!(passed.0 == usual.0 && told.0 != usual.0);
    assert_eq!((&passed.1["ignore_hand_controllers"], &passed.1["notes"]), (&true.into(), &usual.1["notes"]));
}
