//! What each command can be told.

mod taken;

use std::ffi::OsString;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::Args;
use clap::builder::TypedValueParser;

use super::render::{self, BitDepth, Seed, Tail};
use crate::engine::{EngineOptions, Quality};
pub use taken::TakenArgs;

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
  low-action render song.mid --instrument my-guitar.toml --quality studio
  low-action render song.mid --track 2 --tail 5 --stems strings/
  low-action render take.mid --input strings --bend-range 12
                                               from a MIDI guitar
  low-action render song.mid --hand-position 7 -o higher.wav
                                               the same notes farther up the neck
  low-action render song.mid --capo 3          with a capo on the third fret
  low-action render song.mid --legato always --set pluck_position=40 --set finger_force=60
                                               as the plugins are set
  low-action render song.mid --labels song.json
                                               with ground truth of every note
  low-action render song.mid --labels song.json --skip-existing
                                               the same, unless both are there

Notes go to the string and fret nearest to the hand; those no string can give move by octaves. \
Channel 10 is percussion and left out unless asked for with --channel 10 or announced as one of MPE. With --input \
strings or mpe it is one like the others.

Exit codes: 0 done, 1 could not be done, 2 wrong usage, 3 the sound is not finite (file kept). \
Told to stop, it leaves nothing half written and ends by the very signal (130 for Ctrl+C, 143 for SIGTERM, as \
shells count), so that a loop over songs ends with it; on Windows the code is 130."
)]
pub struct RenderArgs {
    /// MIDI file to play, - for standard input; without it, the built-in demo.
    pub song: Option<PathBuf>,
    /// WAV file to write, in place of any that is there, - for standard output [default: SONG.wav in the current folder].
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Set-up that comes with the program (electric, classical, steel, bass, tanpura, ...) or was installed, or
    /// a set-up file; `low-action instruments` lists them.
    #[arg(short, long, value_name = "NAME|FILE", default_value = "electric")]
    pub instrument: OsString,
    /// How much computing.
    #[arg(short, long, value_name = "QUALITY", default_value_t = Quality::Live, help = qualities())]
    pub quality: Quality,
    /// Samples per second, 8000 to 384000.
    #[arg(short = 'r', long, value_name = "HZ", default_value_t = 48_000, value_parser = render::parse_rate, allow_hyphen_values = true)]
    pub sample_rate: u32,
    /// Sample format: 16 or 24 bit whole numbers, or 32f for floating point.
    #[arg(short, long, value_name = "16|24|32f", default_value_t = BitDepth::Int24, allow_hyphen_values = true)]
    pub bit_depth: BitDepth,
    /// How long to go on after the last event that is for the player, whenever the track itself ends: until it is quiet
    /// (auto, 30 to 120 s at most, by how long the instrument rings), so many seconds, up to 3600, or not at all (none).
    #[arg(long, value_name = "auto|SECONDS|none", default_value_t = Tail::Auto, allow_hyphen_values = true)]
    pub tail: Tail,
    /// Play only this track, 1 to 65535, counted from 1; tempo changes and registered parameters (bend ranges, MPE) of all tracks
    /// count.
    #[arg(long, value_name = "N", value_parser = whole::<u16>(1..=65_535), allow_hyphen_values = true)]
    pub track: Option<u16>,
    /// Play only this channel, 1 to 16; registered parameters (bend ranges, MPE) of all channels count.
    #[arg(long, value_name = "N", value_parser = whole::<u8>(1..=16), allow_hyphen_values = true)]
    pub channel: Option<u8>,
    /// Play what is there of a song whose last track is cut off, instead of refusing it.
    #[arg(long)]
    pub allow_truncated: bool,
    /// How notes are taken.
    #[command(flatten)]
    pub taken: TakenArgs,
    /// Longest music accepted, minutes, above 0 to 1e6.
    #[arg(long, value_name = "MIN", default_value_t = 60.0, value_parser = render::parse_minutes, allow_hyphen_values = true)]
    pub max_length: f64,
    /// Also write each string's own sound, mono and before panning, into this folder, as NUMBER-NAME.wav, in place of
    /// files that are there. Each song needs a folder of its own.
    #[arg(long, value_name = "DIR")]
    pub stems: Option<PathBuf>,
    /// Also write what was played into this file, in place of any that is there, - for standard output: for each note that
    /// sounds its string, fret, pitch, times and technique, and every gesture of the hands, as JSON. The sound is the same.
    #[arg(long, value_name = "FILE")]
    pub labels: Option<PathBuf>,
    /// Render nothing where the sound and all else that is asked for are there already, whole and of the form asked for, and --labels
    /// say that they are of this song and these options, and how long (without it, whatever they were made of): a loop over many
    /// songs goes on where it was broken off.
    #[arg(long)]
    pub skip_existing: bool,
    /// Say nothing of how far it has come, nor at the end: only warnings, errors, and why what is there is rendered again.
    #[arg(long)]
    pub quiet: bool,
    /// Threads that share the strings among them, 1 to 64 [default: as many as there are processors]; strings over a body are
    /// one thread's. The sound is the same bits.
    #[arg(long, value_name = "N", value_parser = whole::<u8>(1..=64), allow_hyphen_values = true)]
    pub threads: Option<u8>,
    /// Size of the small differences between one pluck and the next, 0 (none: the hand does the same each time; what
    /// sounds still depends on how the string moves when it is plucked) to 1.
    #[arg(long, value_name = "AMOUNT", default_value_t = EngineOptions::VARIATION, value_parser = render::parse_variation, allow_hyphen_values = true)]
    pub variation: f64,
    /// Which sequence of those differences, 0 to 18446744073709551615, or one that the song's bytes choose (song): in a data set no
    /// song is to have those of another.
    #[arg(long, value_name = "N|song", default_value_t = Seed::Number(0), allow_hyphen_values = true)]
    pub seed: Seed,
}

