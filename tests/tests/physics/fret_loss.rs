//! Promise: a lossy fretboard takes from a string that strikes it what its law says and books just that, never pulls,
//! and leaves a string that rests pressed on a fret alone; one that says nothing of damping has none.

use std::f64::consts::{PI, TAU};

use low_action_dsp::{Scene, Simulation};
use low_action_tests::stage::amplitude;

const RATE: f64 = 88_200.0;

/// A low string without losses of its own.
const STRING: &str = "[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60.0\n\
    youngs_modulus = 2e11\ncore_radius = 4.3e-4\ntension_modulation = true\n";
/// Its T, N, and ρ, kg/m.
const TENSION: f64 = 60.0;
const DENSITY: f64 = 5.25e-3;

/// Frets as hard as steel and a board between them, struck by a string let go; what follows belongs to them.
const STRUCK: &str = "shape = [[0.0, 0.0], [0.4, 3e-3], [0.65, 0.0]]\n[fretboard]\nstiffness = 1e10\nexponent = 1.5\n\
    board = -0.0022\nboard_reference_spacing = 0.005\nfrets = 12\nfret_top = -0.0012\n";

fn build(text: &str) -> Simulation {
    let scene = Scene::from_toml(text).expect("the scene is valid");
    let mut simulation = Simulation::new(&scene).expect("the scene can be built");
    simulation.open_ledger();
    simulation
}

/// A string let go over a fretboard with `damping` as it stands in a scene.
fn struck(duration: f64, cap: usize, damping: &str) -> Simulation {
    let solver = format!("[solver]\nmax_iterations = {cap}\ntolerance = 1e-15\n");
    build(&format!("sample_rate = {RATE}\nduration = {duration}\n{solver}{STRING}{STRUCK}{damping}"))
}

/// Penetrations of every fixed contact, m.
fn penetrations(simulation: &Simulation) -> Vec<f64> {
    let string = simulation.string(0);
    let (state, contacts) = (&string.state, &string.model.contacts);
    contacts.iter().map(|contact| contact.height - state.displacement_at(&contact.reading)).collect()
}

/// What board and frets take in a sample according to their law, J, from their penetrations before, now and after. While
/// they push that is βφv², and of kinked frets, with φ at most that of the knee, 2√(Tρ)v² more in the first sample, and a fifth of
/// it less in each of the next four: `made` counts samples since contact was made. A spring that gives back less than that lets
/// go, and what it gives back is lost.
fn lost(simulation: &Simulation, made: &mut [i32], [before, now, after]: [&[f64]; 3]) -> f64 {
    let k = 1.0 / simulation.sample_rate();
    let contacts = simulation.string(0).model.contacts.iter().enumerate();
    let each = contacts.map(|(i, contact)| {
        let (law, velocity) = (&contact.law, (after[i] - before[i]) / (2.0 * k));
        made[i] = if now[i] > 0.0 && before[i] <= 0.0 { 0 } else { made[i].saturating_add(1) };
        let resistance = if contact.radiation > 0.0 {
            let left = if now[i] > 0.0 { f64::from((5 - made[i]).max(0)) / 5.0 } else { 0.0 };
            contact.damping * law.force(now[i].min(law.knee())) + 2.0 * (TENSION * DENSITY).sqrt() * left
        } else {
            contact.damping * law.force(now[i])
        };
        let loss = k * resistance * velocity * velocity;
        let given_back = 0.5 * (law.energy(before[i]) - law.energy(after[i]));
        if velocity < 0.0 { loss.min(given_back) } else { loss }
    });
    each.sum()
}

#[test]
fn what_strikes_lose_is_what_the_law_says() {
    for damping in [0.0, 0.03, 0.3, 3.0, 300.0] {
        loses_what_the_law_says(damping, struck(0.5, 100, &format!("damping = {damping:e}\n")));
    }
}

/// A thin string bends round them.
#[test]
fn what_strikes_kinked_frets_loses_what_their_law_says() {
    for damping in [0.0, 0.3, 30.0] {
        let thin = STRING.replace("4.3e-4", "6e-5");
        let simulation = build(&format!(
            "sample_rate = {RATE}\nduration = 0.5\n[solver]\nmax_iterations = 100\ntolerance = 1e-15\n{thin}{STRUCK}\
             damping = {damping:e}\nfret_placement = \"kinked\"\n"
        ));
        let contacts = &simulation.string(0).model.contacts;
        let kinked = contacts.iter().filter(|contact| contact.radiation > 0.0).count();
        assert!(kinked > 5, "only {kinked} are kinked");
        loses_what_the_law_says(damping, simulation);
    }
}

