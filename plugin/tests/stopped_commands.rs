//! The promise of all commands that write files: told to stop, by Ctrl+C or by the system, they leave nothing half
//! written and nothing that was not there. Run on the program itself.
#![cfg(unix)]
// A panic is a test's report.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A scene that takes minutes.
const LONG: &str = "sample_rate = 44100\nduration = 3600\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                    tension = 60.0\n";

/// Whether this process was started with one of the signals ignored, as nohup does and shells do in the background. The
/// commands it runs then ignore them too, as they should.
fn ignores_signals() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    // Signal n is bit n − 1: HUP 1, INT 2, TERM 15.
    ignored.unwrap_or(0) & (1 | 1 << 1 | 1 << 14) != 0
}

/// Names of all there is in a folder, hidden or not, in order.
fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<String> = names.map(|name| name.into_string().unwrap()).collect();
    names.sort();
    names
}

/// Runs a command until it has begun its files, and stops it by a signal.
fn is_stopped(signal: &str, arguments: &[&str], begun: &str) {
    if ignores_signals() {
        println!("passed over: signals are ignored here");
        return;
    }
    let room = tempfile::tempdir().unwrap();
    fs::write(room.path().join("long.toml"), LONG).unwrap();
    fs::write(room.path().join("old.wav"), "old").unwrap();
    let before = names(room.path());
    let mut command = Command::new(env!("CARGO_BIN_EXE_low-action"));
    command.current_dir(room.path()).args(arguments).stdin(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let started = Instant::now();
    let has_begun = || {
        fs::read_dir(room.path().join(begun)).is_ok_and(|files| {
            files.flatten().any(|file| file.file_name().to_string_lossy().ends_with(".part"))
        })
    };
    while !has_begun() {
        assert!(started.elapsed() < Duration::from_secs(60), "nothing was begun");
        assert!(child.try_wait().unwrap().is_none(), "it has ended");
        sleep(Duration::from_millis(5));
    }
    // A file is there a moment before it is known.
    sleep(Duration::from_millis(200));
    let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    assert_eq!(child.wait().unwrap().code(), Some(130), "{signal}");
    assert_eq!(names(room.path()), before, "{signal} {arguments:?}");
    assert_eq!(fs::read_to_string(room.path().join("old.wav")).unwrap(), "old");
}

#[test]
fn a_scene_leaves_nothing() {
    let arguments = ["scene", "long.toml", "--wav", "old.wav", "--trace", "new.npz", "--every", "1000"];
    for signal in ["INT", "TERM", "HUP"] {
        is_stopped(signal, &arguments, ".");
    }
}

#[test]
fn a_song_and_its_stems_leave_nothing() {
    let arguments =
        ["render", "-o", "old.wav", "--stems", "new/stems", "--quality", "reference", "--tail", "3600"];
    is_stopped("INT", &arguments, "new/stems");
}
