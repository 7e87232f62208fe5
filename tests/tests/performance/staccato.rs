//! The promise: however short notes are, hands make no noise between them. A note's end is heard in nothing but the string
//! falling silent, and in a quick figure a note is no louder than in a slow one.

use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::numbers::largest;
use low_action_tests::stage::{Stage, cc, decibels, off, on, peak};

const RATE: f64 = 48_000.0;
/// When the second note begins, s.
const NEXT: f64 = 0.4;
/// For how long after a note it is listened to closely, s, and then until nobody touches the string any more.
const SOON: f64 = 0.1;
const LATE: f64 = 1.5;
/// For how long the shortest note sounds, s.
const SHORTEST: f64 = 0.03;

/// Set-up, string, its open key.
const STRINGS: [(&str, usize, u8); 6] = [
    ("electric", 2, 55),
    ("electric", 5, 40),
    ("classical", 1, 59),
    ("steel", 0, 64),
    ("ukulele", 3, 69),
    ("bass", 3, 28),
];

/// How sharply a sound turns at most, dB: third differences, in which clicks are loud and strings are not.
fn click(sound: &[f32], from: f64, to: f64) -> f64 {
    let part = &sound[(from * RATE) as usize..(to * RATE) as usize];
    let third = |w: &[f32]| f64::from(w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs();
    decibels(largest(part.windows(4).map(third)))
}

/// Beside a pluck that lets go at once: what the shipped hands let go of more slowly the softer they pluck is no sharp edge.
/// (The finger of the softest note may come down after its key is up. One that was taken away while it still held the string, to
/// damp behind the other with it, was up to 45 dB louder than the note.)
#[test]
fn a_short_note_ends_without_a_click() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::plucked_at_once(setup, string);
        for [before, fret] in [[5, 7], [3, 8], [2, 12], [0, 5], [8, 3], [5, 5]] {
            for velocity in [10, 40, 100] {
                for length in [0.03, 0.05, 0.1, 0.14] {
                    let end = NEXT + length;
                    let events = [
                        (0.0, on(open + before, 64)),
                        (NEXT, off(open + before)),
                        (NEXT, on(open + fret, velocity)),
                        (end, off(open + fret)),
                    ];
                    let played = stage.play(&events, end + LATE);
                    // Its stroke waits for the hand that stills the string, and is heard for a while.
                    let plucks = |timed: &&TimedGesture| matches!(timed.gesture, Gesture::Pluck { .. });
                    let stroke = played.gestures.iter().rfind(plucks).expect("it is struck");
                    let sound = &played.strings[0];
                    let note = click(sound, NEXT, end.max(stroke.time as f64 / RATE + SHORTEST));
                    let (soon, late) = (click(sound, end, end + SOON), click(sound, end + SOON, end + LATE));
                    let here = format!(
                        "{setup} {string}, fret {fret} after {before}, velocity {velocity}, {length} s"
                    );
                    println!("{here}: {:.1} dB soon, {:.1} dB later", soon - note, late - note);
                    // At most 6.5 dB, of the bass's E1, whose finger comes down after its key is up; and later −15.1 dB. (That
                    // is no more than it was when fingers landed aloud and made the same note 4 dB sharper: −86 dB.)
                    assert!(soon < note + 8.0, "{here}: {soon} dB soon after a note of {note} dB");
                    assert!(late < note - 15.0, "{here}: {late} dB later, after a note of {note} dB");
                }
            }
        }
    }
}

/// (The third note finds the finger of the first still leaving. One that was taken away at once for it made a soft note up to 25 dB
/// louder; louder notes ring into the next.)
#[test]
fn a_quick_figure_is_as_loud_as_a_slow_one() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        for frets in [[2, 4, 7], [3, 5, 3], [2, 5, 3]] {
            for velocity in [10, 40] {
                let mut third = |length: f64| {
                    let mut events = Vec::new();
                    for (n, fret) in (0..3).map(f64::from).zip(frets) {
                        events.push((n * length, on(open + fret, velocity)));
                        events.push(((n + 1.0) * length - 0.001, off(open + fret)));
                    }
                    let begins = (2.0 * length * RATE) as usize;
                    let sound = &stage.play(&events, 2.0 * length + 0.04).strings[0];
                    decibels(peak(&sound[begins..]))
                };
                let slow = third(0.6);
                for length in [0.04, 0.06, 0.08, 0.125] {
                    let quick = third(length);
                    println!(
                        "{setup} {string}, {frets:?}, velocity {velocity}, {length} s: {:.1} dB louder",
                        quick - slow
                    );
                    // At most 5.5 dB either way: what is left of the note before is in step with this one or against it.
                    assert!(
                        (quick - slow).abs() < 7.0,
                        "{setup} {string}, frets {frets:?}, velocity {velocity}, {length} s each: {quick} dB, slowly {slow} dB"
                    );
                }
            }
        }
    }
}

/// A note that is shorter than the shortest is damped 30 ms after its stroke, on a string that sounds, too. Only a finger that waits until
/// the hand that stills the string has gone is to be heard for as long. (Open strings and fingers that stay where they are were
/// damped 2.1 ms later, and on the bass 3.5 ms.)
#[test]
fn the_shortest_notes_that_no_finger_waits_for_are_damped_thirty_milliseconds_after_their_stroke() {
    for (setup, string, open) in STRINGS {
        let mut stage = Stage::alone(setup, string);
        // Frets before and then, and what CC 23 asks for.
        for (before, fret, stop) in [(0, 0, 0), (5, 0, 0), (5, 5, 0), (0, 12, 1)] {
            for length in [0.005, 0.01] {
                let events = [
                    (0.0, on(open + before, 64)),
                    (NEXT, cc(23, stop)),
                    (NEXT, off(open + before)),
                    (NEXT, on(open + fret, 64)),
                    (NEXT + length, off(open + fret)),
                ];
                let gestures = stage.play(&events, NEXT + 0.06).gestures;
                let plucks = |timed: &TimedGesture| matches!(timed.gesture, Gesture::Pluck { .. });
                let stroke = gestures.iter().rposition(plucks).expect("it is struck");
                let lays = |timed: &&TimedGesture| matches!(timed.gesture, Gesture::Place { .. });
                let damped = gestures[stroke..].iter().find(lays).expect("it is damped");
                let sounds = damped.time - gestures[stroke].time;
                let here =
                    format!("{setup} {string}, fret {fret} after {before}, CC 23 = {stop}, {length} s");
                assert!(sounds.abs_diff((SHORTEST * RATE) as u64) <= 1, "{here}: {sounds} samples");
            }
        }
    }
}
