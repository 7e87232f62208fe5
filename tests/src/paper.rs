//! The scenes of the paper, as tests read and run them.

use low_action_dsp::{Entry, Scene, Simulation};

/// A scene of `scenes/paper` by its name.
pub fn scene(name: &str) -> Scene {
    let path = format!("{}/../scenes/paper/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    Scene::from_toml(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The same for a shorter time, s.
pub fn shortened(scene: &Scene, duration: f64) -> Scene {
    Scene { duration, ..scene.clone() }
}

/// Runs a scene with its ledger open and shows every step that has been taken.
pub fn run(scene: &Scene, mut look: impl FnMut(&Simulation, &Entry)) -> Simulation {
    let mut simulation = Simulation::new(scene).expect("the scene can be built");
    simulation.open_ledger();
    while simulation.steps() < simulation.samples() {
        let entry = simulation.step().expect("the ledger is open");
        look(&simulation, &entry);
    }
    simulation
}
