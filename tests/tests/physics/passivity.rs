//! Promise: nothing makes it blow up. For stiff and soft contacts, coarse and fine grids, and at every cap
//! of the solver, even none, the energy never exceeds what was put in so far by more than 1e-10 of its
//! maximum, and everything stays finite.

use low_action_dsp::{Scene, Simulation};
use low_action_tests::numbers::largest;

const STIFFNESSES: [f64; 4] = [1e10, 1e13, 1e15, 1e20];
const CAPS: [usize; 6] = [0, 1, 2, 4, 8, 50];
const RATES: [f64; 4] = [22_050.0, 44_100.0, 96_000.0, 192_000.0];

/// What a run came to: the largest excess over what was put in, what the solver took away at most, and how many samples
/// had contacts.
struct Outcome {
    excess: f64,
    solver_loss: f64,
    touched: u64,
}

fn run(text: &str) -> Outcome {
    let scene = Scene::from_toml(text).expect("the scene is valid");
    let mut simulation = Simulation::new(&scene).expect("the scene can be built");
    simulation.open_ledger();
    let mut excess = 0.0f64;
    let (mut solver_loss, mut touched) = (0.0, 0);
    let step = 1.0 / scene.sample_rate;
    for _ in 0..simulation.samples() {
        let entry = simulation.step().expect("the ledger is open");
        let total = entry.energies.total();
        assert!(total.is_finite(), "not finite in {text}");
        let ledger = &simulation.ledgers()[0];
        excess = largest([excess, (total - ledger.put_in) / largest([ledger.largest, f64::MIN_POSITIVE])]);
        solver_loss += step * entry.power_solver;
        touched += u64::from(simulation.string(0).convergence.active > 0);
    }
    let state = &simulation.string(0).state;
    assert!(state.displacement().all(f64::is_finite), "not finite in {text}");
    Outcome { excess, solver_loss: solver_loss / simulation.ledgers()[0].largest, touched }
}

/// Runs a scene at every stiffness, cap and rate. `{K}` in it stands for the stiffness.
fn passive_everywhere(scene: &str, duration: f64) {
    for rate in RATES {
        for cap in CAPS {
            let mut worst = 0.0f64;
            let mut lost = 0.0f64;
            for stiffness in STIFFNESSES {
                let text = format!(
                    "sample_rate = {rate}\nduration = {duration}\n[solver]\nmax_iterations = {cap}\n{}",
                    scene.replace("{K}", &format!("{stiffness:e}"))
                );
                let outcome = run(&text);
                worst = largest([worst, outcome.excess]);
                lost = largest([lost, outcome.solver_loss]);
                assert!(
                    outcome.excess <= 1e-10,
                    "K {stiffness:e}, cap {cap}, {rate} Hz: {:e} over what was put in",
                    outcome.excess
                );
                // What is promised is about contacts.
                assert!(outcome.touched > 10, "K {stiffness:e}, cap {cap}, {rate} Hz: nothing touches");
            }
            println!(
                "{rate:6} Hz, cap {cap:2}: excess at most {worst:.1e}, solver took {:.1} %",
                100.0 * lost
            );
        }
    }
}

const STRING: &str = "[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60.0\n\
    youngs_modulus = 2e11\ncore_radius = 4.3e-4\ntension_modulation = true\n";

/// A hard pluck and a fast finger on low frets of some damping, s/m.
fn low_frets(damping: f64) -> String {
    format!(
        "{STRING}[fretboard]\nstiffness = {{K}}\nexponent = 2.3\ndamping = {damping:e}\nboard = -0.0012\n\
         frets = 12\nfret_top = -0.0004\n[[pluck]]\nduration = 0.001\nposition = 0.52\nforce = -20.0\n\
         [[finger]]\nmass = 5e-3\nstiffness = 1e10\nexponent = 2.3\nposition = 0.25\nheight = 0.001\n\
         velocity = -3.0\n"
    )
}

#[test]
fn hard_pluck_and_fast_finger_on_low_frets() {
    passive_everywhere(&low_frets(0.0), 0.1);
}

#[test]
fn hard_pluck_and_fast_finger_on_low_lossy_frets() {
    passive_everywhere(&low_frets(0.3), 0.1);
}

#[test]
fn hard_pluck_and_fast_finger_on_frets_that_lose_all() {
    passive_everywhere(&low_frets(1e5), 0.1);
}

#[test]
fn a_fret_between_active_board_nodes_and_coincident_frets() {
    // Frets at the board's own height, some a hair apart, pressed by a finger that lands on one of them.
    let scene = format!(
        "{STRING}[fretboard]\nstiffness = {{K}}\nexponent = 2.3\nboard = -0.0002\n\
         frets = [0.1, 0.2, 0.2, 0.2000001, 0.2001, 0.2003, 0.2005, 0.21, 0.3, 0.4]\nfret_top = -0.0002\n\
         [[pluck]]\nduration = 0.001\nposition = 0.52\nforce = -10.0\n\
         [[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 1.5\nposition = 0.2\nheight = 0.0002\n\
         velocity = -3.0\nforce = 10.0\n"
    );
    passive_everywhere(&scene, 0.05);
}

#[test]
fn a_finger_on_a_fret_and_fingers_on_each_other() {
    let scene = format!(
        "{STRING}[fretboard]\nstiffness = {{K}}\nexponent = 1.5\nfrets = [0.3]\nfret_top = -0.0003\n\
         [[pluck]]\nduration = 0.001\nposition = 0.52\nforce = -10.0\n\
         [[finger]]\nmass = 5e-3\nstiffness = {{K}}\nexponent = 2.3\nposition = 0.3\nheight = 0.0002\n\
         velocity = -3.0\nforce = 10.0\ndamping = 1.0\n\
         [[finger]]\nmass = 1e-3\nstiffness = 1e9\nexponent = 3.0\nposition = 0.3\nheight = 0.0004\n\
         force = 3.0\ndamping = 5.0\nhand_damping = 5.0\n"
    );
    passive_everywhere(&scene, 0.05);
}

/// A string pressed on a flat board of some damping, s/m: tens to hundreds of points in contact at once.
fn flat_board(damping: f64) -> String {
    format!(
        "{STRING}loss_0 = 1.0\nloss_1 = 1e-4\nshape = [[0.0, 0.0], [0.2, -0.001], [0.4, -0.001], [0.65, 0.0]]\n\
         [fretboard]\nstiffness = {{K}}\nexponent = 2.3\ndamping = {damping:e}\n\
         board = [[0.0, -1e-5], [0.65, -1e-5]]\nboard_reference_spacing = 0.005\n"
    )
}

#[test]
fn a_string_pressed_on_a_flat_board() {
    passive_everywhere(&flat_board(0.0), 0.02);
}

#[test]
fn a_string_pressed_on_a_lossy_board() {
    passive_everywhere(&flat_board(0.3), 0.02);
}

#[test]
fn a_string_pressed_on_a_board_that_loses_all() {
    passive_everywhere(&flat_board(1e5), 0.02);
}
