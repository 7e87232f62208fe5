//! The `scene` command: a scene file computed into a WAV file, a trace and a picture.
//!
//! The result is checked as it is made: every sample must be finite and, where the energy ledger is
//! open, the balance must close. The ledger takes ten times as long as the step it measures, and more,
//! so it is open when a trace or a picture is asked for, and when nothing is written at all; a run that only
//! makes a WAV file goes without.

mod summary;
mod warnings;

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail};
use low_action_dsp::digits::{at_least, at_most, plain};
use low_action_dsp::pickup::stretch_tension;
use low_action_dsp::{Account, Scene, Simulation};
use low_action_figures::SceneFigure;

use super::endings::{self, refuse_others};
use super::names::shown;
use super::output::{Draft, publish_all};
use super::paths::{is_dash, keep_apart};
use super::progress::Progress;
use super::trace::Trace;
use super::wav::{BitDepth, Findings, WavFile};
use super::{Failure, Outcome, SceneArgs, say};
use summary::Summary;

/// The largest scene file read, bytes: room for profiles of many thousand points.
const LARGEST_SCENE: u64 = 16 << 20;
/// How far the energy balance may be open over a whole run, as a part of the largest energy or of all that was put in, whichever
/// is more, and beyond what rounding alone may come to. It leaves some 1e-13 a second.
const BALANCE: f64 = 1e-9;
/// Where rounding alone may come to more than this part, little or nothing of the balance is checked, and a warning says so.
const COARSE: f64 = 1e-6;
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
    let mut bytes = Vec::new();
    // One byte more than is accepted, so that an endless source ends and is refused.
    let limit = LARGEST_SCENE + 1;
    let name = scene_name(path);
    let read = if is_dash(path) {
        io::stdin().lock().take(limit).read_to_end(&mut bytes)
    } else {
        File::open(path).and_then(|file| file.take(limit).read_to_end(&mut bytes))
    };
    read.with_context(|| format!("cannot read {name}"))?;
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
    for (option, path, form) in &written {
        path.as_deref().map_or(Ok(()), |path| refuse_others(option, path, form))?;
    }
    let written = written.into_iter().filter_map(|(name, path, _)| Some((name.to_owned(), path.clone()?)));
    keep_apart(&[("the scene".into(), arguments.file.clone())], &written.collect::<Vec<_>>())
}

/// What is written.
struct Outputs {
    wav: Option<WavFile>,
    trace: Option<Trace>,
    figure: Option<Picture>,
}

impl Outputs {
    fn begin(arguments: &SceneArgs, text: &str, scene: &Scene, simulation: &Simulation) -> Result<Outputs> {
        if arguments.wav.is_some() {
            check_sound(scene, simulation).with_context(|| scene_name(&arguments.file))?;
        }
        let begin = |path| WavFile::begin(path, 1, scene.sample_rate as u32, BitDepth::Float32);
        let wav = arguments.wav.as_deref().map(begin).transpose()?;
        let trace =
            arguments.trace.as_ref().map(|path| Trace::begin(path, text, simulation, arguments.every));
        let figure = arguments.figure.as_ref().map(|path| Picture::begin(path, arguments, scene, simulation));
        Ok(Outputs { wav, trace: trace.transpose()?, figure: figure.transpose()? })
    }

    /// Completes all files, then lets them appear: a disk that is full for one leaves none.
    fn finish(self) -> Result<Option<Findings>> {
        let trace = self.trace.map(Trace::complete).transpose()?;
        let figure = self.figure.map(Picture::complete).transpose()?;
        let sound = self.wav.as_ref().map(WavFile::findings);
        let wav = self.wav.map(WavFile::complete).transpose()?;
        publish_all([wav, trace, figure].into_iter().flatten().collect())?;
        Ok(sound)
    }
}

/// A picture being made. Its file is opened at the beginning, so that a place where nothing can be written
/// is found out before anything is computed.
struct Picture {
    path: PathBuf,
    draft: Draft,
    title: String,
    figure: SceneFigure,
}

impl Picture {
    fn begin(path: &Path, arguments: &SceneArgs, scene: &Scene, simulation: &Simulation) -> Result<Picture> {
        let title = match arguments.file.file_name() {
            Some(name) if !is_dash(&arguments.file) => shown(Path::new(name)),
            _ => "A scene".into(),
        };
        let figure = SceneFigure::new(scene, simulation);
        Ok(Picture { path: path.to_owned(), draft: Draft::begin(path)?, title, figure })
    }

    /// Draws it into its file, which then waits to be published.
    fn complete(self) -> Result<Draft> {
        let picture = self.figure.draw(&self.title)?;
        let written = self.draft.handle().and_then(|mut file| file.write_all(picture.as_bytes()));
        written.with_context(|| format!("cannot write {}", shown(&self.path)))?;
        Ok(self.draft)
    }
}

/// Refuses what no WAV file holds.
fn check_sound(scene: &Scene, simulation: &Simulation) -> Result<()> {
    let rate = scene.sample_rate;
    if rate.fract() != 0.0 {
        bail!("sample_rate = {} is refused: --wav needs a whole number of hertz", plain(rate));
    }
    let longest = BitDepth::Float32.largest_length(1);
    if simulation.samples() > longest {
        let longest = (longest as f64 / rate).floor();
        let (given, rate) = (plain(scene.duration), plain(rate));
        bail!("duration = {given} is refused: --wav holds at most {longest} s at {rate} Hz");
    }
    Ok(())
}

