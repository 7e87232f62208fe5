//! What each set of instructions makes of whole steps.

use super::Instructions;
use crate::scene::Scene;
use crate::simulation::Simulation;

/// A thrown finger on a string over frets.
const TAP: &str = include_str!("../../../scenes/tap.toml");

/// By every instruction set there is the same bits: string, fingers, forces and what the solver did. (`every_instruction_set_gives_the_same_bits`
/// in kernel.rs, decimate.rs and body/tests/motion.rs has each pass by itself, tests/tests/physics/any_instructions.rs many contacts.)
#[test]
fn whole_steps_are_the_same_by_every_instruction_set() {
    let scene = Scene::from_toml(TAP).expect("the scene is valid");
    let first = Simulation::new(&scene).expect("the scene can be built");
    let mut all: Vec<_> = Instructions::all().into_iter().map(|set| (set, first.clone())).collect();
    for step in 0..4_000 {
        let mut expected = None;
        for (set, simulation) in &mut all {
            simulation.step_under(|_, string| string.scratch.instructions = *set);
            let string = simulation.string(0);
            let forces = string.scratch.forces().map(|(index, force)| (index, force.to_bits()));
            let fingers = string.fingers().map(|finger| (finger.number, finger.height.to_bits()));
            let displacement: Vec<_> = string.state.displacement().map(f64::to_bits).collect();
            let found = (displacement, forces.chain(fingers).collect::<Vec<_>>(), string.convergence);
            let expected = expected.get_or_insert_with(|| found.clone());
            assert_eq!(found, *expected, "step {step} by {set:?}");
        }
    }
}
