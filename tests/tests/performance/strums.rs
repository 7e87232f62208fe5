//! The promise: in a strum every string is heard when the stroke reaches it. The finger that stops it has the time until then,
//! and takes it; where the stroke comes soon it is there in time.

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, Setup};
use low_action_tests::stage::{Stage, cc, level, off, on};

const RATE: f64 = 48_000.0;
/// F major under one finger, from the low strings, which are struck first.
const BARRE: [u8; 6] = [41, 48, 53, 57, 60, 65];

fn strum(time: u8, velocity: u8) -> Vec<(f64, PlayerEvent)> {
    let keys = BARRE.into_iter().map(|key| (0.0, on(key, velocity)));
    [(0.0, cc(21, time))].into_iter().chain(keys).collect()
}

/// What is between two times, s.
fn part(sound: &[f32], from: f64, to: f64) -> &[f32] {
    &sound[(from * RATE) as usize..(to * RATE) as usize]
}

/// When each string is struck, s.
fn strokes(stage: &mut Stage, events: &[(f64, PlayerEvent)]) -> [f64; 6] {
    let mut strokes = [f64::NAN; 6];
    for timed in stage.play(events, 0.5).gestures {
        if let Gesture::Pluck { .. } = timed.gesture {
            strokes[timed.string] = timed.time as f64 / RATE;
        }
    }
    strokes
}

/// A finger that has the time is heard as much whatever the velocity: half as loud as a pluck at velocity 30, 10 dB, and less
/// than harder ones by their force, 1.5 × 20 log(64/30) and 1.5 × 20 log(120/30) dB more.
#[test]
fn no_string_is_heard_before_the_stroke_reaches_it() {
    for setup in ["electric", "steel", "classical"] {
        let mut stage = Stage::new(&Setup::shipped(setup).expect("it comes with the program"));
        for (velocity, quieter) in [(30, 10.0), (64, 20.0), (120, 28.0)] {
            let events = strum(127, velocity);
            let strokes = strokes(&mut stage, &events);
            let played = stage.play(&events, 0.65);
            // The last string is struck at once.
            for (string, (sound, stroke)) in played.strings.iter().zip(strokes).enumerate().take(5) {
                let before = level(part(sound, 0.0, stroke - 0.003));
                let after = level(part(sound, stroke + 0.01, stroke + 0.2));
                assert!(
                    after - before > quieter,
                    "{setup} string {string}, velocity {velocity}: {before} dB before its stroke, {after} after"
                );
            }
        }
    }
}

/// A strum is the right hand's; fingers that tap come down together, and nothing waits for a stroke.
#[test]
fn taps_come_down_together() {
    let mut stage = Stage::new(&Setup::shipped("electric").expect("it comes with the program"));
    let keys = [42, 47, 52, 57, 61, 66];
    let taps = keys.into_iter().map(|key| (0.0, on(key, 90)));
    let up = keys.into_iter().map(|key| (0.1, off(key)));
    let events: Vec<_> = [(0.0, cc(21, 127)), (0.0, cc(22, 7))].into_iter().chain(taps).chain(up).collect();
    let gestures = stage.play(&events, 0.5).gestures;
    let times = |kind: fn(&Gesture) -> bool| {
        let mut strings = [f64::NAN; 6];
        for timed in gestures.iter().rev().filter(|timed| kind(&timed.gesture)) {
            strings[timed.string] = timed.time as f64 / RATE;
        }
        strings
    };
    assert_eq!(times(|gesture| matches!(gesture, Gesture::Throw { .. })), [0.0; 6]);
    // The edge of the right hand, as soon as keys are up.
    assert_eq!(times(|gesture| matches!(gesture, Gesture::Place { finger: 2, .. })), [0.1; 6]);
}

/// What holds back the finger of each string, kg/s: by it the finger's force makes its speed.
fn held_back(stage: &mut Stage, time: u8) -> [f64; 6] {
    let mut found = [f64::NAN; 6];
    for timed in stage.play(&strum(time, 110), 0.01).gestures {
        if let Gesture::Place { finger: 0, touch, .. } = timed.gesture {
            found[timed.string] = touch.hand_damping;
        }
    }
    found
}

/// The fastest strum is over in 3 ms, a tenth of what the softest finger takes: none may come more than a tenth slower than for
/// strings struck together.
#[test]
fn a_finger_comes_as_fast_as_the_stroke() {
    let mut stage = Stage::new(&Setup::shipped("electric").expect("it comes with the program"));
    let [together, fastest, slowest] = [0, 1, 127].map(|time| held_back(&mut stage, time));
    for (string, (fastest, together)) in fastest.iter().zip(together).enumerate() {
        let slower = fastest / together;
        assert!((1.0..1.12).contains(&slower), "string {string}: {slower} times as slow");
    }
    // The first string is struck at once in the slowest, too; 80 ms are enough for the finger of any other.
    assert_eq!(slowest[5], together[5]);
    for (string, (slowest, together)) in slowest.iter().zip(together).enumerate().take(5) {
        // On the low strings one period, which it takes anyhow, is as long as that.
        let least = if string < 3 { 2.0 } else { 1.0 };
        assert!(*slowest >= least * together, "string {string}: {slowest} and {together} kg/s");
    }
}