/// Arguments of `low-action scene`.
#[derive(Debug, Clone, Args)]
#[command(
    allow_negative_numbers = true,
    after_help = "\
Examples:
  low-action scene scene.toml                          computed and checked
  low-action scene scene.toml --wav out.wav
  low-action scene scene.toml --trace out.npz --every 4
  low-action scene scene.toml --figure out.svg
  low-action scene - --wav - < scene.toml | aplay      from and to a pipe

A scene, a file in TOML (docs/formats.md has all that may stand in one):
  sample_rate = 44100        # Hz
  duration = 1.0             # s
  [[string]]                 # as many as there are
  length = 0.65              # m
  linear_density = 5.25e-3   # kg/m
  tension = 60.0             # N
  loss_0 = 1.4               # 1/s; or t60 = [[Hz, s], [Hz, s]]
  [fretboard]                # if it may hit one
  stiffness = 1e12           # N/m^exponent
  exponent = 2.3
  board = -0.003             # m, up is positive
  frets = 12                 # or [places, m from the nut]
  fret_top = -0.001          # m
  [[finger]]                 # none or more
  mass = 5e-3                # kg
  stiffness = 1e7            # N/m^exponent
  exponent = 2.0
  position = 0.09            # m, or a course over time: [[s, m], ...]
  force = 3.0                # N, downwards
  [body]                     # if the bridge is to give way and to sound
  frequency = 170.0          # Hz
  mass = 0.1                 # kg
  area = 0.05                # m²
  quality = 20.0
  spacing = 50.0             # Hz
  volume = 0.0145            # m³
  hole = 0.0055              # m²
  [[pluck]]                  # none or more
  start = 0.1                # s
  duration = 0.002           # s
  position = 0.5             # m
  force = 1.0                # N, upwards

The trace is an .npz file of NumPy arrays. Strings (S), frets (F) and fingers (N) count from 1. Row n of \
the arrays over time belongs to its time t: the state there, the forces and powers that act there, and \
the energies half a sample later.
  t                            s
  x_S, u_S                     m; places, and displacements over time and there
  u_finger_N, x_finger_N       m; heights, and places
  u_bridge                     m; how far the bridge is up, if there is a body
  tension_S                    N; what stretching adds included
  force_bridge_S               N; of a string on the bridge, upwards
  force_board_S, force_fret_S_F,
  force_finger_N               N
  force_pluck_N                N; the push of each pluck
  power_bridge_S               W; what the bridge puts into a string, if there is a body
  output                       m/s, N or Pa, as the scene's [output] asks
  iterations                   of the contact solver, all strings together
  energy_string, energy_tension,
  energy_contact, energy_finger,
  energy_body                  J
  stored_S                     J; in a string, of several or over a body
  power_loss, power_solver,
  power_in                     W
  power_loss_0, power_loss_1, power_loss_contact,
  power_loss_hand, power_loss_body
                               W; the terms of power_loss
  power_in_pluck, power_in_hand, power_in_slide,
  power_in_barrier, power_in_tension
                               W; the terms of power_in
  work_loss, work_solver,
  work_in                      J; of these powers since the row before, also with --every
  residual                     J in that sample: what the balance leaves over
  scene                        the text of the scene
  program                      name and version of what computed it
  sample_rate, every           Hz, and how many samples apart rows are

