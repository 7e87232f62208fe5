//! Promise: a scene that cannot be computed, and a place that cannot be written, is refused in one line
//! that names the thing, the value and what is accepted, with the right exit code and nothing left behind.

use std::path::Path;

use low_action_dsp::{Scene, Simulation};
use low_action_tests::command::Finished;

use crate::workplace;

const SCENE: &str = r#"
sample_rate = 44100
duration = 0.01
[[string]]
length = 0.65
linear_density = 5.25e-3
tension = 60.0
loss_0 = 1.0
[fretboard]
stiffness = 1e12
exponent = 2.3
board = -0.002
frets = 3
fret_top = -0.001
[[pluck]]
duration = 0.002
position = 0.5
force = -1.0
[[finger]]
mass = 5e-3
stiffness = 1e8
exponent = 2.0
position = 0.2
"#;

/// Whether there is such a device here; what is tried on it is passed over where there is none.
fn has_device(path: &str) -> bool {
    let there = Path::new(path).exists();
    if !there {
        println!("passed over: there is no {path} here");
    }
    there
}

/// That a run was refused in one line holding these words.
fn assert_refused(done: &Finished, code: i32, words: &[&str]) {
    assert_eq!(done.code, code, "{}", done.error);
    assert!(done.error.starts_with("error: "), "{}", done.error);
    assert!(done.error.ends_with('\n') && done.error.lines().count() == 1, "{}", done.error);
    assert!(!done.error.trim_end().contains(char::is_control), "{:?}", done.error);
    assert!(done.error.chars().count() < 600, "{}", done.error);
    for word in words {
        assert!(done.error.contains(word), "{word} is not in: {}", done.error);
    }
    assert!(done.output.is_empty(), "{}", done.text());
}

/// Whether a number that was computed is shown with four digits or fewer.
fn has_few_digits(shown: &str) -> bool {
    let digits = shown.split('e').next().unwrap().chars().filter(char::is_ascii_digit).collect::<String>();
    shown.parse::<f64>().is_ok() && digits.trim_matches('0').len() <= 4
}

/// That the scene with a part replaced is refused before anything is computed (some of these would take years), and with
/// nothing written.
fn assert_scene_refused(from: &str, to: &str, words: &[&str]) {
    assert!(SCENE.contains(from), "{from} is not in the scene");
    let place = workplace();
    place.write("scene.toml", SCENE.replacen(from, to, 1));
    let done = place.run(&["scene", "scene.toml", "--wav", "out.wav", "--trace", "out.npz"]);
    assert_refused(&done, 1, &[&["scene.toml"], words].concat());
    assert_eq!(place.names(), ["scene.toml"], "{to}");
}

#[test]
fn the_scene_itself_is_accepted() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    assert_eq!(place.run(&["scene", "scene.toml"]).code, 0);
}

/// A body that the scene's string bears.
const BODY: &str = "[body]\nfrequency = 170.0\nmass = 0.1\narea = 0.05\nquality = 20.0\nspacing = 50.0\nvolume = 0.0145\n\
                    hole = 0.0055\n[[pluck]]";

#[test]
fn bodies_that_cannot_be_are_refused() {
    let heard = "[output]\nposition = \"air\"\n[[pluck]]";
    let cases: &[(&str, &str, &[&str])] = &[
        ("", heard, &["output.position = \"air\"", "only a [body] is heard in the air"]),
        ("mass = 0.1", "mass = 0.0", &["body.mass = 0 ", "between 0.01 and 1000 kg"]),
        ("hole = 0.0055", "hole = 1.0", &["body.hole = 1 ", "between 1e-5 and 0.1 m²"]),
        ("hole = 0.0055", "", &["body", "hole"]),
        ("hole = 0.0055", "hole = 0.0055\ntop = 1.0", &["top", "unknown"]),
        ("[body]", "[[body]]", &["body"]),
    ];
    for (from, to, words) in cases {
        let body = if from.is_empty() { (*to).to_owned() } else { BODY.replacen(from, to, 1) };
        assert_scene_refused("[[pluck]]", &body, words);
    }
    // Whoever takes the mass that is named has one that is just heavy enough for all strings of the scene.
    let string = "[[string]]\nlength = 0.65\nlinear_density = 0.5\ntension = 6000.0\nloss_1 = 0.01\n";
    let scene = |count: usize, mass: &str| {
        let body = BODY.replacen("mass = 0.1", mass, 1);
        SCENE.replacen("[fretboard]", &format!("{}[fretboard]", string.repeat(count)), 1).replacen(
            "[[pluck]]",
            &body,
            1,
        )
    };
    let place = workplace();
    let mut least = Vec::new();
    for count in [1, 3] {
        place.write("scene.toml", scene(count, "mass = 0.01"));
        let done = place.run(&["scene", "scene.toml", "--wav", "out.wav"]);
        assert_refused(&done, 1, &["scene.toml", "body.mass = 0.01 ", "it must be at least ", " kg"]);
        let mass = done.error.trim_end().rsplit(' ').nth(1).expect("a mass");
        place.write("scene.toml", scene(count, &format!("mass = {mass}")));
        let done = place.run(&["scene", "scene.toml"]);
        assert_eq!(done.code, 0, "{mass} kg: {}", done.error);
        least.push(mass.parse::<f64>().expect("a number"));
    }
    assert!(least[1] > 2.5 * least[0], "{least:?} kg");
}

