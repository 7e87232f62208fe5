//! Promise: a string bends round a kinked fret as if its grid had room for that: what is stopped there rings as long as on a
//! fine grid, and what strikes it is met by the force of two strings pulled along.

use low_action_dsp::{Scene, Simulation};
use low_action_tests::numbers::largest;
use low_action_tests::stage::amplitude;

/// A thin steel string, without bending so that what its grid lacks is all there is.
const LENGTH: f64 = 0.65;
const DENSITY: f64 = 4e-4;
const TENSION: f64 = 72.0;
const LOSS: f64 = 0.8;

fn build(rate: f64, duration: f64, rest: &str) -> Simulation {
    let text = format!(
        "sample_rate = {rate}\nduration = {duration}\n[solver]\nstencil = \"wide\"\nmax_iterations = 100\n\
         tolerance = 1e-14\n{rest}"
    );
    Simulation::new(&Scene::from_toml(&text).expect("the scene is valid")).expect("the scene can be built")
}

/// Spacing of its grid, m.
fn spacing(rate: f64, length: f64) -> f64 {
    build(rate, 1.0, &string(length)).string(0).model.grid.spacing
}

/// Decay rate of the first partial, 1/s, of a string stopped by a finger behind a fret, `part` of the
/// way from grid point `cell` to the next.
fn decay(placement: &str, (cell, part): (f64, f64)) -> f64 {
    let rate = 48e3;
    let fret = (cell + part) * spacing(rate, LENGTH);
    let mut simulation = build(
        rate,
        2.2,
        &format!(
            "[output]\nposition = {}\n{}[fretboard]\nstiffness = 1e10\nexponent = 1.5\nfrets = [{fret}]\nfret_top = -1e-3\n\
             fret_placement = \"{placement}\"\n\
             [[finger]]\nmass = 5e-3\nstiffness = 1e7\nexponent = 2.0\nposition = {}\nheight = 5e-4\n\
             force = [[0, 0], [0.2, 6]]\ndamping = 1.0\nhand_damping = 5.0\n\
             [[pluck]]\nstart = 0.5\nduration = 0.002\nposition = {}\nforce = -0.1\n",
            LENGTH - 0.1,
            string(LENGTH),
            fret - 0.03,
            LENGTH - 0.12,
        ),
    );
    let mut heard = Vec::new();
    for _ in 0..simulation.samples() {
        simulation.step();
        heard.push(simulation.output());
    }
    let frequency = 0.5 * (TENSION / DENSITY).sqrt() / (LENGTH - fret);
    // Its size in 0.3 s from some time on.
    let partial =
        |from: f64| amplitude(&heard[(from * rate) as usize..][..(0.3 * rate) as usize], rate, frequency);
    (partial(0.6) / partial(1.8)).ln() / 1.2
}

fn string(length: f64) -> String {
    format!(
        "[[string]]\nlength = {length}\nlinear_density = {DENSITY}\ntension = {TENSION}\nloss_0 = {LOSS}\n"
    )
}

/// Without room for a kink the two points beside a fret move like a lever, and the string behind the fret and the finger on it
/// with them. With it nothing gets past, and the note decays by the string's own loss.
#[test]
fn a_stopped_string_rings_as_long_as_it_should() {
    for place in [(33.0, 0.5), (38.0, 0.3), (41.0, 0.7)] {
        let [exact, kinked] = ["exact", "kinked"].map(|placement| decay(placement, place) - LOSS);
        println!("{place:?}: lost behind the fret {exact:.1e} 1/s of {LOSS}, kinked {kinked:.1e} 1/s");
        assert!(exact > 0.01 * LOSS, "there was nothing to mend");
        // What gets past grows with the square of what is wrong with the force.
        assert!(kinked.abs() < 0.02 * exact);
    }
}

/// What stands on a slope of a string let go falls at c times the slope once the wave from its tip has passed, and the string
/// beside it with it, until the waves come back from the ends. A fret in its way is pushed by 2√(Tρ) times that speed.
#[test]
fn a_strike_is_met_by_the_force_of_two_strings() {
    let (length, height) = (2.0, 4e-3);
    let wave_speed = (TENSION / DENSITY).sqrt();
    let expected = 2.0 * (TENSION * DENSITY).sqrt() * wave_speed * height / (0.5 * length);
    // Most that the force is off, as a part of it, from a tenth step on while it should not change.
    let off = |rate: f64, placement: &str, part: f64| {
        let spacing = spacing(rate, length);
        let fret = ((0.25 * length / spacing).floor() + part) * spacing;
        let rest = format!(
            "{}shape = [[0, 0], [{}, {height}], [{length}, 0]]\n[fretboard]\nstiffness = 1e10\nexponent = 1.5\n\
             frets = [{fret}]\nfret_top = -2e-4\nfret_placement = \"{placement}\"\n",
            string(length),
            0.5 * length,
        );
        let mut simulation = build(rate, 1.0, &rest);
        let mut forces = Vec::new();
        while forces.len() < (0.2 * length / wave_speed * rate) as usize {
            simulation.step();
            let force: f64 = simulation.string(0).fret_forces().map(|(_, force)| force).sum();
            if force > 0.0 || !forces.is_empty() {
                forces.push(force);
            }
        }
        largest(forces[10..].iter().map(|force| (force / expected - 1.0).abs()))
    };
    for rate in [48e3, 96e3] {
        for part in [0.25, 0.5, 0.7] {
            let [exact, kinked] = ["exact", "kinked"].map(|placement| off(rate, placement, part));
            println!(
                "{rate} Hz, {part} of a spacing: off by {:.1} %, kinked {:.1} %",
                100.0 * exact,
                100.0 * kinked
            );
            // What is left is what the grid itself rings with, waves of two spacings.
            assert!(kinked < 0.04 && exact > 0.08);
        }
    }
}
