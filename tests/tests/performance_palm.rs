//! The promise: a palm mutes whatever the thumb of its hand does beside it. It is back when a pinch has been heard and a slap
//! has bounced off, and so is one that is laid on meanwhile.

use low_action::performance::PlayerEvent;
use low_action_dsp::Gesture;
use low_action_tests::stage::{Stage, cc, decibels, on, peak};

const RATE: f64 = 48_000.0;
/// The slot of palm and thumb.
const RIGHT_HAND: usize = 4;

fn at(seconds: f64) -> usize {
    (seconds * RATE) as usize
}

/// How far a sound has fallen from its first 80 ms to 0.4 s later, dB.
fn fallen(events: &[(f64, PlayerEvent)], start: f64) -> f64 {
    let sound = &Stage::alone("electric", 4).play(events, start + 0.6).strings[0];
    let level = |from, to| decibels(peak(&sound[at(start + from)..at(start + to)]));
    level(0.0, 0.08) - level(0.45, 0.6)
}

#[test]
fn the_palm_comes_back_after_the_thumb() {
    for stroke in [4, 6] {
        let note = [(0.0, cc(22, stroke)), (0.0, on(45, 110))];
        let bare = fallen(&note, 0.0);
        let muted = fallen(&[&[(0.0, cc(20, 100))], &note[..]].concat(), 0.0);
        assert!(muted > bare + 15.0, "stroke {stroke}: {muted} dB under the palm, {bare} dB without");
        // The same for one that is laid on while the thumb is there.
        let later = fallen(&[&note[..], &[(0.003, cc(20, 100))]].concat(), 0.0);
        assert!(later > bare + 15.0, "stroke {stroke}: {later} dB, {bare} dB without");
    }
}

#[test]
fn a_palm_laid_on_during_a_graze_stays() {
    for moved in [0.01, 0.03] {
        let events = [(0.0, cc(22, 6)), (0.0, cc(20, 40)), (0.0, on(45, 110)), (moved, cc(20, 100))];
        let played = Stage::alone("electric", 4).play(&events, 0.5);
        let any = |does: fn(&Gesture) -> bool| played.gestures.iter().any(|timed| does(&timed.gesture));
        let laid = any(|gesture| matches!(gesture, Gesture::Place { finger: RIGHT_HAND, .. }));
        let lifted = any(|gesture| matches!(gesture, Gesture::Lift { finger: RIGHT_HAND, .. }));
        assert!(laid && !lifted, "moved after {moved} s: laid on {laid}, lifted {lifted}");
    }
}

/// Each stroke of a tremolo finds the palm where it was.
#[test]
fn a_tremolo_of_pinches_or_slaps_stays_muted() {
    for stroke in [4, 6] {
        let tremolo = [(0.0, cc(22, stroke)), (0.0, cc(25, 30)), (0.0, on(45, 110)), (0.45, cc(25, 0))];
        let last = 3.0 / (3.0 + 17.0 * 30.0 / 127.0);
        let bare = fallen(&tremolo, last);
        let muted = fallen(&[&[(0.0, cc(20, 100))], &tremolo[..]].concat(), last);
        assert!(muted > bare + 12.0, "stroke {stroke}: {muted} dB under the palm, {bare} dB without");
    }
}
