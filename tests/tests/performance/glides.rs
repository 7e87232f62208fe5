//! The promise: a finger that has glided or slid is where it is, and not where its note began: what comes after it is stopped where
//! it should be, from the first moment on.

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::pitch::off_key;
use low_action_tests::stage::{Stage, at, cc, octave, off, on, wheel};

const FRETLESS: (&str, usize) = ("fretless-bass", 2);

/// How far off a key a string alone sounds in parts of what is played, from and to s, cents; the wheel goes an octave far.
fn off_keys(
    (setup, string): (&str, usize),
    events: &[(f64, PlayerEvent)],
    heard: &[(f64, f64, f64)],
) -> Vec<f64> {
    let octave = octave();
    let last = heard.iter().map(|part| part.1).fold(0.0, f64::max);
    let sound = &Stage::alone(setup, string).play(&[&octave, events].concat(), last).strings[0];
    heard.iter().map(|&(from, to, key)| off_key(&sound[at(from)..at(to)], key)).collect()
}

/// All within so many cents.
fn are_in_tune(what: &str, off: &[f64], cents: f64) {
    assert!(off.iter().all(|off| off.abs() < cents), "{what}: {off:?} cents off");
}

/// The finger had glided, and lies behind the one that was hammered.
#[test]
fn a_pull_comes_back_to_its_note() {
    let events = [
        (0.0, cc(68, 127)),
        (0.0, on(43, 90)),
        (0.2, wheel(1.0)),
        (0.6, wheel(0.0)),
        (0.6, on(45, 90)),
        (1.0, off(45)),
    ];
    let off = off_keys(FRETLESS, &events, &[(0.4, 0.6, 44.0), (0.8, 1.0, 45.0), (1.15, 1.6, 43.0)]);
    are_in_tune("glided up, hammered, pulled off", &off, 8.0);
}

/// It stops the string in front of the one that is to be hammered.
#[test]
fn a_note_behind_a_glided_finger_is_no_hammer() {
    let events =
        [(0.0, cc(68, 127)), (0.0, on(43, 90)), (0.2, wheel(3.0)), (0.6, wheel(0.0)), (0.6, on(45, 90))];
    let off = off_keys(FRETLESS, &events, &[(0.4, 0.6, 46.0), (0.75, 1.2, 45.0)]);
    are_in_tune("glided three up, two asked for", &off, 8.0);
}

#[test]
fn a_plucked_note_behind_it_is_heard_at_once() {
    let events = [(0.0, on(35, 90)), (0.2, wheel(4.0)), (0.6, wheel(0.0)), (0.6, off(35)), (0.6, on(36, 90))];
    let off = off_keys(FRETLESS, &events, &[(0.4, 0.6, 39.0), (0.65, 0.8, 36.0), (0.8, 1.2, 36.0)]);
    are_in_tune("glided four up, one asked for", &off, 15.0);
}

/// One that glided down and was leaving is called back.
#[test]
fn one_that_is_called_back_comes_to_its_fret() {
    let events = [
        (0.0, wheel(-1.0)),
        (0.0, on(43, 90)),
        (0.4, off(43)),
        (0.4, wheel(0.0)),
        (0.4, on(45, 90)),
        (0.5, off(45)),
        (0.5, on(43, 90)),
    ];
    let off = off_keys(FRETLESS, &events, &[(0.2, 0.4, 42.0), (0.65, 1.1, 43.0)]);
    are_in_tune("glided down, called back", &off, 8.0);
}

/// Fingers that come down beside their frets, the second one behind the first, which is behind the fret of the second. (So it was left
/// down until that had come, and was heard for 100 ms.)
#[test]
fn which_of_two_is_behind_goes_by_where_they_are() {
    let events = [(0.0, wheel(-5.0)), (0.0, on(43, 90)), (0.8, off(43)), (0.82, on(41, 90))];
    let off = off_keys(FRETLESS, &events, &[(0.4, 0.8, 38.0), (0.84, 0.94, 36.0), (0.9, 1.3, 36.0)]);
    are_in_tune("two notes five down", &off, 15.0);
}

/// What stopped the string before is still on its way up behind, where a slide passes: as if nobody had been there.
#[test]
fn a_slide_down_passes_what_is_leaving() {
    let before = [(0.0, on(60, 90)), (0.3, off(60))];
    let by_wheel = [(0.3, on(62, 90)), (0.33, wheel(-5.0))];
    let by_legato = [(0.3, on(62, 90)), (0.33, cc(68, 127)), (0.33, cc(65, 127)), (0.33, on(58, 90))];
    for (events, to, from) in [(&by_wheel[..], 57.0, 0.4), (&by_legato, 58.0, 0.45)] {
        let heard = [(from, from + 0.06, to), (from + 0.06, from + 0.12, to), (0.6, 0.8, to)];
        let alone = off_keys(("electric", 2), events, &heard);
        let after = off_keys(("electric", 2), &[&before, events].concat(), &heard);
        println!("to {to}: {after:?} cents off, {alone:?} alone");
        let more: Vec<f64> = after.iter().zip(&alone).map(|(after, alone)| after - alone).collect();
        are_in_tune("more than alone", &more, 10.0);
        assert!(alone[2].abs() < 8.0, "{alone:?}");
    }
}

