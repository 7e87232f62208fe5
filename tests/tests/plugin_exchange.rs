//! Promise: in real time, too, a change of the set-up is put under ringing strings, as soon as it is built,
//! without a break in the sound and with nothing allocated on the audio thread (the framework aborts the
//! test otherwise); a knob that keeps moving and a change that cannot be built do no harm.

use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::pitch::{cents, frequency_near};

const RATE: f64 = 48_000.0;
/// Ten seconds take a second or so to compute, and an engine a tenth of a second to build.
const LENGTH: usize = 480_000;

fn note() -> Score {
    vec![(0, Action::NoteOn { channel: 0, key: 45, velocity: 80 })]
}

fn set(at: u64, id: &str, value: f64) -> (u64, Action) {
    (at, Action::Parameter(parameter(id), value))
}

fn largest_step(sound: &[f32]) -> f32 {
    sound.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max)
}

#[test]
fn a_change_is_put_under_the_ringing_string() {
    let mut score = note();
    // Relaxing depends on the machine, and the last digits of contacts on relaxing.
    score.insert(0, set(0, "relax", 0.0));
    score.push(set(24_000, "tuning", 1.0));
    let [left, _] = Host::in_real_time().play(RATE, &score, LENGTH, &[256]);
    let raised = cents(frequency_near(&left[LENGTH - 48_000..], RATE, 116.54), 110.0);
    assert!((raised - 100.0).abs() < 1.0, "raised by {raised} cents");
    // The note's own beginning has the largest steps; nothing later comes near them.
    let (begin, later) = (largest_step(&left[..2400]), largest_step(&left[20_000..]));
    assert!(later < begin, "a step of {later} where the pluck has {begin}");
}

#[test]
fn a_knob_that_keeps_moving_is_followed() {
    let mut score = note();
    score.extend((0..400).map(|step| set(2400 + 512 * step, "action", 0.5 + 0.001 * step as f64)));
    score.push(set(300_000, "tuning", 0.0));
    let [left, _] = Host::in_real_time().play(RATE, &score, LENGTH, &[512, 64, 1024]);
    assert!(left.iter().all(|sample| sample.is_finite() && sample.abs() < 1.0));
    let raised = cents(frequency_near(&left[LENGTH - 48_000..], RATE, 103.83), 110.0);
    assert!((raised + 100.0).abs() < 1.0, "raised by {raised} cents");
}

#[test]
fn another_instrument_fades_in() {
    let mut score = note();
    score.push(set(24_000, "instrument", 1.0));
    score.push((400_000, Action::NoteOn { channel: 0, key: 50, velocity: 100 }));
    let [left, _] = Host::in_real_time().play(RATE, &score, LENGTH, &[512]);
    let peak = |span: &[f32]| span.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
    // The old one has faded, the new one is silent until it is played.
    assert_eq!(peak(&left[390_000..400_000]), 0.0);
    assert!(peak(&left[400_000..]) > 0.01);
}
