//! The command line: `low-action render`, `low-action scene`, `low-action instruments`, or the stand-alone
//! instrument.
//!
//! Exit codes: 0 done; 1 it could not be done (a file, its format, the disk, a limit); 2 wrong
//! usage; 3 the result failed its own check, and is kept. Told to stop by a signal, the program cleans up and then ends by
//! that very signal, which shells count as 128 and its number (130 for Ctrl+C, 143 for SIGTERM) and end their loops for; on
//! Windows the exit code is 130. Every error is one line on standard error; standard output carries a result asked for with
//! `-`, or else the summary of a scene.

mod arguments;
mod descriptors;
mod endings;
mod instrument;
mod instruments;
mod names;
mod not_text;
mod npz;
pub mod output;
mod paths;
mod progress;
mod render;
mod room_left;
mod scene;
mod stand_alone;
mod stopping;
mod trace;
mod unfinished;
mod wav;

use std::ffi::OsString;
use std::io::Write;

use anyhow::Context;
use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};

pub use arguments::{InstrumentsArgs, RenderArgs, SceneArgs, StandAloneArgs, TakenArgs};
pub use render::{BitDepth, Seed, Tail};

/// Name and version, as results have it that say what made them.
const PROGRAM: &str = concat!("low-action ", env!("CARGO_PKG_VERSION"));

/// A fretted string instrument whose strings really hit the frets.
#[derive(Debug, Parser)]
#[command(
    name = "low-action",
    version,
    about,
    args_conflicts_with_subcommands = true,
    after_help = "\
Without a command, low-action opens the stand-alone instrument, if it was built with it \
(cargo feature standalone), which the mouse and what arrives on MIDI play until it is closed.

Examples:
  low-action --instrument tanpura            played by the first keyboard
  low-action --list-devices                  outputs and MIDI inputs by name
  low-action --instrument bass --midi-input \"Keystation 49\" --period-size 128
  low-action --midi-input GR-55 --input strings --first-channel 11 --bend-range 12
                                             by a MIDI guitar: channel 11 is the first string
  low-action render                          the built-in demo, to demo.wav
  low-action render song.mid --instrument classical
  low-action scene scene.toml --wav out.wav --trace out.npz
  low-action instruments                     which there are"
)]
struct CommandLine {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    playing: StandAloneArgs,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Turns a MIDI file into a WAV file.
    Render(RenderArgs),
    /// Computes a scene file in SI units.
    Scene(SceneArgs),
    /// Lists the instruments there are, or installs more.
    Instruments(InstrumentsArgs),
}

/// Why a command did not end well.
#[derive(Debug)]
pub enum Failure {
    /// It could not be done: a file, its format, the disk, a limit.
    Impossible(anyhow::Error),
    /// It was asked for in a wrong way.
    Usage(String),
    /// The result failed its own check; its files are kept.
    Check(String),
}

impl Failure {
    /// The exit code.
    pub fn code(&self) -> u8 {
        match self {
            Self::Impossible(_) => 1,
            Self::Usage(_) => 2,
            Self::Check(_) => 3,
        }
    }

    /// What to tell the user, in one line.
    pub fn message(&self) -> String {
        let text = match self {
            Self::Impossible(error) => format!("{error:#}"),
            Self::Usage(text) | Self::Check(text) => text.clone(),
        };
        one_line(&text)
    }
}

impl<E: Into<anyhow::Error>> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::Impossible(error.into())
    }
}

/// How a command ends.
pub type Outcome = Result<(), Failure>;

/// Runs the command line, program name first, and returns the exit code.
pub fn run<I, T>(arguments: I) -> u8
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let outcome = match CommandLine::try_parse_from(&arguments) {
        Ok(CommandLine { command: Some(Command::Render(arguments)), .. }) => render::run(&arguments),
        Ok(CommandLine { command: Some(Command::Scene(arguments)), .. }) => scene::run(&arguments),
        Ok(CommandLine { command: Some(Command::Instruments(arguments)), .. }) => {
            instruments::run(&arguments)
        }
        Ok(CommandLine { command: None, playing }) => stand_alone::run(&playing),
        Err(error) => {
            let command = command_of(&arguments);
            match misspelt_command(&error, command.as_deref(), &arguments) {
                Some(failure) => Err(failure),
                None => explain(&error, command.as_deref(), &arguments),
            }
        }
    };
    match outcome {
        Ok(()) => 0,
        Err(failure) => {
            say("error", &failure.message());
            failure.code()
        }
    }
}

