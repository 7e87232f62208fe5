//! Promise: a host that gives nothing to be played into for a while, or not all that a layout has, misses nothing else: notes and
//! parameters that come meanwhile count, and the rest has the same bits.

use clack_host::events::event_types::NoteExpressionType;
use low_action_tests::host::{Action, Between, Host, Score, parameter};

const RATE: f64 = 48_000.0;
const LENGTH: usize = 24_000;

fn score() -> Score {
    vec![
        (0, Action::NoteOn { channel: 0, key: 45, velocity: 100 }),
        (5000, Action::NoteOff { channel: 0, key: 45 }),
        (5500, Action::NoteOn { channel: 0, key: 57, velocity: 100 }),
        (6000, Action::Parameter(parameter("level"), 0.5)),
        (15_000, Action::NoteOff { channel: 0, key: 57 }),
    ]
}

#[test]
fn what_comes_while_nothing_can_be_played_into_counts() {
    let [expected, _] = Host::new().play(RATE, &score(), LENGTH, &[500]);
    let mut host = Host::new();
    host.deaf = 4000..8000;
    let [found, _] = host.play(RATE, &score(), LENGTH, &[500]);
    assert!(
        found[4000..8000].iter().all(|&sample| sample == 0.0) && expected[4000..8000] != found[4000..8000]
    );
    assert!(found[..4000] == expected[..4000] && found[8000..] == expected[8000..]);
}

#[test]
fn strings_whose_outputs_are_missing_are_heard_in_the_stereo_one() {
    let [expected, _] = Host::new().play(RATE, &score(), LENGTH, &[500]);
    for given in [0, 3] {
        let mut host = Host::new();
        host.choose_ports(1);
        let found = host.perform(RATE, &score(), LENGTH, &[500], given);
        assert!(found.stereo[0] == expected, "{given} of 8");
        assert!(found.stems.iter().flatten().any(|&sample| sample != 0.0) == (given > 0), "{given} of 8");
    }
}

#[test]
fn what_comes_in_a_block_without_samples_comes_with_the_next_ones() {
    let on = Action::NoteOn { channel: 0, key: 57, velocity: 100 };
    let off = Action::NoteOff { channel: 0, key: 45 };
    let (force, bend) = (Action::Parameter(parameter("pluck_force"), 0.2), Action::Midi([0xE0, 0, 96]));
    let score = |own: &[Action]| -> Score {
        let first = (0, Action::NoteOn { channel: 0, key: 45, velocity: 100 });
        [first].into_iter().chain(own.iter().map(|&action| (5000, action))).collect()
    };
    let [expected, _] = Host::new().play(RATE, &score(&[off, force, bend, on]), LENGTH, &[500]);
    let play = |between| {
        let mut host = Host::new();
        host.between = between;
        let [found, _] = host.play(RATE, &score(&[on]), LENGTH, &[500]);
        found
    };
    let two = vec![(5000, Between::Nothing(vec![off, force])), (5000, Between::Nothing(vec![bend]))];
    assert!(play(two) == expected);
    assert!(play(Vec::new()) != expected);
}

/// What is heard of a note over which something is said in a block without samples, or in one with.
fn said_at_5000(said: &[Action], without_samples: bool) -> Vec<f32> {
    let first = (0, Action::Begin { number: 45, channel: 0, key: 45 });
    let mut host = Host::new();
    let score = if without_samples {
        host.between = vec![(5000, Between::Nothing(said.to_vec()))];
        vec![first]
    } else {
        [first].into_iter().chain(said.iter().map(|&action| (5000, action))).collect()
    };
    let [found, _] = host.play(RATE, &score, LENGTH, &[500]);
    found
}

#[test]
fn all_that_is_said_of_notes_without_samples_counts() {
    let usual = said_at_5000(&[], false);
    let (channel, key) = (0, 45);
    let modulation = |amount| Action::Modulate { parameter: parameter("pluck_position"), key, amount };
    let again = Action::NoteOn { channel, key, velocity: 100 };
    use NoteExpressionType::{Brightness, Pressure, Tuning, Vibrato, Volume};
    let express = |what, value| Action::Express { what, channel, key, value };
    let said = [
        vec![modulation(0.3), again],
        // What holds for all changes under it.
        vec![modulation(-0.2), Action::Parameter(parameter("pluck_position"), 0.6), again],
        vec![Action::Lift { number: 45 }],
        vec![Action::Choke { channel, key }],
        vec![Action::ChokeAll],
        vec![Action::Midi([0x80, 45, 0])],
        vec![express(Tuning, 1.5)],
        vec![express(Vibrato, 1.0)],
        vec![express(Volume, 0.2), again],
        vec![express(Brightness, 1.0), again],
        vec![express(NoteExpressionType::Expression, 0.2), again],
        vec![Action::Midi([0xB0, 1, 127]), express(Pressure, 0.9)],
    ];
    for said in said {
        let expected = said_at_5000(&said, false);
        assert!(said_at_5000(&said, true) == expected, "{said:?}");
        assert!(expected != usual, "{said:?} says nothing");
    }
}

#[test]
fn an_end_of_a_note_is_not_lost_among_thousands_of_events_without_samples() {
    let bend = Action::Midi([0xE0, 0, 96]);
    let (on, off) =
        (Action::NoteOn { channel: 1, key: 64, velocity: 1 }, Action::NoteOff { channel: 0, key: 45 });
    let many = [vec![bend; 5000], vec![on; 5000], vec![off]].concat();
    let expected = said_at_5000(&[bend, Action::Choke { channel: 0, key: 45 }], false);
    assert!(said_at_5000(&many, true) == expected);
}

#[test]
fn what_waits_is_forgotten_when_a_host_asks_for_silence() {
    let on = Action::NoteOn { channel: 0, key: 57, velocity: 100 };
    let mut host = Host::new();
    host.between = vec![(5000, Between::Nothing(vec![on])), (5000, Between::Reset)];
    let [found, _] =
        host.play(RATE, &vec![(0, Action::NoteOn { channel: 0, key: 45, velocity: 100 })], LENGTH, &[500]);
    assert!(found[..5000].iter().any(|&sample| sample != 0.0));
    assert!(found[5000..].iter().all(|&sample| sample == 0.0), "what waited is played");
}

/// A host that lets the plugin sleep is to go on for what it has said in such a block.
#[test]
fn a_note_of_a_block_without_samples_wakes_a_plugin_that_sleeps() {
    let mut host = Host::new();
    host.sleepy = true;
    let on = Action::NoteOn { channel: 0, key: 57, velocity: 100 };
    host.between = vec![(12_000, Between::Nothing(vec![on]))];
    let played = host.perform(RATE, &Vec::new(), LENGTH, &[500], 0);
    assert!(played.slept >= 10_000, "{} samples", played.slept);
    let [before, after] = [&played.stereo[0][..12_000], &played.stereo[0][12_000..]];
    assert!(before.iter().all(|&sample| sample == 0.0) && after.iter().any(|&sample| sample != 0.0));
}
