//! The promise: when nobody plays, nothing is done. Hands come to rest after every note, whatever controllers say, and
//! strings that are left alone can rest.

use low_action::performance::{Expression, PlayerEvent, StringDeed};
use low_action_dsp::Gesture;
use low_action_tests::stage::{Stage, cc, off, on};

/// What hands do, s, and whether it is a pull at the string.
fn deeds(events: &[(f64, PlayerEvent)], seconds: f64) -> Vec<(f64, bool)> {
    let mut stage = Stage::alone("electric", 2);
    let played = stage.play(events, seconds);
    let deed = |time: u64, gesture| (time as f64 / stage.rate, matches!(gesture, Gesture::Bend { .. }));
    played.gestures.iter().map(|gesture| deed(gesture.time, gesture.gesture)).collect()
}

/// The last thing hands do, s. They must have done something.
fn last(deeds: &[(f64, bool)]) -> f64 {
    deeds.iter().map(|deed| deed.0).max_by(f64::total_cmp).expect("nobody has played")
}

/// How often the string is pulled between two times, s.
fn pulls(deeds: &[(f64, bool)], from: f64, to: f64) -> usize {
    deeds.iter().filter(|(time, pulls)| *pulls && (from..to).contains(time)).count()
}

#[test]
fn a_vibrato_ends_with_its_note() {
    let wheel = cc(1, 64);
    let own = PlayerEvent::Note { channel: 0, key: 60, expression: Expression::Vibrato(1.0) };
    for (key, vibrato) in [(55, wheel), (60, wheel), (60, own)] {
        let deeds = deeds(&[(0.0, on(key, 90)), (0.1, vibrato), (0.4, off(key))], 4.0);
        // A goal every 12 ms: 25 in 0.3 s.
        let pulls = pulls(&deeds, 0.1, 0.4);
        assert!(pulls >= 20, "{key}, {vibrato:?}: it swings by {pulls} pulls");
        let last = last(&deeds);
        assert!(last < 2.0, "{key}, {vibrato:?}: {last} s");
    }
}

#[test]
fn a_wheel_swings_no_string_without_a_note() {
    let deeds = deeds(&[(0.0, on(55, 90)), (0.4, off(55)), (2.5, cc(1, 90))], 4.0);
    let last = last(&deeds);
    assert!((0.4..2.0).contains(&last), "{last} s");
}

/// Somebody who plucks a string whose note is ending lets it ring, and it is straight.
#[test]
fn a_vibrato_ends_under_a_pointed_pluck() {
    let pluck = StringDeed::Pluck { position: 0.4, force: 0.7 };
    let touched = PlayerEvent::Touched { string: 0, deed: pluck };
    let deeds = deeds(&[(0.0, cc(1, 64)), (0.0, on(55, 90)), (0.4, off(55)), (0.6, touched)], 3.0);
    let pulls = pulls(&deeds, 0.1, 0.4);
    assert!(pulls >= 20, "it swings by {pulls} pulls");
    let last = last(&deeds);
    assert!((0.6..0.7).contains(&last), "{last} s");
}