#[test]
fn values_out_of_range_are_refused() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("duration = 0.01", "duration = 1e18", &["duration = 1e18", "between 0 and 100000 s"]),
        ("duration = 0.002", "duration = 0.002\nrelease = -1", &["pluck[1].release = -1", "between 0 and"]),
        ("duration = 0.01", "duration = -1", &["duration = -1", "between 0"]),
        ("duration = 0.01", "duration = nan", &["duration = NaN"]),
        ("duration = 0.01", "duration = 1e400", &["line 3, duration", "overflow"]),
        ("sample_rate = 44100", "sample_rate = 0", &["sample_rate = 0", "between 1000 and 1e7 Hz"]),
        ("sample_rate = 44100", "sample_rate = 1e12", &["sample_rate = 1e12", "1e7 Hz"]),
        ("sample_rate = 44100", "sample_rate = -inf", &["sample_rate = -inf"]),
        ("length = 0.65", "length = 0.0", &["string[1].length = 0", "m"]),
        ("linear_density = 5.25e-3", "linear_density = -1", &["string[1].linear_density = -1", "kg/m"]),
        ("tension = 60.0", "tension = inf", &["string[1].tension = inf", "N"]),
        ("tension = 60.0", "tension = []", &["string[1].tension", "at least one"]),
        (
            "tension = 60.0",
            "tension = [[1, 60], [0.5, 60]]",
            &["time of point 2 of string[1].tension = 0.5", "above that of the point before, 1 s"],
        ),
        ("tension = 60.0", "tension = [[0, 60], [1, -2]]", &["value of point 2 of string[1].tension = -2"]),
        ("tension = 60.0", "tension = 60\nshape = [[0.1, 0.001], [0.7, 0]]", &["shape = 0.7", "0.65"]),
        (
            "tension = 60.0",
            "tension = 60\nshape = [[nan, 0.0]]",
            &["place of point 1 of string[1].shape = NaN", "between 0 and 0.65 m"],
        ),
        (
            "tension = 60.0",
            "tension = 60\nvelocity = [[0.1, 1], [0.7, 0]]",
            &["velocity = 0.7", "0 and 0.65 m"],
        ),
        (
            "tension = 60.0",
            "tension = 60\nvelocity = [[0.1, 0], [0.2, -1001]]",
            &["value of point 2 of string[1].velocity = -1001", "-1000 and 1000 m/s"],
        ),
        (
            "tension = 60.0",
            "tension = 60\nvelocity = [[0.1, 0], [0.1, 1]]",
            &["place of point 2 of string[1].velocity = 0.1", "above"],
        ),
        ("loss_0 = 1.0", "loss_0 = -1.0", &["string[1].loss_0 = -1", "1/s"]),
        (
            "loss_0 = 1.0",
            "loss_0 = 1.0\nt60 = [[100, 10], [1000, 5]]",
            &["string[1].loss_0 = 1", "has a t60", "give one or the other"],
        ),
        (
            "loss_0 = 1.0",
            "t60 = [[100, 10], [1000, 20]]",
            &["time of point 2 of string[1].t60 = 20", "between 0.1 and 10 s"],
        ),
        (
            "loss_0 = 1.0",
            "t60 = [[100, 10], [1000, 0.09]]",
            &["time of point 2 of string[1].t60 = 0.09", "between 0.1 and 10 s", "loss_0 and loss_1"],
        ),
        (
            "loss_0 = 1.0",
            "t60 = [[1000, 5], [100, 10]]",
            &["frequency of point 2 of string[1].t60 = 100", "above that of the point before, 1000 Hz"],
        ),
        (
            "loss_0 = 1.0",
            "t60 = [[-100, 10], [1000, 5]]",
            &["frequency of point 1 of string[1].t60 = -100", "between 0.001 and 1e6 Hz"],
        ),
        (
            "loss_0 = 1.0",
            "t60 = [[100, 0], [1000, 0]]",
            &["time of point 1 of string[1].t60 = 0", "between 0.001 and 1e9 s"],
        ),
        ("exponent = 2.3", "exponent = 0.5", &["fretboard.exponent = 0.5", "between 1 and 5"]),
        (
            "exponent = 2.3",
            "exponent = 2.3\ndamping = -0.3",
            &["fretboard.damping = -0.3", "0 and 100000 s/m"],
        ),
        ("exponent = 2.3", "exponent = 2.3\ndamping = 1e6", &["fretboard.damping = 1e6", "s/m"]),
        ("board = -0.002", "board = 0.001", &["fretboard.board = 0.001", "-10 and 0 m"]),
        (
            "board = -0.002",
            "board = { nut = 0.001, middle = -0.001, bridge = -0.001 }",
            &["fretboard.board.nut = 0.001", "-10 and 0 m"],
        ),
        (
            "board = -0.002",
            "board = { nut = -0.001, middle = -0.001, bridge = nan }",
            &["fretboard.board.bridge = NaN", "-10 and 0 m"],
        ),
        (
            "board = -0.002",
            "board = { nut = 0, middle = -1e-4, bridge = -0.001 }",
            &["fretboard.board.middle = -1e-4", "-10 and -2.5e-4 m", "nowhere above the strings"],
        ),
        ("frets = 3", "frets = -3", &["frets", "-3", "0 to 640"]),
        ("frets = 3", "frets = 641", &["frets", "641", "0 to 640"]),
        ("frets = 3", "frets = [0.1, 0.7]\n#", &["fretboard.frets[2] = 0.7", "0.65 m", "string[1]"]),
        ("fret_top = -0.001", "fret_top = [-0.001]", &["fret_top", "1 heights", "each of the 3"]),
        ("fret_top = -0.001", "", &["fret_top", "need the height"]),
        ("position = 0.5", "position = 0.65", &["pluck[1].position = 0.65", "above 0 and below 0.65 m"]),
        ("force = -1.0", "force = 1e7", &["pluck[1].force = 1e7", "N"]),
        ("[[pluck]]", "[[pluck]]\nstring = 2", &["pluck[1].string = 2", "1 to 1"]),
        ("mass = 5e-3", "mass = -5e-3", &["finger[1].mass = -0.005", "kg"]),
        ("mass = 5e-3", "mass = nan", &["finger[1].mass = NaN"]),
        ("position = 0.2", "position = -0.2", &["finger[1].position = -0.2", "above 0 and below 0.65 m"]),
        (
            "position = 0.2",
            "position = [[0, 0.2], [1, 0.8]]",
            &["point 2 of finger[1].position = 0.8", "0.65 m"],
        ),
        (
            "position = 0.2",
            "position = [[0.0, nan]]",
            &["value of point 1 of finger[1].position = NaN", "above 0 and below 0.65 m"],
        ),
        (
            "position = 0.2",
            "position = [[nan, 0.2]]",
            &["time of point 1 of finger[1].position = NaN", "between -1e9 and 1e9 s"],
        ),
        ("position = 0.2", "position = 0.2\nheight = 11", &["finger[1].height = 11", "m"]),
        (
            "duration = 0.01",
            "duration = 0.01\nsolver.max_iterations = 2000",
            &["solver.max_iterations = 2000", "1000"],
        ),
        ("duration = 0.01", "duration = 0.01\noutput.position = 0.7", &["output.position = 0.7", "0.65 m"]),
    ];
    for (from, to, words) in cases {
        assert_scene_refused(from, to, words);
    }
}

