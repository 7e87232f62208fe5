//! The promise: a note whose string another has just left begins at its pitch and as loud as on a string at rest, wherever the wheel had
//! that one's finger, and wherever it has gone since. One that is still held is bent no faster than a hand bends.

use low_action::performance::PlayerEvent;
use low_action_dsp::Gesture;
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Played, Stage, at, cc, decibels, hertz, octave, off, on, peak, wheel};

const RATE: f64 = 48_000.0;
/// When the first note ends, and when the wheel is turned then, s.
const ENDS: f64 = 0.8;
const TURNS: f64 = 0.802;

/// A note under a wheel that goes somewhere in 0.2 s, and elsewhere (semitones) when that is over; the next one comes at a time, s,
/// by a stroke (CC 22).
fn two_notes(key: u8, [first, then]: [f64; 2], next: f64, stroke: u8) -> Vec<(f64, PlayerEvent)> {
    let announced = octave();
    let turns = (1..=20).map(|step| (0.2 + 0.01 * f64::from(step), wheel(first * f64::from(step) / 20.0)));
    let between = [(ENDS, off(key)), (TURNS, wheel(then)), (next, cc(22, stroke)), (next, on(key, 90))];
    announced.into_iter().chain([(0.0, on(key, 90))]).chain(turns).chain(between).collect()
}

/// When the last stroke falls or the last finger strikes.
fn struck(played: &Played) -> usize {
    let strikes = |gesture: &Gesture| matches!(gesture, Gesture::Pluck { .. } | Gesture::Throw { .. });
    let last = played.gestures.iter().rev().find(|timed| strikes(&timed.gesture));
    last.expect("the note is struck").time as usize
}

/// What sounds from 6 ms after that on, when a push is over, for long enough to hear, Hz, and how loud the first 30 ms are.
fn begins(played: &Played, near: f64) -> [f64; 2] {
    let sound = &played.strings[0][struck(played)..];
    let heard = at(0.006)..at(0.006 + f64::max(0.024, 8.0 / near));
    [frequency_near(&sound[heard], RATE, near), peak(&sound[..at(0.03)])]
}

/// (While hands damped the first one, for 0.4 s, the next scooped by up to `max_bend` for 30 ms: the string had made up for a finger that
/// stayed where it had slid, and was let go of as a hand bends.)
#[test]
fn the_next_note_begins_in_tune_and_as_loud() {
    // Plucked and tapped; where pulling alone reaches as far and where it does not.
    for (setup, string, key, ways) in [
        ("electric", 0, 69, &[[5.0, 0.0], [0.0, 12.0], [7.0, -3.0], [2.0, 0.0], [0.0, 2.0]][..]),
        ("bass", 0, 55, &[[5.0, 0.0], [0.0, 7.0]]),
        // Where nothing keeps it on frets the finger has glided: its note is over, and it is no finger for the next one there.
        ("fretless-bass", 2, 43, &[[5.0, 0.0], [0.0, 5.0], [5.0, -1.0], [0.4, 0.0]]),
    ] {
        let mut stage = Stage::alone(setup, string);
        for &way in ways {
            // How loud a tap is goes by what the finger before has yet to leave, too.
            for (stroke, most) in [(0, 2.5), (7, f64::INFINITY)] {
                let at_rest = stage.play(&two_notes(key, way, 2.8, stroke), 3.0);
                let near = hertz(f64::from(key) + way[1]);
                let [pitch, loudest] = begins(&at_rest, near);
                for gap in [0.02, 0.05, 0.1, 0.2, 0.35, 0.5] {
                    let played = stage.play(&two_notes(key, way, ENDS + gap, stroke), ENDS + gap + 0.2);
                    let [heard, loud] = begins(&played, near);
                    let (beside, louder) = (cents(heard, pitch), decibels(loud / loudest));
                    let what = format!(
                        "{setup}, {way:?}, stroke {stroke}, {gap} s: {beside:.1} cents, {louder:.1} dB louder"
                    );
                    println!("{what}");
                    assert!(beside.abs() < 10.0 && louder.abs() < most, "{what}");
                }
            }
        }
    }
}

#[test]
fn a_string_that_is_still_held_is_bent_as_hands_bend() {
    let mut stage = Stage::alone("electric", 0);
    for key in [64, 69] {
        let announced = octave();
        let again = [
            (0.0, on(key, 90)),
            (0.5, wheel(2.0)),
            (0.5, on(key, 90)),
            (1.0, wheel(0.0)),
            (1.005, on(key, 90)),
        ];
        let played = stage.play(&[&announced[..], &again].concat(), 1.2);
        let bends: Vec<f64> = played
            .gestures
            .iter()
            .filter_map(|timed| match timed.gesture {
                Gesture::Bend { duration, .. } => Some(duration),
                _ => None,
            })
            .collect();
        println!("{key}: {bends:?}");
        assert!(bends.len() >= 2 && bends.iter().all(|&duration| duration > 0.01), "{key}: {bends:?}");
    }
}