The result is checked: it must be finite and, unless only a WAV file is made, its energy must balance to \
1e-9 of the largest energy, or of all that was put in where that is more (what was taken out again is not \
counted off), beside what rounding can do; where that is more than 1e-6, a warning says so.

Exit codes: 0 done, 1 could not be done, 2 wrong usage, 3 the result failed its own check. \
Told to stop, it leaves nothing half written and ends by the very signal (130 for Ctrl+C, 143 for SIGTERM, as \
shells count), so that a loop over scenes ends with it; on Windows the code is 130."
)]
pub struct SceneArgs {
    /// Scene file (TOML, SI units), - for standard input.
    pub file: PathBuf,
    /// WAV file to write, in place of any that is there, - for standard output: 32-bit float, in SI units, at the scene's
    /// rate.
    #[arg(long, value_name = "FILE")]
    pub wav: Option<PathBuf>,
    /// Trace to write, in place of any that is there: displacements, contact forces and the energy balance.
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Keep every N-th sample of the trace, 1 or more, from the first.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "trace", value_parser = whole::<u64>(1..=u64::MAX), allow_hyphen_values = true)]
    pub every: u64,
    /// Picture to draw (SVG), in place of any that is there: the strings over the board, energies, contact forces,
    /// iterations, penetration.
    #[arg(long, value_name = "FILE")]
    pub figure: Option<PathBuf>,
}

/// Options of the stand-alone instrument.
#[derive(Debug, Clone, Args)]
pub struct StandAloneArgs {
    /// Set-up that comes with the program or was installed, or a set-up file; `low-action instruments` lists
    /// them.
    #[arg(short, long, value_name = "NAME|FILE", default_value = "electric")]
    pub instrument: OsString,
    /// How much computing.
    #[arg(short, long, value_name = "QUALITY", default_value_t = Quality::Live, help = qualities())]
    pub quality: Quality,
    /// The keyboard or guitar that plays, or a part of its name that no other has [default: the first there is].
    #[arg(long, value_name = "NAME")]
    pub midi_input: Option<String>,
    /// Where the sound goes, or a part of its name that no other has [default: where the system's usually does].
    #[arg(long, value_name = "NAME")]
    pub output_device: Option<String>,
    /// Way to the devices: jack, alsa (Linux), core-audio (macOS) or wasapi (Windows), or none for no sound [default:
    /// jack if its server runs and no output device is named].
    #[arg(long, value_name = "NAME", value_parser = ["auto", "jack", "alsa", "core-audio", "wasapi", "none"])]
    pub backend: Option<String>,
    /// Samples per second, 8000 to 384000; JACK has its own [default: what the output takes nearest to 48000].
    #[arg(short = 'r', long, value_name = "HZ", value_parser = render::parse_rate, allow_hyphen_values = true)]
    pub sample_rate: Option<u32>,
    /// Samples computed at a time, 1 to 65536: fewer answer sooner, more are safer. JACK has its own [default: what the
    /// output takes nearest to 256].
    #[arg(short, long, value_name = "SAMPLES", value_parser = whole::<u32>(1..=65_536), allow_hyphen_values = true)]
    pub period_size: Option<u32>,
    /// How notes are taken.
    #[command(flatten)]
    pub taken: TakenArgs,
    /// Lists outputs, with what rates and periods they take, and MIDI inputs, and plays nothing.
    #[arg(long)]
    pub list_devices: bool,
    /// More options, of the plugin framework: `low-action -- --help` lists them.
    #[arg(last = true, value_name = "OPTION")]
    pub options: Vec<String>,
}

/// Arguments of `low-action instruments`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Installed set-ups can be named like those that come with the program (render --instrument NAME), and the plugin \
lists them by number under `Instrument file` when it is loaded. They are kept in a folder of yours, which the \
variable LOW_ACTION_INSTRUMENTS may name.

Examples:
  low-action instruments                             what there is
  low-action instruments --install my-guitar.toml    checks and copies the file
  low-action instruments --show steel > my-guitar.toml
                                                     a whole set-up file to begin with

Exit codes: 0 done, 1 could not be done, 2 wrong usage.")]
pub struct InstrumentsArgs {
    /// Set-up files to check and copy to the folder, in place of those of the same name.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub install: Vec<PathBuf>,
    /// Write a set-up to standard output as a set-up file: with all of its keys, also of one that is based on another.
    #[arg(long, value_name = "NAME|FILE", conflicts_with = "install")]
    pub show: Option<OsString>,
}

