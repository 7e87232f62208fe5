//! The promise: hands end notes in the times, and with the forces, that `docs/gestures.md` says, and what touches a string
//! only for a moment is gone when it says so.

use std::sync::LazyLock;

use low_action::performance::{PlayerEvent, StringDeed};
use low_action_dsp::Setup;
use low_action_dsp::{FingerSlot, Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, RATE, play};
use low_action_tests::stage::{Stage, cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

/// When keys go up, samples.
const UP: u64 = 48_000;
/// A at the fifth fret of the first string.
const KEY: u8 = 69;

fn gestures(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    play(&mut GUITAR.player(EXACT), events)
}

/// What hands do after a note's key has gone up: each with the time since then, s.
fn ending(controllers: &[(u8, u8)], key: u8) -> Vec<(f64, Gesture)> {
    let told = controllers.iter().map(|&(number, value)| (0, cc(number, value)));
    let events: Vec<_> = told.chain([(0, on(key, 80)), (UP, off(key))]).collect();
    let later = gestures(&events).into_iter().filter(|timed| timed.time >= UP);
    later.map(|timed| ((timed.time - UP) as f64 / RATE, timed.gesture)).collect()
}

/// Times, forces and durations with which a finger presses.
fn presses(gestures: &[(f64, Gesture)], slot: FingerSlot) -> Vec<[f64; 3]> {
    let press = |&(time, gesture): &(f64, Gesture)| match gesture {
        Gesture::Press { finger, force, duration } if finger == slot => Some([time, force, duration]),
        _ => None,
    };
    gestures.iter().filter_map(press).collect()
}

/// When a finger is lifted, and in which time.
fn lifts(gestures: &[(f64, Gesture)], slot: FingerSlot) -> Vec<[f64; 2]> {
    let lift = |&(time, gesture): &(f64, Gesture)| match gesture {
        Gesture::Lift { finger, duration, .. } if finger == slot => Some([time, duration]),
        _ => None,
    };
    gestures.iter().filter_map(lift).collect()
}

/// Velocities and controllers are single numbers, 6e-8 of them off, and times whole samples.
fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-6 * expected.abs()
}

/// What a finger that holds on presses with when its note has ended, N.
fn holding(fret: usize) -> f64 {
    1.25 * GUITAR.strings[0].leaving_force(fret)
}

/// The hands that damp come at once and leave at a time, s.
fn assert_damped(gestures: &[(f64, Gesture)], dampers: &[FingerSlot], until: f64) {
    for &slot in dampers {
        let pressed = presses(gestures, slot);
        assert!(matches!(pressed[..], [[0.0, force, _]] if force > 0.0), "finger {slot}: {gestures:?}");
        assert_eq!(lifts(gestures, slot), [[until, 0.2]], "finger {slot}");
    }
}

#[test]
fn a_finger_holds_on_eases_off_after_0_4_seconds_and_goes_after_0_9() {
    let found = ending(&[], KEY);
    let [[start, force, relaxing], [eases, lifting, _]] = presses(&found, 0)[..] else { panic!("{found:?}") };
    assert!(start == 0.0 && near(force, holding(5)) && relaxing == 0.4, "{found:?}");
    assert!(eases == 0.4 && lifting < 0.0, "{found:?}");
    let [[goes, _]] = lifts(&found, 0)[..] else { panic!("{found:?}") };
    assert_eq!(goes, 0.9);
    // The edge of the hand, and a finger behind.
    assert_damped(&found, &[2, 3, 1], 0.9);
}

#[test]
fn a_capo_does_the_same() {
    // Under a note of the second fret it is all that stops the string.
    for (key, fingers) in [(KEY, &[(0, 5), (5, 2)][..]), (66, &[(5, 2)])] {
        let found = ending(&[(26, 2)], key);
        for &(slot, fret) in fingers {
            let [[0.0, force, 0.4], [0.4, lifting, _]] = presses(&found, slot)[..] else {
                panic!("{found:?}")
            };
            assert!(near(force, holding(fret)) && lifting < 0.0, "finger {slot}: {found:?}");
            assert!(matches!(lifts(&found, slot)[..], [[0.9, _]]), "finger {slot}: {found:?}");
        }
        assert_damped(&found, &[2, 3], 0.9);
    }
}

#[test]
fn an_open_string_is_left_after_0_4_seconds_and_a_tapped_one_after_40_milliseconds() {
    assert_damped(&ending(&[], 64), &[2, 3], 0.4);
    let tapped = ending(&[(22, 7)], KEY);
    assert_damped(&tapped, &[2, 3, 1], 0.04);
    assert!(matches!(lifts(&tapped, 0)[..], [[0.04, _]]), "{tapped:?}");
}

/// The place of the one finger of a slot that comes, and when it comes and goes, s.
fn visit(controllers: &[(u8, u8)], key: u8, slot: FingerSlot) -> [f64; 3] {
    let told = controllers.iter().map(|&(number, value)| (0, cc(number, value)));
    let gestures = gestures(&told.chain([(0, on(key, 80))]).collect::<Vec<_>>());
    let comes = |timed: &TimedGesture| match timed.gesture {
        Gesture::Place { finger, position, .. } if finger == slot => Some((timed.time, position)),
        _ => None,
    };
    let goes = |timed: &TimedGesture| matches!(timed.gesture, Gesture::Lift { finger, .. } if finger == slot);
    let [(from, position)] = gestures.iter().filter_map(comes).collect::<Vec<_>>()[..] else {
        panic!("{gestures:?}")
    };
    let until = gestures.iter().find(|timed| goes(timed)).expect("it goes").time;
    [position, from as f64 / RATE, until as f64 / RATE]
}

