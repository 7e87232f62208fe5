//! Promise: `low-action scene` writes what the simulation computes, bit for bit, and measuring it changes
//! nothing.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use low_action_dsp::pickup::stretch_tension;
use low_action_dsp::{Entry, Scene, Simulation};
use low_action_tests::npz::{Array, arrays};
use low_action_tests::numbers::largest;
use low_action_tests::scenes::PLUCKED_AND_TAPPED as SCENE;

use crate::workplace;

/// The ledger's arrays, by the alphabet.
const LEDGER: [&str; 24] = [
    "energy_body",
    "energy_contact",
    "energy_finger",
    "energy_string",
    "energy_tension",
    "power_in",
    "power_in_barrier",
    "power_in_hand",
    "power_in_pluck",
    "power_in_slide",
    "power_in_tension",
    "power_loss",
    "power_loss_0",
    "power_loss_1",
    "power_loss_body",
    "power_loss_contact",
    "power_loss_hand",
    "power_solver",
    "residual",
    "stored_1",
    "stored_2",
    "work_in",
    "work_loss",
    "work_solver",
];

fn simulation() -> Simulation {
    Simulation::new(&Scene::from_toml(SCENE).unwrap()).unwrap()
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|number| number.to_bits()).collect()
}

/// What the trace of a run that is not measured must hold, taken from the simulation itself.
fn expected(every: usize) -> BTreeMap<String, Vec<f64>> {
    let mut simulation = simulation();
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    let mut add = |name: String, number: f64| columns.entry(name).or_default().push(number);
    add("sample_rate".into(), 44_100.0);
    add("every".into(), every as f64);
    for (number, string) in (1..).zip(simulation.strings()) {
        string.places().for_each(|place| add(format!("x_{number}"), place));
    }
    for step in 0..simulation.samples() as usize {
        let due = step % every == 0;
        if due {
            add("t".into(), step as f64 / 44100.0);
            for (number, string) in (1..).zip(simulation.strings()) {
                string.state.displacement().for_each(|u| add(format!("u_{number}"), u));
                for finger in string.fingers() {
                    add(format!("x_finger_{}", finger.number + 1), finger.position);
                    add(format!("u_finger_{}", finger.number + 1), finger.height);
                }
            }
        }
        assert!(simulation.step().is_none(), "no ledger is open");
        if !due {
            continue;
        }
        let mut iterations = 0;
        for (number, string) in (1..).zip(simulation.strings()) {
            iterations += string.convergence.iterations;
            let stretched = stretch_tension(&string.model, &string.scratch);
            add(format!("tension_{number}"), string.scratch.stiffness().tension + stretched);
            add(format!("force_bridge_{number}"), string.bridge_force(0.0));
            add(format!("force_board_{number}"), string.board_force());
            let mut frets = vec![0.0; 3];
            string.fret_forces().for_each(|(fret, force)| frets[fret] = force);
            (1..).zip(frets).for_each(|(fret, force)| add(format!("force_fret_{number}_{fret}"), force));
            string.plucks().for_each(|pluck| add(format!("force_pluck_{}", pluck.number + 1), pluck.force));
            string
                .fingers()
                .for_each(|finger| add(format!("force_finger_{}", finger.number + 1), finger.force));
        }
        add("output".into(), simulation.output());
        add("iterations".into(), f64::from(iterations));
    }
    columns
}

