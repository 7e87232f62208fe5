//! The command line: `low-action render`, `low-action scene`, `low-action instruments`, or the stand-alone
//! instrument.
//!
//! Exit codes: 0 done; 1 it could not be done (a file, its format, the disk, a limit); 2 wrong
//! usage; 3 the result failed its own check, and is kept. Every error is one line on standard
//! error; standard output carries a result asked for with `-`, or else the summary of a scene.

mod instrument;
mod instruments;
mod npz;
pub mod output;
mod progress;
mod render;
mod scene;
mod trace;
mod wav;

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;

use clap::error::ErrorKind;
use clap::{Args, Parser, Subcommand};

pub use render::{BitDepth, Tail};

use crate::engine::Quality;

/// A fretted string instrument whose strings really hit the frets.
#[derive(Debug, Parser)]
#[command(
    name = "low-action",
    version,
    about,
    after_help = "\
Without a command, low-action opens the stand-alone instrument, if it was built with it.

Examples:
  low-action render                          the built-in demo, to demo.wav
  low-action render song.mid --instrument classical
  low-action scene scene.toml --wav out.wav --trace out.npz
  low-action instruments                     which there are"
)]
struct CommandLine {
    #[command(subcommand)]
    command: Option<Command>,
    /// Options of the stand-alone instrument.
    #[arg(last = true, value_name = "OPTION")]
    options: Vec<String>,
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

/// Arguments of `low-action render`.
#[derive(Debug, Clone, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Examples:
  low-action render                            the built-in demo, to demo.wav
  low-action render song.mid                   to song.wav in the current folder
  low-action render song.mid -o - | aplay      to standard output
  low-action render - -o take.wav < song.mid   from standard input
  low-action render song.mid --instrument my-guitar.toml --quality studio --bit-depth 32f
  low-action render song.mid --track 2 --tail 5 --stems strings/

Notes go to the string and fret nearest to the hand; those no string can give move by octaves.
Channel 10 is percussion and left out unless asked for with --channel 10.

Exit codes: 0 done, 1 could not be done, 2 wrong usage, 3 the sound is not finite (file kept)."
)]
pub struct RenderArgs {
    /// MIDI file to play, - for standard input; without it, the built-in demo.
    pub song: Option<PathBuf>,
    /// WAV file to write, - for standard output [default: SONG.wav in the current folder].
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Set-up that comes with the program (electric, classical, steel, bass, tanpura, ...) or was installed, or
    /// a set-up file; `low-action instruments` lists them.
    #[arg(short, long, value_name = "NAME|FILE", default_value = "electric")]
    pub instrument: String,
    /// How much computing: draft, live, studio or reference.
    #[arg(short, long, value_name = "QUALITY", default_value_t = Quality::Live)]
    pub quality: Quality,
    /// Samples per second, 8000 to 384000.
    #[arg(short = 'r', long, value_name = "HZ", default_value_t = 48_000, value_parser = render::parse_rate)]
    pub sample_rate: u32,
    /// Sample format: 16 or 24 bit whole numbers, or 32f for floating point.
    #[arg(short, long, value_name = "16|24|32f", default_value_t = BitDepth::Int24)]
    pub bit_depth: BitDepth,
    /// How long to go on after the last event: until it is quiet (auto, 30 s at most), so many
    /// seconds, or not at all (none).
    #[arg(long, value_name = "auto|SECONDS|none", default_value_t = Tail::Auto)]
    pub tail: Tail,
    /// Play only this track, counted from 1; tempo changes of all tracks count.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub track: Option<u16>,
    /// Play only this channel, 1 to 16.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=16))]
    pub channel: Option<u8>,
    /// Longest music accepted, minutes.
    #[arg(long, value_name = "MIN", default_value_t = 60.0, value_parser = render::parse_minutes)]
    pub max_length: f64,
    /// Also write each string's own sound, mono and before panning, into this folder.
    #[arg(long, value_name = "DIR")]
    pub stems: Option<PathBuf>,
    /// Size of the small differences between one pluck and the next, 0 (none) to 1.
    #[arg(long, value_name = "AMOUNT", default_value_t = crate::engine::EngineOptions::VARIATION, value_parser = render::parse_variation)]
    pub variation: f64,
    /// Which sequence of those differences.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
}

