//! Promise: a trace says what it is a trace of: the scene as it was written, what each pluck did, and where each finger was.

use std::f64::consts::PI;

use low_action_tests::command::Workplace;
use low_action_tests::npz::{Array, arrays, text};
use low_action_tests::numbers::largest;

const RATE: f64 = 44_100.0;

/// Plucks and fingers that are not in the order of their strings, one of which slides; and characters of one to four bytes.
const SCENE: &str = r#"# Glissando auf der zweiten Saite, e′ 🎸
sample_rate = 44100
duration = 0.02
[[string]]
length = 0.65
linear_density = 5.25e-3
tension = 60.0
loss_0 = 1.38
[[string]]
length = 0.6
linear_density = 1e-3
tension = 60.0
loss_0 = 1.0
[[pluck]]
string = 2
start = 0.0031
duration = 0.00242
position = 0.5
force = 2.5
[[pluck]]
string = 1
duration = 0.002
position = 0.5
force = -1.5
[[finger]]
string = 2
mass = 5e-3
stiffness = 1e8
exponent = 2.0
position = [[0.004, 0.15], [0.016, 0.2]]
height = 0.0001
force = 1.0
[[finger]]
string = 1
mass = 5e-3
stiffness = 1e8
exponent = 2.0
position = 0.25
height = 0.01
"#;

/// The plucks: start and duration, s, and force, N.
const PLUCKS: [[f64; 3]; 2] = [[0.0031, 0.00242, 2.5], [0.0, 0.002, -1.5]];

fn workplace() -> Workplace {
    let place = crate::workplace();
    place.write("scene.toml", SCENE);
    place
}

#[test]
fn the_scene_is_in_it_as_it_was_written() {
    let place = workplace();
    assert_eq!(place.run(&["scene", "scene.toml", "--trace", "file.npz"]).code, 0);
    let found = text(&place.path("file.npz"), "scene");
    assert_eq!(found, SCENE);
    // Whoever has only the trace can make it again.
    assert_eq!(place.run_with(&["scene", "-", "--trace", "again.npz"], found.as_bytes()).code, 0);
    let read = |name: &str| std::fs::read(place.path(name)).unwrap();
    assert!(read("file.npz") == read("again.npz"));
}

#[test]
fn it_says_what_made_it_and_how_far_rows_are_apart() {
    let place = workplace();
    for (every, rows) in [(1, 882), (7, 126), (u64::MAX, 1)] {
        let done = place.run(&["scene", "scene.toml", "--trace", "out.npz", "--every", &every.to_string()]);
        assert_eq!(done.code, 0, "{}", done.error);
        let path = place.path("out.npz");
        // (The tests have the program's version.)
        assert_eq!(text(&path, "program"), concat!("low-action ", env!("CARGO_PKG_VERSION")));
        let found = arrays(&path);
        let single = |name: &str| {
            let Array { shape, numbers } = &found[name];
            assert!(shape.is_empty(), "{name}: {shape:?}");
            numbers[0]
        };
        assert_eq!((single("sample_rate"), single("every")), (RATE, every as f64));
        let times = &found["t"].numbers;
        assert_eq!(times.len(), rows);
        let exact = (0..rows).map(|row| (row as u64 * every) as f64 / single("sample_rate"));
        assert!(times.iter().copied().eq(exact), "{every}");
    }
}

#[test]
fn plucks_push_as_the_scene_has_it() {
    let place = workplace();
    assert_eq!(place.run(&["scene", "scene.toml", "--trace", "out.npz"]).code, 0);
    let found = arrays(&place.path("out.npz"));
    let times = &found["t"].numbers;
    for (number, [start, duration, force]) in (1..).zip(PLUCKS) {
        // As a part of the pluck's force. A sample has the mean from half of one before it to half of one after.
        let Array { numbers, .. } = &found[&format!("force_pluck_{number}")];
        let push: Vec<f64> = numbers.iter().map(|number| number / force).collect();
        let half = 0.5 / RATE;
        for (&time, &push) in times.iter().zip(&push) {
            let since = time - start;
            if since + half <= 0.0 || since - half >= duration {
                assert_eq!(push, 0.0, "pluck {number} at {time} s");
            } else {
                assert!(push > 0.0, "pluck {number} at {time} s");
            }
            if since >= half && since + half <= duration {
                // The mean of f over k is f in the middle to k²/24·max|f″|, here (πk/T)²/48.
                let exact = 0.5 * (1.0 - (PI * since / duration).cos());
                let off = (push - exact).abs();
                assert!(off <= (PI / RATE / duration).powi(2) / 48.0, "pluck {number} at {time} s: {off}");
            }
        }
        // It ends at once where it is strongest: the last whole sample ends less than one before the end, and (1 + cos(πd/T))/2
        // at d ≤ 2k before it is over 1 − (πk/T)².
        let peak = largest(push.iter().copied());
        assert!(peak <= 1.0 && peak >= 1.0 - (PI / RATE / duration).powi(2), "pluck {number}: {peak}");
        // The mean of a raised cosine is a half; some 100 terms are rounded.
        let sum = push.iter().sum::<f64>() / RATE;
        assert!((sum - 0.5 * duration).abs() < 1e-13 * duration, "pluck {number}: {sum} s");
    }
}