#[test]
fn the_trace_holds_the_motion_of_a_run_that_is_not_measured() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    for every in [1, 7] {
        let done = place.run(&["scene", "scene.toml", "--trace", "out.npz", "--every", &every.to_string()]);
        assert_eq!(done.code, 0, "{}", done.error);
        let found = arrays(&place.path("out.npz"));
        let rows = found["t"].shape[0];
        assert_eq!(rows, 882_u64.div_ceil(every as u64));
        let expected = expected(every);
        for (name, numbers) in &expected {
            assert_eq!(bits(&found[name].numbers), bits(numbers), "{name}");
        }
        for (string, points) in [(1, found["x_1"].shape[0]), (2, found["x_2"].shape[0])] {
            assert_eq!(found[&format!("u_{string}")].shape, [rows, points]);
        }
        assert!(found["force_finger_1"].numbers.iter().any(|f| *f > 1.0), "the scene presses a finger");
        let tension = |string: u32| largest(found[&format!("tension_{string}")].numbers.iter().copied());
        assert!(tension(1) > 60.5, "the scene stretches a string");
        assert!(tension(2) > 61.9, "the scene tunes a string up");
        assert!(found["force_fret_1_3"].numbers.iter().any(|f| *f > 0.1), "the scene hits a fret");
        let rest: Vec<_> = found.keys().filter(|name| !expected.contains_key(*name)).collect();
        assert_eq!(rest, LEDGER.iter().collect::<Vec<_>>());
    }
}

#[test]
fn the_trace_holds_the_ledger() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    assert_eq!(place.run(&["scene", "scene.toml", "--trace", "out.npz"]).code, 0);
    let found = arrays(&place.path("out.npz"));
    let mut simulation = simulation();
    simulation.open_ledger();
    let entries: Vec<Entry> = (0..simulation.samples()).map(|_| simulation.step().unwrap()).collect();
    let column = |of: fn(&Entry) -> f64| entries.iter().map(of).collect::<Vec<_>>();
    let expected = [
        ("energy_string", column(|entry| entry.energies.string)),
        ("energy_tension", column(|entry| entry.energies.tension)),
        ("energy_contact", column(|entry| entry.energies.contact)),
        ("energy_finger", column(|entry| entry.energies.finger)),
        ("energy_body", column(|entry| entry.energies.body)),
        ("power_loss", column(|entry| entry.power_loss)),
        ("power_loss_0", column(|entry| entry.losses.loss_0)),
        ("power_loss_1", column(|entry| entry.losses.loss_1)),
        ("power_loss_contact", column(|entry| entry.losses.contact)),
        ("power_loss_hand", column(|entry| entry.losses.hand)),
        ("power_loss_body", column(|entry| entry.losses.body)),
        ("power_solver", column(|entry| entry.power_solver)),
        ("power_in", column(|entry| entry.power_in)),
        ("power_in_pluck", column(|entry| entry.inputs.pluck)),
        ("power_in_hand", column(|entry| entry.inputs.hand)),
        ("power_in_slide", column(|entry| entry.inputs.slide)),
        ("power_in_barrier", column(|entry| entry.inputs.barrier)),
        ("power_in_tension", column(|entry| entry.inputs.tension)),
        ("residual", column(|entry| entry.residual)),
    ];
    for (name, numbers) in expected {
        assert_eq!(bits(&found[name].numbers), bits(&numbers), "{name}");
    }

    // And whoever has only the file can close the balance: h(n+1/2) - h(n-1/2) + k (q - p) = 0.
    let number = |name: &str, row: usize| found[name].numbers[row];
    let energy = |row: usize| {
        let names = found.keys().filter(|name| name.starts_with("energy_"));
        names.map(|name| number(name, row)).sum::<f64>()
    };
    let largest = largest((0..entries.len()).map(energy));
    let time_step = found["t"].numbers[1];
    let open: f64 = (1..entries.len())
        .map(|row| {
            let lost = number("power_loss", row) + number("power_solver", row) - number("power_in", row);
            energy(row) - energy(row - 1) + time_step * lost
        })
        .sum();
    assert!(open.abs() < 1e-12 * largest, "{open} of {largest}");

    // And can tell what was lost and put in by its terms, also where a string begins inside the board and is thrown.
    terms_add_up(&found);
    assert!(found["power_in_barrier"].numbers.iter().all(|&power| power == 0.0));
    let thrown = "sample_rate = 44100\nduration = 0.01\n[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60.0\n\
                  loss_0 = 1.0\nshape = [[0.0, 0.0], [0.3, -0.004], [0.65, 0.0]]\nvelocity = [[0.3, 1.0]]\n[fretboard]\n\
                  stiffness = 1e9\nexponent = 2.0\nboard = -0.002\nfrets = 3\nfret_top = -0.001\n";
    place.write("scene.toml", thrown);
    assert_eq!(place.run(&["scene", "scene.toml", "--trace", "out.npz"]).code, 0);
    let found = arrays(&place.path("out.npz"));
    terms_add_up(&found);
    let risen = &found["power_in_barrier"].numbers;
    assert!(risen[0].abs() > 1e-3 && risen[1..].iter().all(|&power| power == 0.0), "{} W", risen[0]);
}

