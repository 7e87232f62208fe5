//! What each set of instructions makes of whole steps.

use super::{Instructions, Pass, Vectors};
use crate::field::{LANES, Row};
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

/// Whether any number of a row is no more than another.
struct AnyAtMost<'a>(&'a Row, f64);

impl Pass for AnyAtMost<'_> {
    type Output = bool;

    #[inline(always)]
    fn by<V: Vectors>(self, simd: V) -> bool {
        simd.any_at_most(self.0, self.1)
    }
}

/// A number counts in whichever lane it is, up to the limit and no farther; what is no number never does, and none is below what is no
/// number.
#[test]
fn any_lane_may_be_low() {
    for instructions in Instructions::all() {
        for lane in 0..LANES {
            for (number, most, expected) in [
                (1.0, 1.0, true),
                (-f64::INFINITY, 1.0, true),
                (1.0_f64.next_up(), 1.0, false),
                (f64::NAN, 1.0, false),
                (1.0, f64::NAN, false),
            ] {
                let mut row = [f64::INFINITY; LANES];
                row[lane] = number;
                let found = instructions.run(AnyAtMost(&row, most));
                assert_eq!(found, expected, "{number} in lane {lane}, at most {most}, by {instructions:?}");
            }
        }
    }
}