#[test]
fn what_does_not_fit_the_grid_is_refused() {
    let words = ["string[1].length = 0.65", "too short", "44100 Hz", "at least 1."];
    assert_scene_refused("tension = 60.0", "tension = 1e6", &words);
    assert_scene_refused("stiffness = 1e12", "stiffness = 1e30", &["fretboard.stiffness = 1e30", "at most"]);
    assert_scene_refused("stiffness = 1e8", "stiffness = 1e30", &["finger[1].stiffness = 1e30", "at most"]);
}

#[test]
fn the_length_named_as_the_shortest_is_accepted() {
    let place = workplace();
    let bare =
        "sample_rate = 44100\nduration = 0.001\n[[string]]\nlinear_density = 5e-3\ntension = 60.0\nlength = ";
    place.write("scene.toml", format!("{bare}0.002"));
    let done = place.run(&["scene", "scene.toml"]);
    let shortest = done.error.split("at least ").nth(1).unwrap().trim_end_matches(" m\n").to_owned();
    assert!(has_few_digits(&shortest), "{shortest}");
    place.write("scene.toml", format!("{bare}{shortest}"));
    assert_eq!(place.run(&["scene", "scene.toml"]).code, 0, "{shortest}");
    // The rate is told as it was given. (Turned over twice it would be 1001.9999999999999.)
    place.write("scene.toml", format!("{bare}0.002").replace("44100", "1002"));
    assert_refused(&place.run(&["scene", "scene.toml"]), 1, &["for its grid at 1002 Hz: it must be"]);
}

