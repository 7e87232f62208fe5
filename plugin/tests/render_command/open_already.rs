//! What is open already, such as standard output, is written to by whatever name, and nothing else that is there is lost.

use std::fs::{self, File};
use std::io::Write;
use std::process::Stdio;

use crate::room::Room;

/// The shortest rendering.
const BRIEF: [&str; 8] = ["render", "song.mid", "-q", "draft", "-r", "8000", "--tail", "none"];

#[test]
fn two_results_are_not_written_to_it_by_two_names() {
    let room = Room::new();
    for (sound, labels) in [
        ("-", "/dev/stdout"),
        ("/dev/stdout", "-"),
        ("/dev/fd/1", "/dev/stdout"),
        ("/dev/stderr", "/dev/fd/2"),
    ] {
        let arguments = [&BRIEF[..], &["-o", sound, "--labels", labels]].concat();
        // Through a pipe, and into a file.
        let said = room.refuses(2, &arguments);
        assert!(said.contains("the sound and the labels name the same file"), "{said}");
        let out = room.path("out");
        let done = room.command(&arguments).stdout(File::create(&out).unwrap()).output().unwrap();
        assert_eq!((done.status.code(), fs::metadata(&out).unwrap().len()), (Some(2), 0), "{arguments:?}");
        fs::remove_file(out).unwrap();
    }
    // Nor to the file that it goes to.
    let out = File::create(room.path("out")).unwrap();
    let arguments = [&BRIEF[..], &["-o", "-", "--labels", "out"]].concat();
    let done = room.command(&arguments).stdout(out).output().unwrap();
    assert_eq!(done.status.code(), Some(2));
    // But each its own.
    let arguments = [&BRIEF[..], &["-o", "/dev/stdout", "--labels", "x.json"]].concat();
    let done = room.run(&arguments);
    assert!(done.status.success() && done.stdout.starts_with(b"RIFF") && room.path("x.json").exists());
}

#[test]
fn what_is_written_before_and_after_it_stays() {
    let room = Room::new();
    room.renders(&[&BRIEF[1..], &["-o", "x.wav"]].concat());
    let sound = fs::read(room.path("x.wav")).unwrap();
    let all = [&b"before"[..], &sound, b"after"].concat();
    for name in ["-", "/dev/stdout", "/dev/fd/1", "link"] {
        std::os::unix::fs::symlink("/dev/stdout", room.path("link")).ok();
        for appended in [false, true] {
            fs::write(room.path("log"), "").unwrap();
            let mut log = File::options().write(true).append(appended).open(room.path("log")).unwrap();
            log.write_all(b"before").unwrap();
            let mut command = room.command(&[&BRIEF[..], &["-o", name]].concat());
            assert!(command.stdout(log.try_clone().unwrap()).output().unwrap().status.success());
            log.write_all(b"after").unwrap();
            assert!(fs::read(room.path("log")).unwrap() == all, "{name} {appended}");
        }
    }
}

#[test]
fn any_number_of_it_is_added_to() {
    let room = Room::new();
    room.renders(&[&BRIEF[1..], &["-o", "x.wav"]].concat());
    let sound = fs::read(room.path("x.wav")).unwrap();
    fs::write(room.path("log"), "before").unwrap();
    // As the shell has it: it is the third, and the error.
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", "\"$@\" -o /dev/fd/3 --labels /dev/stderr 3>> log", "sh"]);
    let program = room.command(&BRIEF);
    shell.arg(program.get_program()).args(program.get_args()).current_dir(room.path("")).stdin(Stdio::null());
    let done = shell.output().unwrap();
    assert!(done.status.success() && done.stderr.starts_with(b"{"), "{done:?}");
    assert!(fs::read(room.path("log")).unwrap() == [&b"before"[..], &sound].concat());
    // What is not open is refused beforehand.
    let said = room.refuses(1, &[&BRIEF[..], &["-o", "/dev/fd/77"]].concat());
    assert!(said.contains("cannot write /dev/fd/77"), "{said}");
}

#[test]
fn a_song_that_is_open_already_has_no_name() {
    let room = Room::new();
    for (song, redirected) in
        [("/dev/fd/3", "3< song.mid"), ("/dev/stdin", "< song.mid"), ("-", "< song.mid")]
    {
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", &format!("\"$@\" {redirected}"), "sh"]);
        let program = room.command(&[&["render", song], &BRIEF[2..]].concat());
        let done = shell
            .arg(program.get_program())
            .args(program.get_args())
            .current_dir(room.path(""))
            .output()
            .unwrap();
        assert!(done.status.success(), "{done:?}");
        assert_eq!(room.files(), [room.path("song.mid"), room.path("song.wav")], "{song}");
        fs::remove_file(room.path("song.wav")).unwrap();
    }
}
