//! The promise: taps one after another are as loud as their own velocities have them, whether a finger is still on the string
//! or not. What has been tapped is let go of as softly as the next tap strikes.

use low_action_tests::numbers::largest;
use low_action_tests::stage::{Stage, cc, level, off, on};

const RATE: f64 = 48_000.0;
/// From one tap to the next, s.
const BEAT: f64 = 0.12;
const FRETS: [u8; 6] = [5, 3, 7, 2, 4, 4];

/// Mean level of a figure's taps but for the first, dB, from 10 to 110 ms after each, with such a gap between them, s.
fn heard(stage: &mut Stage, open: u8, velocity: u8, gap: f64) -> f64 {
    let mut events = vec![(0.0, cc(22, 7))];
    for (n, fret) in FRETS.into_iter().enumerate() {
        let time = 0.02 + n as f64 * BEAT;
        events.push((time, on(open + fret, velocity)));
        events.push((time + BEAT - gap, off(open + fret)));
    }
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let sound = &stage.play(&events, 0.02 + 6.0 * BEAT).strings[0];
    let at = |n: usize, after: f64| ((0.02 + n as f64 * BEAT + after) * RATE) as usize;
    (1..6).map(|n| level(&sound[at(n, 0.01)..at(n, 0.11)])).sum::<f64>() / 5.0
}

#[test]
fn taps_in_a_row_are_as_soft_as_their_velocity() {
    let strings = [
        ("electric", 0, 64),
        ("electric", 3, 50),
        ("electric", 5, 40),
        ("classical", 1, 59),
        ("bass", 3, 28),
    ];
    for (setup, string, open) in strings {
        let mut stage = Stage::alone(setup, string);
        let mut figure = |velocity, gap| heard(&mut stage, open, velocity, gap);
        for gap in [0.0005, -0.03] {
            let louder = [10, 30].map(|velocity| figure(velocity, gap) - figure(velocity, 0.025));
            // (Where fingers left at once: up to 15 dB.)
            let most = largest(louder);
            assert!(most < 9.0, "{setup} {string}, {gap} s apart: {louder:?} dB louder than with gaps");
            let range = figure(127, gap) - figure(10, gap);
            // (Where fingers left at once: 2 to 8 dB.)
            assert!(
                range > 8.0,
                "{setup} {string}, {gap} s apart: {range} dB from the softest to the hardest"
            );
        }
    }
}