/// What was seen while computing.
#[derive(Debug, Clone, Copy, Default)]
struct Seen {
    /// The first sample whose output is no finite number.
    not_finite: Option<u64>,
    /// Whether a point of a string is not finite at the end, however finite the output.
    ends_not_finite: bool,
    /// Deepest penetration of board and frets, m.
    penetration: f64,
    /// Newton iterations in all, and the most in one sample of one string.
    iterations: u64,
    most_iterations: u32,
    /// The most contacts active at once in one string.
    contacts: u32,
    /// Where stretching left the least room: the tension there was and the one that the grid bears, N.
    stretched: Option<[f64; 2]>,
}

impl Seen {
    fn look(&mut self, simulation: &Simulation, output: f64) {
        if self.not_finite.is_none() && !output.is_finite() {
            self.not_finite = Some(simulation.steps() - 1);
        }
        for string in simulation.strings() {
            if string.model.string.tension_modulation {
                let own = string.scratch.stiffness().tension;
                let now =
                    [own + stretch_tension(&string.model, &string.scratch), string.model.tension_borne(own)];
                if self.stretched.is_none_or(|[most, borne]| now[0] * borne > most * now[1]) {
                    self.stretched = Some(now);
                }
            }
            let convergence = &string.convergence;
            if convergence.active > 0 {
                self.penetration = self.penetration.max(string.penetration());
                self.iterations += u64::from(convergence.iterations);
                self.most_iterations = self.most_iterations.max(convergence.iterations);
                self.contacts = self.contacts.max(convergence.active);
            }
        }
    }
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

/// Whether the result of a scene that is so called may be believed.
fn check<'a>(
    name: &str,
    seen: &Seen,
    sound: Option<&Findings>,
    strings: usize,
    accounts: impl Iterator<Item = &'a Account>,
) -> Outcome {
    let fails = |text: String| Err(Failure::Check(format!("{name}: {text}")));
    if let Some(sample) = seen.not_finite {
        return fails(format!("the result is not finite from sample {sample} on; it is kept"));
    }
    if seen.ends_not_finite {
        return fails("a string is not finite at the end; the result is kept".into());
    }
    if let Some(sound) = sound.filter(|sound| sound.not_finite > 0) {
        let count = sound.not_finite;
        return fails(format!("{count} samples are too large for 32 bits; the file is kept"));
    }
    for (index, account) in accounts.enumerate() {
        let (open, limit) = (open_part(account), BALANCE + rounding_part(account));
        if open.is_nan() || open > limit {
            return fails(format!(
                "the energy balance of {} is open by {} of its largest energy or of all that was put in, over \
                 the limit of {}; the result is kept",
                named(index, strings),
                plain(at_least(open)),
                plain(at_most(limit))
            ));
        }
    }
    Ok(())
}

/// What the account of an index is of, where the first are of so many strings.
fn named(index: usize, strings: usize) -> String {
    if index < strings { format!("string {}", index + 1) } else { "the body".into() }
}

/// How far a ledger is open in all, as a part of the largest energy or of all that was put in.
fn open_part(account: &Account) -> f64 {
    if account.residual_sum == 0.0 { 0.0 } else { account.residual_sum.abs() / flow(account) }
}

/// How far rounding alone may open it, as the same part.
fn rounding_part(account: &Account) -> f64 {
    account.rounding / flow(account)
}

/// What a balance is judged by, J: above 0. (What hands take out again has gone through it, too.)
fn flow(account: &Account) -> f64 {
    account.largest.max(account.put_in_gross).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accounts() -> Vec<Account> {
        let text = "sample_rate = 44100\nduration = 0.01\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                    tension = 60.0\nshape = [[0.0, 0.0], [0.3, 0.001], [0.65, 0.0]]\n";
        let mut simulation = Simulation::new(&Scene::from_toml(text).unwrap()).unwrap();
        simulation.open_ledger();
        simulation.step();
        simulation.accounts().cloned().collect()
    }

    #[test]
    fn a_good_result_passes() {
        assert!(check("it", &Seen::default(), Some(&Findings::default()), 1, accounts().iter()).is_ok());
    }

    #[test]
    fn what_is_not_finite_or_not_balanced_fails_with_3() {
        let code = |outcome: Outcome| outcome.err().map(|failure| failure.code());
        let nothing = [].iter();
        let seen = Seen { not_finite: Some(7), ..Seen::default() };
        assert_eq!(code(check("it", &seen, None, 1, nothing.clone())), Some(3));
        let seen = Seen { ends_not_finite: true, ..Seen::default() };
        assert_eq!(code(check("it", &seen, None, 1, nothing.clone())), Some(3));
        let sound = Findings { not_finite: 1, ..Findings::default() };
        assert_eq!(code(check("it", &Seen::default(), Some(&sound), 1, nothing)), Some(3));
        for part in [2.0 * BALANCE, -2.0 * BALANCE, f64::NAN] {
            let mut open = accounts();
            open[0].residual_sum = part * open[0].largest;
            assert_eq!(code(check("it", &Seen::default(), None, 1, open.iter())), Some(3));
            // Where more than that has gone through it, and been taken out again, it passes.
            open[0].put_in_gross = 10.0 * open[0].largest;
            let outcome = check("it", &Seen::default(), None, 1, open.iter());
            assert_eq!(code(outcome), part.is_nan().then_some(3));
        }
    }
}
