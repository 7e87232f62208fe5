//! The `render` command: a song through the engine into WAV files, and into labels of what was played.

mod files;
mod heard;
mod labels;
mod options;
mod rendering;
mod there;
mod timeline;
mod tuning;
mod warnings;
mod written;

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};
use low_action_dsp::digits::{at_least, at_most, plain};

use super::descriptors::descriptor;
use super::endings::{self, refuse_others};
use super::names::{escaped, shown};
use super::paths::{is_dash, keep_apart};
pub use super::wav::BitDepth;
use super::{Failure, Outcome, RenderArgs, instrument, say};
use crate::controls::Touching;
use crate::engine::{Engine, EngineOptions};
use crate::midi_file::Song;
use crate::performance::LONGEST_WAIT;
use files::{Files, stem_paths};
use labels::Source;
pub use options::{Seed, Tail};
pub(super) use options::{parse_bend, parse_choice, parse_minutes, parse_rate, parse_variation};
use rendering::{Rendered, Rendering};
use there::There;
use warnings::level;
use written::Written;

/// Renders a song.
pub(super) fn run(arguments: &RenderArgs) -> Outcome {
    let input = arguments.taken.mode()?;
    refuse_settings(arguments)?;
    let (mut setup, setup_file) = instrument::load(&arguments.instrument)?;
    arguments.taken.work_on(&mut setup);
    arguments.taken.fits(&setup, &arguments.instrument)?;
    let mut options = EngineOptions {
        quality: arguments.quality,
        variation: arguments.variation,
        bend_range: arguments.taken.bend_range.unwrap_or(EngineOptions::BEND_RANGE),
        threads: threads(arguments),
        ..EngineOptions::new(setup, f64::from(arguments.sample_rate))
    };
    let names: Vec<&str> = options.setup.string.iter().map(|string| string.name.as_str()).collect();
    let output = output_path(arguments)?;
    check_paths(arguments, setup_file.as_deref(), &output, &names)?;
    refuse_others("-o", &output, &endings::WAV)?;
    arguments.labels.as_ref().map_or(Ok(()), |labels| refuse_others("--labels", labels, &endings::JSON))?;
    let (there, mut again) = match arguments.skip_existing.then(|| There::look(arguments, &output, &names)) {
        Some(Ok(there)) => (Some(there), None),
        Some(Err(reason)) => (None, reason),
        None => (None, None),
    };
    // (Files without labels may be of anything.)
    if let Some(there) = there.as_ref().filter(|_| arguments.labels.is_none()) {
        again = there.difference(arguments, None);
        if again.is_none() {
            return skip(arguments, &output);
        }
    }
    let written = Written::read(arguments)?;
    options.seed = written.seed(arguments.seed);
    let source = Source { arguments, setup: &options.setup, written: &written };
    if let Some((there, labels)) = there.as_ref().zip(arguments.labels.as_deref()) {
        again = match labels::samples_of(labels, &source) {
            Ok(samples) => there.difference(arguments, Some(samples)),
            Err(difference) => Some(difference),
        };
        if again.is_none() {
            return skip(arguments, &output);
        }
    }
    if let Some(reason) = again {
        say(&shown(&output), &format!("rendered again: {reason}"));
    }
    let song = written.song(arguments)?;
    let longest_tail = arguments.tail.longest(options.tail());
    check_length(arguments, &song, longest_tail).with_context(|| song_name(arguments))?;
    let mut warnings: Vec<String> = song.warnings.iter().map(ToString::to_string).collect();
    warnings.extend(arguments.taken.in_vain(&options.setup));
    warnings.iter().for_each(|warning| warn(arguments, warning));
    let mut engine =
        Engine::new(&options).with_context(|| escaped(&arguments.instrument.to_string_lossy()))?;
    // (Of those that come with the program it is known, and what they are for.)
    if (setup_file.is_some() || !arguments.taken.set.is_empty())
        && let Some(warning) = source.tuned(engine.instrument()).out_of_tune()?
    {
        warn(arguments, &warning);
        warnings.push(warning);
    }
    engine.set_input(input);
    let touching =
        Touching { take: options.seed, variation: options.variation, ..arguments.taken.touching() };
    engine.touch(&touching);
    let files = Files::begin(arguments, &output, &names)?;

    let started = Instant::now();
    let rendering = Rendering { engine, song: &song, source, files, warnings, longest_tail };
    let rendered = rendering.play()?;
    report(arguments, &output, &rendered, started.elapsed().as_secs_f64())
}

/// Leaves what is there.
fn skip(arguments: &RenderArgs, output: &Path) -> Outcome {
    if !arguments.quiet {
        say(&shown(output), "skipped: all that is asked for is there already");
    }
    Ok(())
}

/// How many threads share the strings: as many as asked for, or as this machine runs at once.
fn threads(arguments: &RenderArgs) -> NonZeroUsize {
    let asked = arguments.threads.and_then(|threads| NonZeroUsize::new(threads.into()));
    asked.unwrap_or_else(|| thread::available_parallelism().unwrap_or(NonZeroUsize::MIN))
}