#[test]
fn a_finger_at_a_node_is_gone_after_120_milliseconds_and_a_thumb_after_40() {
    let length = GUITAR.strings[0].geometry.length;
    let [place, from, until] = visit(&[(23, 1)], 76, 0);
    assert!(near(place, 0.5 * length) && from == 0.0 && until == 0.12, "{place} m, {from} to {until} s");
    // The thumb comes when the plectrum has gone.
    let [_, from, until] = visit(&[(22, 6)], KEY, 4);
    assert!(near(until - from, 0.04), "{from} to {until} s");
    assert_eq!(from, GUITAR.setup.player.pluck_duration);
}

#[test]
fn a_bar_of_250_grams_in_a_hand_of_half_a_kilogram() {
    let gestures = gestures(&[(0, cc(23, 3)), (0, on(KEY, 80))]);
    let masses: Vec<f64> = gestures
        .iter()
        .filter_map(|timed| match timed.gesture {
            Gesture::Place { touch, .. } | Gesture::Throw { touch, .. } => Some(touch.mass),
            _ => None,
        })
        .collect();
    // And a finger that rests on the string behind it.
    assert_eq!(masses, [0.25 + 0.5, GUITAR.setup.player.damper.touch.mass]);
}

/// Who points at a string under a bar has it lifted as by any hand: 0.3 m/s after 3 ms are 75 N for the three quarters of a
/// kilogram, and 13.5 N for the hand that holds it back.
#[test]
fn nobody_throws_a_bar_up() {
    let touched = |deed| PlayerEvent::Touched { string: 0, deed };
    for deed in [StringDeed::Press { position: 0.2 }, StringDeed::Pluck { position: 0.5, force: 1.0 }] {
        let gestures = gestures(&[(0, cc(23, 3)), (0, on(KEY, 80)), (UP, touched(deed))]);
        let lift = |timed: &TimedGesture| match timed.gesture {
            Gesture::Lift { force, .. } => Some(force),
            _ => None,
        };
        let hardest = gestures.iter().filter_map(lift).fold(0.0, f64::max);
        assert!(hardest <= 75.0 + 13.5, "{deed:?}: {hardest} N");
    }
}

#[test]
fn strokes_and_ways_of_stopping_that_there_are_not_are_the_usual_one() {
    let played = |number, value| gestures(&[(0, cc(number, value)), (0, on(KEY, 80)), (UP, off(KEY))]);
    for (number, count) in [(22, 8), (23, 4)] {
        let usual = played(number, 0);
        // (2 of CC 22 takes turns, and begins with the usual stroke.)
        let is_usual = |value| (number, value) == (22, 2);
        for value in 1..count {
            assert_eq!(played(number, value) == usual, is_usual(value), "CC {number} = {value}");
        }
        for value in count..=127 {
            assert_eq!(played(number, value), usual, "CC {number} = {value}");
        }
    }
}

/// What is left of a note would ring for half a minute where nobody hears it, and cost what a note costs.
#[test]
fn two_seconds_after_its_note_a_string_is_at_rest() {
    for (setup, string) in [
        ("electric", 0),
        ("electric", 5),
        ("classical", 5),
        ("steel", 3),
        ("bass", 3),
        ("five-string-bass", 4),
        ("fretless-bass", 2),
        ("sitar", 4),
        ("lap-steel", 1),
    ] {
        let shipped = Setup::shipped(setup).expect("it is shipped");
        let open = shipped.string[string].pitch as u8;
        let mut stage = Stage::alone(setup, string);
        for fret in [0, 2, 7] {
            let sound = &stage.play(&[(0.0, on(open + fret, 110)), (0.5, off(open + fret))], 3.0).strings[0];
            let rings =
                sound.iter().rposition(|sample| *sample != 0.0).expect("it sounds") as f64 / RATE - 0.5;
            println!("{setup}, string {string}, fret {fret}: at rest after {rings:.2} s");
            assert!(rings < 2.0, "{setup}, string {string}, fret {fret}: {rings} s");
        }
    }
}

/// And the hand that saw to it is off a string that is played again, wherever that falls, and whatever plays.
#[test]
fn no_hand_lies_along_a_new_note() {
    for stroke in [0, 7] {
        // How often a hand is laid that would lie past the beginning of the new note.
        let mut in_the_way = 0;
        for wait in [0.95, 1.12, 1.2, 1.35, 1.45] {
            let again = UP + (wait * RATE) as u64;
            let events =
                [(0, on(KEY, 80)), (UP, off(KEY)), (again, cc(22, stroke)), (again, on(KEY + 3, 80))];
            let mut laid = 0;
            for timed in gestures(&events) {
                match timed.gesture {
                    Gesture::Still { loss, duration } => {
                        laid = timed.time + if loss > 0.0 { (duration * RATE) as u64 } else { 0 };
                        println!(
                            "{stroke} {wait} again {again} still {} {loss} {duration} laid {laid}",
                            timed.time
                        );
                        in_the_way += u32::from(timed.time < again && laid > again);
                    }
                    // What the stroke asks for lies under its push.
                    Gesture::Pluck { duration, .. } if timed.time >= again => {
                        assert!(laid <= timed.time + (duration * RATE) as u64, "{wait} s: {laid}");
                    }
                    Gesture::Throw { .. } if timed.time >= again => {
                        assert!(laid <= timed.time, "{wait} s: {laid}")
                    }
                    _ => {}
                }
            }
        }
        assert!(in_the_way > 0, "no hand is in the way of stroke {stroke}");
    }
}
