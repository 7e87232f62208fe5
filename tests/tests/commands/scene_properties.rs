//! Promise: whatever stands in a scene file, it is either refused in one line or computed, in bounded
//! time and memory and without a panic; and whatever is accepted stays finite and closes its energy balance.

use std::cell::Cell;
use std::f64::consts::PI;

use low_action_dsp::{Account, Scene, Simulation};
use low_action_tests::cases::cases;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

/// Samples computed of each accepted scene.
const SAMPLES: u64 = 48;
/// How far the balance may be open, as a part of the largest energy, beside what rounding alone may do: what the
/// `scene` command accepts.
const BALANCE: f64 = 1e-9;
/// Grid points above which an accepted scene is not computed here, to keep the test short.
const POINTS: usize = 20_000;

fn examples() -> Vec<String> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.is_file());
    paths.sort();
    paths.iter().map(|path| std::fs::read_to_string(path).unwrap()).collect()
}

/// Builds a scene and computes its beginning. Returns what the refusal says, if it is refused.
fn try_scene(text: &str) -> Result<(), String> {
    let mut scene = Scene::from_toml(text).map_err(|error| error.to_string())?;
    // A refusal may depend on the length asked for; what is computed must be short.
    Simulation::new(&scene).map_err(|error| error.to_string())?;
    scene.duration = scene.duration.min(SAMPLES as f64 / scene.sample_rate);
    let mut simulation = Simulation::new(&scene).map_err(|error| error.to_string())?;
    let points: usize = simulation.strings().iter().map(|string| string.model.grid.intervals).sum();
    if points <= POINTS {
        compute(&mut simulation);
    }
    Ok(())
}

/// Runs a simulation to its end and holds it to its promises. Returns whether anything touched a string.
fn compute(simulation: &mut Simulation) -> bool {
    let mut touched = false;
    simulation.open_ledger();
    while simulation.steps() < simulation.samples() {
        let entry = simulation.step().unwrap();
        assert!(entry.energies.total().is_finite(), "energy at {}", simulation.steps());
        assert!(simulation.output().is_finite(), "output at {}", simulation.steps());
        touched |= simulation.strings().iter().any(|string| string.convergence.active > 0);
    }
    for ledger in simulation.accounts() {
        let open = ledger.residual_sum.abs();
        assert!(
            open <= BALANCE * ledger.largest + ledger.rounding,
            "the balance is open by {open:e} of {:e} J",
            ledger.largest
        );
    }
    touched
}

/// That a scene is computed, or refused in one printable line.
fn computed_or_refused(text: &str) {
    if let Err(message) = try_scene(text) {
        assert!(!message.is_empty() && message.chars().count() < 600, "{message}");
        assert!(!message.contains(char::is_control), "{message:?}");
    }
}

/// Values that a slip of the pen or malice puts in the place of a number.
const VALUES: [&str; 22] = [
    "0",
    "-1",
    "1",
    "1e-320",
    "-0.0",
    "1e18",
    "1e300",
    "-1e300",
    "1e400",
    "nan",
    "-inf",
    "inf",
    "9223372036854775807",
    "99999999999999999999",
    "true",
    "\"\"",
    "[]",
    "[[]]",
    "[[0, 1]]",
    "{}",
    "1979-05-27",
    "0.3",
];

/// A change to a text.
#[derive(Debug, Clone)]
enum Change {
    Delete(usize, usize),
    Insert(usize, String),
    RepeatLine(usize),
    DropLine(usize),
    SwapLines(usize, usize),
    Value(usize, usize),
    Scale(usize, f64),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        1 => (any::<usize>(), 1..30_usize).prop_map(|(at, length)| Change::Delete(at, length)),
        1 => (any::<usize>(), ".{1,4}").prop_map(|(at, text)| Change::Insert(at, text)),
        1 => any::<usize>().prop_map(Change::RepeatLine),
        1 => any::<usize>().prop_map(Change::DropLine),
        1 => (any::<usize>(), any::<usize>()).prop_map(|(one, other)| Change::SwapLines(one, other)),
        3 => (any::<usize>(), 0..VALUES.len()).prop_map(|(line, value)| Change::Value(line, value)),
        3 => (any::<usize>(), -6.0..6.0).prop_map(|(line, power)| Change::Scale(line, power)),
    ]
}

