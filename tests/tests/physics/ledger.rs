//! Promise: the energy ledger closes. In every sample to 1e-14 of the largest energy so far and over ten
//! seconds at 88.2 kHz to 1e-12 in sum, whatever touches what, at every cap of the solver; and without
//! loss or force the total energy stays the same to 1e-11. Each term of what is lost and put in has a number of
//! its own, and they add up to both.

use std::panic::resume_unwind;
use std::thread;

use low_action_dsp::drive::Push;
use low_action_dsp::simulation::SceneString;
use low_action_dsp::{
    Barrier, Drive, Energies, Entry, Inputs, Ledger, Losses, Model, Scene, Scratch, Simulation, State,
    StringParameters,
};
use low_action_tests::numbers::largest;

const STRING: &str = r#"
sample_rate = 88200
duration = 10.0
[[string]]
length = 0.65
linear_density = 5.25e-3
tension = 60.0
youngs_modulus = 2e11
core_radius = 4.3e-4
tension_modulation = true
"#;

const LOSSES: &str = "loss_0 = 1.38\nloss_1 = 1.25e-4\n";
const BOARD: &str = "[fretboard]\nstiffness = 1e13\nexponent = 2.3\nboard = -0.0015\n";
const FRETS: &str = "[fretboard]\nstiffness = 1e15\nexponent = 2.3\nfrets = 12\nfret_top = -0.0012\n";
const ALL: &str =
    "[fretboard]\nstiffness = 1e15\nexponent = 2.3\nboard = -0.0022\nfrets = 12\nfret_top = -0.0012\n";
/// Of frets that a thin string bends round, softer than steel, so that they are pressed in as far as their knees and farther.
const KINKED: &str = "[fretboard]\nstiffness = 4e11\nexponent = 2.3\nboard = -0.0022\n\
    board_reference_spacing = 0.005\nfrets = 12\nfret_top = -0.0012\nfret_placement = \"kinked\"\n";
const PLUCK: &str = "[[pluck]]\nduration = 0.002\nposition = 0.52\nforce = -3.0\n";
const TAP: &str = "[[finger]]\nmass = 5e-3\nstiffness = 1e10\nexponent = 2.3\nposition = 0.638\n\
                   height = 0.001\nvelocity = -3.0\n";
const PRESS: &str = "[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 1.5\nposition = 0.2\n\
                     height = 1e-4\nforce = 6.0\nhand_damping = 5.0\ndamping = 1.0\n";
const SLIDE: &str = "[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\n\
                     position = [[0.0, 0.2], [1.0, 0.2], [6.0, 0.31], [9.0, 0.15]]\n\
                     height = 1e-4\nforce = 6.0\nhand_damping = 5.0\ndamping = 1.0\n";

const BODY: &str = "[body]\nfrequency = 170.0\nmass = 0.1\narea = 0.05\nquality = 20.0\nspacing = 50.0\nvolume = 0.0145\n\
                    hole = 0.0055\n";

/// A fretboard that loses energy; steel has 0.3 s/m.
fn lossy(fretboard: &str, damping: f64) -> String {
    format!("{fretboard}damping = {damping:?}\n")
}