fn loses_what_the_law_says(damping: f64, mut simulation: Simulation) {
    let start = simulation.ledgers()[0].initial;
    let (mut before, mut now) = (penetrations(&simulation), penetrations(&simulation));
    let (mut left, mut booked, mut by_law) = (start, 0.0, 0.0);
    // None is made at the start.
    let mut made = vec![i32::MAX; now.len()];
    for _ in 0..simulation.samples() {
        let entry = simulation.step().expect("the ledger is open");
        let after = penetrations(&simulation);
        assert!(entry.power_loss >= 0.0, "{damping} s/m: {} W lost", entry.power_loss);
        left = entry.energies.total();
        booked += (entry.power_loss + entry.power_solver) / RATE;
        by_law += lost(&simulation, &mut made, [&before, &now, &after]);
        (before, now) = (now, after);
    }
    let gone = start - left;
    println!(
        "{damping} s/m: {:.4} of {start:.2e} J gone, {:.1e} more than booked; booked {:.1e} more than the law says",
        gone / start,
        (gone - booked) / start,
        (booked - by_law) / start
    );
    // As the ledger closes over ten seconds.
    assert!((gone - booked).abs() <= 1e-12 * start);
    // Places of some mm are known to 1e-18 m, penetrations of 1 µm to 1e-12 of themselves, their powers and
    // products to some times that.
    assert!((booked - by_law).abs() <= 1e-11 * start);
    // What is lost is known to 1e-12 of all, and so is nothing.
    let resists = simulation.string(0).model.contacts.iter().any(|contact| contact.radiation > 0.0);
    assert_eq!(gone > 1e-6 * start, damping > 0.0 || resists, "{gone} J of {start} J");
}

/// A wall that is as steep as numbers can tell from the first touch on is the same for every exponent next to 1, and so is what it
/// loses by its damping; from there on it changes with the exponent little by little.
#[test]
fn no_exponent_next_to_one_takes_the_damping_away() {
    let lost = |exponent: f64| {
        let text = format!(
            "sample_rate = {RATE}\nduration = 0.05\n[solver]\nmax_iterations = 100\ntolerance = 1e-15\n{STRING}{}damping = 1.0\n",
            STRUCK.replace("exponent = 1.5", &format!("exponent = {exponent:?}")).replace("1e10", "1e15")
        );
        let mut simulation = build(&text);
        let mut lost = 0.0;
        for _ in 0..simulation.samples() {
            lost += simulation.step().expect("the ledger is open").losses.contact / RATE;
        }
        lost
    };
    let straight = lost(1.0);
    println!("exponent 1: {straight:.3e} J lost");
    assert!(straight > 1e-9);
    for (exponent, apart) in [(1.001, 1e-9), (1.01, 1e-9), (1.05, 1e-6), (1.1, 1e-3)] {
        let lost = lost(exponent);
        println!("exponent {exponent}: {lost:.3e} J lost");
        assert!((lost / straight - 1.0).abs() < apart, "exponent {exponent}: {lost:e} J of {straight:e} J");
    }
}

/// With its equations solved: at the solver's cap a force may be eased below nothing, lossy or not.
#[test]
fn a_lossy_fretboard_never_pulls() {
    for damping in [0.3, 30.0, 1e5] {
        let mut simulation = struck(0.6, 100, &format!("damping = {damping:e}\n"));
        let (mut pushed, mut let_go) = (0, 0);
        for _ in 0..simulation.samples() {
            let inside = penetrations(&simulation);
            simulation.step();
            for (index, force) in simulation.string(0).scratch.forces() {
                assert!(force >= 0.0, "{damping} s/m: {force} N");
                pushed += usize::from(force > 0.0);
                let_go += usize::from(force == 0.0 && inside[index] > 0.0);
            }
        }
        println!("{damping} s/m: pushed {pushed} times, let go {let_go} times with the string still inside");
        assert!(pushed > 100 && let_go > 5, "the law was hardly asked");
    }
}

/// A string pressed on a fret, plucked once all is still: from fret to bridge, m; and the exponent of the fret.
const RINGING: f64 = 0.5;
const EXPONENT: f64 = 1.5;

