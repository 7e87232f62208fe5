//! Promise: a session comes back as it was left, at any sample rate; a state that is damaged, newer than the
//! program or somebody else's changes nothing; and no host breaks the plugin by what it asks for.

use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::numbers::{largest, rms};
use low_action_tests::session::{packed, unpacked};
use low_action_tests::stage::peak;
use serde_json::{Value, json};

const RATE: f64 = 48_000.0;

fn score() -> Score {
    vec![
        (100, Action::NoteOn { channel: 0, key: 48, velocity: 100 }),
        (4000, Action::NoteOn { channel: 0, key: 59, velocity: 80 }),
        (9000, Action::NoteOff { channel: 0, key: 48 }),
    ]
}

fn set(values: &[(&str, f64)]) -> Score {
    values.iter().map(|&(id, value)| (0, Action::Parameter(parameter(id), value))).collect()
}

/// A host in whose plugin much has been changed.
fn changed() -> Host {
    let mut host = Host::new();
    let values = [("instrument", 7.0), ("action", 0.8), ("pluck_position", 0.1), ("string_tuning_6", 0.2)];
    host.play(RATE, &set(&values), 64, &[64]);
    host
}

fn sound(host: &mut Host) -> Vec<f32> {
    let [left, _] = host.play(RATE, &score(), 12_000, &[512]);
    assert!(left.iter().any(|&sample| sample != 0.0));
    left
}

#[test]
fn a_session_comes_back() {
    let mut host = changed();
    let saved = host.save();
    let mut other = Host::new();
    assert_ne!(sound(&mut other), sound(&mut host));
    assert!(other.load(&saved));
    assert_eq!(sound(&mut other), sound(&mut host));
    assert_eq!(unpacked(&other.save()), unpacked(&saved));
    // Other rates in between change nothing that is saved.
    for rate in [44_100.0, 192_000.0] {
        other.play(rate, &score(), 1000, &[256]);
        assert_eq!(unpacked(&other.save()), unpacked(&saved), "after {rate} Hz");
    }
    assert_eq!(sound(&mut other), sound(&mut host));
}

#[test]
fn a_running_plugin_takes_a_session_in() {
    let saved = changed().save();
    let mut host = Host::new();
    host.play(RATE, &score(), 1000, &[256]);
    assert!(host.load(&saved));
    assert_eq!(sound(&mut host), sound(&mut changed()));
}

