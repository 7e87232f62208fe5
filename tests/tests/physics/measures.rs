//! Promise: what tests measure with finds what it is there to find. What is not a number breaks every limit, and a jump in a
//! ringing sound is a click.

use std::f64::consts::TAU;

use low_action_tests::clicks::{click, corner, smallest_jump, with_jump};
use low_action_tests::numbers::{largest, largest_step, smallest};
use low_action_tests::stage::{decibels, peak};

#[test]
fn what_is_not_a_number_breaks_every_limit() {
    assert_eq!((largest([-3.0, 2.0, -0.5]), smallest([-3.0, 2.0, -0.5])), (2.0, -3.0));
    assert_eq!(largest([1.0_f32, f32::INFINITY]), f64::INFINITY);
    for place in 0..3 {
        let mut numbers = [1.0_f32, 2.0, 3.0];
        numbers[place] = f32::NAN;
        for found in [
            largest(numbers),
            smallest(numbers),
            largest_step(&numbers),
            corner(&numbers),
            peak(&numbers),
            decibels(peak(&numbers)),
        ] {
            assert!(found.is_nan(), "{found} of {numbers:?}");
        }
    }
    // Nor does a limit hold for nothing.
    assert!(largest::<f64>([]).is_nan() && smallest::<f64>([]).is_nan() && peak(&[]).is_nan());
}

/// Half a second at 48 kHz of a string that decays, its partials as 1/n.
fn ringing() -> Vec<f32> {
    let partial = |time: f64, n: f64| (TAU * 110.0 * n * time).sin() * (-(2.0 + n) * time).exp() / n;
    let sample = |time: f64| 0.1 * (1..20).map(|n| partial(time, f64::from(n))).sum::<f64>();
    (0..24_000).map(|n| sample(f64::from(n) / 48_000.0) as f32).collect()
}

#[test]
fn a_jump_is_a_click() {
    let (sound, change) = (ringing(), 9600);
    assert_eq!(click(&sound, change), None);
    let jump = smallest_jump(&sound, change);
    // Much less than the sound itself.
    assert!(jump < 0.2 * peak(&sound[change..]), "{jump:e}");
    for at in [0, 1, 100, 229, 230, 231, 2000, 4700] {
        for jump in [jump, -jump] {
            assert!(click(&with_jump(&sound, change + at, jump), change).is_some(), "{jump:e} after {at}");
        }
    }
    let mut broken = sound.clone();
    broken[change + 300] = f32::NAN;
    assert!(click(&broken, change).is_some());
}