fn apply(text: &str, change: &Change) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return String::new();
    }
    let keys: Vec<usize> = (0..lines.len()).filter(|&line| lines[line].contains(" = ")).collect();
    let key = |at: &usize| keys.get(at % keys.len().max(1)).copied();
    match change {
        Change::Delete(at, length) => {
            let kept: Vec<char> = text.chars().collect();
            let at = at % kept.len().max(1);
            return kept[..at].iter().chain(kept.iter().skip(at + length)).collect();
        }
        Change::Insert(at, more) => {
            let all: Vec<char> = text.chars().collect();
            let (before, after) = all.split_at(at % (all.len() + 1));
            return before.iter().copied().chain(more.chars()).chain(after.iter().copied()).collect();
        }
        Change::RepeatLine(at) => {
            let at = at % lines.len();
            lines.insert(at, lines[at].clone());
        }
        Change::DropLine(at) => {
            lines.remove(at % lines.len());
        }
        Change::SwapLines(one, other) => {
            let count = lines.len();
            lines.swap(one % count, other % count);
        }
        Change::Value(at, value) => {
            if let Some(line) = key(at) {
                let name = lines[line].split(" = ").next().unwrap().to_owned();
                lines[line] = format!("{name} = {}", VALUES[*value]);
            }
        }
        Change::Scale(at, power) => {
            if let Some(line) = key(at) {
                let (name, rest) = lines[line].split_once(" = ").unwrap();
                let number = rest.split_whitespace().next().and_then(|word| word.parse::<f64>().ok());
                lines[line] = format!("{name} = {:e}", number.unwrap_or(1.0) * 10_f64.powf(*power));
            }
        }
    }
    lines.join("\n") + "\n"
}

/// A number anywhere between two others, spread evenly over its powers of ten.
fn over(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

/// As [`over`], or 0.
fn over_or_nothing(low: f64, high: f64) -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), over(low, high)]
}

fn string() -> impl Strategy<Value = String> {
    let bending = (over_or_nothing(1e8, 1e12), over(1e-4, 1e-3), any::<bool>());
    (over(0.05, 2.0), over(1e-4, 1e-1), over(1.0, 1e3), bending, over_or_nothing(1e-2, 1e3), over_or_nothing(1e-6, 1e-2))
        .prop_map(|(length, density, tension, (modulus, radius, modulation), loss_0, loss_1)| {
            // The same losses by the decay that they make of waves as long as twice the string, and as a tenth of that.
            let losses = if loss_0 > 0.0 && loss_1 > 0.0 {
                let bending = modulus * PI * radius.powi(4) / 4.0;
                let t60 = [1.0, 10.0].map(|number| number * PI / length).map(|number| {
                    let square = number * number;
                    let angular = (square * (tension + bending * square) / density).sqrt();
                    [angular / (2.0 * PI), 1000_f64.ln() / (loss_0 + loss_1 * square)]
                });
                format!("t60 = {t60:?}")
            } else {
                format!("loss_0 = {loss_0}\nloss_1 = {loss_1}")
            };
            format!(
                "[[string]]\nlength = {length}\nlinear_density = {density}\ntension = [[0, {tension}], [0.002, {}]]\n\
                 youngs_modulus = {modulus:e}\ncore_radius = {radius}\ntension_modulation = {modulation}\n\
                 {losses}\nshape = [[0, 0], [{}, {}], [{length}, 0]]\n",
                tension * 1.2,
                length / 3.0,
                length / 300.0,
            )
        })
}

fn fretboard() -> impl Strategy<Value = String> {
    let heights = (over(1e-5, 1e-2), over(1e-5, 1e-2), 0..20_usize);
    let placement = proptest::sample::select(vec!["exact", "nearest", "kinked"]);
    let law = (over(1e3, 1e15), 1.0..5.0, proptest::option::of(over_or_nothing(1e-2, 1e5)));
    (law, heights, placement, proptest::option::of(over(1e-4, 0.1))).prop_map(
        |((stiffness, exponent, damping), (board, top, frets), placement, spacing)| {
            let damping = damping.map_or(String::new(), |damping| format!("damping = {damping:e}\n"));
            let spacing =
                spacing.map_or(String::new(), |spacing| format!("board_reference_spacing = {spacing}\n"));
            let (nut, bridge) = (-board, -board / 2.0);
            let board = match frets % 2 {
                0 => format!("[[0, {nut}], [0.5, {bridge}]]"),
                _ => format!("{{ nut = {nut}, middle = {}, bridge = {bridge} }}", nut + bridge / 2.0),
            };
            format!(
                "[fretboard]\nstiffness = {stiffness:e}\nexponent = {exponent}\nboard = {board}\n\
                 frets = {frets}\nfret_top = {}\nfret_placement = \"{placement}\"\n{spacing}{damping}",
                -top
            )
        },
    )
}

