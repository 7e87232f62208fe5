//! Where things are in the repository, and how scenes are read and run.

use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use low_action_dsp::{Entry, Scene, Simulation};
use low_action_figures::Ground;
use xtask::repository::root;

use super::sound::Sound;

/// The repository this command belongs to.
pub struct Repository {
    root: PathBuf,
}

impl Repository {
    /// `cargo xtask` may be called from anywhere within it.
    pub fn find() -> Repository {
        Repository { root: root() }
    }

    /// Where pages and pictures are.
    pub fn docs(&self) -> PathBuf {
        self.root.join("docs")
    }

    /// Where sounds go.
    pub fn sounds(&self) -> PathBuf {
        self.root.join("target/figures")
    }

    /// Reads a scene by its path from the root.
    pub fn scene(&self, path: &str) -> Result<Scene> {
        let path = self.root.join(path);
        let text = std::fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
        Scene::from_toml(&text).with_context(|| format!("in {}", path.display()))
    }
}

/// What lies under the first string of a scene.
pub fn ground(scene: &Scene) -> Result<Ground> {
    Ok(Ground::under(Simulation::new(scene)?.string(0), scene))
}

/// Runs a scene with its ledger open, and shows every step that has been taken.
///
/// # Errors
/// When the scene is refused, or what it holds is not finite after a step: no verdict is worth anything then.
pub fn run(scene: &Scene, mut look: impl FnMut(&Simulation, &Entry)) -> Result<Simulation> {
    let mut simulation = Simulation::new(scene)?;
    simulation.open_ledger();
    while simulation.steps() < simulation.samples() {
        let entry = simulation.step().unwrap_or_default();
        let (energy, residual) = (entry.energies.total(), entry.residual);
        ensure!(
            energy.is_finite() && residual.is_finite(),
            "step {}: the energy is {energy} J and the balance open by {residual} J, which must be finite",
            simulation.steps()
        );
        look(&simulation, &entry);
    }
    Ok(simulation)
}

/// What a scene sounds like.
pub fn listen(name: &str, scene: &Scene) -> Result<Sound> {
    let mut simulation = Simulation::new(scene)?;
    let mut samples = Vec::new();
    while simulation.steps() < simulation.samples() {
        simulation.step();
        samples.push(simulation.output());
    }
    Ok(Sound { name: name.to_owned(), rate: scene.sample_rate as u32, samples })
}

/// The scene cut down to a shorter time, s.
pub fn shortened(scene: &Scene, duration: f64) -> Scene {
    Scene { duration, ..scene.clone() }
}