/// What happens in the samples between is counted, however few are kept.
#[test]
fn the_balance_closes_between_rows_that_are_kept() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    for every in ["1", "7", "100"] {
        assert_eq!(place.run(&["scene", "scene.toml", "--trace", "out.npz", "--every", every]).code, 0);
        let found = arrays(&place.path("out.npz"));
        let number = |name: &str, row: usize| found[name].numbers[row];
        let energy = |row: usize| {
            let names = found.keys().filter(|name| name.starts_with("energy_"));
            names.map(|name| number(name, row)).sum::<f64>()
        };
        let rows = found["t"].numbers.len();
        let largest = largest((0..rows).map(energy));
        let mut put_in = 0.0;
        for row in 1..rows {
            let work = number("work_loss", row) + number("work_solver", row) - number("work_in", row);
            let open = energy(row) - energy(row - 1) + work;
            assert!(open.abs() < 1e-12 * largest, "--every {every}, row {row}: {open} of {largest} J");
            put_in += number("work_in", row);
        }
        assert!(put_in.abs() > 1e-3 * largest, "{put_in} J");
    }
}

/// Whether the terms of what is lost and of what is put in make up all of it.
fn terms_add_up(found: &BTreeMap<String, Array>) {
    for total in ["power_loss", "power_in"] {
        let terms = found.iter().filter(|(name, _)| name.starts_with(&format!("{total}_")));
        let terms: Vec<_> = terms.map(|(_, array)| &array.numbers).collect();
        for (row, &all) in found[total].numbers.iter().enumerate() {
            let sum: f64 = terms.iter().map(|numbers| numbers[row]).sum();
            let size: f64 = terms.iter().map(|numbers| numbers[row].abs()).sum();
            assert!(
                (all - sum).abs() <= 16.0 * f64::EPSILON * size,
                "{total}: {all} W is not {sum} W in row {row}"
            );
        }
    }
}

#[test]
fn the_sound_is_the_output_in_si_units() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    let mut alone = simulation();
    let expected: Vec<u32> = (0..alone.samples())
        .map(|_| {
            alone.step();
            (alone.output() as f32).to_bits()
        })
        .collect();
    for arguments in [vec!["--wav", "out.wav"], vec!["--wav", "out.wav", "--trace", "out.npz"]] {
        let done = place.run(&[vec!["scene", "scene.toml"], arguments].concat());
        assert_eq!(done.code, 0, "{}", done.error);
        let reader = hound::WavReader::open(place.path("out.wav")).unwrap();
        let spec = reader.spec();
        assert_eq!((spec.channels, spec.sample_rate, spec.bits_per_sample), (1, 44100, 32));
        assert_eq!(spec.sample_format, hound::SampleFormat::Float);
        let found: Vec<u32> = reader.into_samples::<f32>().map(|sample| sample.unwrap().to_bits()).collect();
        assert!(found == expected, "the trace changed the sound, or the sound is not the output");
    }
}

#[test]
fn two_runs_write_the_same_bytes() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    for name in ["a", "b"] {
        let (wav, trace) = (format!("{name}.wav"), format!("{name}.npz"));
        assert_eq!(place.run(&["scene", "scene.toml", "--wav", &wav, "--trace", &trace]).code, 0);
    }
    for kind in ["wav", "npz"] {
        let read = |name: &str| fs::read(place.path(&format!("{name}.{kind}"))).unwrap();
        assert!(read("a") == read("b"), "{kind}");
    }
    assert_eq!(place.names(), ["a.npz", "a.wav", "b.npz", "b.wav", "scene.toml"]);
}

