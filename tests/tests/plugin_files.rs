//! Promise: a user's own set-up file is an instrument of the plugin: chosen by its number, kept whole in the session,
//! so that a project sounds the same where the file is another or missing; and where there is nothing to play, the
//! instrument that comes with the program is, and hosts show why.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use clack_extensions::params::{ParamInfoFlags, PluginParams};
use clack_host::prelude::ClapId;
use low_action::engine::{Engine, EngineOptions, Quality};
use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;
use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::session::{packed, unpacked};
use low_action_tests::user::isolate;
use serde_json::{Value, json};

const RATE: f64 = 48_000.0;
const LENGTH: usize = 12_000;

/// An electric guitar two semitones lower.
const LOWER: &str = "name = \"lower\"\nbased_on = \"electric\"\ntuning = -2.0\n";
/// One with eight strings, the lowest a B1 and an F♯1 tuned like the E2 before it.
fn eight() -> String {
    let below =
        [("B1", 35, 1.1e-2, 2.3e-4), ("F1", 30, 1.9e-2, 2.6e-4)].map(|(name, pitch, density, radius)| {
            format!(
                "[[string]]
            name = \"{name}\"
            pitch = {pitch}.0
            linear_density = {density}
            youngs_modulus = 2e11
            core_radius = {radius}
            loss_0 = 0.5
            loss_1 = 1e-4
            "
            )
        });
    let above = "[[string]]\n".repeat(6);
    format!("name = \"eight\"\nbased_on = \"electric\"\n{above}{}", below.concat())
}

/// Numbers of the files, which are those of their names in order.
const BROKEN_FILE: f64 = 1.0;
const EIGHT_FILE: f64 = 2.0;
const LOWER_FILE: f64 = 3.0;
const NO_FILE: f64 = 17.0;

/// The folder of the user this test is. All tests share it, and none changes what another needs.
fn folder() -> &'static Path {
    static FOLDER: OnceLock<&Path> = OnceLock::new();
    FOLDER.get_or_init(|| {
        let folder = isolate();
        for (name, text) in [
            ("lower.toml", LOWER),
            ("eight.toml", &eight()),
            ("broken.toml", "name = \"broken\"\nbased_on = \"electric\"\n[neck]\naction = 9.0\n"),
            ("notes.txt", "no set-up"),
        ] {
            fs::write(folder.join(name), text).expect("it can be written");
        }
        folder
    })
}

fn score() -> Score {
    vec![
        (100, Action::NoteOn { channel: 0, key: 48, velocity: 100 }),
        (2000, Action::NoteOn { channel: 0, key: 59, velocity: 80 }),
    ]
}

fn host() -> Host {
    folder();
    Host::new()
}

fn choose(host: &mut Host, values: &[(&str, f64)]) {
    let values = values.iter().map(|&(id, value)| (0, Action::Parameter(parameter(id), value))).collect();
    host.play(RATE, &values, 64, &[64]);
}

fn sound(host: &mut Host) -> Vec<f32> {
    let [left, _] = host.play(RATE, &score(), LENGTH, &[512]);
    assert!(left.iter().any(|&sample| sample != 0.0));
    left
}

/// What an engine plays that is built from a file's text, with a change of it.
fn expected(text: &str, change: impl Fn(&mut Setup)) -> Vec<f32> {
    played(text, change, score())
}

/// The same of other notes.
fn played(text: &str, change: impl Fn(&mut Setup), score: Score) -> Vec<f32> {
    let mut setup = Setup::from_toml(text).expect("it is a set-up");
    change(&mut setup);
    let mut engine = Engine::new(&offline(setup)).expect("it can be built");
    for (at, action) in score {
        let Action::NoteOn { channel, key, velocity } = action else { panic!("only notes") };
        engine.event(at as u32, PlayerEvent::NoteOn { channel, key, velocity: f32::from(velocity) / 127.0 });
    }
    let (mut left, mut right) = (vec![0.0; LENGTH], vec![0.0; LENGTH]);
    engine.process(&mut left, &mut right);
    left
}

