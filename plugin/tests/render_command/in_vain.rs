//! A setting of something that the instrument does not have is warned of, and so is said in the labels.

use std::fs;

use serde_json::Value;

use crate::room::Room;

#[test]
fn settings_of_which_nothing_comes_are_warned_of() {
    let room = Room::new();
    let brief = ["song.mid", "-q", "draft", "--tail", "none", "--quiet", "--labels", "song.json"];
    let why = "does nothing: this instrument";
    for (instrument, settings, expected) in [
        (
            "electric",
            &["string_tuning_8=2"][..],
            vec![format!("--set string_tuning_8=+2.00 semitones {why} has no such string")],
        ),
        (
            "electric",
            &["idle_hands=0", "action=120"],
            vec![format!("--set idle_hands=0 % {why} has no body by which strings could sing along")],
        ),
        (
            "classical",
            &["pickup_position=100", "string_tuning_7=1", "idle_hands=0"],
            vec![
                format!("--set pickup_position=+100 mm {why} is heard without a coil"),
                format!("--set string_tuning_7=+1.00 semitones {why} has no such string"),
            ],
        ),
        ("electric", &["pickup_position=10", "string_tuning_6=-2"], vec![]),
    ] {
        let settings: Vec<&str> = settings.iter().flat_map(|setting| ["--set", setting]).collect();
        let said = room.renders(&[&brief[..], &["-i", instrument], &settings].concat());
        let lines: String = expected.iter().map(|line| format!("warning: song.mid: {line}\n")).collect();
        assert_eq!(said, lines);
        let labels: Value = serde_json::from_slice(&fs::read(room.path("song.json")).unwrap()).unwrap();
        assert_eq!(labels["warnings"], serde_json::json!(expected));
    }
}
