//! The `render` command: a song through the engine into WAV files.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};

pub use super::wav::BitDepth;
use super::wav::{Findings, WavFile};
use super::{Failure, Outcome, RenderArgs, instrument, progress, say};
use crate::demo;
use crate::engine::{Engine, EngineOptions};
use crate::midi_file::{LARGEST_FILE, Selection, Song};
use crate::performance::Compromises;

/// Samples computed at a time.
const BLOCK: usize = 512;
/// Longest tail that `auto` waits for, s; open strings of a guitar are down 60 dB after 10 to 20 s.
const LONGEST_TAIL: f64 = 30.0;
/// Shortest tail of `auto`, s: as far back as the engine's level looks, and once more.
const SHORTEST_TAIL: f64 = 0.1;
/// `auto` ends when the sound has stayed below this part of the song's peak: −72 dB.
const QUIET: f64 = 2.5e-4;
/// `auto` ends in any case below this level: −120 dBFS, under the last bit of 16.
const INAUDIBLE: f64 = 1e-6;

/// How long to go on after the last event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tail {
    /// Until it is quiet: 72 dB below the song's peak for 50 ms, at least 0.1 s, at most 30 s.
    Auto,
    /// So many seconds, 0 to 3,600.
    Seconds(f64),
}

impl fmt::Display for Tail {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => out.write_str("auto"),
            Self::Seconds(seconds) => write!(out, "{seconds}"),
        }
    }
}

impl FromStr for Tail {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            "none" => Ok(Self::Seconds(0.0)),
            _ => match text.parse::<f64>() {
                Ok(seconds) if (0.0..=3_600.0).contains(&seconds) => Ok(Self::Seconds(seconds)),
                _ => Err("must be auto, none or 0 to 3600 seconds".into()),
            },
        }
    }
}

/// Reads `--max-length`.
pub(super) fn parse_minutes(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(minutes) if minutes > 0.0 && minutes <= 1e6 => Ok(minutes),
        _ => Err("must be above 0 and at most 1000000 minutes".into()),
    }
}

/// Reads `--variation`.
pub(super) fn parse_variation(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(amount) if (0.0..=1.0).contains(&amount) => Ok(amount),
        _ => Err("must be 0 to 1".into()),
    }
}

/// Renders a song.
pub(super) fn run(arguments: &RenderArgs) -> Outcome {
    let setup = instrument::load(&arguments.instrument)?;
    let song = read_song(arguments)?;
    check_length(arguments, &song)?;
    for warning in &song.warnings {
        say("warning", &warning.to_string());
    }
    let options = EngineOptions {
        quality: arguments.quality,
        variation: arguments.variation,
        seed: arguments.seed,
        ..EngineOptions::new(setup, f64::from(arguments.sample_rate))
    };
    let engine = Engine::new(&options).with_context(|| arguments.instrument.clone())?;
    let names: Vec<&str> = options.setup.string.iter().map(|string| string.name.as_str()).collect();
    let output = output_path(arguments)?;
    let files = Files::begin(arguments, &output, &names)?;

    let started = Instant::now();
    let rendered = Rendering { engine, song: &song, arguments, files }.play()?;
    report(arguments, &output, &rendered, started.elapsed().as_secs_f64())
}

/// Reads the song from wherever it is.
fn read_song(arguments: &RenderArgs) -> Result<Song> {
    let selection = Selection { track: arguments.track.map(usize::from), channel: arguments.channel };
    let Some(path) = &arguments.song else {
        return Song::from_midi(demo::MIDI, selection).context("the built-in demo");
    };
    // One byte more than is accepted, so that an endless source ends and is refused.
    let limit = LARGEST_FILE as u64 + 1;
    let mut bytes = Vec::new();
    let name = if is_dash(path) {
        io::stdin().lock().take(limit).read_to_end(&mut bytes).context("cannot read standard input")?;
        "standard input".to_owned()
    } else {
        let read = File::open(path).and_then(|file| file.take(limit).read_to_end(&mut bytes));
        read.with_context(|| format!("cannot read {}", path.display()))?;
        path.display().to_string()
    };
    Song::from_midi(&bytes, selection).with_context(|| name)
}

