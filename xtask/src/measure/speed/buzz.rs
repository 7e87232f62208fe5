//! How uneven the work is: iterations and instructions, sample by sample, of a chord that buzzes.

use anyhow::{Context, Result};
use low_action_dsp::intonation::flexible_tension;
use low_action_dsp::neck::Neck;
use low_action_dsp::{Convergence, Quality, Scene, Setup, Simulation};

use crate::measure::features::instructions_of_run;

/// What was counted over all samples, six strings together.
pub struct Work {
    /// In the worst sample.
    pub most: f64,
    /// In a sample on average.
    pub mean: f64,
}

/// Samples counted: half a second from the plucks on.
const SAMPLES: usize = 24_000;

/// Samples that look like the most work, of which instructions are counted one by one.
const SUSPECTS: usize = 4;

/// Runs the chord for so many samples, for whoever counts what that takes.
pub fn play(samples: usize) -> Result<()> {
    let mut simulation = chord()?;
    for _ in 0..samples {
        simulation.step();
    }
    Ok(())
}

/// Iterations in each sample, and how much work its contacts look like.
fn count() -> Result<Vec<(u32, u32)>> {
    let mut simulation = chord()?;
    let counts = (0..SAMPLES).map(|_| {
        simulation.step();
        let strings = simulation.strings().iter().map(|string| string.convergence);
        let iterations = strings.clone().map(|done| done.iterations).sum();
        (iterations, strings.map(|done| weight(&done)).sum())
    });
    Ok(counts.collect())
}

/// About how many iterations' work a solution was: a repeat takes the step again, a fallback is as much as an iteration.
fn weight(done: &Convergence) -> u32 {
    done.iterations + done.fallbacks + 3 * done.repeats + done.active
}

/// Counts iterations.
pub fn iterations() -> Result<Work> {
    let counts = count()?;
    let sum: u64 = counts.iter().map(|(iterations, _)| u64::from(*iterations)).sum();
    let most = counts.iter().map(|(iterations, _)| *iterations).max().unwrap_or(0);
    Ok(Work { most: f64::from(most), mean: sum as f64 / SAMPLES as f64 })
}

/// Counts instructions. callgrind counts whole runs, so those of a sample are what a run takes more with it.
pub fn instructions() -> Result<Work> {
    let counts = count()?;
    let program = std::env::current_exe().context("this program has no path")?;
    let run = |samples: usize| {
        instructions_of_run(&program, None, &["measure", "speed", "--buzz", &samples.to_string()])
    };
    let mean = (run(SAMPLES)? - run(0)?) / SAMPLES as f64;
    let mut samples: Vec<usize> = (0..SAMPLES).collect();
    samples.sort_by_key(|&sample| std::cmp::Reverse(counts[sample].1));
    let mut most = 0.0f64;
    for &sample in &samples[..SUSPECTS] {
        most = most.max(run(sample + 1)? - run(sample)?);
    }
    Ok(Work { most, mean })
}

fn chord() -> Result<Simulation> {
    Ok(Simulation::new(&Scene::from_toml(&scene()?)?)?)
}

/// The strings of the default instrument, plucked with 3 N over low frets, `live`.
fn scene() -> Result<String> {
    let setup = Setup::builtin("electric").context("the default instrument is built in")?;
    let length = setup.neck.scale_length;
    let live = Quality::Live.settings(48e3);
    let Neck { stiffness, exponent, damping, board_reference_spacing, .. } = setup.neck;
    let mut text = format!(
        "sample_rate = 48000\nduration = 1\n[solver]\nmax_iterations = {}\ntolerance = {:e}\nstencil = \"wide\"\n\
         [output]\nposition = 0.55\n[fretboard]\nstiffness = {stiffness:e}\nexponent = {exponent}\n\
         damping = {damping}\nboard = -0.0018\nfrets = 22\nfret_top = -0.0006\n\
         board_reference_spacing = {board_reference_spacing}\n",
        live.max_iterations, live.tolerance,
    );
    for (index, string) in setup.string.iter().enumerate() {
        let tension = flexible_tension(&setup, string);
        text += &format!(
            "[[string]]\nlength = {length}\nlinear_density = {}\ntension = {tension}\nyoungs_modulus = {}\n\
             core_radius = {}\nloss_0 = {}\nloss_1 = {}\ntension_modulation = true\n\
             [[pluck]]\nstring = {}\nposition = 0.52\nduration = 0.003\nforce = 3.0\n",
            string.linear_density,
            string.youngs_modulus,
            string.core_radius,
            string.loss_0,
            string.loss_1,
            index + 1,
        );
    }
    Ok(text)
}