#[test]
fn a_scene_comes_from_standard_input_and_goes_to_standard_output() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    assert_eq!(place.run(&["scene", "scene.toml", "--wav", "out.wav", "--trace", "out.npz"]).code, 0);
    for (option, name) in [("--wav", "out.wav"), ("--trace", "out.npz")] {
        let done = place.run_with(&["scene", "-", option, "-"], SCENE.as_bytes());
        assert_eq!(done.code, 0, "{}", done.error);
        assert!(done.output == fs::read(place.path(name)).unwrap(), "{option}");
        assert!(done.error.contains("string 2: N = "), "{}", done.error);
        // By its other name, too.
        if cfg!(unix) {
            let named = place.run(&["scene", "scene.toml", option, "/dev/stdout"]);
            assert!(named.output == done.output && named.error.contains("string 2: N = "), "{}", named.error);
        }
    }
}

#[test]
fn a_run_is_summed_up() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    let done = place.run(&["scene", "scene.toml"]);
    assert_eq!((done.code, done.error.as_str()), (0, ""));
    for words in [
        "string 1: N = ",
        "string 2: N = ",
        "882 samples at 44100 Hz",
        "penetration",
        "iterations",
        " of the largest so far, and in all at the end by ",
    ] {
        assert!(done.text().contains(words), "{words} is not in {}", done.text());
    }
    let done = place.run(&["scene", "scene.toml", "--wav", "out.wav"]);
    assert!(done.text().contains("energy: not measured"), "{}", done.text());
    assert!(done.text().contains("out.wav: velocity at 0.55 m, at most "), "{}", done.text());
}

/// A string that is stretched to 114 N where its grid, made for 60 N, bears 76.
const OVERSTRETCHED: &str = "sample_rate = 88200\nduration = 0.01\n[[string]]\nlength = 0.65\n\
                             linear_density = 5.25e-3\ntension = 60.0\nyoungs_modulus = 2e11\ncore_radius = 4.3e-4\n\
                             tension_modulation = true\nshape = [[0.0, 0.0], [0.3, 0.01], [0.65, 0.0]]\n";

#[test]
fn a_string_stretched_beyond_its_grid_is_told() {
    let place = workplace();
    place.write("scene.toml", OVERSTRETCHED);
    let done = place.run(&["scene", "scene.toml"]);
    assert_eq!(done.code, 0, "{}", done.error);
    let told = "warning: scene.toml: stretching brings the tension to 114.";
    assert!(done.error.starts_with(told) && done.error.lines().count() == 1, "{}", done.error);
    assert!(
        done.error.contains("and the grid bears 76.") && !done.text().contains("stretching"),
        "{}",
        done.text()
    );
    // A course of the tension that reaches as high, after the end, makes room.
    let room = OVERSTRETCHED.replace("tension = 60.0", "tension = [[0.0, 60.0], [1.0, 60.0], [2.0, 120.0]]");
    place.write("room.toml", room);
    let done = place.run(&["scene", "room.toml"]);
    assert_eq!((done.code, done.error.as_str()), (0, ""));
}

/// Beside a string at rest a hand pushes a finger through a thick liquid: energies of nothing much, and a flow of kilowatts.
const FLOW: &str = "sample_rate = 44100\nduration = 0.5\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                    tension = 60.0\n[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\nposition = 0.2\n\
                    height = 1.0\nforce = 1000.0\nhand_damping = 1e5\n";

#[test]
fn a_balance_is_judged_by_what_flows_through_it() {
    let mut simulation = Simulation::new(&Scene::from_toml(FLOW).unwrap()).unwrap();
    simulation.open_ledger();
    (0..simulation.samples()).for_each(|_| {
        simulation.step();
    });
    let ledger = &simulation.ledgers()[0];
    assert!(
        ledger.put_in > 1e4 * ledger.largest,
        "{} J put in, at most {} J there",
        ledger.put_in,
        ledger.largest
    );
    let place = workplace();
    place.write("scene.toml", FLOW);
    let done = place.run(&["scene", "scene.toml"]);
    assert_eq!((done.code, done.error.as_str()), (0, ""));
}