#[test]
fn the_duration_named_as_the_longest_is_accepted() {
    let with = |duration: &str| {
        let text = SCENE.replace("duration = 0.01", &format!("duration = {duration}"));
        let scene = Scene::from_toml(&text.replace("44100", "1e7")).unwrap();
        Simulation::new(&scene).map(drop).map_err(|error| error.to_string())
    };
    let error = with("12345.678901").unwrap_err();
    assert!(error.starts_with("duration = 12345.678901 is refused: "), "{error}");
    let longest = error.split("between 0 and ").nth(1).unwrap().trim_end_matches(" s");
    assert!(has_few_digits(longest), "{longest}");
    assert_eq!(with(longest), Ok(()), "{longest}");
}

#[test]
fn scenes_too_large_to_compute_are_refused() {
    let long = "length = 1000.0\nlinear_density = 50.0";
    assert_scene_refused(
        "length = 0.65\nlinear_density = 5.25e-3",
        long,
        &["sample_rate = 44100", "grid points", "1e6"],
    );
    let fast = "sample_rate = 1e7\nduration = 1e4\n#";
    assert_scene_refused(
        "sample_rate = 44100\nduration = 0.01",
        fast,
        &["duration = 10000", "grid points", "1e7 Hz", "s"],
    );
    // What else counts is named, too.
    let plucks = "[[pluck]]\nduration = 0.002\nposition = 0.5\nforce = -1.0\n".repeat(999);
    let text = SCENE.replace("[[pluck]]", BODY).replace("44100", "200000") + &plucks;
    let text = text.replace("duration = 0.01", "duration = 1e5");
    let error = Simulation::new(&Scene::from_toml(&text).unwrap()).map(drop).unwrap_err().to_string();
    let words =
        ["with 1000 plucks, 1 finger, ", " modes of the body", " grid points", " at 200000 Hz it must lie "];
    assert!(words.iter().all(|words| error.contains(words)), "{error}");
    // Where all frets are on the same few points, each answers every other: two million numbers a string.
    let crowd: Vec<String> = (0..1000).map(|i| format!("{:?}", 0.2 + 1e-8 * f64::from(i))).collect();
    let more = "[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\ntension = 60.0\n".repeat(60);
    assert_scene_refused(
        "[fretboard]\nstiffness = 1e12\nexponent = 2.3\nboard = -0.002\nfrets = 3",
        &format!(
            "{more}[fretboard]\nstiffness = 1e12\nexponent = 2.3\nboard = -0.002\nfrets = [{}]",
            crowd.join(", ")
        ),
        &["number of fretboard.frets = 1000", "contacts that share grid points", "in string[", "1e8 numbers"],
    );
    // Fewer, for days.
    let frets = format!("frets = [{}]", crowd[..400].join(", "));
    let text = SCENE.replace("duration = 0.01", "duration = 1e5").replace("frets = 3", &frets);
    let error = Simulation::new(&Scene::from_toml(&text).unwrap()).map(drop).unwrap_err().to_string();
    let words = ["duration = 100000", " numbers for contacts that share some at 44100 Hz", "between 0 and "];
    assert!(words.iter().all(|words| error.contains(words)), "{error}");
    // And where the string may lie on all of them: to solve for a thousand takes a third of their cube, for weeks in 100 s. For as
    // long as is named, at 1 ns for each of its numbers, it takes hours.
    let frets = format!("frets = [{}]", crowd.join(", "));
    let text = SCENE.replace("frets = 3", &frets);
    let with = |seconds: &str| {
        let text = text.replace("duration = 0.01", &format!("duration = {seconds}"));
        Simulation::new(&Scene::from_toml(&text).unwrap()).map(drop).map_err(|error| error.to_string())
    };
    let error = with("100").unwrap_err();
    let longest = error.split("between 0 and ").nth(1).unwrap().trim_end_matches(" s");
    assert!((0.2..1.0).contains(&longest.parse().unwrap()), "{error}");
}

#[test]
fn a_trace_too_large_for_any_disk_is_refused() {
    let place = workplace();
    place.write("scene.toml", SCENE.replace("duration = 0.01", "duration = 1e5"));
    let done = place.run(&["scene", "scene.toml", "--trace", "out.npz", "--every", "2"]);
    assert_refused(&done, 1, &["--every 2", "1e12", "at least "]);
    assert_eq!(place.names(), ["scene.toml"]);
}