/// Refuses settings that a song has options for.
fn refuse_settings(arguments: &RenderArgs) -> Outcome {
    let own = [("variation", "--variation"), ("take", "--seed")];
    match own.into_iter().find(|(id, _)| arguments.taken.set.iter().any(|setting| setting.id() == *id)) {
        Some((id, option)) => {
            Err(Failure::Usage(format!("--set {id} is for the stand-alone instrument: a song has {option}")))
        }
        None => Ok(()),
    }
}

/// What the song is called in messages.
fn song_name(arguments: &RenderArgs) -> String {
    match &arguments.song {
        None => "the built-in demo".to_owned(),
        Some(path) if is_dash(path) => "standard input".to_owned(),
        Some(path) => shown(path),
    }
}

/// Warns of something about the song, by its name: several may be rendered at once.
fn warn(arguments: &RenderArgs, text: &str) {
    say("warning", &format!("{}: {text}", song_name(arguments)));
}

/// Refuses music that would take hours, or more than a WAV file holds.
fn check_length(arguments: &RenderArgs, song: &Song, longest_tail: f64) -> Result<()> {
    let minutes = song.duration() / 60.0;
    let rate = f64::from(arguments.sample_rate);
    // (How long notes will wait for strings after the song nobody knows before.)
    let longest = (arguments.bit_depth.largest_length(2) as f64 / rate - LONGEST_WAIT) / 60.0;
    let whole = minutes + longest_tail / 60.0;
    if whole > longest {
        bail!(
            "{} minutes do not fit in a WAV file (4 GiB): at most {} at {} Hz and {} bit",
            plain(at_least(whole)),
            plain(at_most(longest)),
            arguments.sample_rate,
            arguments.bit_depth
        );
    }
    // (Only of what fits: a higher limit would be no help to the rest.)
    let limit = arguments.max_length;
    if minutes > limit {
        bail!(
            "the music lasts {} minutes, over the limit of {}: raise it with --max-length MIN",
            plain(at_least(minutes)),
            plain(limit)
        );
    }
    Ok(())
}

/// Where the sound goes: as asked, or named after the song in the current folder.
fn output_path(arguments: &RenderArgs) -> Result<PathBuf> {
    match (&arguments.output, &arguments.song) {
        (Some(output), _) => Ok(output.clone()),
        (None, None) => Ok("demo.wav".into()),
        // What is open already has a number and no name: `render <(...)` is given a pipe as `/dev/fd/63`.
        (None, Some(song)) if descriptor(song).is_some() => Ok("song.wav".into()),
        (None, Some(song)) => {
            let stem = song.file_stem().ok_or_else(|| anyhow!("{} is not a file's name", shown(song)))?;
            let mut name = stem.to_owned();
            name.push(".wav");
            Ok(name.into())
        }
    }
}

/// Refuses to write two results to one file, or in the place of the song or the instrument's file, if it has one.
fn check_paths(
    arguments: &RenderArgs,
    setup_file: Option<&Path>,
    output: &Path,
    strings: &[&str],
) -> Outcome {
    let setup_file = setup_file.map(|path| ("the instrument".to_owned(), path.to_owned()));
    let song = arguments.song.clone().map(|song| ("the song".to_owned(), song));
    let read: Vec<_> = setup_file.into_iter().chain(song).collect();
    let mut written = vec![("the sound".to_owned(), output.to_owned())];
    let stems = stem_paths(arguments, strings).into_iter().zip(strings);
    written.extend(stems.map(|(path, string)| (format!("the sound of string {string}"), path)));
    written.extend(arguments.labels.clone().map(|labels| ("the labels".to_owned(), labels)));
    keep_apart(&read, &written)
}

/// Tells what came of it.
fn report(arguments: &RenderArgs, output: &Path, rendered: &Rendered, elapsed: f64) -> Outcome {
    let Rendered { heard, warnings } = rendered;
    warnings.iter().for_each(|warning| warn(arguments, warning));
    let name = if is_dash(output) { "standard output".to_owned() } else { shown(output) };
    let not_finite = heard.not_finite();
    if not_finite > 0 {
        let text = format!("{not_finite} samples of {name} are not finite numbers; the file is kept");
        return Err(Failure::Check(text));
    }
    let clipped = heard.mix.peak > 1.0 && arguments.bit_depth != BitDepth::Float32;
    let peak = match heard.mix.peak {
        0.0 => "silent".into(),
        _ if clipped => format!("peak {} dBFS, clipped", level(1.0)),
        peak => format!("peak {} dBFS", level(peak)),
    };
    let seconds = heard.samples as f64 / f64::from(arguments.sample_rate);
    let speed = seconds / elapsed.max(1e-9);
    if !arguments.quiet {
        say(&name, &format!("{seconds:.2} s, {peak}, {speed:.1} times faster than real time"));
    }
    Ok(())
}