/// Writes a line to standard error. A closed standard error is no reason to stop.
pub(crate) fn say(kind: &str, text: &str) {
    writeln!(std::io::stderr(), "{}: {}", names::escaped(kind), one_line(text)).ok();
}

/// The command that arguments, program name first, are for; a command comes before all options.
fn command_of(arguments: &[OsString]) -> Option<String> {
    let first = arguments.get(1)?.to_str()?;
    let known = CommandLine::command();
    known.get_subcommands().any(|command| command.get_name() == first).then(|| first.to_owned())
}

/// What to say where a word stands that is no command: without one, the program takes options only.
fn misspelt_command(error: &clap::Error, command: Option<&str>, arguments: &[OsString]) -> Option<Failure> {
    let word = arguments.get(1)?.to_string_lossy();
    if error.kind() != ErrorKind::UnknownArgument || command.is_some() || word.starts_with('-') {
        return None;
    }
    let known = CommandLine::command();
    let known: Vec<&str> = known.get_subcommands().map(|command| command.get_name()).collect();
    let known = known.join(", ");
    Some(Failure::Usage(format!("unknown command {word:?}: must be {known} (see low-action --help)")))
}

/// Help and version are printed in full; a mistake becomes one line, with what else may have been meant and whose
/// help says more.
fn explain(error: &clap::Error, command: Option<&str>, arguments: &[OsString]) -> Outcome {
    let program = command.map_or("low-action".to_owned(), |command| format!("low-action {command}"));
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            unless_closed(error.print())?;
            Ok(())
        }
        _ => {
            let text = error.render().to_string();
            let first = text.split("\n\n").next().unwrap_or_default();
            let mut first = first.strip_prefix("error: ").unwrap_or(first).to_owned();
            if error.kind() == ErrorKind::InvalidUtf8 {
                let mut known = CommandLine::command();
                known.build();
                let known = command.and_then(|command| known.find_subcommand(command)).unwrap_or(&known);
                first = not_text::told(known, arguments).unwrap_or(first);
            }
            // How to pass a word that begins with a dash is no help to who has misspelt an option.
            let tips = text.lines().map(str::trim).filter(|line| line.starts_with("tip: "));
            let tips: String =
                tips.filter(|tip| !tip.starts_with("tip: to pass")).map(|tip| format!("; {tip}")).collect();
            Err(Failure::Usage(format!("{first}{tips} (see {program} --help)")))
        }
    }
}

/// What came of writing to standard output. A reader who has seen enough and closed it is no failure.
pub(crate) fn unless_closed(written: std::io::Result<()>) -> anyhow::Result<()> {
    match written {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        written => written.context("cannot write to standard output"),
    }
}

/// A message folded into one line, without orders to the terminal. Within its lines nothing is folded: names may have any number
/// of spaces.
pub(crate) fn one_line(text: &str) -> String {
    let mut lines = text.split(['\n', '\r', '\u{2028}', '\u{2029}']);
    let first = lines.next().unwrap_or_default().to_owned();
    let folded = lines.map(str::trim).filter(|line| !line.is_empty()).fold(first, |before, line| {
        let before = before.trim_end();
        if before.is_empty() { line.to_owned() } else { format!("{before} {line}") }
    });
    names::escaped(&folded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_folded_and_names_are_not() {
        for (text, expected) in [
            ("cannot read a  b   .mid", "cannot read a  b   .mid"),
            ("one\n  two  three\r\n\n | four\n", "one two  three | four"),
            ("\none\u{2028}two", "one two"),
            ("one \n two ", "one two"),
            ("\u{1b}\t", "\\u{1b}\\t"),
            (" ", " "),
            ("", ""),
        ] {
            assert_eq!(one_line(text), expected);
        }
    }
}
