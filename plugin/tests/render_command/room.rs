//! A folder to work in, and the program run there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use hound::{SampleFormat, WavReader};
use low_action::setups::FOLDER_VARIABLE;
use midly::live::LiveEvent;
use midly::num::{u15, u28};
use midly::{Format, Header, MetaMessage, Smf, Timing, TrackEvent, TrackEventKind};
use tempfile::TempDir;

/// A folder to work in, with a short song.
pub struct Room {
    folder: TempDir,
}

/// A MIDI file of format 0 with 96 ticks a beat, half a second each, of channel messages, each so many ticks after the last.
pub fn midi(messages: &[(u8, &[u8])]) -> Vec<u8> {
    let events: Vec<_> = messages.iter().map(|&(delta, bytes)| (delta, message(bytes))).collect();
    midi_of(&events)
}

/// A channel message as an event of a file.
pub fn message(bytes: &[u8]) -> TrackEventKind<'_> {
    match LiveEvent::parse(bytes) {
        Ok(LiveEvent::Midi { channel, message }) => TrackEventKind::Midi { channel, message },
        other => panic!("{bytes:?} is no channel message: {other:?}"),
    }
}

/// The same file of any events.
pub fn midi_of(events: &[(u8, TrackEventKind)]) -> Vec<u8> {
    let end = (0, TrackEventKind::Meta(MetaMessage::EndOfTrack));
    let events = events.iter().copied().chain([end]);
    let track = events.map(|(delta, kind)| TrackEvent { delta: u28::new(delta.into()), kind }).collect();
    let header = Header::new(Format::SingleTrack, Timing::Metrical(u15::new(96)));
    let mut bytes = Vec::new();
    Smf { header, tracks: vec![track] }.write_std(&mut bytes).unwrap();
    bytes
}

/// Two notes within a quarter of a second.
pub fn song() -> Vec<u8> {
    midi(&[(0, &[0x90, 52, 90]), (24, &[0x90, 59, 90]), (24, &[0x80, 52, 0]), (0, &[0x80, 59, 0])])
}

impl Room {
    pub fn new() -> Self {
        let room = Self { folder: TempDir::new().unwrap() };
        fs::write(room.path("song.mid"), song()).unwrap();
        room
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_low-action"));
        command.current_dir(self.folder.path()).args(arguments).stdin(Stdio::null());
        // A user without set-ups of their own.
        command.env(FOLDER_VARIABLE, self.path("instruments"));
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Renders and expects success, and that every warning names the song; returns what was said.
    pub fn renders(&self, arguments: &[&str]) -> String {
        let output = self.run(&[&["render"], arguments].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(output.stdout.is_empty());
        let song = arguments.first().filter(|first| !first.starts_with('-')).unwrap_or(&"the built-in demo");
        for warning in said.lines().filter_map(|line| line.strip_prefix("warning: ")) {
            assert!(warning.starts_with(&format!("{song}: ")), "{said}");
        }
        said
    }

    /// Runs and expects an exit code, one line of error, and no new file.
    pub fn refuses(&self, code: i32, arguments: &[&str]) -> String {
        let before = self.files();
        let output = self.run(arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.starts_with("error: ") && said.trim_end().lines().count() == 1, "{arguments:?}: {said}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        assert_eq!(self.files(), before, "{arguments:?} left something behind");
        said
    }

    pub fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> =
            fs::read_dir(self.folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files
    }
}

pub fn peak(path: &Path) -> f64 {
    let mut reader = WavReader::open(path).unwrap();
    let full = f64::from(1_u32 << (reader.spec().bits_per_sample - 1));
    match reader.spec().sample_format {
        SampleFormat::Int => {
            reader.samples::<i32>().map(|sample| f64::from(sample.unwrap()).abs() / full).fold(0.0, f64::max)
        }
        SampleFormat::Float => {
            reader.samples::<f32>().map(|sample| f64::from(sample.unwrap()).abs()).fold(0.0, f64::max)
        }
    }
}
