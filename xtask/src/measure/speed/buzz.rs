//! How uneven the work is: iterations, sample by sample, of a chord that buzzes.

use anyhow::{Context, Result};
use low_action_dsp::{Scene, Setup, Simulation};

/// What was counted over all samples, six strings together.
pub struct Iterations {
    /// In the worst sample.
    pub most: u32,
    /// In a sample on average.
    pub mean: f64,
}

/// Samples counted: half a second from the plucks on.
const SAMPLES: usize = 24_000;

/// Counts.
pub fn iterations() -> Result<Iterations> {
    let mut simulation = Simulation::new(&Scene::from_toml(&scene()?)?)?;
    let (mut most, mut sum) = (0, 0);
    for _ in 0..SAMPLES {
        simulation.step();
        let now: u32 = simulation.strings().iter().map(|string| string.convergence.iterations).sum();
        most = most.max(now);
        sum += u64::from(now);
    }
    Ok(Iterations { most, mean: sum as f64 / SAMPLES as f64 })
}

/// The strings of the default instrument, plucked with 3 N over low frets, `live`.
fn scene() -> Result<String> {
    let setup = Setup::builtin("electric").context("the default instrument is built in")?;
    let length = setup.neck.scale_length;
    let mut text = String::from(
        "sample_rate = 48000\nduration = 1\n[solver]\nmax_iterations = 20\ntolerance = 1e-10\n\
         stencil = \"wide\"\n[output]\nposition = 0.55\n[fretboard]\nstiffness = 1e10\nexponent = 1.5\n\
         board = -0.0018\nfrets = 22\nfret_top = -0.0006\nboard_reference_spacing = 0.005\n",
    );
    for (index, string) in setup.string.iter().enumerate() {
        let wave_speed = 2.0 * length * low_action_dsp::setup::frequency(string.pitch);
        let tension = string.linear_density * wave_speed * wave_speed;
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