#[test]
fn what_is_not_a_scene_is_refused() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("loss_0 = 1.0", "losses = 1.0", &["line 8", "unknown key `losses`", "loss_0"]),
        ("loss_0 = 1.0", "loss_0 = \"none\"", &["line 8, loss_0", "\"none\"", "a number"]),
        (
            "loss_0 = 1.0",
            "loss_0 = 100000000000000000000",
            &["line 8, loss_0", "integer `100000000000000000000`, expected one of at most 18 digits"],
        ),
        ("loss_0 = 1.0", "loss_0 = 1979-05-27", &["loss_0: invalid type: date or time `1979-05-27`"]),
        ("loss_0 = 1.0", "loss_0 = ", &["line 8, loss_0"]),
        ("loss_0 = 1.0", "loss_0 = abc", &["line 8, loss_0: this is no value", "0.5 or 5e-3"]),
        ("loss_0 = 1.0", "loss_0 = 5 mm", &["line 8, loss_0: this is no value"]),
        ("loss_0 = 1.0", "loss_0 = np.float64(1.0)", &["line 8, loss_0: this is no value"]),
        ("loss_0 = 1.0", "loss_0 = infinity", &["line 8, loss_0: this is no value"]),
        ("loss_0 = 1.0", "loss_0 = 1.2.3", &["line 8, loss_0: this is no value"]),
        ("loss_0 = 1.0", "loss_0 = .5", &["line 8, loss_0: a number has digits before its point"]),
        ("loss_0 = 1.0", "loss_0 = 5.", &["line 8, loss_0: a number has digits after its point"]),
        ("loss_0 = 1.0", "loss_0 = 5e", &["line 8, loss_0: a number has digits after its e"]),
        // Not of the key before.
        ("loss_0 = 1.0", "loss_0: 1.0", &["line 8: key with no value"]),
        ("loss_0 = 1.0", "tension = 1.0", &["line 8, tension", "duplicate"]),
        ("length = 0.65\n", "", &["[[string]]", "missing key `length`"]),
        ("fret_top = -0.001\n", "", &["[fretboard]", "missing key `fret_top`", "-10 to 0 m"]),
        (
            "[[pluck]]\n",
            "[[pluck]]\nstring = -1\n",
            &["string", "`-1`", "expected a whole number, 1 or more"],
        ),
        (
            "[[finger]]\n",
            "[[finger]]\nstring = 1.0\n",
            &["string", "`1.0`", "expected a whole number, 1 or more"],
        ),
        ("[[string]]", "[string]", &["line 4, [string]", "write [[string]]"]),
        ("[fretboard]", "[[fretboard]]", &["line 9, [[fretboard]]", "write [fretboard]"]),
        ("sample_rate = 44100\n", "", &["missing key `sample_rate`"]),
        ("sample_rate", "sample_räte", &["line 2"]),
        ("duration", "[[[", &["line 3"]),
        (
            "duration = 0.01",
            "duration = 0.01\nsolver.stencil = \"better\"",
            &["`better`", "`paper`, `corrected`, `wide`"],
        ),
        (
            "duration = 0.01",
            "duration = 0.01\nsolver.stencil = 3",
            &["line 4, solver.stencil", "integer `3`", "`paper`, `corrected`, `wide`"],
        ),
        (
            "frets = 3",
            "frets = 3\nfret_placement = []",
            &["fret_placement", "list", "`exact`, `nearest`, `kinked`"],
        ),
        (
            "loss_0 = 1.0",
            "tension_modulation = 1",
            &["tension_modulation", "integer `1`", "`true` or `false`"],
        ),
        ("loss_0 = 1.0", "shape = []", &["string[1].shape = []", "at least one"]),
        ("loss_0 = 1.0", "velocity = []", &["string[1].velocity = []", "at least one"]),
        ("loss_0 = 1.0", "velocity = 1.0", &["velocity", "expected a list"]),
        ("board = -0.002", "board = [[0, -0.001, 3]]", &["line 12, board", "length 3", "pair"]),
        (
            "board = -0.002",
            "board = \"low\"",
            &["line 12, board", "a height, a list of pairs", "{ nut, middle"],
        ),
        (
            "board = -0.002",
            "board = { nut = -0.001, midle = -0.001, bridge = -0.001 }",
            &["line 12", "unknown key `midle`", "`nut`, `middle`, `bridge`"],
        ),
        ("board = -0.002", "board = { nut = -0.001, middle = -0.001 }", &["line 12, board", "key `bridge`"]),
        ("board = -0.002", "board = { nut = [], middle = 0, bridge = 0 }", &["line 12", "list", "a number"]),
        ("loss_0 = 1.0", "t60 = 10", &["line 8, t60", "integer `10`", "expected a list"]),
        ("loss_0 = 1.0", "t60 = [[100, 10]]", &["line 8, t60", "length 1", "two pairs [[frequency, time]"]),
        ("loss_0 = 1.0", "t60 = [[1, 3], [2, 2], [3, 1]]", &["line 8, t60", "length 3", "two pairs"]),
        ("loss_0 = 1.0", "t60 = [10, 5]", &["line 8, t60", "integer `10`", "expected a list"]),
        ("loss_0", "\"\\u001b[31m\\n\\u0007\"", &["line 8", "unknown key"]),
    ];
    for (from, to, words) in cases {
        assert_scene_refused(from, to, words);
    }
    let place = workplace();
    place.write("scene.toml", [0xff, 0xfe, 0x00]);
    assert_refused(&place.run(&["scene", "scene.toml"]), 1, &["scene.toml", "UTF-8"]);
    place.write("scene.toml", vec![b'#'; (16 << 20) + 1]);
    assert_refused(&place.run(&["scene", "scene.toml"]), 1, &["scene.toml", "16 MiB"]);
    let deep = "[".repeat(100_000);
    place.write("scene.toml", format!("sample_rate = {deep}"));
    assert_refused(&place.run(&["scene", "scene.toml"]), 1, &["scene.toml", "line 1"]);
    place.write("scene.toml", format!("{} = 1", "a".repeat(100_000)));
    assert_refused(&place.run(&["scene", "scene.toml"]), 1, &["scene.toml", "unknown key"]);
    assert_refused(&place.run_with(&["scene", "-"], b"nothing"), 1, &["standard input", "line 1"]);
}

