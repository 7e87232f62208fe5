//! Promise: in real time, too, a change of the set-up is put under ringing strings, as soon as it is built,
//! without a break in the sound and with nothing allocated on the audio thread (the framework aborts the
//! test otherwise); a knob that keeps moving and a change that cannot be built do no harm.
//!
//! How long a build takes is the machine's affair: from the change on, these hosts wait between blocks until
//! what is waited for is heard.

use std::thread::sleep;
use std::time::{Duration, Instant};

use low_action_tests::host::{Action, Host, Score, Watch, parameter};
use low_action_tests::numbers::largest_step;
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::peak;
use low_action_tests::watch;

const RATE: f64 = 48_000.0;
/// Ten seconds, of which the last second shows what has come of the change.
const LENGTH: usize = 480_000;
/// Where the change is.
const CHANGE: usize = 24_000;
/// Pause between two blocks while waiting: so long that the longest wait fits in the sound. Between a change and the last
/// second there are (480,000 − 24,000 − 48,000)/512 = 796 blocks of the longest size that is used there.
const PAUSE: Duration = Duration::from_millis(80);
/// The longest wait: 750 pauses.
const PATIENCE: Duration = Duration::from_secs(60);

/// How far off a string may be whose set-up says its pitch, cents: it is as exact as pitches are measured (`tuning` says how
/// well).
const EXACTLY: f64 = 0.05;

fn note() -> Score {
    vec![(0, Action::NoteOn { channel: 0, key: 45, velocity: 80 })]
}

fn set(at: u64, id: &str, value: f64) -> (u64, Action) {
    (at, Action::Parameter(parameter(id), value))
}

/// Waits from the block of a sample on until something is heard in the left channel.
fn wait(from: usize, mut heard: impl FnMut(&[f32]) -> bool + 'static) -> Option<Watch> {
    let (mut begun, mut done) = (None, false);
    Some(Box::new(move |[left, _]: [&[f32]; 2]| {
        if left.len() > from && !done {
            done = heard(left);
            let begun = *begun.get_or_insert_with(Instant::now);
            assert!(begun.elapsed() < PATIENCE, "waited in vain");
            if !done {
                sleep(PAUSE);
            }
        }
    }))
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "in a release build nobody keeps watch over allocations")]
fn the_watch_over_allocations_is_kept() {
    watch::assert_it_is_kept(module_path!(), "the_watch_over_allocations_is_kept");
}

#[test]
fn a_change_is_put_under_the_ringing_string() {
    let mut score = note();
    // A slow machine must not mix relaxed contacts in.
    score.insert(0, set(0, "relax", 0.0));
    let [unchanged, _] = Host::in_real_time().play(RATE, &score, LENGTH, &[256]);
    score.push(set(CHANGE as u64, "tuning", 1.0));
    let mut host = Host::in_real_time();
    host.watch = wait(CHANGE, move |left| left[CHANGE..] != unchanged[CHANGE..left.len()]);
    let [left, _] = host.play(RATE, &score, LENGTH, &[256]);
    let raised = cents(frequency_near(&left[LENGTH - 48_000..], RATE, 116.54), 110.0);
    assert!((raised - 100.0).abs() < EXACTLY, "raised by {raised} cents");
    // The note's own beginning has the largest steps; nothing later comes near them.
    let (begin, later) = (largest_step(&left[..2400]), largest_step(&left[20_000..]));
    assert!(later < begin, "a step of {later} where the pluck has {begin}");
}

#[test]
fn a_knob_that_keeps_moving_is_followed() {
    let mut score = note();
    score.extend((0..400).map(|step| set(2400 + 512 * step, "action", 0.5 + 0.001 * step as f64)));
    let last = 240_000;
    score.push(set(last as u64, "tuning", 0.0));
    let lowered = |left: &[f32]| cents(frequency_near(&left[left.len() - 48_000..], RATE, 103.83), 110.0);
    let mut host = Host::in_real_time();
    host.watch = wait(last + 48_000, move |left| (lowered(left) + 100.0).abs() < 1.0);
    // The wait begins a second after the last move; 750 pauses between blocks of 533 samples on average, and a second more.
    let length = last + 48_000 + 750 * 534 + 48_000;
    let [left, _] = host.play(RATE, &score, length, &[512, 64, 1024]);
    assert!(left.iter().all(|sample| sample.is_finite() && sample.abs() < 1.0));
    assert!((lowered(&left) + 100.0).abs() < EXACTLY, "lowered by {} cents", lowered(&left));
}

#[test]
fn another_instrument_fades_in() {
    let mut score = note();
    score.push(set(CHANGE as u64, "instrument", 1.0));
    score.push((LENGTH as u64 - 48_000, Action::NoteOn { channel: 0, key: 50, velocity: 100 }));
    let mut host = Host::in_real_time();
    host.watch = wait(CHANGE, |left| peak(&left[left.len() - 256..]) == 0.0);
    let [left, _] = host.play(RATE, &score, LENGTH, &[512]);
    // The old one has faded, the new one is silent until it is played.
    assert_eq!(peak(&left[LENGTH - 60_000..LENGTH - 48_000]), 0.0);
    assert!(peak(&left[LENGTH - 48_000..]) > 0.01);
}

/// As when the host changed it while the plugin slept: the first note comes before the new instrument is built.
#[test]
fn a_note_that_comes_after_the_change_is_played_by_the_new_instrument() {
    let played = |change: &[(u64, Action)]| {
        let mut score = change.to_vec();
        score.insert(0, set(0, "relax", 0.0));
        score.push((CHANGE as u64 + 10, Action::NoteOn { channel: 0, key: 40, velocity: 100 }));
        score
    };
    let [unchanged, _] = Host::in_real_time().play(RATE, &played(&[]), LENGTH, &[512]);
    let mut host = Host::in_real_time();
    host.sleepy = true;
    host.watch = wait(CHANGE, move |left| left[CHANGE..] != unchanged[CHANGE..left.len()]);
    let [left, _] = host.play(RATE, &played(&[set(CHANGE as u64, "instrument", 3.0)]), LENGTH, &[512]);
    assert!(peak(&left[LENGTH - 48_000..]) > 1e-4, "the key is down, and nothing sounds");
}
