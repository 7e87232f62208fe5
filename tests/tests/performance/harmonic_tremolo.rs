//! The promise: in a tremolo of harmonics each stroke is one, and as loud as those before it. The light finger stays at its node from
//! stroke to stroke, and a hand stills the string before each.

use low_action_dsp::Gesture;
use low_action_tests::numbers::{largest, root_mean_square};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Stage, amplitude, at, cc, decibels, hertz, level, on};

use crate::harmonics_after_notes::STRINGS;

const SECONDS: f64 = 1.6;
/// From when to when after a stroke it is listened to, s, if no other comes first.
const HEARD: [f64; 2] = [0.02, 0.15];

/// Natural harmonics, and one of a stopped note, semitones over the open string.
const OVER: [u8; 3] = [12, 19, 21];
/// What CC 25 asks for: 4.2, 11.5 and 20 strokes a second.
const RATES: [u8; 3] = [10, 64, 127];

/// A tremolo of a harmonic: its sound, and when its strokes fall, s.
fn tremolo(stage: &mut Stage, key: u8, velocity: u8, rate: u8) -> (Vec<f32>, Vec<f64>) {
    let events = [(0.0, cc(23, 1)), (0.0, cc(25, rate)), (0.0, on(key, velocity))];
    let mut played = stage.play(&events, SECONDS);
    let plucks = played.gestures.iter().filter(|timed| matches!(timed.gesture, Gesture::Pluck { .. }));
    let times = plucks.map(|timed| timed.time as f64 / stage.rate).collect();
    (played.strings.swap_remove(0), times)
}

/// What is heard of each of its strokes but the last.
fn strokes<'a>(sound: &'a [f32], times: &[f64]) -> Vec<&'a [f32]> {
    let [from, to] = HEARD;
    times.windows(2).map(|pair| &sound[at(pair[0] + from)..at(pair[1].min(pair[0] + to))]).collect()
}

/// A light finger is at its node for every stroke. (Of all strokes together the pitch is not heard: alike as they are, they come to
/// multiples of their rate.)
#[test]
fn each_stroke_of_a_tremolo_is_a_harmonic() {
    // A natural one and one of a stopped note, slow and fast.
    for (key, rate) in [(76, 10), (76, 64), (76, 127), (81, 10), (81, 64)] {
        let mut stage = Stage::alone("electric", 0);
        let (sound, times) = tremolo(&mut stage, key, 90, rate);
        let pitch = hertz(f64::from(key));
        let below = |sound: &[f32]| {
            let [asked, below] = [pitch, 0.5 * pitch].map(|pitch| amplitude(sound, stage.rate, pitch));
            decibels(below / asked)
        };
        for (n, stroke) in strokes(&sound, &times).into_iter().enumerate() {
            let off = cents(frequency_near(stroke, stage.rate, pitch), pitch);
            let down = below(stroke);
            println!("key {key} at {rate}, stroke {n}: {off:.1} cents, an octave below at {down:.1} dB");
            assert!(off.abs() < 10.0, "key {key} at {rate}, stroke {n}: {off} cents");
            // For the first one the light finger has yet to come.
            let most = if n == 0 { -6.0 } else { -40.0 };
            assert!(down < most, "key {key} at {rate}, stroke {n}: an octave below at {down} dB");
        }
        // Each pluck has some of it until the finger has taken it up.
        let down = below(&sound[at(1.0)..]);
        println!("key {key} at {rate}: an octave below at {down:.1} dB in all");
        assert!(down < -6.0, "key {key} at {rate}: an octave below at {down} dB in all");
    }
}

/// By how much the strokes of tremolos on one string at a velocity differ in level from the first, and from the one before last, which
/// goes the same way, dB.
fn differences((setup, string, open): (&str, usize, u8), velocity: u8) -> [Vec<f64>; 2] {
    let mut stage = Stage::alone(setup, string);
    let mut found = [const { Vec::new() }; 2];
    for over in OVER {
        for rate in RATES {
            let (sound, times) = tremolo(&mut stage, open + over, velocity, rate);
            let levels: Vec<f64> = strokes(&sound, &times).into_iter().map(level).collect();
            println!("{setup} {string}, {over} at {rate}, velocity {velocity}: {levels:.1?}");
            found[0].extend(levels[1..].iter().map(|level| level - levels[0]));
            // The first finds a string at rest.
            found[1].extend(levels[1..].windows(3).map(|three| three[2] - three[0]));
        }
    }
    found
}

/// Strokes back are softer by themselves. (Not stilled, those of velocity 40 differed by 8.7 dB root mean square from the first,
/// 21.7 at most, and by 3.6 and 18.8 from the one before last.)
#[test]
fn strokes_of_a_tremolo_of_harmonics_are_alike() {
    let mut rows = String::new();
    for velocity in [40, 64, 100] {
        let found = std::thread::scope(|scope| {
            let strings = STRINGS.map(|string| scope.spawn(move || differences(string, velocity)));
            strings.map(|string| string.join().expect("it plays"))
        });
        let [first, last] = [0, 1].map(|which| {
            let all: Vec<f64> = found.iter().flat_map(|found| found[which].clone()).collect();
            [root_mean_square(&all), largest(all.iter().map(|apart| apart.abs()))]
        });
        println!("velocity {velocity}: {first:?} dB from the first, {last:?} from the one before last");
        rows += &format!(
            "| {velocity} | {:.1} dB | {:.1} dB | {:.1} dB | {:.1} dB |\n",
            first[0], first[1], last[0], last[1]
        );
        assert!(first[0] < 3.0 && first[1] < 8.0, "velocity {velocity}: {first:?} dB from the first");
        assert!(last[0] < 0.5 && last[1] < 2.0, "velocity {velocity}: {last:?} dB from the one before last");
    }
    let page = include_str!("../../../docs/gestures.md");
    assert!(page.contains(&rows), "docs/gestures.md has other numbers than\n{rows}");
}
