//! Promise: strings of a scene that stand over a body hear one another by it, and the ledger knows of every joule. It closes in
//! every sample to 1e-14 of the largest energy and in sum to 1e-12, whatever touches the strings and however their tension moves,
//! in all and of the body by itself; what is stored only falls once nothing acts; and the sound is the same bits without it.

use low_action_dsp::{Entry, Scene, Simulation};
use low_action_tests::numbers::largest;

const RATE: f64 = 88_200.0;

/// As a guitar has it.
const BODY: &str = "[body]\nfrequency = 170.0\nmass = 0.1\narea = 0.05\nquality = 20.0\nspacing = 50.0\nvolume = 0.0145\n\
                    hole = 0.0055\n";
/// Hardly heavier than three strings over it, and slow to lose what it has.
const LIGHT: &str = "[body]\nfrequency = 300.0\nmass = 0.012\narea = 0.01\nquality = 200.0\nspacing = 30.0\nvolume = 0.002\n\
                     hole = 0.0005\n";
const ALL: &str = "[fretboard]\nstiffness = 1e15\nexponent = 2.3\ndamping = 0.3\nboard = -0.0022\nfrets = 12\nfret_top = -0.0012\n";
const PLUCK: &str = "[[pluck]]\nduration = 0.002\nposition = 0.52\nforce = -3.0\n";
const SLIDE: &str = "[[finger]]\nstring = 2\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\n\
                     position = [[0.0, 0.2], [0.2, 0.2], [0.8, 0.31]]\nheight = 1e-4\nforce = 6.0\nhand_damping = 5.0\n\
                     damping = 1.0\n";

/// A low string at a tension, or a course of it.
fn string(tension: &str) -> String {
    format!(
        "[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = {tension}\nyoungs_modulus = 2e11\ncore_radius = 4.3e-4\n\
         tension_modulation = true\nloss_0 = 1.38\nloss_1 = 1.25e-4\n"
    )
}

/// Three strings, two of which are bent, of everything there is.
fn everything(body: &str) -> String {
    let strings =
        ["60.0", "[[0.1, 60.0], [0.3, 84.0], [0.9, 50.0]]", "[[0.0, 80.0], [1.0, 70.0]]"].map(string);
    format!("{}{body}{ALL}{PLUCK}{SLIDE}", strings.concat())
}

fn begin(scene: &str, solver: &str, seconds: f64) -> Simulation {
    let text = format!("sample_rate = {RATE}\nduration = {seconds}\n[solver]\n{solver}\n{scene}");
    let scene = Scene::from_toml(&text).expect("the scene is valid");
    Simulation::new(&scene).expect("the scene can be built")
}

/// Runs a scene to its end.
fn entries(simulation: &mut Simulation) -> Vec<Entry> {
    simulation.open_ledger();
    (0..simulation.samples()).map(|_| simulation.step().expect("the ledger is open")).collect()
}

#[test]
fn the_balance_of_strings_and_body_closes() {
    let solvers = [
        "max_iterations = 0\nstencil = \"wide\"",
        "max_iterations = 50\nstencil = \"paper\"",
        "stencil = \"corrected\"",
    ];
    for (body, name) in [(BODY, "a guitar's"), (LIGHT, "a light one")] {
        for solver in solvers {
            let mut simulation = begin(&everything(body), solver, 1.0);
            simulation.open_ledger();
            let initial: f64 = simulation.accounts().map(|account| account.initial).sum();
            let entries = entries(&mut simulation);
            let (mut most, mut worst, mut sum, mut before) = (0.0_f64, 0.0, 0.0, initial);
            let (mut contact, mut tension) = (0.0, 0.0);
            for entry in &entries {
                let energy = entry.energies.total();
                most = most.max(energy);
                // What an entry says is left over is what its numbers leave over.
                let lost = entry.power_loss + entry.power_solver - entry.power_in;
                let open = energy - before + lost / RATE;
                worst = largest([worst, entry.residual.abs() / most, open.abs() / most]);
                sum += entry.residual;
                before = energy;
                // What strings get from the bridge it gets from them.
                assert_eq!(entry.inputs.bridge, 0.0);
                contact = largest([contact, entry.energies.contact]);
                tension = largest([tension, entry.inputs.tension.abs()]);
            }
            println!("{name}, {solver:?}: worst {worst:.2e}, sum {:.2e}", sum.abs() / most);
            assert!(worst <= 1e-14, "{name}, {solver}: {worst:e} in a sample");
            assert!(sum.abs() <= 1e-12 * most, "{name}, {solver}: {sum:e} of {most} J in sum");
            for (index, account) in simulation.accounts().enumerate() {
                let open = account.residual_sum.abs() / account.largest;
                println!("account {index}: worst {:.2e}, sum {open:.2e}", account.worst_residual);
                assert!(
                    account.worst_residual <= 1e-14 && open <= 1e-12,
                    "{name}, {solver}: account {index}"
                );
            }
            let lost = entries.iter().map(|entry| entry.losses.body).sum::<f64>() / RATE;
            assert!(most > 1e-4 && contact > 1e-6 && tension > 1e-3 && lost > 1e-6, "nothing happened");
        }
    }
}