/// The text a host shows for a value of the parameter.
fn shown(host: &mut Host, value: f64) -> String {
    let handle = host.handle();
    let params = handle.get_extension::<PluginParams>().expect("it has parameters");
    let mut text = [0; 512];
    let id = ClapId::new(parameter("instrument_file"));
    let text = params.value_to_text(&handle, id, value, &mut text).expect("it has a text");
    String::from_utf8_lossy(text).into_owned()
}

/// What an engine is built from for a host that renders offline.
fn offline(setup: Setup) -> EngineOptions {
    EngineOptions { quality: Quality::Studio, ..EngineOptions::new(setup, RATE) }
}

#[test]
fn a_file_is_played_by_its_number() {
    let mut host = host();
    let usual = sound(&mut host);
    choose(&mut host, &[("instrument_file", LOWER_FILE)]);
    let lower = sound(&mut host);
    assert!(lower == expected(LOWER, |_| ()) && lower != usual);
    // What a luthier does is done to it.
    choose(&mut host, &[("action", 1.0)]);
    let high = expected(LOWER, |setup| {
        setup.neck.action *= 3.0;
        setup.neck.nut_clearance *= 3.0;
    });
    assert!(sound(&mut host) == high);
    choose(&mut host, &[("action", 0.5), ("instrument_file", 0.0)]);
    assert!(sound(&mut host) == usual);
    // Under a ringing string, at the sample of its choice.
    let mut score = score();
    score.push((6000, Action::Parameter(parameter("instrument_file"), LOWER_FILE)));
    let changed = [64, 4096].map(|block| self::host().play(RATE, &score, LENGTH, &[block]));
    assert!(changed[0] == changed[1] && changed[0][0][..6000] == usual[..6000] && changed[0][0] != usual);
}

#[test]
fn eight_strings_can_be_tuned() {
    for (id, string) in [("string_tuning_7", 6), ("string_tuning_8", 7)] {
        for (end, semitones) in [(0.0, -12.0), (1.0, 7.0)] {
            let mut host = host();
            choose(&mut host, &[("instrument_file", EIGHT_FILE), (id, end)]);
            let mut low = score();
            low.push((3000, Action::NoteOn { channel: 0, key: 31, velocity: 100 }));
            let [found, _] = host.play(RATE, &low, LENGTH, &[512]);
            let retuned = played(&eight(), |setup| setup.string[string].pitch += semitones, low);
            assert!(found == retuned, "{id} at {end}");
        }
    }
}

#[test]
fn hosts_show_the_names_of_files() {
    let mut host = host();
    assert_eq!(shown(&mut host, 0.0), "none");
    assert_eq!(shown(&mut host, LOWER_FILE), "3: lower");
    assert_eq!(shown(&mut host, NO_FILE), "17: no such file");
    let handle = host.handle();
    let params = handle.get_extension::<PluginParams>().expect("it has parameters");
    let id = ClapId::new(parameter("instrument_file"));
    for (text, value) in [(c"lower", 3.0), (c"3: lower", 3.0), (c"17: no such file", 17.0), (c"none", 0.0)] {
        assert_eq!(params.text_to_value(&handle, id, text), Some(value), "{text:?}");
    }
    // Numbers mean other files elsewhere: nothing should move them by itself.
    let mut buffer = clack_extensions::params::ParamInfoBuffer::new();
    let info = (0..params.count(&handle))
        .find_map(|index| {
            params.get_info(&handle, index, &mut buffer).filter(|info| info.id == id).map(|i| i.flags)
        })
        .expect("it is there");
    assert!(!info.contains(ParamInfoFlags::IS_AUTOMATABLE));
}

