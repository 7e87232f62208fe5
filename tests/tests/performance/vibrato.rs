//! The promise: a hand begins to swing with its note. A note that is struck begins at its pitch and rises first, whenever it is
//! played; the strings of a chord swing together; a connected note goes on with the swing of the one before.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{Neck, RATE, of_string, wheel};
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
static BARE: LazyLock<Neck> = LazyLock::new(|| Neck::of("fretless-bass"));

/// From one goal of the hand to the next, s: fifteen to a turn.
const STEP: f64 = 0.012;
/// Turns a second, and semitones at its deepest.
const SWING: (f64, f64) = (5.5, 0.5);

fn gestures(neck: &Neck, legato: bool, events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    let touching = Touching { legato, ..Touching::new(0.0, 2.0) };
    neck.told(InputMode::Keyboard, &touching, events)
}

/// Sample, goal (semitones) and seconds of what bends a string from a sample on.
fn bends(gestures: &[TimedGesture], string: usize, from: u64) -> Vec<(u64, f64, f64)> {
    let bend = |g: &TimedGesture| match g.gesture {
        Gesture::Bend { tension_ratio, duration } if g.time >= from => {
            Some((g.time, 6.0 * tension_ratio.log2(), duration))
        }
        _ => None,
    };
    of_string(gestures, string).iter().filter_map(bend).collect()
}

/// Where a hand that has begun at a sample is to be one step after another.
fn swing(since: u64, time: u64) -> f64 {
    let seconds = (time - since) as f64 / RATE + STEP;
    SWING.1 * (std::f64::consts::TAU * SWING.0 * seconds).sin()
}

/// Strings at rest, at four times a quarter of a turn apart.
#[test]
fn a_note_begins_at_its_pitch_whenever_it_is_played() {
    let later = |start: u64| -> Vec<(u64, f64, f64)> {
        let all =
            gestures(&GUITAR, false, &[(0, cc(1, 127)), (start, on(64, 90)), (start + 24_000, off(64))]);
        bends(&all, 0, 0).into_iter().map(|(time, goal, seconds)| (time - start, goal, seconds)).collect()
    };
    let first = later(48_000);
    assert!(first.len() > 30, "{first:?}");
    let (time, goal, seconds) = first[0];
    assert!(time <= 1 && (goal - swing(0, time)).abs() < 1e-9 && seconds >= STEP, "{:?}", first[0]);
    assert!(first[1].1 > goal, "it rises first");
    for start in [50_160, 52_320, 54_528] {
        assert_eq!(later(start), first, "from {start}");
    }
}

#[test]
fn what_bends_a_string_before_its_note_leaves_the_swing_out() {
    let all = gestures(&GUITAR, false, &[(0, cc(1, 127)), (0, wheel(0, 1.0)), (4_800, on(64, 90))]);
    let [before, first, ..] = bends(&all, 0, 0)[..] else { panic!("{all:?}") };
    assert!(before.0 == 4_800 && (before.1 - 2.0).abs() < 1e-9 && before.2 <= 1.0 / RATE, "{before:?}");
    assert!(first.0 == 4_801 && first.1 < 2.25 && first.2 >= STEP, "{first:?}");
}

/// One of its strings sounds already, and swings elsewhere.
#[test]
fn the_strings_of_a_chord_swing_together() {
    let chord = [40, 47, 52].map(|key| (13_000, on(key, 90)));
    let all = gestures(&GUITAR, false, &[&[(0, cc(1, 127)), (0, on(40, 90))], &chord[..]].concat());
    for string in [3, 4, 5] {
        let swings = bends(&all, string, 13_000);
        assert!(swings.len() > 20, "string {string}: {swings:?}");
        for &(time, goal, seconds) in swings.iter().take(20) {
            // Compensated for their frets, which is less than a hundredth.
            assert!((goal - swing(13_000, time)).abs() < 0.02, "string {string}: {goal} at {time}");
            assert!(seconds >= STEP, "what sounds is not pulled at once: {seconds} s");
        }
        assert!(swings[0].0 < 13_000 + 200, "string {string}: {swings:?}");
    }
}

#[test]
fn a_connected_note_goes_on_with_the_swing() {
    // A hammer, and the pull as its key goes up, anywhere in a turn; and a slide.
    for told in [&[][..], &[(0, cc(65, 127))]] {
        let notes = [(0, cc(1, 127)), (13_000, on(52, 90)), (30_000, on(54, 90)), (44_000, off(54))];
        let all = gestures(&GUITAR, true, &[told, &notes].concat());
        let string = all.iter().find(|g| matches!(g.gesture, Gesture::Pluck { .. })).expect("struck").string;
        let swings = bends(&all, string, 0);
        assert!(swings.len() > 60, "{swings:?}");
        for &(time, goal, _) in swings.iter().filter(|bend| bend.0 < 60_000) {
            assert!((goal - swing(13_000, time)).abs() < 0.02, "{goal} at {time}");
        }
    }
}

/// A finger that rolls on a bare board is heard on its way, and so takes its time from the first.
#[test]
fn a_finger_on_a_bare_board_begins_at_its_place() {
    let places = |start: u64| -> Vec<(u64, f64)> {
        let all = gestures(&BARE, false, &[(0, cc(1, 127)), (start, on(35, 90)), (start + 24_000, off(35))]);
        let slide = |g: &TimedGesture| match g.gesture {
            Gesture::Slide { position, .. } => Some((g.time - start, position)),
            _ => None,
        };
        all.iter().filter_map(slide).collect()
    };
    let first = places(48_000);
    assert!(first.len() > 20 && first[0].0 == 0 && first[1].1 > first[0].1, "{first:?}");
    for start in [50_160, 52_320] {
        assert_eq!(places(start), first, "from {start}");
    }
}