fn finger() -> impl Strategy<Value = String> {
    let touch =
        (over(1e-5, 1.0), over(1e3, 1e12), 1.0..5.0, over_or_nothing(1e-2, 1e3), over_or_nothing(1e-2, 1e3));
    (touch, 0.001..0.049, 0.001..0.049, over(1e-5, 1e-2), -20.0..1.0, -1.0..50.0).prop_map(
        |((mass, stiffness, exponent, damping, hand), from, to, height, velocity, force)| {
            format!(
                "[[finger]]\nmass = {mass}\nstiffness = {stiffness:e}\nexponent = {exponent}\ndamping = {damping}\n\
                 hand_damping = {hand}\nposition = [[0, {from}], [0.005, {to}]]\nheight = {height}\n\
                 velocity = {velocity}\nforce = [[0, 0], [0.001, {force}]]\n"
            )
        },
    )
}

fn pluck() -> impl Strategy<Value = String> {
    (over(1e-5, 1e-2), 0.001..0.049, -50.0..50.0).prop_map(|(duration, position, force)| {
        format!("[[pluck]]\nduration = {duration}\nposition = {position}\nforce = {force}\n")
    })
}

/// A scene of values that all are in range, though few would be met on an instrument.
fn scene() -> impl Strategy<Value = String> {
    let solver =
        (0..60_usize, over(1e-18, 1e-6), prop_oneof![Just("paper"), Just("corrected"), Just("wide")]);
    (
        over(8e3, 2e5),
        solver,
        proptest::collection::vec(string(), 1..3),
        proptest::option::of(fretboard()),
        proptest::collection::vec(finger(), 0..3),
        proptest::collection::vec(pluck(), 0..3),
    )
        .prop_map(|(rate, (cap, tolerance, stencil), strings, board, fingers, plucks)| {
            let solver = format!(
                "[solver]\nmax_iterations = {cap}\ntolerance = {tolerance:e}\nstencil = \"{stencil}\"\n"
            );
            let head = format!("sample_rate = {rate}\nduration = {}\n", 600.0 / rate);
            let things = [strings.concat(), board.unwrap_or_default(), fingers.concat(), plucks.concat()];
            head + &solver + &things.concat()
        })
}

#[test]
fn the_examples_are_accepted() {
    for text in examples() {
        assert_eq!(try_scene(&text), Ok(()));
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn random_bytes_are_refused_in_one_line(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        computed_or_refused(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn random_text_is_refused_in_one_line(text in "[\\[\\]{}=\"'#.,0-9a-z_ \n-]{0,200}") {
        computed_or_refused(&text);
    }

    #[test]
    fn changed_examples_are_computed_or_refused(
        which in any::<prop::sample::Index>(),
        changes in proptest::collection::vec(change(), 1..5),
    ) {
        let text = which.get(&examples()).clone();
        computed_or_refused(&changes.iter().fold(text, |text, change| apply(&text, change)));
    }
}

#[test]
fn accepted_scenes_stay_finite_and_balanced() {
    let (accepted, touched, coarse) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let tried = TestRunner::new(cases(100)).run(&scene(), |text| {
        match Scene::from_toml(&text).and_then(|scene| Simulation::new(&scene)) {
            Ok(mut simulation) => {
                touched.set(touched.get() + u32::from(compute(&mut simulation)));
                accepted.set(accepted.get() + 1);
                let rounds = |ledger: &Account| ledger.rounding > BALANCE * ledger.largest;
                coarse.set(coarse.get() + u32::from(simulation.accounts().any(rounds)));
            }
            // What does not fit its grid is refused only now.
            Err(error) => {
                println!("{error}");
                prop_assert!(!error.to_string().contains('\n'));
            }
        }
        Ok(())
    });
    tried.unwrap_or_else(|error| panic!("{error}"));
    println!(
        "{} of 100 accepted, {} of them touched, {} coarse",
        accepted.get(),
        touched.get(),
        coarse.get()
    );
    // A generator of scenes that are refused would check nothing. 87 are accepted; of the others a string is too short for
    // the grid that its rate allows. Other seeds give others, with a deviation of 3.4, of which 3 fewer make 77.
    assert!(accepted.get() >= 77, "only {} of 100 scenes were accepted", accepted.get());
    // Nor would one of strings that nothing touches. Something does in 68; with a deviation of 4.7, 3 fewer make 54.
    assert!(touched.get() >= 54, "something touches the strings of only {} scenes", touched.get());
    // Where rounding alone may be more nothing is checked: in 6 here and in 7 of 100 random trials (`docs/stability.md`), with
    // a deviation of 2.6, of which 3 more make 14.
    assert!(coarse.get() <= 14, "rounding alone may open the balance of {} scenes", coarse.get());
}