#[test]
fn what_cannot_be_played_falls_back_and_says_so() {
    let usual = sound(&mut host());
    let mut bass = host();
    choose(&mut bass, &[("instrument", 3.0)]);
    let bass_sound = sound(&mut bass);
    for (number, words) in [(BROKEN_FILE, ["broken", "neck.action"]), (NO_FILE, ["17", "no set-up file"])] {
        let mut host = host();
        choose(&mut host, &[("instrument_file", number)]);
        assert!(sound(&mut host) == usual);
        let text = shown(&mut host, number);
        assert!(words.iter().all(|word| text.contains(word)), "{text}");
        assert!(text.contains("electric is played instead"), "{text}");
        choose(&mut host, &[("instrument", 3.0)]);
        assert!(sound(&mut host) == bass_sound);
        // All is well again.
        choose(&mut host, &[("instrument_file", LOWER_FILE)]);
        assert!(sound(&mut host) == expected(LOWER, |_| ()));
        assert_eq!(shown(&mut host, LOWER_FILE), "3: lower");
    }
}

#[test]
fn a_session_keeps_its_file() {
    let mut one = host();
    choose(&mut one, &[("instrument_file", LOWER_FILE)]);
    let lower = sound(&mut one);
    let saved = one.save();
    // As if on a machine where the file has another number, or is another, or is not there.
    let mut state = unpacked(&saved);
    for number in [1, 2, 40] {
        let kept = json!({ "number": number, "name": "lower", "text": LOWER });
        assert_ne!(state["fields"]["instrument_file"], json!("null"));
        state["params"]["instrument_file"]["i32"] = json!(number);
        state["fields"]["instrument_file"] = Value::String(kept.to_string());
        let mut other = host();
        assert!(other.load(&packed(&state)));
        assert!(sound(&mut other) == lower, "as number {number}");
        assert_eq!(shown(&mut other, f64::from(number)), format!("{number}: lower"));
        let again = unpacked(&other.save());
        let field = |state: &Value| -> Value {
            serde_json::from_str(state["fields"]["instrument_file"].as_str().expect("a text")).expect("JSON")
        };
        assert_eq!((field(&again), &again["params"]), (kept, &state["params"]));
        // Whoever chooses another file means the one in the folder, from then on for this number, too.
        choose(&mut other, &[("instrument_file", 0.0)]);
        choose(&mut other, &[("instrument_file", f64::from(number))]);
        assert_ne!(shown(&mut other, f64::from(number)), format!("{number}: lower"));
    }
    // A session that never had its file says which one it misses.
    let mut broken = host();
    choose(&mut broken, &[("instrument_file", NO_FILE)]);
    let saved = broken.save();
    let mut other = host();
    assert!(other.load(&saved));
    sound(&mut other);
    assert!(shown(&mut other, NO_FILE).contains("no such file"), "{}", shown(&mut other, NO_FILE));
    // A kept file that is damaged is no state.
    let before = unpacked(&one.save());
    let mut damaged = before.clone();
    damaged["fields"]["instrument_file"] = json!("{\"number\":");
    damaged["params"]["action"]["f32"] = json!(2.0);
    one.load(&packed(&damaged));
    assert_eq!(unpacked(&one.save()), before);
    // A session without a file takes none over.
    let usual = unpacked(&host().save());
    assert!(one.load(&packed(&usual)));
    assert_eq!(unpacked(&one.save()), usual);
}

#[test]
fn a_file_that_has_changed_since_is_kept_as_it_was() {
    let path = folder().join("zither.toml");
    fs::write(&path, LOWER).expect("it can be written");
    let mut host = host();
    let number = 4.0;
    choose(&mut host, &[("instrument_file", number)]);
    let lower = sound(&mut host);
    fs::write(&path, LOWER.replace("-2.0", "-5.0")).expect("it can be written");
    assert!(sound(&mut host) == lower);
    let saved = host.save();
    fs::remove_file(&path).expect("it was there");
    let mut other = Host::new();
    assert!(other.load(&saved));
    assert!(sound(&mut other) == lower);
}