/// What it did.
struct Pressed {
    /// Decay rate of its first partial, 1/s.
    decay: f64,
    /// Force on the fret and how deep it is in the string before the pluck, N and m.
    force: f64,
    depth: f64,
    /// The least force on the fret thereafter, N.
    least_force: f64,
}

/// First partial, rad/s. Bending changes it by less than 1e-3.
fn first_partial() -> f64 {
    PI / RINGING * (TENSION / DENSITY).sqrt()
}

fn pressed(damping: f64) -> Pressed {
    let rate = 44_100.0;
    let string = STRING.replace("tension_modulation = true", "loss_0 = 5.0");
    let mut simulation = build(&format!(
        "sample_rate = {rate}\nduration = 5.0\n[output]\nposition = 0.55\n\
         [solver]\nmax_iterations = 100\ntolerance = 1e-16\n{string}\
         [fretboard]\nstiffness = 1e10\nexponent = {EXPONENT}\ndamping = {damping:e}\nfrets = [0.15]\nfret_top = -1e-3\n\
         [[finger]]\nmass = 5e-3\nstiffness = 1e7\nexponent = 2.0\nposition = 0.145\nheight = 5e-4\n\
         force = [[0, 0], [0.5, 6]]\ndamping = 1.0\nhand_damping = 5.0\n\
         [[pluck]]\nstart = 3.0\nduration = 0.01\nposition = 0.5\nforce = -0.1\n"
    ));
    let (mut heard, mut force, mut depth, mut least_force) = (Vec::new(), 0.0, 0.0, f64::INFINITY);
    while simulation.steps() < simulation.samples() {
        simulation.step();
        heard.push(simulation.output());
        if simulation.steps() > (2.9 * rate) as u64 {
            let now: f64 = simulation.string(0).fret_forces().map(|(_, force)| force).sum();
            least_force = least_force.min(now);
            if simulation.steps() < (3.0 * rate) as u64 {
                (force, depth) = (now, penetrations(&simulation)[0]);
            }
        }
    }
    // Its size in a fifth of a second from some time on.
    let partial = |from: f64| {
        let part = &heard[(from * rate) as usize..][..(0.2 * rate) as usize];
        amplitude(part, rate, first_partial() / TAU)
    };
    Pressed { decay: (partial(3.1) / partial(4.6)).ln() / 1.5, force, depth, least_force }
}

/// A pressed fret is a spring κ = αF/η beside a damper R = βF. A wave of the played length L turns back on it under the
/// force 2√(Tρ)v, and of its power ½√(Tρ)v² loses ½(2√(Tρ)v)²Rω²/κ² each time, so that its amplitude decays by TRω²/(κ²L)
/// a second more: of steel 1e-6, of which nobody hears anything beside the string's own decay of some tenths.
#[test]
fn a_string_that_rests_on_a_fret_rings_on() {
    let plain = pressed(0.0);
    for damping in [0.3, 30.0] {
        let lossy = pressed(damping);
        let spring = EXPONENT * lossy.force / lossy.depth;
        let expected = TENSION * damping * lossy.force * (first_partial() / spring).powi(2) / RINGING;
        let more = lossy.decay - plain.decay;
        println!(
            "{damping} s/m: {more:.3e} 1/s more than {:.3} 1/s, {expected:.3e} expected; at least {:.2} of {:.2} N",
            plain.decay, lossy.least_force, lossy.force
        );
        assert!(lossy.least_force > 0.5 * lossy.force, "it has left the fret");
        // The finger behind the fret takes part, and bending stiffens the end: a few parts in a hundred.
        assert!((more - expected).abs() < 0.05 * expected);
        assert!(damping > 1.0 || more < 1e-6);
    }
}

#[test]
fn damping_left_out_is_none() {
    let mut left_out = struck(0.2, 50, "");
    let mut none = struck(0.2, 50, "damping = 0.0\n");
    let mut least = struck(0.2, 50, "damping = 1e-9\n");
    for _ in 0..left_out.samples() {
        assert_eq!(left_out.step(), none.step());
        least.step();
        assert!(left_out.string(0).state.displacement().eq(none.string(0).state.displacement()));
    }
    // Where the fretboard has not been struck any damping would do.
    assert!(!left_out.string(0).state.displacement().eq(least.string(0).state.displacement()));
}