#[test]
fn files_that_cannot_be_read_are_refused() {
    let place = workplace();
    assert_refused(&place.run(&["scene", "none.toml"]), 1, &["cannot read none.toml"]);
    assert_refused(&place.run(&["scene", "."]), 1, &["cannot read ."]);
    if has_device("/dev/zero") {
        assert_refused(&place.run(&["scene", "/dev/zero"]), 1, &["/dev/zero", "16 MiB"]);
    }
}

#[test]
fn places_that_cannot_be_written_are_refused() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    place.write("file", "kept");
    std::fs::create_dir(place.path("folder")).unwrap();
    let before = place.names();
    for option in ["--wav", "--trace"] {
        for target in ["folder", "file/out", "none/out"] {
            let done = place.run(&["scene", "scene.toml", option, target]);
            assert_refused(&done, 1, &["cannot write", target]);
            assert_eq!(place.names(), before, "{option} {target}");
        }
        if has_device("/dev/full") {
            let done = place.run(&["scene", "scene.toml", option, "/dev/full"]);
            assert_eq!(done.code, 1, "{}", done.error);
            assert_refused(&done, 1, &["cannot write", "/dev/full"]);
            assert_eq!(place.names(), before);
        }
    }
    assert_eq!(std::fs::read(place.path("file")).unwrap(), b"kept");
}

#[test]
fn a_result_that_cannot_be_begun_leaves_the_other_as_it_was() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    place.write("out.wav", "old");
    let done = place.run(&["scene", "scene.toml", "--wav", "out.wav", "--trace", "none/out.npz"]);
    assert_refused(&done, 1, &["none/out.npz"]);
    assert_eq!(std::fs::read(place.path("out.wav")).unwrap(), b"old");
    assert_eq!(place.names(), ["out.wav", "scene.toml"]);
}

/// Whichever it is that fails, and only as it appears.
#[test]
fn a_result_that_a_device_does_not_take_leaves_no_other() {
    if !has_device("/dev/full") {
        return;
    }
    let place = workplace();
    place.write("scene.toml", SCENE);
    place.write("out.npz", "old");
    let options = [("--wav", "out.wav"), ("--trace", "out.npz"), ("--figure", "out.svg")];
    for full in 0..options.len() {
        let written = options
            .iter()
            .enumerate()
            .flat_map(|(index, &(option, path))| [option, if index == full { "/dev/full" } else { path }]);
        let done = place.run(&["scene", "scene.toml"].into_iter().chain(written).collect::<Vec<_>>());
        assert_refused(&done, 1, &["cannot write /dev/full"]);
        assert_eq!(place.names(), ["out.npz", "scene.toml"], "{} to a full device", options[full].0);
        assert_eq!(std::fs::read(place.path("out.npz")).unwrap(), b"old");
    }
}