/// The finger is to be a fret below the new note, and is ten above it.
#[test]
fn a_note_in_a_slide_is_stopped_where_it_should_be() {
    let events = [
        (0.0, cc(68, 127)),
        (0.0, cc(65, 127)),
        (0.0, on(67, 90)),
        (0.3, on(56, 90)),
        // Plucked, and not by legato.
        (0.36, cc(68, 0)),
        (0.36, cc(65, 0)),
        (0.38, on(58, 90)),
    ];
    let off = off_keys(("electric", 2), &events, &[(0.42, 0.46, 58.0), (0.44, 0.54, 58.0), (0.6, 0.9, 58.0)]);
    are_in_tune("plucked in a slide", &off, 8.0);
}

/// Past the reach of pulling it comes down where it would have to slide: on an open string, too, and again and again.
#[test]
fn a_note_under_a_wheel_begins_in_tune_however_far_that_stands() {
    let cases = [
        ("classical", 3, 50, 2.0),
        ("classical", 3, 57, 2.0),
        ("electric", 2, 57, 5.0),
        ("electric", 5, 40, 7.0),
        ("electric", 5, 47, -3.0),
        ("steel", 2, 55, 12.0),
    ];
    for (setup, string, key, turned) in cases {
        let events = [
            (0.0, wheel(turned)),
            (0.01, on(key, 90)),
            (0.3, off(key)),
            (0.31, on(key, 90)),
            (0.6, off(key)),
            (1.05, on(key, 90)),
        ];
        let to = f64::from(key) + turned;
        let heard =
            [(0.015, 0.065, to), (0.05, 0.3, to), (0.34, 0.4, to), (1.055, 1.105, to), (1.1, 1.4, to)];
        let off = off_keys((setup, string), &events, &heard);
        are_in_tune(setup, &off, 8.0);
    }
}

/// So does a finger that taps or hammers, and one that is left when another is pulled off.
#[test]
fn fingers_that_strike_come_down_there_too() {
    let taps = [(0.0, cc(22, 7)), (0.0, wheel(5.0)), (0.01, on(57, 90)), (0.3, off(57)), (0.4, on(58, 90))];
    let heard = [(0.03, 0.1, 62.0), (0.1, 0.3, 62.0), (0.45, 0.6, 63.0)];
    are_in_tune("tapped", &off_keys(("electric", 2), &taps, &heard), 8.0);
    let legato = [
        (0.0, cc(68, 127)),
        (0.0, wheel(5.0)),
        (0.01, on(57, 90)),
        (0.3, on(60, 90)),
        (0.6, off(60)),
        (0.9, off(57)),
    ];
    let heard = [(0.1, 0.3, 62.0), (0.33, 0.4, 65.0), (0.4, 0.6, 65.0), (0.63, 0.7, 62.0), (0.7, 0.9, 62.0)];
    are_in_tune("hammered and pulled off", &off_keys(("electric", 2), &legato, &heard), 10.0);
}

/// Where nothing keeps fingers on frets they come down beside them, a bar too, and not at the fret to glide from there.
#[test]
fn fingers_that_glide_come_down_where_the_wheel_has_them() {
    for (setup, key) in [(FRETLESS, 43), (("lap-steel", 2), 64)] {
        let to = f64::from(key) + 1.5;
        let begun = [(0.0, wheel(1.5)), (0.01, on(key, 90))];
        let glides = |gesture: &TimedGesture| matches!(gesture.gesture, Gesture::Slide { .. });
        let octave = octave();
        let played = Stage::alone(setup.0, setup.1).play(&[&octave[..], &begun].concat(), 0.3);
        assert!(!played.gestures.iter().any(glides), "{setup:?}: {:?}", played.gestures);
        let off = off_key(&played.strings[0][at(0.05)..at(0.3)], to);
        are_in_tune(setup.0, &[off], 8.0);
    }
    let legato =
        [(0.0, cc(68, 127)), (0.0, wheel(1.5)), (0.01, on(43, 90)), (0.3, on(45, 90)), (0.6, off(45))];
    let heard = [(0.05, 0.3, 44.5), (0.33, 0.6, 46.5), (0.65, 0.9, 44.5)];
    are_in_tune("fretless, hammered and pulled off", &off_keys(FRETLESS, &legato, &heard), 10.0);
}