/// Refuses music that would take hours, or more than a WAV file holds.
fn check_length(arguments: &RenderArgs, song: &Song) -> Result<()> {
    let minutes = song.duration() / 60.0;
    let limit = arguments.max_length;
    if minutes > limit {
        bail!(
            "the music lasts {minutes:.1} minutes, over the limit of {limit}: raise it with --max-length MIN"
        );
    }
    let tail = match arguments.tail {
        Tail::Auto => LONGEST_TAIL,
        Tail::Seconds(seconds) => seconds,
    };
    let rate = f64::from(arguments.sample_rate);
    let longest = arguments.bit_depth.largest_length(2) as f64 / rate / 60.0;
    let whole = minutes + tail / 60.0;
    if whole > longest {
        bail!(
            "{whole:.1} minutes do not fit in a WAV file (4 GiB): at most {longest:.1} at {} Hz and {} bit",
            arguments.sample_rate,
            arguments.bit_depth
        );
    }
    Ok(())
}

fn is_dash(path: &Path) -> bool {
    path == Path::new("-")
}

/// Where the sound goes: as asked, or named after the song in the current folder.
fn output_path(arguments: &RenderArgs) -> Result<PathBuf> {
    let path = match (&arguments.output, &arguments.song) {
        (Some(output), _) => {
            return refuse_overwriting(arguments.song.as_deref(), output).map(|()| output.clone());
        }
        (None, None) => PathBuf::from("demo.wav"),
        (None, Some(song)) if is_dash(song) => PathBuf::from("song.wav"),
        (None, Some(song)) => {
            let stem = song.file_stem().ok_or_else(|| anyhow!("{} is not a file's name", song.display()))?;
            let mut name = stem.to_owned();
            name.push(".wav");
            PathBuf::from(name)
        }
    };
    refuse_overwriting(arguments.song.as_deref(), &path)?;
    Ok(path)
}

/// The song itself must not be replaced by its sound.
fn refuse_overwriting(song: Option<&Path>, output: &Path) -> Result<()> {
    let Some(song) = song.filter(|song| !is_dash(song) && !is_dash(output)) else { return Ok(()) };
    match (fs::canonicalize(song), fs::canonicalize(output)) {
        (Ok(song), Ok(output)) if song == output && fs::metadata(&song).is_ok_and(|song| song.is_file()) => {
            bail!("the output {} is the song itself: choose another with -o", output.display())
        }
        _ => Ok(()),
    }
}

/// The files of one rendering.
struct Files {
    mix: WavFile,
    stems: Vec<WavFile>,
}

impl Files {
    /// Begins them all, so that a full disk or a missing folder shows before the work.
    fn begin(arguments: &RenderArgs, output: &Path, strings: &[&str]) -> Result<Self> {
        let (rate, depth) = (arguments.sample_rate, arguments.bit_depth);
        let mix = WavFile::begin(output, 2, rate, depth)?;
        let mut stems = Vec::new();
        if let Some(folder) = &arguments.stems {
            fs::create_dir_all(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
            for (index, name) in strings.iter().enumerate() {
                let path = folder.join(stem_name(index, name));
                stems.push(WavFile::begin(&path, 1, rate, depth)?);
            }
        }
        Ok(Self { mix, stems })
    }
}

/// File name of a string's own sound: its number from 1 and its name, without what file systems
/// mind.
fn stem_name(index: usize, string: &str) -> String {
    let name: String =
        string.chars().map(|c| if c.is_alphanumeric() || "-_#+".contains(c) { c } else { '_' }).collect();
    format!("{}-{name}.wav", index + 1)
}

/// What came of it.
struct Rendered {
    /// Of the stereo file and all stems.
    findings: Findings,
    compromises: Compromises,
    lost_events: u64,
    seconds: f64,
}

/// A song on its way through the engine.
struct Rendering<'a> {
    engine: Engine,
    song: &'a Song,
    arguments: &'a RenderArgs,
    files: Files,
}

