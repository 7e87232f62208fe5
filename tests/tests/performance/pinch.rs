//! The promise: the thumb of a pinch harmonic is beside the plectrum, so the controller that moves the hand (74) chooses the
//! partial that sounds; a hand that has not been moved grazes the node nearest to its usual place.

use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::stage::{Stage, amplitude, cc, decibels, hertz, on};

const RATE: f64 = 48_000.0;
/// What the palm and the thumb are among the fingers of a string.
const RIGHT_HAND: usize = 4;

/// What the hands do and how loud the first twelve partials are (dB), from 0.1 to 0.2 s, so short that
/// stretched partials count in full, for a pinched E on the
/// second fret of the electric guitar's fourth string, which is plucked 0.12 m from the saddle.
fn pinched(stage: &mut Stage, place: Option<u8>) -> (Vec<TimedGesture>, Vec<f64>) {
    let moved = place.map(|place| (0.0, cc(74, place)));
    let events: Vec<_> = moved.into_iter().chain([(0.0, cc(22, 6)), (0.0, on(52, 110))]).collect();
    let played = stage.play(&events, 1.0);
    let sound = &played.strings[0][(0.1 * RATE) as usize..(0.2 * RATE) as usize];
    let pitch = hertz(52.0);
    let levels = (1..=12).map(|k| decibels(amplitude(sound, RATE, pitch * f64::from(k)))).collect();
    (played.gestures, levels)
}

/// The place that the thumb touches, m from the nut.
fn touched(gestures: &[TimedGesture]) -> f64 {
    let place = gestures.iter().find_map(|timed| match timed.gesture {
        Gesture::Place { finger: RIGHT_HAND, position, .. } => Some(position),
        _ => None,
    });
    place.expect("a thumb touches the string")
}

/// The string that sounds is 0.594 m long, so its nodes nearest to the saddle are those of the 3rd partial 0.2 m from it, of
/// the 5th 0.12 m, of the 8th 0.074 m and of the 9th 0.066 m.
#[test]
fn the_place_of_the_hand_chooses_the_partial() {
    let mut stage = Stage::alone("electric", 3);
    for (place, partial) in [(0, 3), (40, 4), (64, 5), (80, 6), (90, 7), (100, 8), (127, 9)] {
        let (gestures, levels) = pinched(&mut stage, Some(place));
        let geometry = stage.instrument.geometry(0);
        let (length, sounding) = (geometry.length, geometry.length - geometry.finger_position(2));
        let touched = sounding / (length - touched(&gestures));
        assert!((touched - partial as f64).abs() < 1e-9, "74 = {place}: the thumb is at 1/{touched}");
        // Others lose 40 ms under a thumb that takes up what they send it. Nearest come those that move least there: the
        // first, and one beside that which is picked out: the 6th moves by sin(π/7) there, 0.43 of its most, and is 3.5 dB
        // below the 7th; at all other places they are 7 dB and more below.
        for (other, level) in (1..).zip(&levels).filter(|&(other, _)| other % partial != 0) {
            let below = levels[partial - 1] - level;
            assert!(below > 3.0, "74 = {place}: partial {other} is {below} dB below the {partial}th");
        }
    }
}

#[test]
fn a_hand_at_rest_is_at_its_usual_place() {
    let mut stage = Stage::alone("electric", 3);
    let unsent = pinched(&mut stage, None);
    assert_eq!(pinched(&mut stage, Some(64)), unsent);
}
