//! What is there already is not rendered again where that is asked for, and only what is there whole is there.

use std::fs;

use crate::room::{Room, midi};

/// The shortest rendering of all that there can be of a song.
const ALL: [&str; 10] = [
    "song.mid",
    "-q",
    "draft",
    "--tail",
    "none",
    "--stems",
    "stems",
    "--labels",
    "song.json",
    "--skip-existing",
];

#[test]
fn a_song_is_rendered_again_as_long_as_any_of_its_files_is_missing() {
    let room = Room::new();
    let all = &ALL[..];
    let first = room.renders(all);
    assert!(!first.contains("again") && first.contains("times faster than real time"), "{first}");
    let skipped = "song.wav: skipped: all that is asked for is there already\n";
    for missing in ["song.wav", "song.json", "stems/3-G3.wav"] {
        // Nothing is written, and what is there need not be what would be written.
        let old = fs::read_to_string(room.path("song.json")).unwrap().replace("\"notes\"", "\"old\"");
        fs::write(room.path("song.json"), &old).unwrap();
        assert_eq!(room.renders(all), skipped);
        assert_eq!(fs::read_to_string(room.path("song.json")).unwrap(), old);
        fs::remove_file(room.path(missing)).unwrap();
        let said = room.renders(all);
        let reason = format!("song.wav: rendered again: {missing} is not there\n");
        assert!(said.starts_with(&reason), "{missing}: {said}");
        assert!(said.contains("times faster than real time"), "{missing}: {said}");
        assert!(
            room.path(missing).exists() && fs::read_to_string(room.path("song.json")).unwrap() != old,
            "{missing}"
        );
    }
    // Fewer of them may be asked for; without it everything is rendered.
    assert_eq!(room.renders(&["song.mid", "--skip-existing"]), skipped);
    assert!(room.renders(&all[..9]).contains("times faster"));
}

#[test]
fn what_labels_say_is_of_something_else_is_rendered_again() {
    let room = Room::new();
    room.renders(&ALL);
    fs::rename(room.path("song.mid"), room.path("moved.mid")).unwrap();
    let all = |options: &[&str]| -> String {
        room.renders(&[&["moved.mid", "-o", "song.wav"], &ALL[1..], options].concat())
    };
    let sound = || fs::read(room.path("song.wav")).unwrap();
    let mut before = sound();
    let mut again = |options: &[&str], expected: &str| {
        let said = all(options);
        let expected = format!("song.wav: rendered again: {expected}\n");
        assert!(said.starts_with(&expected) && said.contains("times faster"), "{options:?}: {said}");
        assert!(sound() != before, "{options:?}");
        before = sound();
        let said = all(options);
        assert!(said.contains("skipped") && said.lines().count() == 1, "{options:?}: {said}");
    };
    again(&["--seed", "1"], "seed was 0 and is 1");
    again(
        &["--seed", "1", "-i", "flatwound-jazz"],
        "instrument was \"electric\" and is \"flatwound-jazz\", and 1 more",
    );
    again(&["-i", "flatwound-jazz", "--set", "action=120"], "seed was 1 and is 0, and 2 more");
    fs::write(room.path("moved.mid"), midi(&[(0, &[0x90, 45, 90]), (48, &[0x80, 45, 0])])).unwrap();
    let said = all(&["-i", "flatwound-jazz", "--set", "action=120"]);
    assert!(said.starts_with("song.wav: rendered again: song_bytes was "), "{said}");
    // Another version of the program may play otherwise.
    let labels = fs::read_to_string(room.path("song.json")).unwrap();
    let program = concat!("low-action ", env!("CARGO_PKG_VERSION"));
    fs::write(room.path("song.json"), labels.replace(program, "low-action 0.0.1")).unwrap();
    let said = all(&["-i", "flatwound-jazz", "--set", "action=120"]);
    assert!(said.starts_with("song.wav: rendered again: program was \"low-action 0.0.1\" and is "), "{said}");
    // Without labels nobody knows.
    assert!(room.renders(&["moved.mid", "-o", "song.wav", "--skip-existing"]).contains("skipped"));
}

