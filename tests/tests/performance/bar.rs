//! The promise: an instrument whose strings no finger can press down is played with a bar, unless hands are told otherwise.

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, play};
use low_action_tests::pitch::{cents, frequency_near, off_key};
use low_action_tests::stage::{Stage, at, cc, hertz, off, on};

/// Heaviest finger, kg, and a bar with the hand that holds it is heavier.
const FINGER: f64 = 0.05;

/// Masses of what is laid on the strings, kg.
fn laid(gestures: &[TimedGesture]) -> Vec<f64> {
    let mass = |gesture: &TimedGesture| match gesture.gesture {
        Gesture::Place { touch, .. } | Gesture::Throw { touch, .. } => Some(touch.mass),
        _ => None,
    };
    gestures.iter().filter_map(mass).collect()
}

fn stopped_by(instrument: &str, told: &[PlayerEvent]) -> Vec<f64> {
    let mut performance = Neck::of(instrument).player(EXACT);
    let key = PlayerEvent::NoteOn { channel: 0, key: 67, velocity: 0.7 };
    let events: Vec<_> = told.iter().chain([&key]).map(|&event| (0, event)).collect();
    laid(&play(&mut performance, &events))
}

#[test]
fn a_bar_stops_what_fingers_cannot_reach() {
    let stopped = stopped_by("lap-steel", &[]);
    assert!(stopped.iter().any(|&mass| mass > FINGER), "a bar: {stopped:?} kg");
    // As usual again, and as a harmonic.
    let stopped = stopped_by("lap-steel", &[cc(23, 2), cc(23, 0)]);
    assert!(stopped.iter().any(|&mass| mass > FINGER), "a bar again: {stopped:?} kg");
    for way in [1, 2] {
        let stopped = stopped_by("lap-steel", &[cc(23, way)]);
        let by_a_finger = !stopped.is_empty() && stopped.iter().all(|&mass| mass < FINGER);
        assert!(by_a_finger, "CC 23 = {way}: {stopped:?} kg");
    }
    let stopped = stopped_by("electric", &[]);
    assert!(!stopped.is_empty() && stopped.iter().all(|&mass| mass < FINGER), "a finger: {stopped:?} kg");
}

/// The bar weighs 0.25 N on the string and is not infinitely heavy: both raise the pitch a little, as far as
/// `touches` allows where a bar is asked for.
#[test]
fn so_it_is_in_tune_by_itself() {
    for (string, open) in [(0, 62.0), (2, 55.0), (5, 38.0)] {
        for fret in [5.0, 7.0, 12.0] {
            let key = open + fret;
            let sound = &Stage::alone("lap-steel", string).play(&[(0.0, on(key as u8, 90))], 1.2).strings[0];
            let off = cents(frequency_near(&sound[12_000..], 48_000.0, hertz(key)), hertz(key));
            assert!((-4.0..10.0).contains(&off), "string {string}, semitone {fret}: {off} cents");
        }
    }
}

/// One that is going is laid anew: it came down so slowly that the open string sounded first, for 120 ms after a rest of 0.88 s.
#[test]
fn it_lies_there_when_its_note_comes_again() {
    let mut stage = Stage::alone("lap-steel", 3);
    for rest in [0.2, 0.45, 0.6, 0.75, 0.8, 0.88, 0.95, 1.2] {
        let again = 0.3 + rest;
        let events = [(0.0, on(55, 90)), (0.3, off(55)), (again, on(55, 90))];
        let sound = &stage.play(&events, again + 0.5).strings[0];
        let off = [(0.02, 0.12), (0.1, 0.5)]
            .map(|(from, to)| off_key(&sound[at(again + from)..at(again + to)], 55.0));
        assert!(off.iter().all(|off| (-4.0..10.0).contains(off)), "{rest} s: {off:?} cents");
    }
}

/// It would have to press strings down that lie millimetres above their frets: they would be a third of a semitone sharp.
#[test]
fn no_capo_is_laid_there() {
    let (steel, guitar) = (Neck::of("lap-steel"), Neck::of("electric"));
    let notes = [62, 69, 50].map(|key| (0, on(key, 90)));
    let with_capo = [&[(0, cc(26, 5))][..], &notes].concat();
    assert_eq!(play(&mut steel.player(EXACT), &with_capo), play(&mut steel.player(EXACT), &notes));
    // Another instrument that takes over has it where it was asked for, whether strings go on or not.
    let capo = |gesture: &TimedGesture| matches!(gesture.gesture, Gesture::Place { finger: 5, .. });
    for go_on in [false, true] {
        let mut first = steel.player(EXACT);
        first.event(0, cc(26, 5), &mut Vec::new());
        let mut next = guitar.player(EXACT);
        next.take_over(&first, go_on);
        let gestures = play(&mut next, &[(10, on(64, 90))]);
        assert!(gestures.iter().any(capo), "strings go on: {go_on}");
        let mut announced = guitar.player(EXACT);
        announced.announce(&first.announced());
        assert!(play(&mut announced, &[(0, on(64, 90))]).iter().any(capo));
    }
}
