//! The `scene` command: a scene file computed into a WAV file, a trace and a picture.
//!
//! The result is checked as it is made: every sample must be finite and, where the energy ledger is
//! open, the balance must close. The ledger takes ten times as long as the step it measures, and more,
//! so it is open when a trace or a picture is asked for, and when nothing is written at all; a run that only
//! makes a WAV file goes without.

mod check;
mod outputs;
mod seen;
mod summary;
mod warnings;

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};
use low_action_dsp::{Scene, Simulation};

use super::endings::{self, refuse_others};
use super::names::shown;
use super::paths::{self, is_dash, keep_apart};
use super::progress::Progress;
use super::trace::Trace;
use super::{Outcome, SceneArgs, say};
use check::check;
use outputs::Outputs;
use seen::Seen;
use summary::Summary;

/// The largest scene file read, bytes: room for profiles of many thousand points.
const LARGEST_SCENE: u64 = 16 << 20;
/// A trace of more bytes is announced.
const LARGE_TRACE: u64 = 1_000_000_000;
/// Samples between two looks at the progress: with the largest scenes a second or so.
const LOOK: u64 = 64;

/// Computes a scene.
pub(super) fn run(arguments: &SceneArgs) -> Outcome {
    let (text, scene) = read(&arguments.file)?;
    let name = scene_name(&arguments.file);
    let mut simulation = Simulation::new(&scene).with_context(|| name.clone())?;
    check_paths(arguments)?;
    let warn = |warning: &String| say("warning", &format!("{name}: {warning}"));
    warnings::of(&scene, &simulation).iter().for_each(warn);
    if arguments.trace.is_some() || arguments.figure.is_some() || arguments.wav.is_none() {
        simulation.open_ledger();
    }
    let mut outputs = Outputs::begin(arguments, &text, &scene, &simulation)?;
    let trace_size = outputs.trace.as_ref().map(Trace::size);
    if let Some((_, bytes)) = trace_size.filter(|(_, bytes)| *bytes > LARGE_TRACE) {
        let size = bytes as f64 / 1e9;
        say("note", &format!("{name}: the trace will take {size:.1} GB; --every N keeps less"));
    }
    let started = Instant::now();
    let seen = compute(&name, &mut simulation, &mut outputs)?;
    let elapsed = started.elapsed().as_secs_f64();
    let sound = outputs.finish()?;
    let summary =
        Summary { arguments, scene: &scene, simulation: &simulation, seen, sound, trace_size, elapsed };
    summary.print();
    warnings::overstretched(&seen).iter().for_each(warn);
    let strings = simulation.strings().len();
    check(&name, &seen, sound.as_ref(), strings, simulation.accounts())?;
    warnings::coarse(strings, simulation.accounts()).iter().for_each(warn);
    Ok(())
}

/// What the scene is called in messages.
fn scene_name(path: &Path) -> String {
    if is_dash(path) { "standard input".to_owned() } else { shown(path) }
}

/// Reads the scene from wherever it is: how it is written, and what that says.
fn read(path: &Path) -> Result<(String, Scene)> {
    let name = scene_name(path);
    let bytes = paths::read(path, LARGEST_SCENE).with_context(|| format!("cannot read {name}"))?;
    if bytes.len() as u64 > LARGEST_SCENE {
        bail!("{name} is too large for a scene: at most {} MiB are accepted", LARGEST_SCENE >> 20);
    }
    let text =
        String::from_utf8(bytes).map_err(|_| anyhow!("{name} is not a scene: it is not UTF-8 text"))?;
    let scene = Scene::from_toml(&text).context(name)?;
    Ok((text, scene))
}

/// Refuses results that are called something else, and to write two results, or a result and the scene, to one file.
fn check_paths(arguments: &SceneArgs) -> Outcome {
    let written = [
        ("--wav", &arguments.wav, endings::WAV),
        ("--trace", &arguments.trace, endings::NPZ),
        ("--figure", &arguments.figure, endings::SVG),
    ];
    let named = written.iter().filter_map(|(name, path, _)| Some(((*name).to_owned(), (*path).clone()?)));
    keep_apart(&[("the scene".into(), arguments.file.clone())], &named.collect::<Vec<_>>())?;
    written.iter().try_for_each(|(option, path, form)| {
        path.as_deref().map_or(Ok(()), |path| refuse_others(option, path, form))
    })
}

fn compute(name: &str, simulation: &mut Simulation, outputs: &mut Outputs) -> Result<Seen> {
    let mut progress = Progress::new(name.to_owned(), simulation.samples());
    let mut seen = Seen::default();
    while simulation.steps() < simulation.samples() {
        let entry = match &mut outputs.trace {
            Some(trace) => trace.step(simulation)?,
            None => simulation.step(),
        };
        if let Some(picture) = &mut outputs.figure {
            picture.figure.look(simulation, &entry.unwrap_or_default());
        }
        let output = simulation.output();
        seen.look(simulation, output);
        if let Some(wav) = &mut outputs.wav {
            wav.write(std::iter::once(output as f32))?;
        }
        if simulation.steps().is_multiple_of(LOOK) {
            progress.reach(simulation.steps());
        }
    }
    progress.end();
    // A listening point may never meet what went wrong elsewhere.
    let still = |state: &low_action_dsp::State| state.displacement().all(f64::is_finite);
    seen.ends_not_finite = !simulation.strings().iter().all(|string| still(&string.state));
    Ok(seen)
}