#[test]
fn what_a_wav_file_cannot_hold_is_refused() {
    let place = workplace();
    place.write("scene.toml", SCENE.replace("44100", "44100.5"));
    let done = place.run(&["scene", "scene.toml", "--wav", "out.wav"]);
    assert_refused(&done, 1, &["error: scene.toml: sample_rate = 44100.5", "--wav", "whole number"]);
    place.write("scene.toml", SCENE.replace("duration = 0.01", "duration = 90000"));
    let done = place.run(&["scene", "scene.toml", "--wav", "out.wav"]);
    assert_refused(&done, 1, &["error: scene.toml: duration = 90000", "--wav", "at most"]);
    assert_eq!(place.names(), ["scene.toml"]);
}

/// What `--every` accepts.
const EVERY: &str = "a whole number from 1 to 18446744073709551615";

#[test]
fn wrong_usage_is_told_apart() {
    let place = workplace();
    place.write("scene.toml", SCENE);
    let cases: &[(&[&str], &[&str])] = &[
        (&["scene"], &["FILE", "(see low-action scene --help)"]),
        (
            &["scene", "scene.toml", "--wave", "x"],
            &["'--wave' found; tip: a similar argument exists: '--wav' (see low-action scene --help)"],
        ),
        (
            &["scene", "scene.toml", "--trace", "x.npz", "--every", "0"],
            &["'0' for '--every <N>': must be", EVERY],
        ),
        (&["scene", "scene.toml", "--trace", "x.npz", "--every", "-1"], &["'-1' for '--every <N>'", EVERY]),
        (&["scene", "scene.toml", "--trace", "x.npz", "--every", "-.5"], &["'-.5' for '--every <N>'", EVERY]),
        (
            &["scene", "scene.toml", "--trace", "x.npz", "--every", "some"],
            &["'some' for '--every <N>'", EVERY],
        ),
        (&["scene", "scene.toml", "--every", "2"], &["--trace"]),
        (&["scene", "scene.toml", "--wav", "x", "--trace", "x"], &["--wav", "--trace", "same file"]),
        (&["scene", "scene.toml", "--wav", "x.flac"], &["--wav x.flac is refused", "writes WAV"]),
        (&["scene", "scene.toml", "--figure", "x.png"], &["--figure x.png is refused", "writes SVG", ".png"]),
        (&["scene", "scene.toml", "--figure", "x.PDF"], &["--figure x.PDF is refused", "writes SVG", ".pdf"]),
        (&["scene", "scene.toml", "--trace", "x.npy"], &["--trace x.npy is refused", "writes NPZ", ".npy"]),
        (&["scene", "scene.toml", "--wav", "-", "--trace", "-"], &["--wav", "--trace", "same file"]),
        (&["scene", "scene.toml", "--wav", "./scene.toml"], &["the scene", "--wav", "same file"]),
        (&["scene", "scene.toml", "--wav", "x", "--trace", "./x"], &["--wav", "--trace", "same file"]),
    ];
    for (arguments, words) in cases {
        assert_refused(&place.run(arguments), 2, words);
        assert_eq!(place.names(), ["scene.toml"], "{arguments:?}");
    }
}