#[test]
fn fingers_are_where_the_scene_has_them() {
    let place = workplace();
    for every in [1, 7] {
        let done = place.run(&["scene", "scene.toml", "--trace", "out.npz", "--every", &every.to_string()]);
        assert_eq!(done.code, 0, "{}", done.error);
        let found = arrays(&place.path("out.npz"));
        let (times, slide) = (&found["t"].numbers, &found["x_finger_1"].numbers);
        assert_eq!(slide.len(), times.len());
        assert_eq!((slide[0], slide[slide.len() - 1]), (0.15, 0.2));
        assert!(slide.is_sorted(), "it goes back");
        for (time, place) in times.iter().zip(slide) {
            let exact = 0.15 + 0.05 * ((time - 0.004) / 0.012).clamp(0.0, 1.0);
            // A sample's way is 1e-4 m; a place is rounded a few times.
            assert!((place - exact).abs() < 1e-15, "{place} m at {time} s");
        }
        assert!(found["x_finger_2"].numbers.iter().all(|&place| place == 0.25));
    }
}

/// What the bridge of a body has put into each string it has taken from the body, and nothing of it is in `power_in`.
#[test]
fn what_strings_and_a_body_give_each_other_is_told() {
    let body = "[body]\nfrequency = 170.0\nmass = 0.1\narea = 0.05\nquality = 20.0\nspacing = 50.0\nvolume = 0.0145\n\
                hole = 0.0055\n";
    let place = workplace();
    place.write("scene.toml", format!("{SCENE}{body}[output]\nposition = \"air\"\n"));
    let done = place.run(&["scene", "scene.toml", "--trace", "out.npz", "--wav", "out.wav"]);
    assert_eq!(done.code, 0, "{}", done.error);
    assert!(done.text().contains("out.wav: sound pressure before the body, at most "), "{}", done.text());
    let found = arrays(&place.path("out.npz"));
    let numbers = |name: &str| &found[name].numbers;
    let (energy, lost) = (numbers("energy_body"), numbers("power_loss_body"));
    let [first, second] = ["power_bridge_1", "power_bridge_2"].map(numbers);
    let largest = largest(energy.iter().copied());
    let mut given = 0.0;
    for row in 1..energy.len() {
        let put_in = -(first[row] + second[row]);
        let open = energy[row] - energy[row - 1] + (lost[row] - put_in) / RATE;
        assert!(open.abs() < 1e-14 * largest, "row {row}: {open} of {largest} J");
        given += put_in / RATE;
    }
    assert!(given > 1e-9 && largest > 1e-9 && second.iter().any(|power| *power > 0.0), "{given} J");
    // Strings have the rest, each its own.
    let [one, other] = ["stored_1", "stored_2"].map(numbers);
    let terms = ["energy_string", "energy_tension", "energy_contact", "energy_finger"].map(numbers);
    for row in 0..one.len() {
        let all: f64 = terms.iter().map(|numbers| numbers[row]).sum();
        assert!(
            (one[row] + other[row] - all).abs() <= 1e-14 * all,
            "row {row}: {} {} J",
            one[row],
            other[row]
        );
    }
    assert!(!found.contains_key("power_in_bridge"));
    // Without a body there is none of that.
    place.write("scene.toml", SCENE);
    assert_eq!(place.run(&["scene", "scene.toml", "--trace", "out.npz"]).code, 0);
    let found = arrays(&place.path("out.npz"));
    assert!(
        ["energy_body", "power_loss_body"].iter().all(|name| found[*name].numbers.iter().all(|&x| x == 0.0))
    );
    assert!(!found.contains_key("power_bridge_1"));
}

