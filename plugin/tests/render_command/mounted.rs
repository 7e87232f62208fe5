//! A file that may be written but not replaced, as one that is mounted by itself in a container, gets what is computed.

use std::fs;
use std::process::{Command, Output};

use low_action::setups::FOLDER_VARIABLE;

use crate::room::{Room, peak};

/// Runs the program in a room after a command of the shell has mounted something there; nothing if it cannot be mounted.
fn where_is_mounted(room: &Room, mount: &str, arguments: &[&str]) -> Option<Output> {
    let program = room.command(&[]);
    let mut command = Command::new("unshare");
    command.args(["--user", "--map-root-user", "--mount", "sh", "-c"]);
    command.arg(format!("{mount} || exit 99; exec \"$@\"")).arg("sh").arg(program.get_program());
    command.args(arguments).current_dir(room.path("")).env(FOLDER_VARIABLE, room.path("instruments"));
    let output = command.output().ok()?;
    let said = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(99) || said.starts_with("unshare: ") {
        println!("passed over: nothing can be mounted here: {said}");
        return None;
    }
    Some(output)
}

const RENDER: [&str; 10] =
    ["render", "song.mid", "-q", "draft", "--tail", "none", "-o", "mounted.wav", "--labels", "new.json"];

#[test]
fn what_cannot_be_renamed_over_is_written_into() {
    let room = Room::new();
    for name in ["real.wav", "mounted.wav"] {
        // Longer than what is to come.
        fs::write(room.path(name), vec![1; 1_000_000]).unwrap();
    }
    let mount = "mount --bind real.wav mounted.wav";
    let Some(output) = where_is_mounted(&room, mount, &RENDER) else { return };
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    room.renders(&["song.mid", "-q", "draft", "--tail", "none", "-o", "plain.wav"]);
    assert!(peak(&room.path("real.wav")) > 0.01);
    assert!(fs::read(room.path("real.wav")).unwrap() == fs::read(room.path("plain.wav")).unwrap());
    // Nothing of it is left beside it.
    assert_eq!(room.files().len(), 5, "{:?}", room.files());
}

#[test]
fn what_may_be_written_where_nothing_new_may_be_is_written_into() {
    let room = Room::new();
    fs::create_dir(room.path("fixed")).unwrap();
    for name in ["real.wav", "fixed/own.wav"] {
        fs::write(room.path(name), vec![1; 1_000_000]).unwrap();
    }
    let temporary = room.path("temporary");
    fs::create_dir(&temporary).unwrap();
    let mount = format!(
        "export TMPDIR={}; mount --bind fixed fixed && mount --bind real.wav fixed/own.wav && \
         mount -o remount,bind,ro fixed",
        temporary.display()
    );
    let render = ["render", "song.mid", "-q", "draft", "--tail", "none", "-o"];
    let Some(output) = where_is_mounted(&room, &mount, &[&render[..], &["fixed/own.wav"]].concat()) else {
        return;
    };
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    room.renders(&[&render[1..], &["plain.wav"]].concat());
    assert!(fs::read(room.path("real.wav")).unwrap() == fs::read(room.path("plain.wav")).unwrap());
    // Nothing of it is left, and what is not there yet cannot be.
    assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0);
    let output = where_is_mounted(&room, &mount, &[&render[..], &["fixed/new.wav"]].concat()).unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("error: cannot write fixed/new.wav: read-only"), "{said}");
}

#[test]
fn what_it_has_no_room_for_is_kept_beside_it_and_named() {
    let room = Room::new();
    fs::write(room.path("mounted.wav"), "").unwrap();
    fs::create_dir(room.path("small")).unwrap();
    let mount = "mount -t tmpfs -o size=16k none small && touch small/real.wav && \
                 mount --bind small/real.wav mounted.wav";
    let Some(output) = where_is_mounted(&room, mount, &RENDER) else { return };
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    // The labels come before it, and are named.
    assert!(said.starts_with("error: only new.json was written: cannot write "), "{said}");
    let (reason, kept) = said.trim_end().split_once("; kept: ").unwrap();
    assert!(reason.contains("mounted.wav: No space left") && said.lines().count() == 1, "{said}");
    let kept: Vec<_> = kept.split(", ").map(|kept| kept.split_once(" as ").unwrap()).collect();
    let [(sound, sound_kept)] = kept.as_slice() else { panic!("{said}") };
    assert!(sound.ends_with("mounted.wav"), "{said}");
    assert!(peak(&room.path(sound_kept)) > 0.01);
    let labels = fs::read_to_string(room.path("new.json")).unwrap();
    assert!(labels.starts_with('{') && labels.ends_with("}\n"), "{labels}");
}

/// Not after hours, when it is full.
#[test]
fn a_trace_that_there_is_no_room_for_is_refused_before_the_work() {
    let room = Room::new();
    let scene = "sample_rate = 44100\nduration = 1.0\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\ntension = 60.0\n\
                 shape = [[0.0, 0.0], [0.3, 0.001], [0.65, 0.0]]\n";
    fs::write(room.path("scene.toml"), scene).unwrap();
    fs::create_dir(room.path("small")).unwrap();
    let mount = "mount -t tmpfs -o size=1m none small";
    let run = |every: &str| {
        let trace = ["scene", "scene.toml", "--trace", "small/out.npz", "--every", every];
        let output = where_is_mounted(&room, mount, &trace)?;
        Some((output.status.code(), String::from_utf8(output.stderr).unwrap()))
    };
    let Some((code, said)) = run("1") else { return };
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.starts_with("error: --every 1 is refused: the trace would take ") && said.lines().count() == 1,
        "{said}"
    );
    assert!(said.contains(" where it goes: it must be at least "), "{said}");
    // What is named is enough, and no less is.
    let least = said.trim_end().rsplit(' ').next().unwrap();
    let (code, said) = run(least).unwrap();
    assert_eq!(code, Some(0), "{least}: {said}");
    let less = (least.parse::<u64>().unwrap() - 1).to_string();
    assert!(run(&less).unwrap().1.contains(&format!("it must be at least {least}")));
}
