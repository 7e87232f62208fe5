//! Promise: strings that are held and plucked as firmly as hands do it stay on frets and board at every cap: these are pressed in
//! no deeper than where one contact would store all that the hands gave. (What other programs make of the same strings stands in
//! `docs/others.md`.)

use low_action_dsp::{Scene, Simulation};
use low_action_tests::numbers::largest;

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/others");

fn stay_on_the_frets(name: &str) {
    let text = std::fs::read_to_string(format!("{SCENES}/{name}.toml")).expect("the scene is there");
    let mut scene = Scene::from_toml(&text).expect("the scene is valid");
    let board = scene.fretboard.clone().expect("there is a fretboard");
    for cap in [0, 1, 4, 20] {
        scene.solver.max_iterations = cap;
        let mut simulation = Simulation::new(&scene).expect("the scene can be built");
        simulation.open_ledger();
        let mut deepest = 0.0;
        for _ in 0..simulation.samples() {
            simulation.step();
            assert!(simulation.output().is_finite(), "cap {cap}");
            deepest =
                largest(simulation.strings().iter().map(|string| string.penetration()).chain([deepest]));
        }
        let put_in = largest(simulation.ledgers().iter().map(|ledger| ledger.put_in));
        // K/(α + 1)·η^(α + 1) is what is stored.
        let power = board.exponent + 1.0;
        let all_of_it = (power * put_in / board.stiffness).powf(1.0 / power);
        assert!(deepest > 1e-7 && deepest < all_of_it, "cap {cap}: {deepest:e} m of {all_of_it:e} m");
        println!("cap {cap}: {deepest:.2e} m of {all_of_it:.2e} m");
    }
}

#[test]
fn strings_held_firmly_stay_on_the_frets() {
    stay_on_the_frets("firm");
}

#[test]
fn so_do_strings_held_gently() {
    stay_on_the_frets("gentle");
}
