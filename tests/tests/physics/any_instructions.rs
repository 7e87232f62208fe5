//! The promise: whole steps give the same bits by the two lanes of an old processor as by the widest of this machine, with
//! many contacts and with few.

use low_action_dsp::{Scene, Simulation};

/// A string over the bridge of a sitar, in steps so short that it leaves that point by point, and one under a thrown finger.
const SITAR: &str = include_str!("../../../scenes/sitar.toml");
const TAP: &str = include_str!("../../../scenes/tap.toml");

/// Steps both ways, and compares string and fingers after each. Returns in how many steps how many contacts acted.
fn acted(text: &str, steps: usize) -> Vec<usize> {
    let scene = Scene::from_toml(text).expect("the scene is valid");
    let mut widest = Simulation::new(&scene).expect("the scene can be built");
    let mut any = widest.clone();
    let mut acted = Vec::new();
    for step in 0..steps {
        widest.step();
        any.step_under(|_, string| string.scratch.leave_vectors());
        let [widest, any] = [&widest, &any].map(|simulation| simulation.string(0));
        assert_eq!(widest.convergence, any.convergence, "step {step}");
        let same =
            widest.state.displacement().map(f64::to_bits).eq(any.state.displacement().map(f64::to_bits));
        assert!(same, "displacement after step {step}");
        let [forces, others] = [widest, any].map(|string| {
            let forces = string.scratch.forces().map(|(index, force)| (index, force.to_bits()));
            let fingers = string.fingers().map(|finger| (finger.number, finger.height.to_bits()));
            forces.chain(fingers).collect::<Vec<_>>()
        });
        assert_eq!(forces, others, "step {step}");
        let active = widest.convergence.active as usize;
        acted.resize(acted.len().max(active + 1), 0);
        acted[active] += 1;
    }
    acted
}

/// More contacts than are solved for as a few.
#[test]
fn a_string_that_buzzes_on_its_bridge() {
    let text = SITAR.replace("sample_rate = 96000", "sample_rate = 384000");
    assert!(text != SITAR);
    let acted = acted(&text, 16_000);
    let many: usize = acted.iter().skip(11).sum();
    assert!(many > 100, "{acted:?}");
}

#[test]
fn a_tap() {
    let acted = acted(TAP, 4000);
    assert!(acted.len() > 4 && acted[1..=4].iter().all(|&steps| steps > 5), "{acted:?}");
}