/// Runs a scene to its end at three caps and checks the ledger of its string.
fn closes(scene: &str, stencil: &str) -> Vec<Ledger> {
    let close = |cap: usize| -> Ledger {
        let text = format!("{scene}[solver]\nmax_iterations = {cap}\nstencil = \"{stencil}\"\n");
        let scene = Scene::from_toml(&text).expect("the scene is valid");
        let mut simulation = Simulation::new(&scene).expect("the scene can be built");
        simulation.open_ledger();
        let mut touched = 0;
        for _ in 0..simulation.samples() {
            simulation.step();
            touched += u64::from(simulation.string(0).convergence.active > 0);
        }
        let can_touch = scene.fretboard.is_some() || !scene.finger.is_empty();
        assert_eq!(touched > 0, can_touch, "{touched} samples have contacts");
        let ledger = simulation.ledgers()[0].clone();
        let sum = ledger.residual_sum.abs() / ledger.largest;
        println!("cap {cap:2}: worst {:.2e}, sum {sum:.2e}", ledger.worst_residual);
        assert!(ledger.largest > 1e-4, "nothing happened");
        assert!(ledger.worst_residual <= 1e-14, "cap {cap}: {:e} in a sample", ledger.worst_residual);
        assert!(sum <= 1e-12, "cap {cap}: {sum:e} in sum");
        ledger
    };
    thread::scope(|threads| {
        let runs = [0, 3, 50].map(|cap| threads.spawn(move || close(cap)));
        runs.into_iter().map(|run| run.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    })
}

#[test]
fn string_alone_with_losses() {
    closes(&format!("{STRING}{LOSSES}{PLUCK}"), "wide");
}

#[test]
fn board_alone_without_losses() {
    closes(&format!("{STRING}{PLUCK}{BOARD}"), "paper");
}

#[test]
fn frets_alone_with_losses() {
    closes(&format!("{STRING}{LOSSES}{PLUCK}{FRETS}"), "corrected");
}

#[test]
fn finger_alone_with_losses() {
    closes(&format!("{STRING}{LOSSES}{TAP}"), "wide");
}

#[test]
fn all_contacts_with_losses() {
    closes(&format!("{STRING}{LOSSES}{PLUCK}{PRESS}{ALL}"), "paper");
}

#[test]
fn a_sliding_finger_over_frets() {
    closes(&format!("{STRING}{LOSSES}{PLUCK}{SLIDE}{ALL}"), "wide");
}

#[test]
fn lossy_frets_alone_without_other_losses() {
    closes(&format!("{STRING}{PLUCK}{}", lossy(FRETS, 0.3)), "corrected");
}

#[test]
fn a_sliding_finger_over_a_lossy_fretboard() {
    closes(&format!("{STRING}{LOSSES}{PLUCK}{SLIDE}{}", lossy(ALL, 0.3)), "wide");
}

/// Of what is kinked there is enough, and both parts of its law are asked.
#[test]
fn a_sliding_finger_over_kinked_frets() {
    let thin = STRING.replace("core_radius = 4.3e-4", "core_radius = 6e-5");
    let scene = format!("{thin}{LOSSES}{PLUCK}{SLIDE}{}", lossy(KINKED, 0.3));
    let mut simulation = Simulation::new(&Scene::from_toml(&scene).expect("the scene is valid"))
        .expect("the scene can be built");
    let mut touched = [0; 2];
    for _ in 0..88_200 {
        simulation.step();
        let SceneString { model, state, .. } = simulation.string(0);
        for contact in model.contacts.iter().filter(|contact| contact.radiation > 0.0) {
            let inside = contact.height - state.displacement_at(&contact.reading);
            touched[0] += u32::from(inside > 0.0 && inside < contact.law.knee());
            touched[1] += u32::from(inside > contact.law.knee());
        }
    }
    println!("touched {touched:?} times before the knee and beyond it");
    assert!(touched.iter().all(|&times| times > 1000), "{touched:?}");
    closes(&scene, "wide");
}

#[test]
fn moving_tension_with_all_contacts() {
    let bent = STRING.replace(
        "tension = 60.0",
        "tension = [[0.0, 60.0], [1.0, 60.0], [1.5, 84.0], [5.0, 50.0], [9.0, 60.0]]",
    );
    closes(&format!("{bent}{LOSSES}{PLUCK}{SLIDE}{ALL}"), "wide");
}

/// A ledger that is opened while a bent string rings goes on from there: its first step is as closed as those of one that has
/// been open all the time, with the same numbers.
#[test]
fn a_ledger_may_be_opened_at_any_time() {
    let bent = STRING.replace("tension = 60.0", "tension = [[0.0, 60.0], [0.5, 84.0], [9.0, 60.0]]");
    let scene = Scene::from_toml(&format!("{bent}{LOSSES}{PLUCK}{PRESS}{ALL}")).expect("the scene is valid");
    let begin = || Simulation::new(&scene).expect("the scene can be built");
    let (mut always, mut later) = (begin(), begin());
    always.open_ledger();
    for _ in 0..10_000 {
        always.step();
        later.step();
    }
    later.open_ledger();
    for n in 0..1000 {
        let (entry, of_later) = (always.step().expect("it is open"), later.step().expect("it is open"));
        assert_eq!(entry, of_later, "step {n}");
    }
    let ledger = &later.ledgers()[0];
    assert!(ledger.largest > 1e-4 && ledger.worst_residual <= 1e-14, "{:e}", ledger.worst_residual);
}

/// Largest departure of the total energy from its value after the last force has acted, which is after so many seconds,
/// as a part of it.
fn energy_change(scene: &str, stencil: &str, forced_for: f64) -> f64 {
    let text = format!("{scene}[solver]\nstencil = \"{stencil}\"\n");
    let scene = Scene::from_toml(&text).expect("the scene is valid");
    let mut simulation = Simulation::new(&scene).expect("the scene can be built");
    simulation.open_ledger();
    let forced = (forced_for * scene.sample_rate) as u64;
    let mut start = 0.0;
    let mut change = 0.0f64;
    for n in 0..simulation.samples() {
        let total = simulation.step().expect("the ledger is open").energies.total();
        if n == forced {
            start = total;
        } else if n > forced {
            change = largest([change, (total - start).abs() / start]);
        }
    }
    println!("{stencil}: energy changed by {change:.2e}");
    change
}

#[test]
fn without_loss_energy_stays() {
    for stencil in ["paper", "corrected", "wide"] {
        assert!(energy_change(&format!("{STRING}{PLUCK}{ALL}"), stencil, 0.003) <= 1e-11, "buzzing string");
    }
    // The finger bounces off, 2.5 ms after the start, and flies away with its share for the rest of the ten seconds. No
    // hand pushes it: all energy there is comes with it.
    for stencil in ["paper", "wide"] {
        assert!(energy_change(&format!("{STRING}{TAP}{ALL}"), stencil, 0.0) <= 1e-11, "tapping finger");
    }
}

#[test]
fn moving_frets_placed_and_removed_fingers() {
    moving_frets(ALL);
}

#[test]
fn moving_lossy_frets_placed_and_removed_fingers() {
    moving_frets(&lossy(ALL, 1.0));
}

/// Moves the fretboard under a string, places fingers, takes them away and brakes it, and checks the ledger.
fn moving_frets(fretboard: &str) {
    let scene = Scene::from_toml(&format!("{STRING}{LOSSES}{PRESS}{fretboard}")).expect("the scene is valid");
    let barrier = Barrier::from_spec(scene.fretboard.as_ref().expect("there is one"), 0.65);
    let string = StringParameters::from_spec(&scene.string[0]);
    for cap in [0, 3, 50] {
        let settings = low_action_dsp::SolverSettings { max_iterations: cap, ..scene.solver };
        let barrier = barrier.as_ref().expect("it is valid");
        let model = Model::new(string, Some(barrier), 2, settings, 88200.0).expect("it can be built");
        let mut state = State::new(&model);
        let mut scratch = Scratch::new(&model);
        let mut drive = Drive::new(&model);
        let mut ledger = Ledger::new(&model, &state, drive.tension);
        let rest: Vec<f64> = model.contacts.iter().map(|contact| contact.height).collect();
        for n in 0..88200u32 {
            let time = f64::from(n) / 88200.0;
            drive.pushes.clear();
            if time < 0.002 {
                let force = -3.0 * time / 0.002;
                drive.pushes.push(Push { reading: model.grid.reading(0.52), force });
            }
            for (slot, place) in [(0, 0.2), (1, 0.5)] {
                drive.hands[slot].position = place;
                drive.hands[slot].force = 4.0;
            }
            if n % 9000 == 100 {
                let touch = scene.finger[0].touch();
                state.place_finger(&model, 0, touch, 0.2, 1e-3, -1.0).expect("it can be placed");
            } else if n % 9000 == 5000 {
                state.remove_finger(0);
            } else if n == 20000 {
                // In the middle of the string's motion, overlapping it.
                let height = state.displacement_at(&model.grid.reading(0.5)) - 1e-4;
                let touch = scene.finger[0].touch();
                state.place_finger(&model, 1, touch, 0.5, height, 0.0).expect("it can be placed");
            } else if n == 60000 {
                state.remove_finger(1);
            }
            // A hand is laid along it, up to one that brings it to rest in a step.
            drive.loss = match n % 7000 {
                3000..3300 => 300.0,
                6000..6010 => 88200.0,
                _ => 0.0,
            };
            drive.heights.clear();
            if n % 20000 > 10000 {
                let lift = 3e-4 * (time * 40.0).sin();
                drive.heights.extend(rest.iter().map(|height| height + lift));
            }
            state.step(&model, &drive, &mut scratch);
            ledger.record(&model, &state, &scratch, &drive);
        }
        let sum = ledger.residual_sum.abs() / ledger.largest;
        println!("cap {cap}: worst {:.2e}, sum {sum:.2e}", ledger.worst_residual);
        assert!(ledger.worst_residual <= 1e-14 && sum <= 1e-12, "cap {cap}");
    }
}

/// Names of what is lost and of what is put in, in the order of [`losses`] and [`inputs`].
const LOST: [&str; 5] = ["loss_0", "loss_1", "contact", "hand", "body"];
const PUT_IN: [&str; 6] = ["pluck", "hand", "slide", "barrier", "tension", "finger"];

// (Taken apart whole, so that no term can be left out of them.)
fn losses(entry: &Entry) -> [f64; 5] {
    let Losses { loss_0, loss_1, contact, hand, body } = entry.losses;
    [loss_0, loss_1, contact, hand, body]
}

fn inputs(entry: &Entry) -> [f64; 6] {
    let Inputs { pluck, bridge, hand, slide, barrier, tension, finger } = entry.inputs;
    // What it puts into strings it takes from them.
    assert_eq!(bridge, 0.0);
    [pluck, hand, slide, barrier, tension, finger]
}

/// Runs a scene to its end under what `act` does to its string besides in each step.
fn entries(scene: &str, mut act: impl FnMut(u64, &mut SceneString)) -> Vec<Entry> {
    let scene = Scene::from_toml(scene).expect("the scene is valid");
    let mut simulation = Simulation::new(&scene).expect("the scene can be built");
    simulation.open_ledger();
    (0..simulation.samples())
        .map(|n| simulation.step_under(|_, string| act(n, string)).expect("the ledger is open"))
        .collect()
}

/// Lifts the fretboard under a string and lets it sink.
fn sway(n: u64, string: &mut SceneString) {
    let lift = 3e-4 * (40.0 * n as f64 / 88200.0).sin();
    let heights = string.model.contacts.iter().map(|contact| contact.height + lift);
    string.drive.heights.extend(heights);
}

/// The names of those terms that are not 0 all the time.
fn at_work<const N: usize>(
    names: [&'static str; N],
    terms: fn(&Entry) -> [f64; N],
    entries: &[Entry],
) -> Vec<&'static str> {
    let works = |term: usize| entries.iter().any(|entry| terms(entry)[term] != 0.0);
    (0..N).filter(|&term| works(term)).map(|term| names[term]).collect()
}

/// Checks that terms add up to their total but for rounding.
fn add_up(terms: &[f64], total: f64) {
    let sum: f64 = terms.iter().sum();
    let size: f64 = terms.iter().map(|term| term.abs()).sum();
    // Some tens of contacts are added up in each, which is off by a few units in the last place.
    assert!((total - sum).abs() <= 16.0 * f64::EPSILON * size, "{terms:?} W are not {total} W");
}

#[test]
fn terms_add_up_to_what_is_lost_and_put_in() {
    let bent = STRING
        .replace("duration = 10.0", "duration = 1.0")
        .replace("tension = 60.0", "tension = [[0.3, 60.0], [0.5, 66.0]]");
    let slide = SLIDE.replace("[1.0, 0.2], [6.0, 0.31], [9.0, 0.15]", "[0.2, 0.2], [0.8, 0.31]");
    let scene = format!("{bent}{LOSSES}{PLUCK}{slide}{BODY}{}", lossy(ALL, 0.3));
    let touch = Scene::from_toml(&scene).expect("the scene is valid").finger[0].touch();
    let entries = entries(&scene, |n, string| {
        sway(n, string);
        match n % 20_000 {
            10_000 => string.state.remove_finger(0),
            15_000 => {
                let place = string.drive.hands[0].position;
                let placed = string.state.place_finger(&string.model, 0, touch, place, 1e-3, -1.0);
                placed.expect("it can be placed");
            }
            _ => {}
        }
    });
    assert_eq!(at_work(LOST, losses, &entries), LOST);
    assert_eq!(at_work(PUT_IN, inputs, &entries), PUT_IN);
    for entry in &entries {
        let losses = losses(entry);
        add_up(&losses, entry.power_loss);
        add_up(&inputs(entry), entry.power_in);
        assert!(losses.iter().all(|&loss| loss >= 0.0), "{losses:?} W are lost");
    }
}

/// Runs a scene and checks what of its balance is at work.
fn books(scene: &str, act: impl FnMut(u64, &mut SceneString), lost: &[&str], put_in: &[&str]) {
    let entries = entries(scene, act);
    assert_eq!(at_work(LOST, losses, &entries), lost, "lost in {scene}");
    assert_eq!(at_work(PUT_IN, inputs, &entries), put_in, "put in by {scene}");
}

#[test]
fn each_term_is_booked_by_its_name() {
    let string = STRING.replace("duration = 10.0", "duration = 0.1");
    let alone = |_: u64, _: &mut SceneString| {};
    books(&format!("{string}loss_0 = 1.38\n{PLUCK}"), alone, &["loss_0"], &["pluck"]);
    books(&format!("{string}loss_1 = 1.25e-4\n{PLUCK}"), alone, &["loss_1"], &["pluck"]);
    books(&format!("{string}{PLUCK}{}", lossy(FRETS, 0.3)), alone, &["contact"], &["pluck"]);
    let hand_alone = PRESS.replace("\ndamping = 1.0", "");
    books(&format!("{string}{hand_alone}"), alone, &["hand"], &["hand"]);
    let pad_alone = PRESS.replace("hand_damping = 5.0\n", "");
    books(&format!("{string}{pad_alone}"), alone, &["contact"], &["hand"]);
    let slide = TAP.replace("position = 0.638", "position = [[0.0, 0.6], [0.1, 0.5]]");
    books(&format!("{string}{slide}"), alone, &[], &["slide"]);
    books(&format!("{string}{PLUCK}{ALL}"), sway, &[], &["pluck", "barrier"]);
    let bent = string.replace("tension = 60.0", "tension = [[0.0, 60.0], [0.1, 66.0]]");
    books(&format!("{bent}{PLUCK}"), alone, &[], &["pluck", "tension"]);
    let taken_away = |n: u64, string: &mut SceneString| {
        if n == 200 {
            string.state.remove_finger(0);
        }
    };
    books(&format!("{string}{TAP}"), taken_away, &[], &["finger"]);
    let braked = |n: u64, string: &mut SceneString| {
        string.drive.loss = if n > 4000 { 300.0 } else { 0.0 };
    };
    books(&format!("{string}{PLUCK}"), braked, &["hand"], &["pluck"]);
    books(&format!("{string}{PLUCK}{BODY}"), alone, &["body"], &["pluck"]);
}

/// What is taken out again is counted off what was put in, and not off what has gone through the balance.
#[test]
fn what_is_taken_out_again_was_put_in() {
    let bent = STRING.replace("duration = 10.0", "duration = 0.3").replace(
        "tension = 60.0",
        "tension = [[0.1, 60.0], [0.15, 66.0], [0.2, 60.0], [0.25, 66.0], [0.3, 60.0]]",
    );
    let scene = Scene::from_toml(&format!("{bent}{PLUCK}")).expect("the scene is valid");
    let mut simulation = Simulation::new(&scene).expect("the scene can be built");
    simulation.open_ledger();
    let (mut net, mut gross) = (0.0, 0.0);
    for _ in 0..simulation.samples() {
        let put_in = simulation.step().expect("the ledger is open").power_in / simulation.sample_rate();
        net += put_in;
        gross += put_in.max(0.0);
    }
    let ledger = &simulation.ledgers()[0];
    for (booked, sum) in [(ledger.put_in, net), (ledger.put_in_gross, gross)] {
        assert!((booked - sum).abs() <= 1e-12 * sum, "{booked} J of {sum} J");
    }
    assert!(gross > 1.05 * net, "{gross} J went in, {net} J of it to stay");
}

/// What is not there holds 0 J, and not the negative zero that a sum of nothing is.
#[test]
fn nothing_holds_no_energy() {
    let mut simulation =
        Simulation::new(&Scene::from_toml(STRING).expect("it is valid")).expect("it can be built");
    simulation.open_ledger();
    let energies = simulation.step().expect("the ledger is open").energies;
    let Energies { string, tension, contact, finger, body } = energies;
    for energy in [string, tension, contact, finger, body] {
        assert!(energy == 0.0 && energy.is_sign_positive(), "{energies:?}");
    }
}