/// Reads a whole number, and names the range where it is none or lies outside.
fn whole<T>(range: RangeInclusive<u64>) -> impl TypedValueParser<Value = T>
where
    T: TryFrom<u64> + Clone + Send + Sync + 'static,
{
    move |text: &str| {
        let number = text.parse::<u64>().ok().filter(|number| range.contains(number));
        number
            .and_then(|number| T::try_from(number).ok())
            .ok_or_else(|| format!("must be a whole number from {} to {}", range.start(), range.end()))
    }
}

/// The help of `--quality`.
fn qualities() -> String {
    let said = Quality::ALL.map(|quality| format!("{quality} ({})", quality.summary()));
    format!("How much computing: {}", said.join(", "))
}

#[cfg(test)]
mod tests {
    use clap::Command;
    use clap::error::ErrorKind;

    use super::*;
    use crate::performance::highest_capo;

    /// A text without what stands in parentheses or brackets.
    fn outside(text: &str) -> String {
        let mut depth = 0;
        let is_outside = |letter: &char| {
            depth += i32::from("([".contains(*letter));
            let is_outside = depth == 0;
            depth -= i32::from(")]".contains(*letter));
            is_outside
        };
        text.chars().filter(is_outside).collect()
    }

    /// A number as it is written, whole ones of any size.
    fn beside(text: &str, by: i128) -> Option<String> {
        let whole = text.parse::<i128>().ok().map(|number| (number + by).to_string());
        whole.or_else(|| Some((text.parse::<f64>().ok()? + by as f64).to_string()))
    }

    /// Options whose help has a range, `1 to 16` or `up to 3600`, and its ends as they are written.
    fn ranges(command: &Command) -> Vec<(String, Option<String>, String)> {
        let mut ranges = Vec::new();
        for argument in command.get_arguments() {
            let (Some(long), Some(help)) = (argument.get_long(), argument.get_help()) else { continue };
            let help = outside(&argument.get_long_help().unwrap_or(help).to_string());
            let words: Vec<&str> =
                help.split_whitespace().map(|word| word.trim_end_matches([',', '.', ':', ';'])).collect();
            for window in
                words.windows(3).filter(|window| window[1] == "to" && beside(window[2], 0).is_some())
            {
                let low = beside(window[0], 0).map(|_| window[0].to_owned());
                if low.is_some() || window[0] == "up" {
                    ranges.push((long.to_owned(), low, window[2].to_owned()));
                }
            }
        }
        ranges
    }

    #[test]
    fn options_take_the_ranges_that_their_help_has() {
        let mut found = Vec::new();
        for command in [
            RenderArgs::augment_args(Command::new("render")),
            StandAloneArgs::augment_args(Command::new("x")),
        ] {
            let is_taken = |option: &str, value: &str| {
                let words = ["low-action".to_owned(), format!("--{option}={value}")];
                let refused = command.clone().try_get_matches_from(words).err();
                refused.is_none_or(|error| error.kind() != ErrorKind::ValueValidation)
            };
            for (option, low, high) in ranges(&command) {
                assert!(is_taken(&option, &high), "--{option} {high}");
                let over = beside(&high, 1).expect("it is a number");
                assert!(!is_taken(&option, &over), "--{option} {over}");
                if let Some(low) = low {
                    // (Whose help says that it is above that.)
                    assert_eq!(is_taken(&option, &low), option != "max-length", "--{option} {low}");
                    let under = beside(&low, -1).expect("it is a number");
                    assert!(!is_taken(&option, &under), "--{option} {under}");
                }
                found.push(option);
            }
        }
        for option in
            ["sample-rate", "tail", "track", "channel", "max-length", "threads", "variation", "seed"]
        {
            assert!(found.iter().any(|known| known == option), "{option}: {found:?}");
        }
        for option in ["first-channel", "bend-range", "period-size"] {
            assert!(found.iter().any(|known| known == option), "{option}: {found:?}");
        }
    }

    #[test]
    fn the_help_has_the_highest_capo_of_electric() {
        let electric = low_action_dsp::Setup::builtin("electric").expect("it is built in");
        let command = RenderArgs::augment_args(Command::new("render"));
        let capo = command.get_arguments().find(|argument| argument.get_id() == "capo").expect("it is there");
        let said = format!("({} on electric)", highest_capo(electric.neck.frets));
        assert!(capo.get_help().expect("it has one").to_string().contains(&said), "{said}");
    }
}
