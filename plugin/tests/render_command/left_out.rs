//! Every note-on of a song is among the labels, played or not, and those that are left out have their reason.

use std::fs;

use serde_json::Value;

use crate::room::{Room, midi};

/// The keys of those that sound, and key, channel and reason of those that do not.
fn labelled(room: &Room, options: &[&str]) -> (Vec<u64>, Vec<(u64, u64, String)>) {
    let brief = ["x.mid", "-q", "draft", "--tail", "0.2", "--quiet", "--labels", "x.json"];
    room.renders(&[&brief[..], options].concat());
    let labels: Value = serde_json::from_slice(&fs::read(room.path("x.json")).unwrap()).unwrap();
    let list = |name: &str| labels[name].as_array().unwrap().clone();
    let number = |note: &Value, key: &str| note[key].as_u64().unwrap();
    let unplayed = list("unplayed").into_iter().map(|note| {
        (number(&note, "key"), number(&note, "channel"), note["why"].as_str().unwrap().to_owned())
    });
    (list("notes").iter().map(|note| number(note, "key")).collect(), unplayed.collect())
}

#[test]
fn percussion_and_channels_that_are_not_chosen_are_told() {
    let room = Room::new();
    let song: [(u8, &[u8]); 7] = [
        (0, &[0x90, 52, 90]),
        (0, &[0x99, 36, 90]),
        (12, &[0x91, 59, 90]),
        (12, &[0x80, 52, 0]),
        (0, &[0x81, 59, 0]),
        // After all that is played, in the tail; and after the end.
        (10, &[0x99, 38, 100]),
        (96, &[0x99, 40, 100]),
    ];
    fs::write(room.path("x.mid"), midi(&song)).unwrap();
    let told = |key, channel, why: &str| (key, channel, why.to_owned());
    let (notes, unplayed) = labelled(&room, &[]);
    let percussion = |key| told(key, 10, "percussion");
    assert_eq!(notes, [52, 59]);
    assert_eq!(unplayed, [36, 38].map(percussion));
    let (notes, unplayed) = labelled(&room, &["--channel", "1"]);
    assert_eq!(notes, [52]);
    assert_eq!(
        unplayed,
        [(36, 10), (59, 2), (38, 10)].map(|(key, channel)| told(key, channel, "not_chosen"))
    );
    // Where it is asked for, nothing is left out of it.
    let (notes, unplayed) = labelled(&room, &["--channel", "10"]);
    assert_eq!(notes.len() + unplayed.len(), 5, "{notes:?} {unplayed:?}");
    assert!(unplayed.iter().all(|(_, _, why)| why != "percussion"), "{unplayed:?}");
    let (notes, unplayed) = labelled(&room, &["--input", "keyboard", "--track", "1"]);
    assert_eq!((notes.len(), unplayed.len()), (2, 2));
}