/// The bridge moves, and what strings do to it on its way is what they lose to it; of several strings each is told, and what is heard
/// there is all together.
#[test]
fn how_strings_move_the_bridge_is_told() {
    let place = workplace();
    let body = "[body]\nfrequency = 170.0\nmass = 0.1\narea = 0.05\nquality = 20.0\nspacing = 50.0\nvolume = 0.0145\n\
                hole = 0.0055\n";
    let string =
        |shape: &str| format!("[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60.0\n{shape}");
    let strings = [string("shape = [[0.0, 0.0], [0.5, 0.003], [0.65, 0.0]]\n"), string("")].concat();
    let output = "[output]\nposition = \"bridge\"\n";
    for (body, has_body) in [(body, true), ("", false)] {
        place.write("scene.toml", format!("sample_rate = 44100\nduration = 0.3\n{strings}{body}{output}"));
        let done = place.run(&["scene", "scene.toml", "--trace", "out.npz"]);
        assert_eq!((done.code, done.error.as_str()), (0, ""));
        let found = arrays(&place.path("out.npz"));
        let numbers = |name: &str| &found[name].numbers;
        let [first, second] = ["force_bridge_1", "force_bridge_2"].map(numbers);
        let heard = numbers("output");
        assert!((0..heard.len()).all(|row| first[row] + second[row] == heard[row]));
        assert!(first.iter().any(|force| force.abs() > 0.1));
        assert_eq!(found.contains_key("u_bridge"), has_body);
        if !has_body {
            assert!(second.iter().all(|force| *force == 0.0));
            continue;
        }
        let lift = numbers("u_bridge");
        let work = |force: &[f64]| -> f64 {
            (1..lift.len() - 1).map(|row| force[row] * 0.5 * (lift[row + 1] - lift[row - 1])).sum()
        };
        let taken = |name: &str| -> f64 { -numbers(name).iter().sum::<f64>() / RATE };
        let (done, taken) = (work(heard), taken("power_bridge_1") + taken("power_bridge_2"));
        // (The force that is heard has what stretching pulls, too, some per cent of it here.)
        assert!(
            (done / taken - 1.0).abs() < 0.02,
            "{done} J are done at the bridge, {taken} J taken of the strings"
        );
    }
}

/// A string that nobody plays has nothing but what the bridge of the body gives it, and loses it to itself alone.
#[test]
fn what_each_string_stores_is_told_apart() {
    let place = workplace();
    let string =
        |shape: &str| format!("[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60.0\n{shape}");
    let body = "[body]\nfrequency = 170.0\nmass = 0.1\narea = 0.05\nquality = 20.0\nspacing = 50.0\nvolume = 0.0145\n\
                hole = 0.0055\n";
    let strings = [string("shape = [[0.0, 0.0], [0.5, 0.003], [0.65, 0.0]]\n"), string("")].concat();
    place.write("scene.toml", format!("sample_rate = 44100\nduration = 0.05\n{strings}{body}"));
    let done = place.run(&["scene", "scene.toml", "--trace", "out.npz"]);
    assert_eq!((done.code, done.error.as_str()), (0, ""));
    let found = arrays(&place.path("out.npz"));
    let largest = largest(found["stored_1"].numbers.iter().copied());
    for number in [1, 2] {
        let stored = &found[&format!("stored_{number}")].numbers;
        let given = &found[&format!("power_bridge_{number}")].numbers;
        for row in 1..stored.len() {
            let open = stored[row] - stored[row - 1] - given[row] / RATE;
            assert!(open.abs() < 1e-13 * largest, "string {number}, row {row}: {open} of {largest} J");
        }
    }
    assert!(found["stored_2"].numbers.iter().any(|&stored| stored > 1e-9));
    // Alone it has all there is.
    place.write(
        "scene.toml",
        format!("sample_rate = 44100\nduration = 0.01\n{}", string("velocity = [[0.1, 0.1]]\n")),
    );
    assert_eq!(place.run(&["scene", "scene.toml", "--trace", "out.npz"]).code, 0);
    assert!(!arrays(&place.path("out.npz")).contains_key("stored_1"));
}
