//! The `render` command: a song through the engine into WAV files, and into labels of what was played.

mod files;
mod labels;
mod options;
mod rendering;
mod timeline;
mod tuning;

use std::fs::File;
use std::io::{self, Read};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};
use low_action_dsp::digits::{at_least, at_most, plain};

use super::descriptors::descriptor;
use super::names::{escaped, shown};
use super::paths::{is_dash, keep_apart};
pub use super::wav::BitDepth;
use super::{Failure, Outcome, RenderArgs, instrument, say};
use crate::controls::Touching;
use crate::demo;
use crate::engine::{Engine, EngineOptions};
use crate::midi_file::{LARGEST_FILE, Selection, Song};
use crate::params::InputChoice;
use crate::performance::{Compromises, LONGEST_WAIT};
use files::{Files, stem_paths};
use labels::Source;
pub use options::Tail;
pub(super) use options::{parse_bend, parse_choice, parse_minutes, parse_rate, parse_variation};
use rendering::{Cut, Rendered, Rendering};

/// Renders a song.
pub(super) fn run(arguments: &RenderArgs) -> Outcome {
    let input = arguments.taken.mode()?;
    refuse_settings(arguments)?;
    let (mut setup, setup_file) = instrument::load(&arguments.instrument)?;
    arguments.taken.work_on(&mut setup);
    let options = EngineOptions {
        quality: arguments.quality,
        variation: arguments.variation,
        seed: arguments.seed,
        bend_range: arguments.taken.bend_range.unwrap_or(EngineOptions::BEND_RANGE),
        threads: threads(arguments),
        ..EngineOptions::new(setup, f64::from(arguments.sample_rate))
    };
    let names: Vec<&str> = options.setup.string.iter().map(|string| string.name.as_str()).collect();
    let output = output_path(arguments)?;
    check_paths(arguments, setup_file.as_deref(), &output, &names)?;
    if arguments.skip_existing && files::are_there(arguments, &output, &names) {
        say(&shown(&output), "skipped: all that is asked for is there already");
        return Ok(());
    }
    let song = read_song(arguments)?;
    let longest_tail = arguments.tail.longest(options.tail());
    check_length(arguments, &song, longest_tail).with_context(|| song_name(arguments))?;
    for warning in &song.warnings {
        warn(arguments, &warning.to_string());
    }
    let mut engine =
        Engine::new(&options).with_context(|| escaped(&arguments.instrument.to_string_lossy()))?;
    // (Of those that come with the program it is known, and what they are for.)
    if (setup_file.is_some() || !arguments.taken.set.is_empty())
        && let Some(warning) = tuning::out_of_tune(&options.setup, engine.instrument(), options.quality)?
    {
        warn(arguments, &warning);
    }
    engine.set_input(input);
    let touching =
        Touching { take: options.seed, variation: options.variation, ..arguments.taken.touching() };
    engine.touch(&touching);
    let files = Files::begin(arguments, &output, &names)?;

    let source = Source { arguments, setup: &options.setup };
    let started = Instant::now();
    let rendering =
        Rendering { engine, touching, begins_anew: false, song: &song, source, files, longest_tail };
    let rendered = rendering.play()?;
    report(arguments, &output, &rendered, started.elapsed().as_secs_f64())
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

/// Reads the song from wherever it is.
fn read_song(arguments: &RenderArgs) -> Result<Song> {
    let selection = Selection {
        track: arguments.track.map(usize::from),
        channel: arguments.channel,
        tenth: matches!(arguments.taken.input, InputChoice::Strings | InputChoice::Mpe),
        truncated: arguments.allow_truncated,
    };
    let Some(path) = &arguments.song else {
        return Song::from_midi(demo::MIDI, selection).with_context(|| song_name(arguments));
    };
    // One byte more than is accepted, so that an endless source ends and is refused.
    let limit = LARGEST_FILE as u64 + 1;
    let mut bytes = Vec::new();
    let read = if is_dash(path) {
        io::stdin().lock().take(limit).read_to_end(&mut bytes)
    } else {
        File::open(path).and_then(|file| file.take(limit).read_to_end(&mut bytes))
    };
    read.with_context(|| format!("cannot read {}", song_name(arguments)))?;
    Song::from_midi(&bytes, selection).with_context(|| song_name(arguments))
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
    let Rendered { mix, stems, compromises, lost_events, seconds, cut } = rendered;
    let Compromises {
        moved_by_octaves,
        moved_strings,
        arpeggiated,
        left_out,
        without_string,
        doubled,
        bent_short,
        overtaken,
    } = compromises;
    let warn_of = |count: u64, what: &str| {
        if count > 0 {
            let notes = if count == 1 { "note was" } else { "notes were" };
            warn(arguments, &format!("{count} {notes} {what}"));
        }
    };
    warn_of(*moved_by_octaves, "moved by octaves: no string gives them as written");
    warn_of(
        *moved_strings,
        "struck again on another string: others of their chord that began a moment later needed theirs",
    );
    warn_of(*arpeggiated, "played a moment late: more began at once than there were strings for");
    warn_of(*left_out, "left out: more began at once than anybody could play");
    warn_of(*overtaken, "left out: another took their string before the hand had got there");
    warn_of(*without_string, "left out: no string gives them in any octave, or their channel has none");
    warn_of(*doubled, "one with another: the same key of the same channel at the same moment");
    warn_of(*bent_short, "bent less far than asked: string or finger goes no farther (max_bend)");
    if *lost_events > 0 {
        warn(arguments, &format!("{lost_events} events or gestures of theirs were lost: too many at once"));
    }
    if *seconds == 0.0 {
        warn(arguments, "the sound has no samples: the song ends as it begins (--tail SECONDS goes on)");
    }
    if let Some(Cut { after, level }) = cut {
        let below = -20.0 * level.log10();
        let advice = "it rings on, and --tail SECONDS waits for it";
        warn(
            arguments,
            &format!("the sound is cut off after {after:.0} s, {below:.0} dB below its peak: {advice}"),
        );
    }
    if arguments.bit_depth != BitDepth::Float32 {
        for (name, findings) in [("sound", mix), ("strings' own sound", stems)] {
            if findings.peak > 1.0 {
                let peak = level(findings.peak);
                let advice = "use --bit-depth 32f or a set-up with less gain";
                warn(arguments, &format!("the {name} peaks at {peak} dBFS and is clipped: {advice}"));
            }
        }
    }
    let name = if is_dash(output) { "standard output".to_owned() } else { shown(output) };
    let not_finite = mix.not_finite + stems.not_finite;
    if not_finite > 0 {
        let text = format!("{not_finite} samples of {name} are not finite numbers; the file is kept");
        return Err(Failure::Check(text));
    }
    let clipped = mix.peak > 1.0 && arguments.bit_depth != BitDepth::Float32;
    let peak = match mix.peak {
        0.0 => "silent".into(),
        _ if clipped => format!("peak {} dBFS, clipped", level(1.0)),
        peak => format!("peak {} dBFS", level(peak)),
    };
    let speed = seconds / elapsed.max(1e-9);
    say(&name, &format!("{seconds:.2} s, {peak}, {speed:.1} times faster than real time"));
    Ok(())
}

/// A size as a level in dB, 1 is 0. Above that it is rounded up: what is clipped is not at 0.
fn level(size: f32) -> String {
    let tenths = 200.0 * f64::from(size).log10();
    if size > 1.0 { format!("{:+.1}", tenths.ceil() / 10.0) } else { format!("{:.1}", tenths / 10.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_above_full_scale_is_shown_above_it() {
        for (size, expected) in [
            (1.0, "0.0"),
            (1.000_001, "+0.1"),
            (1.1, "+0.9"),
            (1.11, "+1.0"),
            (0.5, "-6.0"),
            (1e-6, "-120.0"),
        ] {
            assert_eq!(level(size), expected, "{size}");
        }
    }
}
