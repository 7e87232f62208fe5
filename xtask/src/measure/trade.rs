//! Speed against accuracy: what sample rate, stencil, cap, tolerance and contact law cost, and what they buy.
//!
//! ```text
//! scenes × settings ─> record (runs one) ─> errors (against the reference) ─> table, aims, picture
//! ```

mod aims;
mod columns;
mod compare;
mod errors;
mod filter;
mod frets;
mod losses;
mod pace;
mod picture;
mod qualities;
mod record;
mod rival;
pub(super) mod scenes;
pub(super) mod settings;
mod spectrum;
mod table;
mod worst;

use anyhow::{Context, Result, ensure};
use clap::Parser;

use super::features::callgrind_is_there;
use super::{page, threads};
use crate::files;
use crate::repository::root;
use errors::{Errors, Reference};
use filter::LowPass;
use scenes::{Kind, Playing, SCENES};
use settings::{Axis, Setting};

/// Where the tables stand.
const PAGE: &str = "docs/trade.md";
/// Where the picture stands.
const PICTURE: &str = "docs/figures/trade.svg";

/// Measures what speed costs in accuracy, against a converged reference.
#[derive(Parser)]
#[command(
    name = "cargo xtask measure trade",
    after_help = "Examples:\n  cargo xtask measure trade          measures and prints the tables (some minutes)\n  \
                  cargo xtask measure trade --write  puts them and the picture into docs/\n  \
                  cargo xtask measure trade --quick  a part of them, without times, compared\n  \
                  \x20                                  with docs/trade.md"
)]
struct Arguments {
    /// Only the errors at 48 kHz of `draft`, `live` and all stencils.
    /// They are compared with the tables in docs/trade.md.
    #[arg(long, conflicts_with = "write")]
    quick: bool,
    /// Put the tables into docs/trade.md and draw docs/figures/trade.svg.
    #[arg(long)]
    write: bool,
    /// Only time the chord of six strings, and put only that into docs/trade.md.
    #[arg(long, conflicts_with = "quick")]
    chord: bool,
    /// Play one sample, as callgrind is told to.
    #[arg(long, hide = true)]
    sample: Option<String>,
}

/// What was measured of one scene under one setting.
struct Outcome {
    setting: Setting,
    /// Index of the scene.
    scene: usize,
    errors: Errors,
    /// Deepest penetration, m, and the reference's.
    penetration: [f64; 2],
    /// Strongest pull of a contact, N.
    pull: f64,
    /// Energy booked to the solver, as a part of the largest energy; only of Newton's method.
    booked: Option<f64>,
    /// Most iterations in a sample.
    iterations: u32,
    /// Part of the samples with contact that took the fallback.
    fallbacks: f64,
    /// The sample with most work, by iterations times contacts: that number, string and step.
    worst: Option<(u32, usize, u64)>,
    /// Its instructions, if they were counted.
    instructions: Option<f64>,
    /// Part of a core that a string takes, if times were taken.
    load: Option<f64>,
}

impl Outcome {
    /// What its scene is good for.
    fn kind(&self) -> Kind {
        SCENES[self.scene].kind
    }

    /// The error of its waveform, %.
    fn waveform(&self) -> Option<f64> {
        self.errors.waveform.map(percent)
    }

    /// The error of what its contacts push, %.
    fn impulses(&self) -> Option<f64> {
        self.errors.impulses.map(percent)
    }

    /// The largest error of a decay, %.
    fn decay(&self) -> Option<f64> {
        self.errors.decay().map(percent)
    }
}

/// A part in %.
fn percent(part: f64) -> f64 {
    100.0 * part
}

/// Runs the measurement.
pub fn run(arguments: Vec<String>) -> Result<()> {
    let Some(arguments) = super::parse::<Arguments>(arguments)? else { return Ok(()) };
    if let Some(place) = &arguments.sample {
        return worst::child(place);
    }
    if arguments.quick {
        let committed = page::read(PAGE, &page::marks("trade"))?;
        for axis in [Axis::Quality, Axis::Grid] {
            let settings = settings::quick(axis);
            let outcomes = measure(&settings, Kind::is_main)?;
            let table = table::accuracy(axis, &settings, &outcomes);
            println!("{table}");
            compare::compare(&table, &committed)?;
        }
        println!("as in {PAGE}, as nearly as can be asked");
        return Ok(());
    }
    if arguments.chord {
        let table = qualities::speeds(&chords()?);
        println!("{table}");
        if arguments.write {
            page::write(PAGE, &qualities::chord_marks(), &table)?;
        }
        return Ok(());
    }
    let marks = page::marks("trade");
    if arguments.write {
        // What cannot be measured or written is not measured for nothing, nor put in the place of what was measured elsewhere.
        ensure!(
            callgrind_is_there(),
            "--write: valgrind is not there, and it counts the instructions of worst samples"
        );
        page::read(PAGE, &marks)?;
    }
    let mut outcomes = measure(&settings::all(), |_| true)?;
    time(&mut outcomes)?;
    let chords = chords()?;
    if callgrind_is_there() {
        eprintln!("instructions");
        worst::count(&mut outcomes)?;
    } else {
        eprintln!("valgrind is not there: the instructions of the worst samples are left out");
    }
    let aims = aims::aims(&outcomes);
    let reached = format!("\n### What qualities reach\n\n{}", aims::table(&aims));
    let tables = reached + &qualities::tables(&outcomes, &chords)? + &table::all(&outcomes);
    println!("{tables}");
    if arguments.write {
        let picture = (root().join(PICTURE), picture::draw(&outcomes)?);
        files::write_all(&[picture, page::with(PAGE, &marks, &tables)?])?;
    }
    // Last: what was measured is looked into where it is missed.
    aims::judge(&aims)
}

