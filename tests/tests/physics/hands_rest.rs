//! The promise: above 1e30 J no hand slides or bends and no board moves, so that nothing multiplies what is there for ever; they
//! stay where they are until the string is reset, however little of its energy is left.

use low_action_dsp::curve::Curve;
use low_action_dsp::simulation::SceneString;
use low_action_dsp::{Scene, Simulation};

const TENSION: f64 = 60.0;
const BENT: f64 = 70.0;
const PLACE: f64 = 0.2;
const ELSEWHERE: f64 = 0.25;
/// How far board and frets rise, m.
const RISE: f64 = 1e-3;
/// A string between a finger and frets, both so soft that they hold no more energy than a thousand times what it does, m from m.
const SCENE: &str = "sample_rate = 48000\nduration = 1.0\n[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\n\
    tension = [[10.0, 60.0], [11.0, 90.0]]\n[fretboard]\nstiffness = 1e3\nexponent = 1.0\nboard = -0.002\n\
    frets = 12\nfret_top = -0.001\n[[finger]]\nmass = 5e-3\nstiffness = 1e3\nexponent = 1.0\nposition = 0.2\n\
    height = 1e-4\nforce = 6.0\nhand_damping = 5.0\n";

/// A triangle so high that the string, drawn out so, holds so many joules: T h² (1/a + 1/b)/2 with sides of a and b.
fn triangle(energy: f64) -> Curve {
    let height = (2.0 * energy / (TENSION * (1.0 / 0.3 + 1.0 / 0.35))).sqrt();
    Curve::Points(vec![[0.0, 0.0], [0.3, height], [0.65, 0.0]])
}

/// A string that has taken a few steps with so much energy.
fn drawn(energy: f64) -> Simulation {
    let scene = Scene::from_toml(SCENE).expect("the scene is valid");
    let mut simulation = Simulation::new(&scene).expect("the scene can be built");
    for step in 0..4 {
        simulation.step_under(|_, string| {
            if step == 0 {
                string.state.set_shape(&string.model, &triangle(energy));
            }
        });
    }
    simulation
}

/// A bend, a slide and a board that moves.
fn hands_move(string: &mut SceneString) {
    string.drive.tension = BENT;
    string.drive.hands[0].position = ELSEWHERE;
    string.drive.heights.extend(string.model.contacts.iter().map(|contact| contact.height + RISE));
}

/// Whether each of them did, where all of them did or none.
fn have_moved(simulation: &mut Simulation) -> [bool; 3] {
    for _ in 0..500 {
        simulation.step_under(|_, string| hands_move(string));
        let string = simulation.string(0);
        assert!(string.state.displacement().chain(string.state.motion()).all(f64::is_finite));
        assert!(string.fingers().all(|finger| finger.height.is_finite() && finger.force.is_finite()));
    }
    let string = simulation.string(0);
    let tension = string.scratch.stiffness().tension;
    assert!(tension == TENSION || tension == BENT, "{tension} N");
    let position = string.fingers().next().expect("there is one").position;
    assert!(position == PLACE || position == ELSEWHERE, "{position} m");
    let raised = string.state.heights().iter().zip(&string.model.contacts);
    let raised: Vec<_> = raised.map(|(height, contact)| height - contact.height).collect();
    let rises = raised[0] != 0.0;
    let rise = if rises { RISE } else { 0.0 };
    assert!(raised.iter().all(|raised| (raised - rise).abs() < 1e-12), "{raised:?}");
    [tension == BENT, position == ELSEWHERE, rises]
}

#[test]
fn they_move_below() {
    for energy in [1e-3, 1e26] {
        assert_eq!(have_moved(&mut drawn(energy)), [true; 3], "{energy:e} J");
    }
}

#[test]
fn they_rest_above() {
    assert_eq!(have_moved(&mut drawn(1e31)), [false; 3]);
}

/// A hand along the string takes the energy, by a factor of e¹⁰⁰ in a tenth of a second.
#[test]
fn they_rest_until_the_string_is_reset() {
    let mut simulation = drawn(1e31);
    for _ in 0..4800 {
        simulation.step_under(|_, string| string.drive.loss = 500.0);
    }
    let left = simulation.string(0).scratch.string_energy();
    assert!(left < 1.0, "{left:e} J are left");
    assert_eq!(have_moved(&mut simulation), [false; 3]);
    let touch = Scene::from_toml(SCENE).expect("the scene is valid").finger[0].touch();
    simulation.step_under(|_, string| {
        string.state.reset(&string.model);
        string.scratch.reset();
        string.state.place_finger(&string.model, 0, touch, PLACE, 1e-4, 0.0).expect("there is room");
    });
    assert_eq!(have_moved(&mut simulation), [true; 3]);
}