/// Arguments of `low-action scene`.
#[derive(Debug, Clone, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Examples:
  low-action scene scene.toml                          computed, checked, summed up
  low-action scene scene.toml --wav out.wav
  low-action scene scene.toml --trace out.npz --every 4
  low-action scene scene.toml --figure out.svg
  low-action scene - --wav - < scene.toml | aplay      from standard input to standard output

The trace is an .npz file of NumPy arrays. Strings (S), frets (F) and fingers (N) count from 1. Row n of
the arrays over time belongs to its time t: the state there, the forces and powers that act there, and
the energies half a sample later.
  t                                                    s
  x_S, u_S                                             m; places, and displacements over time and places
  u_finger_N                                           m
  force_board_S, force_fret_S_F, force_finger_N        N
  iterations                                           of the contact solver, all strings together
  energy_string, energy_tension, energy_contact, energy_finger    J
  power_loss, power_solver, power_in                   W
  residual                                             J in that sample: what the balance does not explain

The result is checked: it must be finite and, unless only a WAV file is made, its energy must balance to
1e-9 of the largest energy.

Exit codes: 0 done, 1 could not be done, 2 wrong usage, 3 the result failed its own check."
)]
pub struct SceneArgs {
    /// Scene file (TOML, SI units), - for standard input.
    pub file: PathBuf,
    /// WAV file to write, - for standard output: 32-bit float, in SI units, at the scene's rate.
    #[arg(long, value_name = "FILE")]
    pub wav: Option<PathBuf>,
    /// Trace to write: displacements, contact forces and the energy balance.
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Keep every N-th sample of the trace, from the first.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "trace", value_parser = clap::value_parser!(u64).range(1..))]
    pub every: u64,
    /// Picture to draw (SVG): the strings over the board, energies, contact forces, iterations, penetration.
    #[arg(long, value_name = "FILE")]
    pub figure: Option<PathBuf>,
}

/// Arguments of `low-action instruments`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Installed set-ups can be named like those that come with the program (render --instrument NAME), and the plugin
lists them by number under `Instrument file` when it is loaded. They are kept in a folder of yours, which the
variable LOW_ACTION_INSTRUMENTS may name.

Examples:
  low-action instruments                             what there is
  low-action instruments --install my-guitar.toml    checks the file and copies it to the folder

Exit codes: 0 done, 1 could not be done, 2 wrong usage.")]
pub struct InstrumentsArgs {
    /// Set-up files to check and copy to the folder, in place of those of the same name.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub install: Vec<PathBuf>,
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
    let outcome = match CommandLine::try_parse_from(arguments) {
        Ok(CommandLine { command: Some(Command::Render(arguments)), .. }) => render::run(&arguments),
        Ok(CommandLine { command: Some(Command::Scene(arguments)), .. }) => scene::run(&arguments),
        Ok(CommandLine { command: Some(Command::Instruments(arguments)), .. }) => {
            instruments::run(&arguments)
        }
        Ok(CommandLine { command: None, options }) => stand_alone(options),
        Err(error) => explain(&error),
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
    writeln!(std::io::stderr(), "{kind}: {}", one_line(text)).ok();
}

/// Opens the instrument with options of the plugin framework's.
#[cfg(feature = "standalone")]
fn stand_alone(options: Vec<String>) -> Outcome {
    say("low-action", "playing what arrives on MIDI until Ctrl+C; `low-action -- --help` lists the options");
    if crate::standalone::open(options) {
        Ok(())
    } else {
        Err(Failure::Impossible(anyhow::anyhow!("the stand-alone instrument could not be opened")))
    }
}

/// Says how to get the instrument.
#[cfg(not(feature = "standalone"))]
fn stand_alone(_options: Vec<String>) -> Outcome {
    Err(Failure::Usage(
        "this build has no stand-alone instrument: build it with `cargo build --release --features \
         standalone`, or see `low-action --help` for the commands"
            .into(),
    ))
}

/// Help and version are printed in full; a mistake becomes one line.
fn explain(error: &clap::Error) -> Outcome {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            error.print()?;
            Ok(())
        }
        _ => {
            let text = error.render().to_string();
            let first = text.split("\n\n").next().unwrap_or_default();
            let first = first.strip_prefix("error: ").unwrap_or(first);
            Err(Failure::Usage(format!("{first} (see low-action --help)")))
        }
    }
}

/// A message folded into one line.
fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
