//! The promise of all commands that write files: told to stop, by Ctrl+C or by the system, they leave nothing half
//! written and nothing that was not there, and end by that very signal, so that a shell's loop over songs ends with them.
//! Run on the program itself.
#![cfg(unix)]
// A panic is a test's report.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::io::Write;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use low_action::setups::FOLDER_VARIABLE;
use tempfile::TempDir;

/// A scene that takes minutes.
const LONG: &str = "sample_rate = 44100\nduration = 3600\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                    tension = 60.0\n";

/// The number of a signal.
fn number(signal: &str) -> libc::c_int {
    match signal {
        "HUP" => libc::SIGHUP,
        "INT" => libc::SIGINT,
        "QUIT" => libc::SIGQUIT,
        "ALRM" => libc::SIGALRM,
        "USR1" => libc::SIGUSR1,
        "USR2" => libc::SIGUSR2,
        "XCPU" => libc::SIGXCPU,
        "XFSZ" => libc::SIGXFSZ,
        _ => libc::SIGTERM,
    }
}

/// Sends a signal, at once: starting `kill` would take a millisecond. What has ended gets none.
fn send(signal: &str, child: &mut Child) {
    if child.try_wait().unwrap().is_some() {
        return;
    }
    let id = libc::pid_t::try_from(child.id()).unwrap();
    // SAFETY: it takes two numbers. The child's end has not been asked for since, so nobody else has its number.
    assert_eq!(unsafe { libc::kill(id, number(signal)) }, 0);
}

/// Sends a signal to a child that leads a group and to all that is in it, as a terminal does with Ctrl+C.
fn send_to_group(signal: &str, leader: &Child) {
    let id = libc::pid_t::try_from(leader.id()).unwrap();
    // SAFETY: it takes two numbers. The leader's end has not been asked for, so nobody else has its number.
    assert_eq!(unsafe { libc::kill(-id, number(signal)) }, 0);
}

/// Whether this process was started with a signal ignored, as nohup does and shells do in the background. The commands it
/// runs then ignore it too, as they should.
fn ignores(signal: &str) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    let ignored = ignored.unwrap_or(0) & 1 << (number(signal) - 1) != 0;
    if ignored {
        println!("passed over: {signal} is ignored here");
    }
    ignored
}

/// Names of all there is in a folder, hidden or not, in order.
fn names(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<String> = names.map(|name| name.into_string().unwrap()).collect();
    names.sort();
    names
}

/// Whether there is a file in a folder that is being written.
fn has_part(folder: &Path) -> bool {
    let part = |file: fs::DirEntry| file.file_name().to_string_lossy().ends_with(".part");
    fs::read_dir(folder).is_ok_and(|files| files.flatten().any(part))
}

/// A folder with what commands read.
fn room() -> TempDir {
    let room = tempfile::tempdir().unwrap();
    fs::write(room.path().join("long.toml"), LONG).unwrap();
    fs::write(room.path().join("old.wav"), "old").unwrap();
    room
}