#[test]
fn what_cannot_be_read_changes_nothing() {
    let mut host = changed();
    let saved = host.save();
    let before = unpacked(&saved);
    let with_mark = |mark: &str| {
        let mut state = unpacked(&Host::new().save());
        state["fields"]["state"] = Value::String(mark.into());
        packed(&state)
    };
    let truncated = saved[..saved.len() - 20].to_vec();
    let mut scrambled = saved.clone();
    scrambled[60..90].fill(b'#');
    let mut endless = saved.clone();
    endless[..8].fill(0xFF);
    let foreign = json!({ "version": "2.1", "params": { "gain": { "f32": 0.5 } }, "fields": {} });
    // The host is told, and does not save over what it has.
    for (what, bytes) in [
        ("nothing", Vec::new()),
        ("a truncated state", truncated),
        ("a scrambled state", scrambled),
        ("an endless length", endless),
        ("random bytes", (0..200_u8).map(|n| n.wrapping_mul(73)).collect()),
        ("another plugin's state", packed(&foreign)),
        ("a newer form", with_mark(r#"{"owner":"low-action","version":99}"#)),
        ("somebody else's mark", with_mark(r#"{"owner":"high-action","version":1}"#)),
        ("an unreadable mark", with_mark("[]")),
    ] {
        assert!(!host.load(&bytes), "{what}");
        assert_eq!(unpacked(&host.save()), before, "{what} was taken in");
    }
    assert!(host.load(&saved), "what was refused before has nothing to do with it");
}

#[test]
fn the_first_form_is_brought_up_to_date() {
    let old = json!({
        "version": "0.1.0",
        "params": { "instrument": { "string": "bass" }, "variation": { "f32": 0.0 }, "level": { "f32": -6.0 } },
        "fields": {},
    });
    let mut host = Host::new();
    assert!(host.load(&packed(&old)));
    let now = unpacked(&host.save());
    assert_eq!(now["params"]["instrument"]["string"], "bass");
    assert_eq!(now["params"]["level"]["f32"], -6.0);
    assert_eq!(now["params"]["action"]["f32"], 1.0);
}

#[test]
fn the_second_form_says_the_same_in_other_words() {
    let mut state = unpacked(&Host::new().save());
    state["fields"]["state"] = json!(r#"{"owner":"low-action","version":1}"#);
    let params = state["params"].as_object_mut().expect("there are parameters");
    params.insert("input_mode".into(), json!({ "string": "strings_11" }));
    params.remove("first_channel");
    params.remove("pluck_force");
    // What was set before the state came has no place in it.
    let mut host = Host::new();
    host.play(RATE, &set(&[("first_channel", 4.0), ("pluck_force", 0.9)]), 64, &[64]);
    assert!(host.load(&packed(&state)));
    let now = unpacked(&host.save());
    assert_eq!(now["params"]["input_mode"]["string"], "strings");
    assert_eq!(now["params"]["first_channel"]["i32"], 11);
    assert_eq!(now["params"]["pluck_force"]["f32"], 1.0);
}

#[test]
fn numbers_out_of_range_are_brought_back() {
    let mut state = unpacked(&Host::new().save());
    state["params"]["action"]["f32"] = json!(1e30);
    state["params"]["iterations"]["i32"] = json!(-7);
    state["params"]["instrument"]["string"] = json!("theremin");
    let mut host = Host::new();
    assert!(host.load(&packed(&state)));
    let now = unpacked(&host.save());
    assert_eq!(now["params"]["action"]["f32"], 3.0);
    assert_eq!(now["params"]["iterations"]["i32"], 0);
    assert_eq!(now["params"]["instrument"]["string"], "electric");
    sound(&mut host);
}

#[test]
fn what_a_parameter_cannot_be_becomes_the_usual() {
    let mut state = unpacked(&Host::new().save());
    for (id, value) in [
        ("quality", json!({ "string": "ultra" })),
        ("legato", json!({ "i32": 99 })),
        ("tension_modulation", json!({ "f32": 0.0 })),
        ("action", json!({ "string": "high" })),
        ("iterations", json!({ "bool": true })),
    ] {
        state["params"][id] = value;
    }
    // What was set before has no place in it.
    let mut host = Host::new();
    let before = [("quality", 3.0), ("legato", 1.0), ("action", 0.8), ("iterations", 9.0)];
    host.play(RATE, &set(&before), 64, &[64]);
    host.play(RATE, &set(&[("tension_modulation", 0.0)]), 64, &[64]);
    assert!(host.load(&packed(&state)));
    assert_eq!(unpacked(&host.save())["params"], unpacked(&Host::new().save())["params"]);
}

#[test]
fn every_rate_and_block_size_plays() {
    for rate in [8000.0, 22_050.0, 44_100.0, 96_000.0, 384_000.0] {
        for block in [1, 8192] {
            let length = (0.05 * rate) as usize;
            let notes = vec![(0, Action::NoteOn { channel: 0, key: 52, velocity: 100 })];
            let [left, _] = Host::new().play(rate, &notes, length, &[block]);
            assert!(left.iter().all(|sample| sample.is_finite()));
            assert!(left.iter().any(|&sample| sample != 0.0), "silent at {rate} Hz, blocks of {block}");
        }
    }
}

#[test]
fn other_rates_are_silent() {
    for rate in [1000.0, 7999.0, 768_000.0] {
        let [left, right] = Host::new().play(rate, &score(), 12_000, &[512]);
        assert!(left.iter().chain(&right).all(|&sample| sample == 0.0));
    }
}

#[test]
fn instances_do_not_hear_each_other() {
    let (mut one, mut two) = (Host::new(), changed());
    let (first, second) = (sound(&mut one), sound(&mut two));
    // Interleaved, and with the other gone.
    assert_eq!(sound(&mut two), second);
    assert_eq!(sound(&mut one), first);
    drop(two);
    one.play(RATE, &set(&[("action", 0.9)]), 64, &[64]);
    assert_ne!(sound(&mut one), first);
}

#[test]
fn activating_again_and_again_is_harmless() {
    let mut host = Host::new();
    let first = sound(&mut host);
    for round in 0..20 {
        host.play([RATE, 44_100.0][round % 2], &Score::new(), 64, &[64]);
    }
    assert_eq!(sound(&mut host), first);
}

#[test]
fn hostile_events_do_no_harm() {
    use clack_host::events::event_types::NoteExpressionType;
    let mut score = Score::new();
    // Ten thousand a block, of every kind, in the host's order of time.
    for step in 0..10_000_u64 {
        let (n, at) = (step as u8, step / 40);
        let wild = [f64::NAN, f64::INFINITY, -1e300, 0.5, 1e9][step as usize % 5];
        score.push((
            at,
            match step % 9 {
                0 => Action::NoteOn { channel: n % 16, key: n % 128, velocity: n % 128 },
                1 => Action::NoteOff { channel: n % 16, key: n % 128 },
                2 => Action::Parameter(step as u32 * 7919, wild),
                3 => Action::Parameter(parameter("pluck_force"), wild),
                4 => Action::Midi([0x80 | (n & 0x7F), n & 127, (n / 2) & 127]),
                5 => {
                    let what = NoteExpressionType::Tuning;
                    Action::Express { what, channel: n % 16, key: n % 128, value: wild }
                }
                6 => {
                    let what = NoteExpressionType::Pressure;
                    Action::Express { what, channel: n % 16, key: n % 128, value: wild }
                }
                7 => Action::Modulate { parameter: parameter("finger_force"), key: n % 128, amount: wild },
                _ => Action::Transport(n % 2 == 0),
            },
        ));
    }
    let mut host = Host::new();
    let [left, right] = host.play(RATE, &score, 4096, &[256]);
    // The gain of a set-up leaves room for a full chord of its hardest plucks, and no parameter makes them more than five times
    // as hard.
    assert!(largest([peak(&left), peak(&right)]) <= 5.0, "{} and {}", peak(&left), peak(&right));
    // Activated anew it plays as if nothing had been, but for the parameter that was set.
    host.play(RATE, &set(&[("pluck_force", 0.5)]), 64, &[64]);
    assert!(sound(&mut host) == sound(&mut Host::new()));
}

#[test]
fn everything_stops_with_the_transport() {
    let mut score = vec![(0, Action::Transport(true)), (1, Action::Midi([0xB0, 64, 127]))];
    score.push((10, Action::NoteOn { channel: 0, key: 45, velocity: 100 }));
    score.push((12_000, Action::Transport(false)));
    let [left, _] = Host::new().play(RATE, &score, 36_000, &[256]);
    assert!(rms(&left[30_000..]) < 0.01 * rms(&left[8_000..12_000]));
}
