//! However many threads share the strings, all files are the same bytes.

use std::collections::BTreeMap;
use std::fs;

use crate::room::{Room, midi};

/// What is written of a chord on all strings, by so many threads, each file under its name.
fn written(threads: &str) -> BTreeMap<String, Vec<u8>> {
    let room = Room::new();
    let keys = [40, 47, 52, 56, 59, 64];
    let down: Vec<[u8; 3]> = keys.iter().map(|&key| [0x90, key, 90]).collect();
    let up: Vec<[u8; 3]> = keys.iter().map(|&key| [0x80, key, 0]).collect();
    let down = down.iter().map(|message| (1, &message[..]));
    let up = up.iter().map(|message| (9, &message[..]));
    fs::write(room.path("song.mid"), midi(&down.chain(up).collect::<Vec<_>>())).unwrap();
    let files = ["-o", "out/song.wav", "--stems", "out", "--labels", "out/song.json"];
    fs::create_dir(room.path("out")).unwrap();
    room.renders(&[&["song.mid", "--quality", "draft", "--threads", threads], &files[..]].concat());
    let files = fs::read_dir(room.path("out")).unwrap().map(|file| file.unwrap());
    files.map(|file| (file.file_name().into_string().unwrap(), fs::read(file.path()).unwrap())).collect()
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let alone = written("1");
    let names: Vec<&str> = alone.keys().map(String::as_str).collect();
    let stems = ["1-E4.wav", "2-B3.wav", "3-G3.wav", "4-D3.wav", "5-A2.wav", "6-E2.wav"];
    assert_eq!(names, [&stems[..], &["song.json", "song.wav"]].concat());
    for threads in ["3", "64"] {
        let shared = written(threads);
        assert!(shared.keys().eq(alone.keys()), "{threads} threads: {:?}", shared.keys());
        for (name, bytes) in &alone {
            assert!(shared[name] == *bytes, "{name} by {threads} threads");
        }
    }
}
