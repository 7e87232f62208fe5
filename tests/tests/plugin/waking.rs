//! Promise: what is set while a host lets the plugin sleep is there before the next note: the plugin asks to be processed, goes on until
//! it is, and then rests again. One that is not active asks for nothing.

use std::thread::sleep;
use std::time::Duration;

use low_action_tests::host::{Action, Between, Host, Score, parameter};

const RATE: f64 = 48_000.0;
const LENGTH: usize = 480_000;
/// Samples: when it is set, and when a note comes.
const SET: u64 = 20_000;
const NOTE: u64 = 450_000;

const BASS: f64 = 3.0;

fn bass() -> Action {
    Action::Parameter(parameter("instrument"), BASS)
}

fn session() -> Vec<u8> {
    let mut host = Host::new();
    host.play(RATE, &vec![(0, bass())], 64, &[64]);
    host.save()
}

fn note() -> Score {
    vec![(NOTE, Action::NoteOn { channel: 0, key: 40, velocity: 100 })]
}

/// What is heard from the note on in real time, where something is done between blocks; and for how many samples the host slept.
fn heard(between: Vec<(u64, Between)>) -> (Vec<f32>, usize) {
    let mut host = Host::in_real_time();
    host.sleepy = true;
    host.between = between;
    // The time that builds take is the world's, not the sound's.
    host.watch = Some(Box::new(|_| sleep(Duration::from_millis(5))));
    let performed = host.perform(RATE, &note(), LENGTH, &[512], 0);
    let [left, _] = performed.stereo;
    (left[NOTE as usize..].to_vec(), performed.slept)
}

#[test]
fn what_is_set_while_it_sleeps_is_there_before_the_next_note() {
    let expected = |load: bool| {
        let mut host = Host::in_real_time();
        assert!(!load || host.load(&session()));
        let [left, _] = host.play(RATE, &note(), LENGTH, &[512]);
        left[NOTE as usize..].to_vec()
    };
    let [guitar, bass_guitar] = [false, true].map(expected);
    assert!(guitar != bass_guitar);
    let (plain, slept) = heard(Vec::new());
    assert!(plain == guitar && slept > 400_000, "it slept for {slept} samples");
    for between in [Between::Load(session()), Between::Flush(vec![bass()])] {
        let (sound, slept) = heard(vec![(SET, between)]);
        assert!(sound == bass_guitar, "the note begins on another instrument");
        assert!(slept > 100_000, "it slept for {slept} samples");
    }
}

#[test]
fn what_is_not_active_asks_for_nothing() {
    let mut host = Host::new();
    host.flush(&[bass()]);
    assert!(host.load(&session()));
    assert!(!host.take_process_request(), "before it was ever active");
    host.play(RATE, &note(), 64, &[64]);
    host.flush(&[bass()]);
    assert!(host.load(&session()));
    assert!(!host.take_process_request(), "when it is so no longer");
}