/// Parts that do nothing are allowed, and more often a slip of a unit.
#[test]
fn what_does_nothing_is_warned_of() {
    let place = workplace();
    let board = "board = -0.002\nfrets = 3\nfret_top = -0.001\n";
    for (old, new, warning) in [
        (board, "", "fretboard has neither board nor frets under any string"),
        (
            board,
            "board = [[0.7, -0.001], [0.8, -0.001]]\n",
            "fretboard has neither board nor frets under any string",
        ),
        (
            "fret_top = -0.001",
            "fret_top = -0.003",
            "fretboard.fret_top = -0.003 m is below the board, -0.002 m, at fret 1 of string[1], and 2 more are: the string",
        ),
        (
            "frets = 3\nfret_top = -0.001",
            "frets = 3\nfret_top = [-0.001, -0.002, -0.0021]",
            "fretboard.fret_top = -0.0021 m is below the board, -0.002 m, at fret 3 of string[1]: the string",
        ),
        (
            "loss_0 = 1.0",
            "loss_0 = 1.0\ntension_modulation = true",
            "string[1].tension_modulation = true does nothing without youngs_modulus and core_radius",
        ),
        (
            "loss_0 = 1.0",
            "loss_0 = 1.0\nyoungs_modulus = 2e11\ntension_modulation = true",
            "string[1].youngs_modulus = 2e11 does nothing without core_radius: stretching does not raise the tension",
        ),
        (
            "loss_0 = 1.0",
            "loss_0 = 1.0\ncore_radius = 4.3e-4",
            "string[1].core_radius = 4.3e-4 does nothing without youngs_modulus\n",
        ),
        ("duration = 0.01", "duration = 1e-6", "duration = 1e-6 s has no sample at 44100 Hz"),
        ("duration = 0.002", "duration = 0.0", "pluck[1] pushes nothing: force -1 N for 0 s"),
        ("force = -1.0", "force = 0.0", "pluck[1] pushes nothing: force 0 N for 0.002 s"),
        (
            "[[pluck]]",
            "[[pluck]]\nstart = 0.01",
            "pluck[1] begins at 0.01 s, when the scene of 0.01 s is over",
        ),
    ] {
        assert!(SCENE.contains(old), "{old}");
        place.write("scene.toml", SCENE.replacen(old, new, 1));
        let done = place.run(&["scene", "scene.toml"]);
        assert_eq!(done.code, 0, "{}", done.error);
        assert!(done.error.starts_with(&format!("warning: scene.toml: {warning}")), "{new}: {}", done.error);
    }
    // Nor does anything else push then.
    let still = "[[pluck]]\nduration = 0.002\nposition = 0.5\nforce = -1.0\n";
    let motionless = "warning: scene.toml: nothing sets it in motion: ";
    for (old, new, is_told) in [
        (still, "", true),
        ("force = -1.0", "force = 0.0", true),
        (
            still,
            "[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\nposition = 0.3\nforce = 0.1\n",
            false,
        ),
        (
            still,
            "[[finger]]\nmass = 5e-3\nstiffness = 1e8\nexponent = 2.0\nposition = 0.3\nvelocity = -0.1\n",
            false,
        ),
        ("force = -1.0", "force = 1.0", false),
    ] {
        assert!(SCENE.contains(old), "{old}");
        place.write("scene.toml", SCENE.replacen(old, new, 1));
        let done = place.run(&["scene", "scene.toml", "--wav", "out.wav"]);
        assert_eq!((done.code, done.error.contains(motionless)), (0, is_told), "{new}: {}", done.error);
        assert_eq!(done.text().contains("at most 0.0000 N"), is_told, "{}", done.text());
    }
    for shape in ["shape = [[0, 0], [0.3, 1e-6], [0.65, 0]]", "velocity = [[0.3, 1e-6]]"] {
        let begun =
            SCENE.replacen(still, "", 1).replacen("loss_0 = 1.0", &format!("loss_0 = 1.0\n{shape}"), 1);
        place.write("scene.toml", begun);
        let done = place.run(&["scene", "scene.toml", "--wav", "out.wav"]);
        assert_eq!((done.code, done.error.as_str()), (0, ""));
        // However little it is, it is something.
        assert!(!done.text().contains("at most 0.0000"), "{}", done.text());
    }
    // One that only lets go pushes.
    let released = SCENE.replacen("duration = 0.002", "duration = 0.0\nrelease = 0.002", 1);
    for scene in [SCENE, &released] {
        place.write("scene.toml", scene);
        let done = place.run(&["scene", "scene.toml"]);
        assert!(done.code == 0 && !done.error.contains("warning"), "{}", done.error);
    }
}

/// A finger of a tonne that a hand drags to and fro over a taut string, with its full force: what flows through that is known to no
/// digit, and a check that lets all of it pass says so.
const DRAGGED: &str = "youngs_modulus = 2e11
core_radius = 4.3e-4
tension_modulation = true
[fretboard]
stiffness = 1e13
exponent = 1.0
damping = 1e5
board = -0.0001
[[finger]]
mass = 1e3
stiffness = 1e9
exponent = 5.0
damping = 1e5
position = [[0.0, 0.3], [0.001, 0.6], [0.002, 0.01], [0.01, 0.64]]
height = 0.0
velocity = -1000.0
force = 1e6
";

#[test]
fn a_balance_that_rounding_leaves_unchecked_is_warned_of() {
    let place = workplace();
    let (string, _) = SCENE.split_once("[fretboard]").unwrap();
    place.write("scene.toml", string.to_owned() + DRAGGED);
    let done = place.run(&["scene", "scene.toml"]);
    assert_eq!(done.code, 0, "{}", done.error);
    let warning = "warning: scene.toml: the energy balance of string 1 is checked only to ";
    // (It is stretched far beyond its grid, too.)
    let told: Vec<&str> = done.error.lines().filter(|line| !line.contains("stretching brings")).collect();
    assert!(told.len() == 1 && told[0].starts_with(warning), "{}", done.error);
    assert!(told[0].contains("rounding"), "{}", done.error);
    // Where nothing is measured nothing is checked.
    let done = place.run(&["scene", "scene.toml", "--wav", "out.wav"]);
    assert_eq!((done.code, done.error.contains("balance")), (0, false), "{}", done.error);
}
