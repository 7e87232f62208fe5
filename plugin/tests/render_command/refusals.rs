//! The rest is refused in one line, and nothing is left or lost.

use std::fs;

use midly::num::u24;
use midly::{MetaMessage, TrackEventKind};

#[cfg(unix)]
use crate::room::peak;
use crate::room::{Room, message, midi_of, song};

#[test]
fn wrong_usage_is_code_2() {
    let room = Room::new();
    for (arguments, expected) in [
        (&["render", "song.mid", "--sample-rate", "0"][..], "8000 to 384000"),
        (&["render", "song.mid", "--sample-rate", "-48000"], "8000 to 384000"),
        (&["render", "song.mid", "--sample-rate", "1e12"], "'1e12' for '--sample-rate <HZ>': must be"),
        (&["render", "song.mid", "--bit-depth", "20"], "16, 24 or 32f"),
        (&["render", "song.mid", "--tail", "-1"], "auto, none or 0 to 3600"),
        (&["render", "song.mid", "--tail", "nan"], "auto, none or 0 to 3600"),
        (&["render", "song.mid", "--tail", "1e18"], "auto, none or 0 to 3600"),
        (&["render", "song.mid", "--quality", "best"], "draft, live, studio or reference"),
        (
            &["render", "song.mid", "--channel", "17"],
            "'17' for '--channel <N>': must be a whole number from 1 to 16",
        ),
        (&["render", "song.mid", "--channel", "1.5"], "must be a whole number from 1 to 16"),
        (
            &["render", "song.mid", "--track", "0"],
            "'0' for '--track <N>': must be a whole number from 1 to 65535",
        ),
        (&["render", "song.mid", "--max-length", "0"], "above 0"),
        (&["render", "song.mid", "--variation", "2"], "0 to 1"),
        (&["render", "song.mid", "--instrument", "banjo"], "electric, classical, steel, bass"),
        (&["render", "song.mid", "--instrument", ""], "unknown instrument \"\": must be electric"),
        (&["render", "song.mid", "--input", "guitar"], "auto, keyboard, strings, mpe"),
        (&["render", "song.mid", "--first-channel", "0"], "must be a whole number from 1 to 16"),
        (&["render", "song.mid", "--string-order", "up"], "first_first, last_first"),
        (&["render", "song.mid", "--first-channel", "2"], "--first-channel is only for --input strings"),
        (
            &["render", "song.mid", "--input", "mpe", "--string-order", "last_first"],
            "--string-order is only for --input strings",
        ),
        (
            &["render", "song.mid", "--input", "strings", "--hand-position", "5"],
            "--hand-position is not for --input strings",
        ),
        (&["render", "song.mid", "--bend-range", "97"], "0 to 96 semitones"),
        (&["render", "song.mid", "--legato", "never"], "pedal, always"),
        (&["render", "song.mid", "--set", "pluck_force"], "must be ID=VALUE, as velocity_curve=2"),
        (&["render", "song.mid", "--set", "pluck_force=501"], "pluck_force must be 5 % to 500 %"),
        (&["render", "song.mid", "--set", "keyswitches=109"], "keyswitches must be off, or 0 to 108"),
        (
            &["render", "song.mid", "--set", "level=0"],
            "there is no parameter level: must be action, relief, ",
        ),
        (
            &["render", "song.mid", "--set", "=2"],
            "'=2' for '--set <ID=VALUE>': must be ID=VALUE, as velocity_curve=2",
        ),
        (
            &["render", "song.mid", "--set", "take=1", "--set", "variation=0", "--set", "variation=1"],
            "--set variation cannot be used multiple times",
        ),
        (&["render", "song.mid", "--set", "capo=2"], "capo has an option of its own, --capo"),
        (
            &["render", "song.mid", "--set", "take=2"],
            "--set take is for the stand-alone instrument: a song has --seed",
        ),
        // What is no fret of any instrument is refused as what is none of this one.
        (
            &["render", "song.mid", "--hand-position", "0"],
            "--hand-position 0 is refused: must be a whole number from 1 to 22 on electric",
        ),
        (
            &["render", "song.mid", "--hand-position", "40", "-i", "classical"],
            "--hand-position 40 is refused: must be a whole number from 1 to 19 on classical",
        ),
        (
            &["render", "song.mid", "--hand-position", "-1e99"],
            "--hand-position -1e99 is refused: must be a whole number from 1 to 22 on electric",
        ),
        (
            &["render", "song.mid", "--hand-position", "x\ny", "-i", "tanpura"],
            "--hand-position \"x\\ny\" is refused: tanpura has no frets",
        ),
        (
            &["render", "song.mid", "--capo", "99999999999999999999"],
            "--capo 99999999999999999999 is refused: must be a whole number from 1 to 17 on electric, so that five",
        ),
        (
            &["render", "song.mid", "--capo", "18"],
            "--capo 18 is refused: must be a whole number from 1 to 17 on electric, so that five frets are left",
        ),
        (
            &["render", "song.mid", "--capo", "1", "-i", "lap-steel"],
            "no capo on lap-steel: its strings are too",
        ),
        (
            &["render", "song.mid", "--capo", "1", "-i", "tanpura"],
            "no capo on tanpura: it leaves no five frets",
        ),
        (
            &["render", "song.mid", "--hand-position", "20", "-i", "classical"],
            "--hand-position 20 is refused: must be a whole number from 1 to 19 on classical",
        ),
        (
            &["render", "song.mid", "--hand-position", "1", "-i", "tanpura"],
            "--hand-position 1 is refused: tanpura has no frets",
        ),
        (
            &["render", "song.mid", "--input", "mpe", "--bend-range", "12"],
            "--bend-range is not for --input mpe: there wheels reach 48 semitones",
        ),
        (
            &["render", "song.mid", "--threads", "0"],
            "'0' for '--threads <N>': must be a whole number from 1 to 64",
        ),
        (
            &["render", "song.mid", "--threads", "65"],
            "'65' for '--threads <N>': must be a whole number from 1 to 64",
        ),
        (&["render", "song.mid", "--threads", "-1"], "'-1' for '--threads <N>': must be a whole number"),
        (&["render", "song.mid", "--threads", "x"], "'x' for '--threads <N>': must be a whole number"),
        (&["render", "song.mid", "more.mid"], "more.mid"),
        (
            &["render", "song.mid", "--seed", "-1"],
            "'-1' for '--seed <N|song>': must be a whole number from 0 to 184467",
        ),
        (
            &["render", "song.mid", "--seed", "1.5"],
            "must be a whole number from 0 to 18446744073709551615, or song (see",
        ),
        // What begins with a dash and is no option, either.
        (
            &["render", "song.mid", "--variation", "-1e-9"],
            "'-1e-9' for '--variation <AMOUNT>': must be 0 to 1",
        ),
        (&["render", "song.mid", "--tail", "-.5"], "'-.5' for '--tail <auto|SECONDS|none>': must be auto"),
        (&["render", "song.mid", "--tail", "-inf"], "'-inf' for '--tail <auto|SECONDS|none>': must be auto"),
        (
            &["render", "song.mid", "--seed", "-x"],
            "'-x' for '--seed <N|song>': must be a whole number from 0",
        ),
        (&["render", "song.mid", "--max-length", "-1e3"], "'-1e3' for '--max-length <MIN>': must be above 0"),
        (&["render", "--bogus"], "'--bogus' found (see low-action render --help)"),
        (
            &["render", "--qualty", "studio"],
            "found; tip: a similar argument exists: '--quality' (see low-action render --help)",
        ),
        (&["instruments", "--bogus"], "(see low-action instruments --help)"),
        (&["--bogus"], "(see low-action --help)"),
        (&["sing"], "sing"),
        (
            &["rende", "song.mid"],
            "unknown command \"rende\": must be render, scene, instruments (see low-action --help)",
        ),
    ] {
        let said = room.refuses(2, arguments);
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
    // What is not refused is where labels say.
    room.renders(&["song.mid", "-q", "draft", "--tail", "none", "--capo", "17", "--hand-position", "22"]);
}

#[test]
fn sound_in_another_form_is_not_promised() {
    let room = Room::new();
    for name in ["x.flac", "x.mp3", "no/such/x.ogg", "x.AIF", "x.wav.aiff"] {
        let expected = format!("{name} is refused: low-action writes WAV");
        let said = room.refuses(2, &["render", "song.mid", "-o", name]);
        assert!(said.contains(&format!("-o {expected}")), "{said}");
    }
    for (option, name, form) in [
        ("-o", "other.mid", "WAV"),
        ("-o", "mine.toml", "WAV"),
        ("--labels", "other.MIDI", "JSON"),
        ("--labels", "x.csv", "JSON"),
    ] {
        let said = room.refuses(2, &["render", "song.mid", option, name]);
        assert!(said.contains(&format!("{option} {name} is refused: low-action writes {form}")), "{said}");
    }
    fs::write(room.path("a.toml"), include_str!("../../../docs/figures/string_over_frets.toml")).unwrap();
    let said = room.refuses(2, &["scene", "a.toml", "--figure", "b.toml"]);
    assert!(said.contains("--figure b.toml is refused: low-action writes SVG"), "{said}");
    // Other names may be of anything.
    for name in ["flac", "x", "x.wave", "x.WAV"] {
        room.renders(&["song.mid", "-q", "draft", "--tail", "none", "-o", name]);
    }
}

#[test]
fn what_cannot_be_done_is_code_1_and_leaves_nothing() {
    let room = Room::new();
    let whole = song();
    fs::write(room.path("cut.mid"), &whole[..20]).unwrap();
    fs::write(room.path("last.mid"), &whole[..whole.len() - 9]).unwrap();
    fs::write(room.path("text.mid"), "not music").unwrap();
    fs::write(room.path("none.mid"), b"MThd\0\0\0\x06\0\x01\0\0\0\x60").unwrap();
    fs::write(room.path("fewer.mid"), b"MThd\0\0\0\x06\0\x01\0\x01\0\x60").unwrap();
    fs::write(room.path("empty"), "").unwrap();
    fs::create_dir(room.path("folder")).unwrap();
    fs::write(room.path("bad.toml"), "name = \"x\"\nbogus = 1\n").unwrap();
    fs::write(room.path("bytes.toml"), b"name = \"\xff\"\n").unwrap();
    let electric = include_str!("../../../dsp/instruments/electric.toml");
    fs::write(room.path("heavy.toml"), electric.replace("mass = ", "mass = -")).unwrap();
    for (arguments, expected) in [
        (&["render", "missing.mid"][..], "cannot read missing.mid"),
        (&["render", "folder"], "folder"),
        (&["render", "text.mid"], "not a MIDI file"),
        (&["render", "empty"], "not a MIDI file"),
        (&["render", "cut.mid"], "truncated MIDI file"),
        (&["render", "cut.mid", "--allow-truncated"], "truncated MIDI file"),
        (&["render", "last.mid"], "9 are left (--allow-truncated plays what they hold)"),
        (
            &["render", "song.mid", "--track", "2"],
            "no track 2: the file has 1 in all, so --track takes 1 only",
        ),
        (&["render", "none.mid", "--track", "1"], "none.mid: no track 1: the file has 0 in all\n"),
        (&["render", "fewer.mid"], "the header's count of tracks is 1, and 0 can be found"),
        (&["render", "song.mid", "-o", "no/such/folder/x.wav"], "cannot write no/such/folder/x.wav"),
        (&["render", "song.mid", "-o", "text.mid/x.wav"], "cannot write text.mid/x.wav"),
        (&["render", "song.mid", "-o", "folder"], "it is a folder"),
        (&["render", "song.mid", "--stems", "text.mid"], "cannot make the folder text.mid: it is a file\n"),
        (
            &["render", "song.mid", "-o", "new/x.wav", "--stems", "new", "--labels", "no/such/x.json"],
            "cannot write no/such/x.json",
        ),
        // The first of these folders could be made.
        (
            &["render", "song.mid", "--stems", &format!("new/{}", "x".repeat(300))],
            "cannot make the folder new",
        ),
        (&["render", "song.mid", "--instrument", "missing.toml"], "missing.toml"),
        (&["render", "song.mid", "--instrument", "bad.toml"], "bogus"),
        (&["render", "song.mid", "--instrument", "heavy.toml"], "mass"),
        (&["render", "song.mid", "--instrument", "song.mid"], "song.mid"),
        (
            &["render", "song.mid", "--instrument", "bytes.toml"],
            "cannot read the instrument bytes.toml: it is not UTF-8 text\n",
        ),
    ] {
        let said = room.refuses(1, arguments);
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
    assert_eq!(fs::read(room.path("song.mid")).unwrap(), whole);
}

#[test]
fn no_sound_takes_the_place_of_another_or_of_what_it_is_made_from() {
    let room = Room::new();
    let own = "name = \"own\"\ndescription = \"mine\"\nbased_on = \"electric\"\n";
    fs::write(room.path("own.toml"), own).unwrap();
    fs::create_dir(room.path("same")).unwrap();
    fs::write(room.path("same/1-E4.wav"), song()).unwrap();
    for (arguments, expected) in [
        (&["render", "song.mid", "-o", "song.mid"][..], ["the song", "song.mid"]),
        (&["render", "song.mid", "-o", "./same/../song.mid"], ["the song", "song.mid"]),
        (&["render", "song.mid", "-i", "own.toml", "-o", "./own.toml"], ["the instrument", "own.toml"]),
        (&["render", "same/1-E4.wav", "-o", "x.wav", "--stems", "same"], ["the song", "string E4"]),
        (&["render", "song.mid", "-o", "new/1-E4.wav", "--stems", "./new"], ["the sound", "string E4"]),
    ] {
        let said = room.refuses(2, arguments);
        let all = expected.iter().chain(&["name the same file"]).all(|word| said.contains(word));
        assert!(all, "{arguments:?}: {said}");
    }
    assert_eq!(fs::read(room.path("song.mid")).unwrap(), song());
    assert_eq!(fs::read(room.path("same/1-E4.wav")).unwrap(), song());
    assert_eq!(fs::read_to_string(room.path("own.toml")).unwrap(), own);
    assert!(!room.path("new").exists() && !room.path("x.wav").exists());
}

#[test]
fn names_of_any_length_become_names_of_files() {
    let room = Room::new();
    let own = "name = \"own\"\ndescription = \"mine\"\nbased_on = \"electric\"\n[[string]]\nname = \"";
    fs::write(room.path("own.toml"), format!("{own}{}\"\n", "E/é".repeat(200))).unwrap();
    room.renders(&["song.mid", "-i", "own.toml", "--stems", "stems", "--tail", "none"]);
    assert_eq!(fs::read_dir(room.path("stems")).unwrap().count(), 6);
}

#[cfg(unix)]
#[test]
fn names_give_no_orders_to_the_terminal() {
    let room = Room::new();
    fs::write(room.path("a\nb\u{1b}.mid"), song()).unwrap();
    let said = room.renders(&["a\nb\u{1b}.mid", "--tail", "none", "--quality", "draft"]);
    assert!(said.starts_with("a\\nb\\u{1b}.wav: ") && said.lines().count() == 1, "{said:?}");
    for arguments in [
        &["render", "c\nd\u{1b}.mid"][..],
        &["render", "-o", "c\nd\u{1b}/x.wav"],
        &["scene", "c\nd\u{1b}.toml"],
    ] {
        let said = room.refuses(1, arguments);
        assert!(said.contains("c\\nd\\u{1b}") && !said.contains('\u{1b}'), "{said:?}");
    }
    let said = room.refuses(2, &["render", "--b\u{1b}"]);
    assert!(!said.contains('\u{1b}'), "{said:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn names_of_files_may_be_any_bytes_and_what_else_is_no_text_is_named() {
    use std::os::unix::ffi::OsStrExt;

    let room = Room::new();
    let strange =
        |before: &str| std::ffi::OsStr::from_bytes(&[before.as_bytes(), b"a\xff"].concat()).to_owned();
    let own = "name = \"own\"\ndescription = \"mine\"\nbased_on = \"electric\"\n";
    fs::write(room.path("").join(strange("")), own).unwrap();
    let mut command = room.command(&["render", "song.mid", "-q", "draft", "--tail", "none", "-i"]);
    let output = command.arg(strange("./")).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    for (option, value, expected) in [
        ("--quality", "", "'a\u{fffd}' for '--quality <QUALITY>'"),
        ("--seed", "", "'a\u{fffd}' for '--seed <N|song>'"),
        ("-q", "", "'a\u{fffd}' for '--quality <QUALITY>'"),
        ("-i", "-q", "'a\u{fffd}' for '--quality <QUALITY>'"),
        ("--allow-truncated", "--track=", "'a\u{fffd}' for '--track <N>'"),
    ] {
        let mut command = room.command(&["render", "song.mid", "-o"]);
        command.arg(strange("x")).args(["--labels", "x", option]);
        let output = command.args((option == "-i").then_some("./a")).arg(strange(value)).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            said.starts_with(&format!("error: invalid value {expected}: it is not UTF-8 text (see")),
            "{said}"
        );
        assert_eq!(output.status.code(), Some(2));
    }
}

#[test]
fn an_hour_is_the_limit_unless_another_is_named() {
    let room = Room::new();
    // 17 seconds a beat, and two notes 240 beats apart: 68 minutes.
    let slow = TrackEventKind::Meta(MetaMessage::Tempo(u24::new(0xFF_FFFF)));
    let mut events = vec![(0, slow), (0, message(&[0x90, 60, 90]))];
    events.extend(std::iter::repeat_n((96, message(&[0xB0, 7, 100])), 242));
    events.push((96, message(&[0x80, 60, 0])));
    fs::write(room.path("long.mid"), midi_of(&events)).unwrap();
    let said = room.refuses(1, &["render", "long.mid"]);
    assert!(
        said.contains("long.mid")
            && said.contains("minutes")
            && said.contains("limit of 60")
            && said.contains("--max-length"),
        "{said}"
    );
    // More than a WAV file holds, whatever is allowed.
    let finest = ["--sample-rate", "384000", "--bit-depth", "32f"];
    let most = [&["render", "long.mid", "--max-length", "1000"], &finest[..]].concat();
    assert!(room.refuses(1, &most).contains("do not fit in a WAV file"));
    // However little is too much, it is shown as too much. (23.3 minutes would fit, were there no notes that wait for strings.)
    let said = room.refuses(1, &[&["render", "song.mid", "--tail", "1388.9"], &finest[..]].concat());
    assert!(
        said.contains("song.mid: 23.16 minutes do not fit in a WAV file (4 GiB): at most 23.15 at"),
        "{said}"
    );
    // The limit can be lowered, too: to what the music is said to last, and no less.
    let said = room.refuses(1, &["render", "song.mid", "--max-length", "1e-7"]);
    assert!(said.contains("the music lasts 0.004167 minutes, over the limit of 1e-7: raise it"), "{said}");
    room.refuses(1, &["render", "song.mid", "--max-length", "0.004166"]);
    room.renders(&["song.mid", "--max-length", "0.004167", "--tail", "none"]);
}

#[cfg(target_os = "linux")]
#[test]
fn devices_are_written_directly() {
    let room = Room::new();
    room.renders(&["song.mid", "-o", "/dev/null"]);
    let said = room.refuses(1, &["render", "song.mid", "-o", "/dev/full"]);
    assert!(said.contains("cannot write /dev/full") && said.contains("space"), "{said}");
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = room.command(&["render", "song.mid", "-o", "-"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    for arguments in [&["--help"][..], &["scene", "--help"], &["instruments"]] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let output = room.command(arguments).stdout(full).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            said.starts_with("error: cannot write to standard output: No space"),
            "{arguments:?}: {said}"
        );
        assert_eq!(output.status.code(), Some(1));
    }
    // What goes there waits in a folder for such files.
    let mut command = room.command(&["render", "song.mid", "-o", "-"]);
    let output = command.env("TMPDIR", "no/such").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("error: cannot make a temporary file in no/such: "), "{said}");
    // An endless source ends and is refused.
    assert!(room.refuses(1, &["render", "/dev/zero"]).contains("at most"));
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link() {
    let room = Room::new();
    fs::write(room.path("real.wav"), "old").unwrap();
    std::os::unix::fs::symlink("real.wav", room.path("link.wav")).unwrap();
    room.renders(&["song.mid", "-o", "link.wav"]);
    assert!(fs::symlink_metadata(room.path("link.wav")).unwrap().is_symlink());
    assert!(peak(&room.path("real.wav")) > 0.01);
    std::os::unix::fs::symlink("new.wav", room.path("ahead.wav")).unwrap();
    room.renders(&["song.mid", "-o", "ahead.wav"]);
    assert!(fs::symlink_metadata(room.path("ahead.wav")).unwrap().is_symlink());
    assert!(peak(&room.path("new.wav")) > 0.01);
    // Which is found out beforehand.
    std::os::unix::fs::symlink("no/such/x.wav", room.path("astray.wav")).unwrap();
    let said = room.refuses(1, &["render", "song.mid", "-o", "astray.wav"]);
    assert!(said.contains("cannot write astray.wav") && said.contains("no/such does not exist"), "{said}");
}

#[cfg(unix)]
#[test]
fn a_private_file_stays_private_and_a_protected_one_as_it_is() {
    use std::io::ErrorKind;
    use std::os::unix::fs::PermissionsExt;
    use std::os::unix::process::CommandExt;

    let room = Room::new();
    let set =
        |name: &str, mode| fs::set_permissions(room.path(name), fs::Permissions::from_mode(mode)).unwrap();
    fs::write(room.path("own.wav"), "old").unwrap();
    set("own.wav", 0o600);
    room.renders(&["song.mid", "-o", "own.wav"]);
    assert_eq!(fs::metadata(room.path("own.wav")).unwrap().permissions().mode() & 0o777, 0o600);
    assert!(peak(&room.path("own.wav")) > 0.01);

    fs::write(room.path("kept.wav"), "old").unwrap();
    set("kept.wav", 0o444);
    let mut command = room.command(&["render", "song.mid", "-o", "kept.wav"]);
    // Root may write anything, and so lets nobody try, in a folder where anybody may rename files.
    if fs::File::options().write(true).open(room.path("kept.wav")).is_ok() {
        set("", 0o777);
        fs::copy(command.get_program(), room.path("program")).unwrap();
        let mut by_nobody = std::process::Command::new(room.path("program"));
        by_nobody.current_dir(room.path("")).args(command.get_args()).uid(65534);
        command = by_nobody;
    }
    let before = room.files();
    let mut tries = 0..100;
    let output = loop {
        match command.output() {
            Ok(output) => break output,
            // A test that was starting a program while the copy was written has it open for a moment.
            Err(error) if error.kind() == ErrorKind::ExecutableFileBusy && tries.next().is_some() => {
                std::thread::sleep(std::time::Duration::from_millis(20));
            }
            Err(error) if error.kind() == ErrorKind::PermissionDenied => {
                println!("passed over: nobody can run a copy of the program here");
                return;
            }
            Err(error) => panic!("{error}"),
        }
    };
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("error: cannot write kept.wav: Permission denied"), "{said}");
    assert_eq!(fs::read_to_string(room.path("kept.wav")).unwrap(), "old");
    assert_eq!(room.files(), before);
}

#[cfg(unix)]
#[test]
fn a_reader_who_has_seen_enough_of_the_help_is_no_failure() {
    let room = Room::new();
    for arguments in [&["--help"][..], &["render", "--help"], &["--version"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = room.command(arguments).stdout(writer).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), said.as_str()), (Some(0), ""), "{arguments:?}");
    }
}