#[test]
fn a_scene_of_no_length_makes_empty_files() {
    let place = workplace();
    place.write("scene.toml", SCENE.replace("duration = 0.02", "duration = 0"));
    let done = place.run(&["scene", "scene.toml", "--wav", "out.wav", "--trace", "out.npz"]);
    assert_eq!(done.code, 0, "{}", done.error);
    assert_eq!(arrays(&place.path("out.npz"))["t"].shape, [0]);
    assert_eq!(hound::WavReader::open(place.path("out.wav")).unwrap().len(), 0);
}

#[test]
fn arrays_larger_than_what_is_gathered_are_whole() {
    // 40,000 rows of 30 points are several times what one array gathers in memory.
    let text = "sample_rate = 8000\nduration = 5.0\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                tension = 60.0\nloss_0 = 1.0\nshape = [[0.0, 0.0], [0.2, 0.001], [0.65, 0.0]]\n";
    let place = workplace();
    place.write("scene.toml", text);
    assert_eq!(place.run(&["scene", "scene.toml", "--trace", "out.npz"]).code, 0);
    let found = arrays(&place.path("out.npz"));
    let mut simulation = Simulation::new(&Scene::from_toml(text).unwrap()).unwrap();
    for (row, sample) in found["u_1"].numbers.chunks(found["x_1"].numbers.len()).enumerate() {
        assert_eq!(
            bits(sample),
            bits(&simulation.string(0).state.displacement().collect::<Vec<_>>()),
            "row {row}"
        );
        simulation.step();
    }
    assert_eq!(simulation.steps(), 40_000);
    let names: Vec<_> = found.keys().filter(|name| name.starts_with("force_")).collect();
    assert_eq!(names, ["force_bridge_1"], "nothing else touches this string");
}

#[test]
fn every_example_runs() {
    let place = workplace();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let files = |folder: &Path| fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut names = Vec::new();
    for path in files(&folder).chain(files(&folder.join("paper"))).filter(|path| path.is_file()) {
        let done = place.run(&["scene".as_ref(), path.as_os_str()]);
        assert_eq!(done.code, 0, "{}: {}", path.display(), done.error);
        // The paper's own scenes have as much room for stretching as the paper gave them.
        let is_ours = path.parent().is_some_and(|parent| parent == folder);
        assert!(!(is_ours && done.error.contains("stretching")), "{}: {}", path.display(), done.error);
        names.push(path.file_name().unwrap().to_string_lossy().into_owned());
    }
    names.sort();
    let ours = ["hammer", "pluck", "sitar", "slide", "sympathy", "tap"];
    let papers = ["barrier", "figure_2", "figure_4", "figure_5", "figure_6", "ledger", "strings"];
    let mut expected: Vec<String> = ours.iter().chain(&papers).map(|name| format!("{name}.toml")).collect();
    expected.sort();
    assert_eq!(names, expected);
    // So is the one in the description of the files.
    let page = fs::read_to_string(folder.join("../docs/formats.md")).unwrap();
    let (_, rest) = page.split_once("```toml\n").unwrap();
    place.write("scene.toml", rest.split_once("```").unwrap().0);
    let done = place.run(&["scene", "scene.toml"]);
    assert_eq!(done.code, 0, "{}", done.error);
    assert!(!done.error.contains("stretching"), "{}", done.error);
}

/// What the help shows as a scene is one, without a warning.
#[test]
fn the_scene_in_the_help_can_be_computed() {
    let place = workplace();
    let help = place.run(&["scene", "--help"]).text();
    let lines = help.lines().skip_while(|line| !line.starts_with("A scene")).skip(1);
    let scene: Vec<&str> = lines.take_while(|line| !line.is_empty()).map(str::trim).collect();
    assert!(scene.len() > 20, "{help}");
    place.write("scene.toml", scene.join("\n"));
    let done = place.run(&["scene", "scene.toml"]);
    assert!(done.code == 0 && !done.error.contains("warning"), "{}", done.error);
}