impl Rendering<'_> {
    fn play(mut self) -> Result<Rendered> {
        let rate = self.arguments.sample_rate;
        let bar = progress::bar(self.song.duration());
        let mut buffers = Buffers::new(self.files.stems.len());
        let mut peak = 0.0_f64;
        let mut events =
            self.song.events.iter().map(|event| (event.time.sample(rate), event.event)).peekable();
        // Blocks end at events, so that any number of them may share a sample.
        loop {
            while let Some((_, event)) = events.next_if(|&(time, _)| time <= self.engine.now()) {
                self.engine.event(0, event);
            }
            let Some(&(next, _)) = events.peek() else { break };
            let frames = (next - self.engine.now()).min(BLOCK as u64);
            self.block(&mut buffers, frames as usize)?;
            peak = peak.max(self.engine.level());
            bar.set_position(self.engine.now() / u64::from(rate));
        }
        let end = self.engine.now();
        let longest = match self.arguments.tail {
            Tail::Auto => LONGEST_TAIL,
            Tail::Seconds(seconds) => seconds,
        };
        let last = end + (longest * f64::from(rate)).round() as u64;
        let earliest = end + (SHORTEST_TAIL * f64::from(rate)).round() as u64;
        while self.engine.now() < last {
            let now = self.engine.now();
            peak = peak.max(self.engine.level());
            let quiet = self.engine.level() <= (QUIET * peak).max(INAUDIBLE);
            if self.arguments.tail == Tail::Auto && now >= earliest && quiet {
                break;
            }
            self.block(&mut buffers, (last - now).min(BLOCK as u64) as usize)?;
        }
        bar.finish_and_clear();
        self.finish()
    }

    /// Computes and writes so many samples.
    fn block(&mut self, buffers: &mut Buffers, frames: usize) -> Result<()> {
        let Buffers { left, right, stems } = buffers;
        let (left, right) = (&mut left[..frames], &mut right[..frames]);
        if stems.is_empty() {
            self.engine.process(left, right);
        } else {
            let mut parts: Vec<&mut [f32]> = stems.iter_mut().map(|stem| &mut stem[..frames]).collect();
            self.engine.process_stems(&mut parts, left, right);
        }
        self.files.mix.write(left.iter().zip(right.iter()).flat_map(|(&left, &right)| [left, right]))?;
        for (file, stem) in self.files.stems.iter_mut().zip(stems) {
            file.write(stem[..frames].iter().copied())?;
        }
        Ok(())
    }

    fn finish(self) -> Result<Rendered> {
        let mut findings = self.files.mix.finish()?;
        for stem in self.files.stems {
            let of_stem = stem.finish()?;
            findings.peak = findings.peak.max(of_stem.peak);
            findings.not_finite += of_stem.not_finite;
        }
        Ok(Rendered {
            findings,
            compromises: self.engine.compromises(),
            lost_events: self.engine.lost_events(),
            seconds: self.engine.now() as f64 / f64::from(self.arguments.sample_rate),
        })
    }
}

/// Room for one block.
struct Buffers {
    left: Vec<f32>,
    right: Vec<f32>,
    stems: Vec<Vec<f32>>,
}

impl Buffers {
    fn new(stems: usize) -> Self {
        Self { left: vec![0.0; BLOCK], right: vec![0.0; BLOCK], stems: vec![vec![0.0; BLOCK]; stems] }
    }
}

/// Tells what came of it.
fn report(arguments: &RenderArgs, output: &Path, rendered: &Rendered, elapsed: f64) -> Outcome {
    let Rendered { findings, compromises, lost_events, seconds } = rendered;
    let Compromises { moved_by_octaves, left_out } = compromises;
    if *moved_by_octaves > 0 {
        say("warning", &format!("{moved_by_octaves} notes no string can give were moved by octaves"));
    }
    if *left_out > 0 {
        say(
            "warning",
            &format!("{left_out} notes were left out: more began at once than strings could take"),
        );
    }
    if *lost_events > 0 {
        say("warning", &format!("{lost_events} events were lost: too many at once"));
    }
    let decibels = 20.0 * f64::from(findings.peak).log10();
    if findings.peak > 1.0 && arguments.bit_depth != BitDepth::Float32 {
        let advice = "use --bit-depth 32f or a set-up with less gain";
        say("warning", &format!("the sound peaks at {decibels:+.1} dBFS and is clipped: {advice}"));
    }
    let name = if is_dash(output) { "standard output".to_owned() } else { output.display().to_string() };
    if findings.not_finite > 0 {
        let count = findings.not_finite;
        return Err(Failure::Check(format!(
            "{count} samples of {name} are not finite numbers; the file is kept"
        )));
    }
    let peak = if findings.peak > 0.0 { format!("peak {decibels:.1} dBFS") } else { "silent".to_owned() };
    let speed = seconds / elapsed.max(1e-9);
    say(&name, &format!("{seconds:.2} s, {peak}, {speed:.1} times faster than real time"));
    Ok(())
}