/// Starts a command in a room, with some signals ignored, and comes back at the moment at which something is there, or when
/// it has ended.
fn begin(room: &Path, ignored: &[&str], arguments: &[&str], begun: impl Fn() -> bool) -> Child {
    let ignoring: String = ignored.iter().map(|signal| format!("trap '' {signal}; ")).collect();
    let mut command = Command::new("sh");
    // (Some signals would leave an image of the memory where there is no limit to it.)
    command.args([
        "-c",
        &format!("{ignoring}ulimit -c 0; exec \"$@\""),
        "sh",
        env!("CARGO_BIN_EXE_low-action"),
    ]);
    command.env(FOLDER_VARIABLE, room.join("instruments"));
    command.current_dir(room).args(arguments).stdin(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().unwrap();
    wait_for(|| begun() || child.try_wait().unwrap().is_some());
    child
}

/// Comes back at the moment at which something is so.
fn wait_for(mut so: impl FnMut() -> bool) {
    let started = Instant::now();
    while !so() {
        assert!(started.elapsed() < Duration::from_secs(60), "it takes too long");
    }
}

/// How many bytes there are in the files of a folder and of those in it.
fn bytes_in(folder: &Path) -> u64 {
    let size = |file: fs::DirEntry| match file.metadata() {
        Ok(about) if about.is_dir() => bytes_in(&file.path()),
        about => about.map_or(0, |about| about.len()),
    };
    fs::read_dir(folder).map_or(0, |files| files.flatten().map(size).sum())
}

/// Whether a command writes more from now on, or ends.
fn goes_on(room: &Path, child: &mut Child) -> bool {
    // What was under way when this was asked may still come: more than a block of it does not.
    let (before, more) = (bytes_in(room), 100_000);
    let started = Instant::now();
    while bytes_in(room) <= before + more {
        if child.try_wait().unwrap().is_some() {
            return false;
        }
        assert!(started.elapsed() < Duration::from_secs(60), "nothing happens");
        sleep(Duration::from_millis(1));
    }
    true
}

/// Runs a command and stops it by a signal, at the moment at which something is there. It is started with others ignored,
/// and sent those before.
fn is_stopped(signal: &str, ignored: &[&str], arguments: &[&str], begun: impl Fn(&Path) -> bool) {
    if ignores(signal) {
        return;
    }
    let room = room();
    let before = names(room.path());
    let begun = || begun(room.path());
    let mut child = begin(room.path(), ignored, arguments, begun);
    for ignored in ignored {
        send(ignored, &mut child);
        // It goes on with its work.
        assert!(goes_on(room.path(), &mut child), "{ignored} is ignored");
        assert!(begun(), "{ignored} is ignored");
    }
    send(signal, &mut child);
    assert_eq!(child.wait().unwrap().signal(), Some(number(signal)), "{signal} {ignored:?}");
    assert_eq!(names(room.path()), before, "{signal} {ignored:?} {arguments:?}");
    assert_eq!(fs::read_to_string(room.path().join("old.wav")).unwrap(), "old");
}

#[test]
fn a_scene_leaves_nothing() {
    let arguments = ["scene", "long.toml", "--wav", "old.wav", "--trace", "new.npz", "--every", "1000"];
    for signal in ["INT", "TERM", "HUP", "QUIT", "ALRM", "USR1", "USR2", "XCPU"] {
        is_stopped(signal, &[], &arguments, has_part);
    }
}

#[test]
fn a_file_that_may_not_get_longer_is_an_error_and_leaves_nothing() {
    if ignores("XFSZ") {
        return;
    }
    let room = room();
    let before = names(room.path());
    let mut command = Command::new("sh");
    let limited = "ulimit -f 100; exec \"$0\" render -o old.wav --stems new/stems --tail none";
    command.args(["-c", limited, env!("CARGO_BIN_EXE_low-action")]).current_dir(room.path());
    let done = command.env(FOLDER_VARIABLE, room.path().join("instruments")).output().unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{said}");
    assert!(said.starts_with("error: cannot write ") && said.lines().count() == 1, "{said}");
    assert_eq!(names(room.path()), before);
}

/// A song that takes minutes, with stems in folders that are not there yet, and labels.
const SONG: [&str; 11] = [
    "render",
    "-o",
    "old.wav",
    "--stems",
    "new/stems",
    "--labels",
    "new.json",
    "--quality",
    "reference",
    "--tail",
    "3600",
];

/// Stops at the first file and at the first folder. Where these are entered after they are made, 28 of 60 and 7 of 60 leave
/// something: so many all go well by chance once in 290 000 times and once in 140.
const STOPS: [usize; 2] = [20, 40];

#[test]
fn a_song_and_its_stems_leave_nothing_from_the_moment_they_are_there() {
    for _ in 0..STOPS[0] {
        is_stopped("INT", &[], &SONG, has_part);
    }
    for _ in 0..STOPS[1] {
        is_stopped("INT", &[], &SONG, |room| room.join("new").exists());
    }
}

#[test]
fn a_signal_that_is_ignored_takes_nothing_from_the_others() {
    for (signal, ignored) in
        [("TERM", &["INT"][..]), ("INT", &["HUP"]), ("TERM", &["HUP"]), ("HUP", &["INT", "TERM"])]
    {
        is_stopped(signal, ignored, &SONG, |room| has_part(&room.join("new/stems")));
    }
}

/// A MIDI file of one short note.
#[cfg(target_os = "linux")]
const SHORT_SONG: &[u8] =
    b"MThd\0\0\0\x06\0\0\0\x01\0\x60MTrk\0\0\0\x0c\0\x90\x28\x40\x08\x80\x28\0\0\xff\x2f\0";

/// What numbers of requests are, in one library and in others.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
type Request = libc::c_uint;
#[cfg(all(target_os = "linux", not(target_env = "gnu")))]
type Request = libc::c_int;

/// The first thread of a program, which stands still wherever it calls the system or comes back from there. Its other threads go on.
#[cfg(target_os = "linux")]
struct Held(libc::pid_t);

#[cfg(target_os = "linux")]
impl Held {
    /// Takes hold of a program, where that is allowed.
    fn take(child: &Child) -> Option<Self> {
        let held = Self(libc::pid_t::try_from(child.id()).unwrap());
        (held.does(libc::PTRACE_SEIZE) && held.does(libc::PTRACE_INTERRUPT) && held.stands()).then_some(held)
    }

    /// Has it go on to where it stands still next, if it does.
    fn steps(&self) -> bool {
        self.does(libc::PTRACE_SYSCALL) && self.stands()
    }

    /// Lets go of it.
    fn end(self) {
        // (It may have ended.)
        self.does(libc::PTRACE_DETACH);
    }

    fn does(&self, request: Request) -> bool {
        let none = std::ptr::null_mut::<libc::c_void>();
        // SAFETY: of these requests none reads or writes memory. The child's end has not been asked for, so nobody else has its
        // number.
        unsafe { libc::ptrace(request, self.0, none, none) == 0 }
    }

    /// Waits until it stands still, or has ended.
    fn stands(&self) -> bool {
        let mut status = 0;
        // SAFETY: it writes a number, for which there is room.
        let found = unsafe { libc::waitpid(self.0, &raw mut status, libc::__WALL) };
        found == self.0 && libc::WIFSTOPPED(status)
    }
}

/// Stopped while so many of its files are there and the others are still to come.
#[cfg(target_os = "linux")]
#[test]
fn a_song_its_stems_and_its_labels_appear_all_or_none() {
    if ignores("INT") {
        return;
    }
    let files = ["new.wav", "new.json", "new/1-E4.wav", "new/2-B3.wav", "new/3-G3.wav", "new/4-D3.wav"];
    let files = [&files[..], &["new/5-A2.wav", "new/6-E2.wav"]].concat();
    for there in 1..files.len() {
        let room = room();
        fs::write(room.path().join("short.mid"), SHORT_SONG).unwrap();
        let arguments = ["render", "short.mid", "-o", "new.wav", "--stems", "new", "--labels", "new.json"];
        let cheap = ["--quality", "draft", "--tail", "none"];
        let appeared = || files.iter().filter(|name| room.path().join(name).exists()).count();
        let mut child = begin(room.path(), &[], &[&arguments[..], &cheap].concat(), || true);
        let Some(held) = Held::take(&child) else {
            child.kill().unwrap();
            child.wait().unwrap();
            return println!("passed over: no program can be held here");
        };
        while appeared() < there {
            assert!(held.steps(), "it has ended before {there} files are there");
        }
        assert_eq!(appeared(), there);
        send("INT", &mut child);
        // Whoever minds the signal has time to do so.
        sleep(Duration::from_millis(100));
        held.end();
        // It may have come to its end as well.
        let status = child.wait().unwrap();
        assert!(status.success() || status.signal() == Some(libc::SIGINT), "{status}");
        assert_eq!(appeared(), files.len(), "{status}, stopped when {there} were there");
        assert_eq!(names(room.path()), ["long.toml", "new", "new.json", "new.wav", "old.wav", "short.mid"]);
        assert_eq!(names(&room.path().join("new")).len(), 6);
    }
}

/// Whoever is killed tidies nothing up, and a script that takes up its work again looks whether the sound is there.
#[test]
fn the_sound_of_a_song_appears_after_its_labels_and_its_stems() {
    let room = room();
    let arguments = ["render", "-o", "new.wav", "--stems", "new", "--labels", "new.json"];
    let begun = || has_part(room.path()) && has_part(&room.path().join("new"));
    let mut child = begin(room.path(), &[], &arguments, begun);
    // What comes after the sound, which cannot take its place, does not appear either.
    fs::create_dir(room.path().join("new.wav")).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1));
    assert!(room.path().join("new.json").exists(), "the labels come after the sound");
    let stems = names(&room.path().join("new"));
    assert!(stems.len() == 6 && stems.iter().all(|name| name.ends_with(".wav")), "{stems:?}");
}