/// Whatever labels lie beside it.
#[test]
fn a_sound_of_another_form_or_length_is_rendered_again() {
    let room = Room::new();
    room.renders(&ALL);
    let whole = fs::read(room.path("song.wav")).unwrap();
    let length = labelled_samples(&room);
    for (options, expected) in [
        (["--bit-depth", "16"], "16 bit and not 24 bit".to_owned()),
        (["--bit-depth", "32f"], "32f bit and not 24 bit".into()),
        (["--sample-rate", "8000"], "8000 Hz and not 48000 Hz".into()),
        (["--tail", "0.5"], format!("{} samples and not {length} samples", length + 24_000)),
    ] {
        let brief = ["song.mid", "-q", "draft", "--tail", "none"];
        let brief = if options[0] == "--tail" { &brief[..3] } else { &brief[..] };
        room.renders(&[brief, &options[..]].concat());
        // Without labels that is known of what the options say.
        let said = room.renders(&[&ALL[..5], &["--skip-existing"]].concat());
        assert_eq!(said.contains("rendered again"), options[0] != "--tail", "{options:?}: {said}");
        room.renders(&[brief, &options[..]].concat());
        let said = room.renders(&ALL);
        assert!(
            said.starts_with(&format!("song.wav: rendered again: song.wav is of {expected}\n")),
            "{options:?}: {said}"
        );
        assert!(fs::read(room.path("song.wav")).unwrap() == whole, "{options:?}");
    }
    fs::copy(room.path("stems/3-G3.wav"), room.path("song.wav")).unwrap();
    let said = room.renders(&ALL);
    assert!(said.starts_with("song.wav: rendered again: song.wav is of 1 channel and not 2"), "{said}");
}

/// Two songs that are given one folder for their strings.
#[test]
fn strings_of_another_song_are_rendered_again() {
    let room = Room::new();
    fs::write(room.path("long.mid"), midi(&[(0, &[0x90, 45, 90]), (96, &[0x80, 45, 0])])).unwrap();
    for labels in [&[][..], &["--labels", "song.json"]] {
        let all = [&ALL[..7], &["--skip-existing"], labels].concat();
        room.renders(&all);
        assert!(room.renders(&all).contains("skipped"));
        room.renders(&[&["long.mid"], &ALL[1..7]].concat());
        let said = room.renders(&all);
        assert!(said.starts_with("song.wav: rendered again: stems/1-E4.wav is of "), "{said}");
        assert!(room.renders(&all).contains("skipped"));
    }
}

/// How many samples the labels say there are.
fn labelled_samples(room: &Room) -> u64 {
    let labels = fs::read_to_string(room.path("song.json")).unwrap();
    let (_, samples) = labels.split_once("\"samples\":").unwrap();
    samples.split(',').next().unwrap().trim().parse().unwrap()
}

#[test]
fn what_is_no_file_is_never_there() {
    let room = Room::new();
    let brief = ["render", "song.mid", "-q", "draft", "--tail", "none", "--skip-existing", "-o"];
    fs::create_dir(room.path("folder")).unwrap();
    assert!(room.refuses(1, &[&brief[..], &["folder"]].concat()).contains("it is a folder"));
    let output = room.run(&[&brief[..], &["-"]].concat());
    assert!(output.status.success() && output.stdout.starts_with(b"RIFF"));
    // Nor may the sound be what it is made from, though that is there.
    assert!(room.refuses(2, &[&brief[..], &["song.mid"]].concat()).contains("name the same file"));
}

#[test]
fn what_is_not_whole_is_not_there() {
    let room = Room::new();
    room.renders(&ALL);
    for name in ["song.wav", "song.json", "stems/3-G3.wav"] {
        let whole = fs::read(room.path(name)).unwrap();
        for length in [0, 7, whole.len() / 2, whole.len() - 1] {
            fs::write(room.path(name), &whole[..length]).unwrap();
            let said = room.renders(&ALL);
            let reason = format!("song.wav: rendered again: {name} is not whole\n");
            assert!(said.starts_with(&reason), "{length} bytes of {name}: {said}");
            assert!(said.contains("times faster than real time"), "{length} bytes of {name}: {said}");
            assert!(fs::read(room.path(name)).unwrap() == whole, "{length} bytes of {name}");
        }
        fs::write(room.path(name), [&whole[..], b" "].concat()).unwrap();
        assert!(room.renders(&ALL).contains("times faster than real time"), "more than {name}");
    }
    assert!(room.renders(&ALL).contains("skipped"));
}

#[test]
fn who_asks_for_quiet_hears_of_nothing_that_goes_well() {
    let room = Room::new();
    let quiet = [&ALL[..], &["--quiet"]].concat();
    // Rendered, and skipped.
    assert_eq!(room.renders(&quiet), "");
    assert!(room.path("song.wav").exists());
    assert_eq!(room.renders(&quiet), "");
    // What is not as asked is said.
    let said = room.renders(&[&quiet[..], &["--seed", "1"]].concat());
    assert_eq!(said, "song.wav: rendered again: seed was 0 and is 1\n");
    fs::write(room.path("odd.mid"), midi(&[(0, &[0x90, 20, 90]), (48, &[0x80, 20, 0])])).unwrap();
    let said = room.renders(&["odd.mid", "-q", "draft", "--quiet"]);
    assert!(said.starts_with("warning: odd.mid: 1 note was moved") && said.lines().count() == 1, "{said}");
    assert!(room.refuses(1, &["render", "none.mid", "--quiet"]).contains("cannot read none.mid"));
}