#[test]
fn what_the_help_shows_can_be_typed() {
    let room = Room::new();
    for arguments in
        [&["--help"][..], &["render", "--help"], &["scene", "--help"], &["instruments", "--help"]]
    {
        let help = String::from_utf8(room.run(arguments).stdout).unwrap();
        assert!(help.lines().all(|line| !line.contains("\\\"")), "{arguments:?}: {help}");
    }
    // As it is shown, quotes and all.
    let help = String::from_utf8(room.run(&["render", "--help"]).stdout).unwrap();
    assert!(help.contains("pluck_force=\"80 %\""), "{help}");
    room.renders(&["song.mid", "-q", "draft", "--tail", "none", "--set", "pluck_force=80 %"]);
}

#[test]
fn the_help_says_how_far_wheels_reach() {
    let help = String::from_utf8(Room::new().run(&["render", "--help"]).stdout).unwrap();
    let (_, help) = help.split_once("--bend-range").unwrap();
    let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
    // As it is refused with --input mpe, and as docs/plugin.md has it.
    for said in ["[default: 2]", "for MPE: there it is 48, channel 1's 2, or what the song says"] {
        assert!(words.split("--ignore-rpn").next().unwrap().contains(said), "{words}");
    }
}

#[test]
fn without_a_command_it_says_how_to_get_the_instrument() {
    let room = Room::new();
    if !cfg!(feature = "standalone") {
        assert!(room.refuses(2, &[]).contains("--features standalone"));
    }
    for arguments in [&["--help"][..], &["render", "--help"], &["scene", "--help"], &["--version"]] {
        let output = room.run(arguments);
        assert_eq!(output.status.code(), Some(0));
        assert!(output.stderr.is_empty() && !output.stdout.is_empty());
    }
}
