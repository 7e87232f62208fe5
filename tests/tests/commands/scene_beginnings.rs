//! Promise: of a string that begins inside board, frets or fingers it is said what these store and what the string has itself, where
//! that is less; and of any other nothing.

use low_action_dsp::{Scene, Simulation};
use low_action_tests::command::Workplace;

/// One string, and what is put behind it.
fn scene(string: &str, rest: &str) -> String {
    format!(
        "sample_rate = 44100\nduration = 0.001\n[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60.0\n{string}\n{rest}"
    )
}

/// What is warned of, a line each.
fn warned(scene: &str) -> Vec<String> {
    let place = Workplace::new(env!("CARGO_BIN_EXE_low-action-command"));
    place.write("scene.toml", scene);
    let done = place.run(&["scene", "scene.toml"]);
    assert_eq!(done.code, 0, "{}", done.error);
    done.error.lines().map(str::to_owned).collect()
}

/// The two energies of the warning, J: of the contacts, and of the string.
fn told(scene: &str) -> [f64; 2] {
    let lines = warned(scene);
    assert_eq!(lines.len(), 1, "{lines:?}");
    let begins = "warning: scene.toml: string[1] begins inside board, frets or fingers, which store ";
    let numbers = lines[0].strip_prefix(begins).unwrap_or_else(|| panic!("{lines:?}"));
    let (contacts, own) = numbers.split_once(" J and throw it: it has ").unwrap();
    [contacts, own.strip_suffix(" J itself").unwrap()].map(|number| number.parse().unwrap())
}

/// What the points of a board store, K/(α + 1)·η^(α + 1) each, J, under a triangle whose tip is at 0.3 m.
fn stored(scene: &str, [stiffness, exponent]: [f64; 2], board: f64, tip: f64) -> f64 {
    let simulation = Simulation::new(&Scene::from_toml(scene).unwrap()).unwrap();
    let shape = |place: f64| tip * if place < 0.3 { place / 0.3 } else { (0.65 - place) / 0.35 };
    let depths = simulation.string(0).places().map(|place| board - shape(place));
    depths
        .filter(|depth| *depth > 0.0)
        .map(|depth| stiffness / (exponent + 1.0) * depth.powf(exponent + 1.0))
        .sum()
}

fn assert_near(actual: f64, expected: f64, part: f64, of: &str) {
    assert!((actual / expected - 1.0).abs() < part, "{of}: {actual} instead of {expected}");
}

#[test]
fn a_shape_inside_the_board_is_told_of_by_what_it_and_the_board_store() {
    for ([stiffness, exponent], board, tip) in
        [([1e9, 1.5], -0.003, -0.01), ([1e10, 1.5], -0.009_94, -0.01), ([1e12, 2.3], -0.002, -0.003)]
    {
        let scene = scene(
            &format!("shape = [[0, 0], [0.3, {tip}], [0.65, 0]]"),
            &format!("[fretboard]\nstiffness = {stiffness}\nexponent = {exponent}\nboard = {board}\n"),
        );
        let [contacts, own] = told(&scene);
        assert_near(contacts, stored(&scene, [stiffness, exponent], board, tip), 1e-3, &scene);
        // T/2 ∫ (∂u/∂x)² dx; the grid has no point at the very tip.
        assert_near(own, 0.5 * 60.0 * tip * tip * (1.0 / 0.3 + 1.0 / 0.35), 0.01, &scene);
    }
}

#[test]
fn what_a_string_is_struck_with_is_its_own() {
    let finger =
        "[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\nposition = 0.4\nheight = -0.002\n";
    let thrown = "velocity = [[0.1, 0], [0.2, 5], [0.3, 0]]\nloss_1 = 1e-2";
    let [contacts, own] = told(&scene(thrown, finger));
    assert_near(contacts, 1e8 / 3.0 * 0.002_f64.powi(3), 1e-3, "the pad");
    // ρ/2 ∫ v² dx
    assert_near(own, 0.5 * 5.25e-3 * 2.0 * 0.1 * 25.0 / 3.0, 0.01, "the string");
    // Ten times as fast it has more than the pad.
    assert!(warned(&scene(&thrown.replace("5]", "50]"), finger)).is_empty());
}

#[test]
fn what_only_comes_to_touch_is_not_inside() {
    for (string, rest) in [
        (
            "",
            "[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\nposition = 0.4\nheight = 0.0\nforce = 1e6\nhand_damping = 10.0\n\
             [fretboard]\nstiffness = 1e12\nexponent = 2.3\nboard = -0.002\n",
        ),
        (
            "",
            "[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\nposition = 0.4\nheight = 1e-6\nvelocity = -1000.0\n",
        ),
        (
            "shape = [[0, 0], [0.3, -0.0005], [0.65, 0]]",
            "[fretboard]\nstiffness = 1e12\nexponent = 2.3\nboard = -0.002\n",
        ),
    ] {
        let warned = warned(&scene(string, rest));
        assert!(!warned.iter().any(|line| line.contains("begins inside")), "{warned:?}");
    }
}