/// Of what a body loses nothing is below 0, and once the pluck has let go nothing grows: by more than what is rounded in a sample.
#[test]
fn what_is_stored_only_falls() {
    for body in [BODY, LIGHT] {
        let scene = format!("{}{}{body}{PLUCK}", string("60.0"), string("90.0"));
        let entries = entries(&mut begin(&scene, "", 1.0));
        let start = (0.003 * RATE) as usize;
        let first = entries[start].energies.total();
        for pair in entries[start..].windows(2) {
            let [before, after] = [0, 1].map(|index| pair[index].energies.total());
            assert!(after <= before + 1e-14 * first, "from {before} to {after} J");
        }
        assert!(entries.iter().all(|entry| entry.losses.body >= 0.0), "a body gives what it has not got");
        let last = entries[entries.len() - 1].energies.total();
        assert!(last < 0.9 * first, "{last} of {first} J are left");
    }
}

/// A string that nobody touches sings along where it is in unison with one that is plucked, until it has as much as that, and
/// hardly where it is a tritone off; without a body it does not at all.
#[test]
fn strings_in_tune_sing_along() {
    let strings = ["110.0", "110.0", "220.0"].map(|tension| {
        format!("[[string]]\nlength = 0.65\nlinear_density = 3.5e-3\ntension = {tension}\nloss_0 = 0.5\n")
    });
    let held = |body: &str| {
        let mut simulation = begin(&format!("{}{body}{PLUCK}", strings.concat()), "stencil = \"wide\"", 2.0);
        entries(&mut simulation);
        let plucked = simulation.ledgers()[0].energies().total();
        [1, 2].map(|index: usize| simulation.ledgers()[index].energies().total() / plucked)
    };
    let [unison, tritone] = held(BODY);
    println!("in unison {unison:.2e} of what is plucked, a tritone off {tritone:.2e}");
    assert!(unison > 0.1 && tritone < 0.01 * unison, "{unison} and {tritone}");
    assert_eq!(held(""), [0.0; 2]);
}

/// Grids bear 2 % more than a course of the tension reaches, which is what a body may take; without one they bear just that.
#[test]
fn grids_leave_room_for_a_body() {
    for (body, room) in [(BODY, 1.02), ("", 1.0)] {
        let simulation = begin(&everything(body), "", 0.1);
        for (string, highest) in simulation.strings().iter().zip([60.0, 84.0, 80.0]) {
            let (most, limit) = (string.most_tension(), string.model.string.tension_limit);
            assert!((most / highest - 1.0).abs() < 1e-15, "{most} and not {highest} N");
            assert!((limit / highest - room).abs() < 1e-15, "{limit} N for {highest} N");
        }
    }
}

#[test]
fn the_sound_is_the_same_without_a_ledger() {
    for position in ["\"air\"", "\"bridge\"", "0.3"] {
        let scene = format!("{}[output]\nposition = {position}\n", everything(BODY));
        let [mut measured, mut alone] = [0, 1].map(|_| begin(&scene, "", 0.2));
        measured.open_ledger();
        let mut loudest = 0.0;
        for n in 0..measured.samples() {
            assert!(measured.step().is_some() && alone.step().is_none());
            assert_eq!(measured.output().to_bits(), alone.output().to_bits(), "{position}, sample {n}");
            loudest = largest([loudest, alone.output().abs()]);
        }
        for (measured, alone) in measured.strings().iter().zip(alone.strings()) {
            assert!(measured.state.displacement().eq(alone.state.displacement()), "{position}");
        }
        assert!(loudest > 1e-3, "{position}: nothing is heard");
    }
}