/// Measures scenes of some kinds under all settings that are for them, on as many threads as there are
/// processors.
fn measure(settings: &[Setting], kinds: fn(Kind) -> bool) -> Result<Vec<Outcome>> {
    let scenes: Vec<usize> = (0..SCENES.len()).filter(|&index| kinds(SCENES[index].kind)).collect();
    let found = threads::each(&scenes, |number, &index| {
        let playing = &SCENES[index];
        eprintln!("{} of {}: {}", number + 1, scenes.len(), playing.name);
        observe(index, playing, settings).with_context(|| playing.name.clone())
    });
    let mut outcomes = Vec::new();
    for scene in found {
        outcomes.extend(scene?);
    }
    Ok(outcomes)
}

/// Measures one scene under all settings; each exponent has a reference of its own.
fn observe(index: usize, playing: &Playing, settings: &[Setting]) -> Result<Vec<Outcome>> {
    let filter = LowPass::new();
    let pitch = playing.pitch()?;
    let mut references: Vec<(Setting, Reference)> = Vec::new();
    let mut outcomes = Vec::new();
    for &setting in settings.iter().filter(|setting| setting.plays(playing.kind)) {
        let of = setting.reference();
        if !references.iter().any(|(known, _)| *known == of) {
            let run = record::record(playing, &of, false)?;
            references.push((of, Reference::new(run, &filter)));
        }
        let reference = references.iter().find(|(known, _)| *known == of);
        let (_, reference) = reference.context("the reference has just been made")?;
        let run = record::record(playing, &setting, true)?;
        let errors = reference.errors(&run, (playing.kind, setting.law), pitch, &filter);
        let errors = errors.with_context(|| format!("under {setting:?}"))?;
        outcomes.push(Outcome {
            setting,
            scene: index,
            errors,
            penetration: [run.penetration, reference.record().penetration],
            pull: run.pull,
            booked: run.booked.map(|[sum, largest]| sum / largest.max(f64::MIN_POSITIVE)),
            iterations: run.iterations,
            fallbacks: run.contacts[1] as f64 / run.contacts[0].max(1) as f64,
            worst: run.worst,
            instructions: None,
            load: None,
        });
    }
    Ok(outcomes)
}

/// Rounds in which everything is timed; of each hundredth of a second the fastest counts. In rounds, so that whatever else the machine
/// does for a while does not fall on one setting alone.
const ROUNDS: usize = 3;

/// Of the chord, which is over in a moment.
const CHORD_ROUNDS: usize = 20;

/// Takes the times, one after another.
fn time(outcomes: &mut [Outcome]) -> Result<()> {
    let mut times: Vec<_> = outcomes.iter().map(|_| record::Times::default()).collect();
    for round in 1..=ROUNDS {
        eprintln!("times: {round} of {ROUNDS}");
        for (outcome, times) in outcomes.iter_mut().zip(&mut times) {
            if outcome.kind().is_main() {
                outcome.load = Some(record::load(&SCENES[outcome.scene], &outcome.setting, times)?);
            }
        }
    }
    Ok(())
}

/// How many times faster than real time a chord is computed, for each quality and host's rate.
fn chords() -> Result<Vec<(Setting, f64)>> {
    let settings = settings::settings(Axis::Quality);
    let mut chords: Vec<_> = settings.into_iter().map(|setting| (setting, 0.0)).collect();
    for round in 1..=CHORD_ROUNDS {
        eprintln!("chords: {round} of {CHORD_ROUNDS}");
        for (setting, best) in &mut chords {
            *best = pace::of_the_chord(setting)?.max(*best);
        }
    }
    Ok(chords)
}
