//! Promise: what is set is kept and saved, whatever a host adds to it for the moment, also where the sum is the same as before:
//! at the end of a range, and on the same step.

use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::session::unpacked;
use serde_json::Value;

const RATE: f64 = 48_000.0;

/// Identifiers, what is set first, what is added so that the sum is beyond the end, and what is set under it: a number without
/// steps, one with, a choice and a switch.
const CASES: [(&str, f64, f64, f64); 5] = [
    ("pluck_force", 0.5, 1.0, 0.25),
    ("level", 0.8, -1.0, 0.6),
    ("bend_range", 2.0, 96.0, 12.0),
    ("input_mode", 0.0, 3.0, 2.0),
    ("ignore_rpn", 0.0, 1.0, 1.0),
];

fn set(id: &str, value: f64) -> Action {
    Action::Parameter(parameter(id), value)
}

fn add(id: &str, amount: f64) -> Action {
    Action::ModulateAll { parameter: parameter(id), amount }
}

fn saved(host: &mut Host) -> Value {
    unpacked(&host.save())["params"].clone()
}

fn play(host: &mut Host, score: &Score) {
    host.play(RATE, score, 256, &[128]);
}

/// A host where nothing was ever added.
fn plain(values: &[(&str, f64)]) -> Host {
    let mut host = Host::new();
    play(&mut host, &values.iter().map(|&(id, value)| (0, set(id, value))).collect());
    host
}

#[test]
fn what_is_set_under_what_is_added_is_saved() {
    for (id, first, amount, then) in CASES {
        let expected = saved(&mut plain(&[(id, then)]));
        assert!(expected != saved(&mut plain(&[(id, first)])), "{id} is the same anyway");
        // In one block after the other, at one sample, and at those of one block.
        for [added, under, gone] in [[0, 0, 0], [0, 128, 200], [16, 32, 48], [3, 140, 160]] {
            let mut host = plain(&[(id, first)]);
            play(&mut host, &vec![(added, add(id, amount)), (under, set(id, then))]);
            assert_eq!(saved(&mut host), expected, "{id}, set at {under}, while it is there");
            play(&mut host, &vec![(gone, add(id, 0.0))]);
            assert_eq!(saved(&mut host), expected, "{id}, set at {under}");
            assert_eq!(host.value(parameter(id)), plain(&[(id, then)]).value(parameter(id)), "{id}");
            let mut host = plain(&[(id, first)]);
            play(&mut host, &vec![(added, add(id, amount)), (under, set(id, then)), (gone, add(id, 0.0))]);
            assert_eq!(saved(&mut host), expected, "{id}, set at {under}, all in one performance");
        }
    }
}

#[test]
fn what_is_set_between_performances_is_saved() {
    for (id, first, amount, then) in CASES {
        let mut host = plain(&[(id, first)]);
        host.flush(&[add(id, amount), set(id, then)]);
        host.flush(&[add(id, 0.0)]);
        assert_eq!(saved(&mut host), saved(&mut plain(&[(id, then)])), "{id}");
    }
}

#[test]
fn a_session_is_loaded_under_what_is_added() {
    let values = CASES.map(|(id, _, _, then)| (id, then));
    let session = plain(&values).save();
    let mut host = plain(&CASES.map(|(id, first, ..)| (id, first)));
    play(&mut host, &CASES.iter().map(|&(id, _, amount, _)| (0, add(id, amount))).collect());
    assert!(host.load(&session));
    assert_eq!(unpacked(&host.save()), unpacked(&session), "while it is there");
    play(&mut host, &CASES.iter().map(|&(id, ..)| (0, add(id, 0.0))).collect());
    assert_eq!(unpacked(&host.save()), unpacked(&session));
}

/// By bits: what is heard is the sum, at every sample.
#[test]
fn what_is_added_sounds_on_over_what_is_set() {
    let note = (0, Action::NoteOn { channel: 0, key: 45, velocity: 100 });
    let again = (3000, Action::NoteOn { channel: 0, key: 57, velocity: 100 });
    let sound = |score: Score| Host::new().play(RATE, &[score, vec![note, again]].concat(), 6000, &[256]);
    let [whole, half] = [1.0, 0.5].map(|value| sound(vec![(0, set("pluck_force", value))]));
    assert!(whole != half);
    // The end of the range by addition, and a half under it that comes to light in the middle of a block.
    let before =
        vec![(0, set("pluck_force", 0.2)), (0, add("pluck_force", 1.0)), (1000, set("pluck_force", 0.5))];
    assert!(sound(before.clone()) == whole, "it is not the sum");
    let after = sound([before, vec![(2900, add("pluck_force", 0.0))]].concat());
    assert!(after[0][..2900] == whole[0][..2900]);
    let expected = sound(vec![(0, set("pluck_force", 1.0)), (2900, set("pluck_force", 0.5))]);
    assert!(after == expected, "what was set under it does not come to light");
}