#[test]
fn set_ups_are_installed_all_or_none() {
    if ignores("INT") {
        return;
    }
    let room = room();
    let files: Vec<String> = (10..60).map(|number| format!("own{number}.toml")).collect();
    let text = |base: &str| format!("name = \"own\"\nbased_on = \"{base}\"\n");
    let install: Vec<&str> =
        ["instruments", "--install"].into_iter().chain(files.iter().map(String::as_str)).collect();
    let folder = room.path().join("instruments");
    // Where there is no folder yet, and over what is there.
    for base in ["electric", "classical"] {
        files.iter().for_each(|file| fs::write(room.path().join(file), text(base)).unwrap());
        let mut child = begin(room.path(), &[], &install, || has_part(&folder));
        send("INT", &mut child);
        // It may have come to its end as well.
        let status = child.wait().unwrap();
        assert!(status.success() || status.signal() == Some(libc::SIGINT), "{status}");
        assert_eq!(names(&folder), files);
        // Once begun it goes through.
        for file in &files {
            assert_eq!(fs::read_to_string(folder.join(file)).unwrap(), text(base), "{file}");
        }
    }
}

/// Bash ends a loop at Ctrl+C only if what runs in it has ended by that.
#[test]
fn a_loop_of_the_shell_is_stopped_too() {
    if ignores("INT") {
        return;
    }
    if Command::new("bash").arg("--version").stdout(Stdio::null()).status().is_err() {
        println!("passed over: there is no bash here");
        return;
    }
    let room = room();
    fs::write(room.path().join("short.toml"), LONG.replace("3600", "0.01")).unwrap();
    let before = names(room.path());
    let scenes = "for scene in long short; do \"$0\" scene $scene.toml --wav $scene.wav; done; touch after";
    let mut bash = Command::new("bash");
    bash.args(["-c", scenes, env!("CARGO_BIN_EXE_low-action")]);
    bash.current_dir(room.path()).process_group(0).stdin(Stdio::null()).stderr(Stdio::null());
    let mut bash = bash.spawn().unwrap();
    wait_for(|| has_part(room.path()));
    send_to_group("INT", &bash);
    assert_eq!(bash.wait().unwrap().signal(), Some(libc::SIGINT));
    // On a busy machine bash may not yet have begun to wait for what it runs, and ends sooner.
    wait_for(|| !has_part(room.path()));
    assert_eq!(names(room.path()), before);
}

