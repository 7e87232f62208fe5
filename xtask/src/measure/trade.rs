//! Speed against accuracy: what sample rate, stencil, cap, tolerance and contact law cost, and what they buy.
//!
//! ```text
//! scenes × settings ─> record (runs one) ─> errors (against the reference) ─> table, picture
//! ```

mod errors;
mod filter;
mod picture;
mod record;
mod scenes;
mod settings;
mod spectrum;
mod table;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use anyhow::{Context, Result};
use clap::Parser;

use super::page;
use errors::{Errors, Reference};
use filter::LowPass;
use scenes::{Playing, SCENES};
use settings::{Axis, Setting};

/// Where the tables stand.
const PAGE: &str = "docs/trade.md";
/// Where the picture stands.
const PICTURE: &str = "docs/figures/trade.svg";

/// Measures what speed costs in accuracy, against a converged reference.
#[derive(Parser)]
#[command(
    name = "cargo xtask measure trade",
    after_help = "Examples:\n  cargo xtask measure trade            measures and prints the tables (some minutes)\n  \
                  cargo xtask measure trade --write    puts them and the picture into docs/\n  \
                  cargo xtask measure trade --quick    the rows at 48 kHz, without times, compared with docs/trade.md"
)]
struct Arguments {
    /// Measure the errors at 48 kHz only, and compare them with the table in docs/trade.md.
    #[arg(long, conflicts_with = "write")]
    quick: bool,
    /// Put the tables into docs/trade.md and draw docs/figures/trade.svg.
    #[arg(long)]
    write: bool,
}

/// What was measured of one scene under one setting.
struct Outcome {
    setting: Setting,
    /// Index of the scene.
    scene: usize,
    errors: Errors,
    /// Deepest penetration, m, and the reference's.
    penetration: [f64; 2],
    /// Energy booked to the solver, as a part of the largest energy.
    booked: f64,
    /// Most iterations in a sample.
    iterations: u32,
    /// Part of the samples with contact that took the fallback.
    fallbacks: f64,
    /// Nanoseconds per sample and string, if they were taken.
    time: Option<f64>,
}

/// Runs the measurement.
pub fn run(arguments: Vec<String>) -> Result<()> {
    let Some(arguments) = super::parse::<Arguments>(arguments)? else { return Ok(()) };
    if arguments.quick {
        let committed = page::read(PAGE, "trade")?;
        let outcomes = measure(&settings::quick())?;
        let table = table::accuracy(Axis::Grid, &settings::quick(), &outcomes);
        println!("{table}");
        table::compare(&table, &committed)?;
        println!("as in {PAGE}, as nearly as can be asked");
        return Ok(());
    }
    let mut all: Vec<Setting> = Vec::new();
    for axis in [Axis::Grid, Axis::Solver, Axis::Exponent] {
        for setting in settings::settings(axis) {
            if !all.contains(&setting) {
                all.push(setting);
            }
        }
    }
    let mut outcomes = measure(&all)?;
    time(&mut outcomes)?;
    let tables = table::all(&outcomes);
    println!("{tables}");
    if arguments.write {
        let picture = picture::draw(&outcomes)?;
        let path = super::root().join(PICTURE);
        std::fs::write(&path, picture).with_context(|| format!("cannot write {PICTURE}"))?;
        page::write(PAGE, "trade", &tables)?;
    }
    Ok(())
}

/// Measures all scenes under all settings, on as many threads as there are processors.
fn measure(settings: &[Setting]) -> Result<Vec<Outcome>> {
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(SCENES.len());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(playing) = SCENES.get(index) else { break };
                    eprintln!("{} of {}: {}", index + 1, SCENES.len(), playing.name);
                    let found = observe(index, playing, settings).with_context(|| playing.name.to_owned());
                    results.lock().unwrap_or_else(|broken| broken.into_inner()).push(found);
                }
            });
        }
    });
    let found = results.into_inner().unwrap_or_else(|broken| broken.into_inner());
    let mut outcomes = Vec::new();
    for scene in found {
        outcomes.extend(scene?);
    }
    outcomes.sort_by_key(|outcome: &Outcome| outcome.scene);
    Ok(outcomes)
}

/// Measures one scene under all settings; each exponent has a reference of its own.
fn observe(index: usize, playing: &Playing, settings: &[Setting]) -> Result<Vec<Outcome>> {
    let filter = LowPass::new();
    let pitch = playing.pitch()?;
    let mut references: Vec<(Setting, Reference)> = Vec::new();
    let mut outcomes = Vec::new();
    for &setting in settings {
        let of = setting.reference();
        if !references.iter().any(|(known, _)| *known == of) {
            let run = record::record(&playing.scene(&of)?, false)?;
            references.push((of, Reference::new(run, &filter)));
        }
        let reference = references.iter().find(|(known, _)| *known == of);
        let (_, reference) = reference.context("the reference has just been made")?;
        let run = record::record(&playing.scene(&setting)?, true)?;
        outcomes.push(Outcome {
            setting,
            scene: index,
            errors: reference.errors(&run, playing.kind, pitch, &filter),
            penetration: [run.penetration, reference.record().penetration],
            booked: run.booked,
            iterations: run.iterations,
            fallbacks: run.fallbacks,
            time: None,
        });
    }
    Ok(outcomes)
}

/// Rounds in which everything is timed; the fastest counts. In rounds, so that whatever else the machine does
/// for a while does not fall on one setting alone.
const ROUNDS: usize = 3;

/// Takes the times, one after another.
fn time(outcomes: &mut [Outcome]) -> Result<()> {
    for round in 1..=ROUNDS {
        eprintln!("times: {round} of {ROUNDS}");
        for outcome in &mut *outcomes {
            let time = record::nanoseconds(&SCENES[outcome.scene].scene(&outcome.setting)?)?;
            outcome.time = Some(outcome.time.map_or(time, |best| best.min(time)));
        }
    }
    Ok(())
}