/// As in a container whose only program it is: no signal that such a process sends to itself ends it.
#[cfg(target_os = "linux")]
#[test]
fn the_first_process_of_a_container_ends_by_its_exit_code() {
    if ignores("INT") {
        return;
    }
    let contained = |program: &str| {
        let mut command = Command::new("unshare");
        command.args(["--user", "--map-root-user", "--pid", "--fork", program]);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    if !contained("true").status().is_ok_and(|status| status.success()) {
        println!("passed over: no processes can be kept by themselves here");
        return;
    }
    let room = room();
    let before = names(room.path());
    let mut command = contained(env!("CARGO_BIN_EXE_low-action"));
    command.args(SONG).current_dir(room.path());
    let mut around = command.spawn().unwrap();
    wait_for(|| has_part(&room.path().join("new/stems")));
    let inside = format!("/proc/{id}/task/{id}/children", id = around.id());
    let inside = fs::read_to_string(inside).unwrap().trim().parse().unwrap();
    // SAFETY: it takes two numbers. What runs inside computes for minutes, and what is around it waits for its end.
    assert_eq!(unsafe { libc::kill(inside, libc::SIGINT) }, 0);
    assert_eq!(around.wait().unwrap().code(), Some(130));
    assert_eq!(names(room.path()), before);
}

#[test]
fn where_nothing_is_to_be_cleaned_up_the_signal_itself_ends_the_program() {
    if ignores("TERM") {
        return;
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_low-action"));
    // It waits for a scene that never comes.
    let mut child = command.args(["scene", "-"]).stdin(Stdio::piped()).spawn().unwrap();
    // More than a pipe holds: when it has gone in, it has begun to read.
    let mut pipe = child.stdin.take().unwrap();
    pipe.write_all("# nothing yet\n".repeat(20_000).as_bytes()).unwrap();
    send("TERM", &mut child);
    assert_eq!(child.wait().unwrap().signal(), Some(15));
}

#[cfg(target_os = "linux")]
#[test]
fn where_no_thread_finds_room_it_does_its_work_all_the_same() {
    use std::os::unix::fs::PermissionsExt;

    let room = room();
    let program = room.path().join("program");
    fs::copy(env!("CARGO_BIN_EXE_low-action"), &program).unwrap();
    fs::set_permissions(room.path(), fs::Permissions::from_mode(0o777)).unwrap();
    // The limit is none to root.
    // SAFETY: it only asks who this is.
    let is_root = unsafe { libc::geteuid() } == 0;
    let nobody = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"];
    let limited =
        ["prlimit", "--nproc=1:1", "./program", "render", "-q", "draft", "-r", "8000", "--tail", "none"];
    let arguments = [if is_root { &nobody[..] } else { &[] }, &limited].concat();
    let mut command = Command::new(arguments[0]);
    command.args(&arguments[1..]).current_dir(room.path()).stdin(Stdio::null());
    let Ok(output) = command.output() else {
        return println!("passed over: there is no setpriv or prlimit here");
    };
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && !said.contains("panicked"), "{said}");
    assert!(room.path().join("demo.wav").exists());
}
