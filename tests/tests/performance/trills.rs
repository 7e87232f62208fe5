//! The promise: a trill under a pedal goes on as one. A key that is struck again over one that is down is hammered, or struck on an
//! open string; when the pedal goes up the one below comes back, and what the sostenuto pedal has caught is not lost under another.

use std::sync::LazyLock;

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, RATE};
use low_action_tests::pitch::off_key;
use low_action_tests::stage::{Stage, at, cc, level, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
const LEGATO: (f64, PlayerEvent) = (0.0, PlayerEvent::Controller { channel: 0, number: 68, value: 1.0 });

/// A key held, and another struck over it so often, 0.2 s apart, each time for half of that, from 0.3 s on.
fn trill(held: u8, other: u8, turns: u8) -> Vec<(f64, PlayerEvent)> {
    let mut events = vec![LEGATO, (0.1, on(held, 90))];
    for turn in 0..turns {
        let start = 0.3 + 0.2 * f64::from(turn);
        events.extend([(start, on(other, 90)), (start + 0.1, off(other))]);
    }
    events
}

#[test]
fn a_trill_under_a_pedal_goes_on_as_one() {
    // Hammered over it, and pulled off it.
    for (setup, string, held, other) in
        [("electric", 4, 52, 54), ("electric", 0, 69, 71), ("electric", 2, 62, 60), ("bass", 3, 33, 35)]
    {
        let mut stage = Stage::alone(setup, string);
        let pedal = [(0.0, cc(64, 127))];
        let events = [&pedal[..], &trill(held, other, 4), &[(1.3, cc(64, 0)), (1.8, off(held))]].concat();
        let played = stage.play(&events, 2.4);
        // The first, and one pull: from the one to the other, or back.
        let plucks = played.gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. })).count();
        assert_eq!(plucks, 2, "{setup} {string}");
        let sound = &played.strings[0];
        for (from, to, key) in [(0.33, 0.5, other), (1.0, 1.3, other), (1.4, 1.8, held)] {
            let cents = off_key(&sound[at(from)..at(to)], f64::from(key));
            assert!(cents.abs() < 8.0, "{setup} {string}, {key} from {from} s: {cents} cents");
        }
        // A finger strikes for each, as soon as the string is up.
        for turn in 1..4 {
            let start = at(0.3 + 0.2 * f64::from(turn)) as u64;
            let throws = |g: &&TimedGesture| matches!(g.gesture, Gesture::Throw { .. });
            let thrown = played.gestures.iter().filter(throws).find(|g| g.time >= start);
            let late = thrown.map(|g| g.time - start);
            assert!(
                late.is_some_and(|late| late < at(0.015) as u64),
                "{setup} {string}, turn {turn}: {late:?}"
            );
        }
        let left = level(&sound[at(2.3)..]) - level(&sound[at(1.4)..at(1.8)]);
        assert!(left < -50.0, "{setup} {string}: {left} dB when the key is up");
    }
}

/// By the right hand, on an open string, and where fingers slide.
#[test]
fn what_no_finger_can_strike_again_is_plucked() {
    for (slides, held, other) in [(0, 57, 55), (127, 57, 59)] {
        let told = [(0.0, cc(64, 127)), (0.0, cc(65, slides)), (0.0, cc(5, 20))];
        let events = [&told[..], &trill(held, other, 3), &[(1.0, cc(64, 0))]].concat();
        let played = Stage::alone("electric", 2).play(&events, 1.6);
        let strokes = played.gestures.iter().filter(|g| match g.gesture {
            Gesture::Pluck { .. } => [0.5, 0.7].iter().any(|&time| g.time == at(time + 1e-9) as u64),
            _ => false,
        });
        assert_eq!(strokes.count(), 2, "slides {slides}");
        for (from, to, key) in [(0.8, 1.0, other), (1.1, 1.6, held)] {
            let cents = off_key(&played.strings[0][at(from)..at(to)], f64::from(key));
            assert!(cents.abs() < 8.0, "slides {slides}, {key}: {cents} cents");
        }
    }
}

/// Which of two keys sound after each event of theirs (samples).
fn sounding(events: &[(u64, PlayerEvent)], keys: [u8; 2]) -> Vec<[bool; 2]> {
    let mut player = GUITAR.player(EXACT);
    let mut gestures = Vec::new();
    let after = |&(time, event): &(u64, PlayerEvent)| {
        player.event(time, event, &mut gestures);
        player.advance(time + 1, &mut gestures);
        keys.map(|key| player.sounds(0, key))
    };
    events.iter().map(after).collect()
}

#[test]
fn what_the_sostenuto_pedal_has_caught_is_kept_under_another() {
    let time = |tenths: u64| tenths * RATE as u64 / 10;
    let (a, b) = (52, 54);
    let begun = [(0, cc(68, 127)), (0, on(a, 90)), (time(2), cc(66, 127)), (time(4), on(b, 90))];
    // In either order of its own key and the other.
    for [first, second] in [[a, b], [b, a]] {
        let ends = [(time(6), off(first)), (time(8), off(second)), (time(10), cc(66, 0))];
        let found = sounding(&[&begun[..], &ends].concat(), [a, b]);
        assert_eq!(found[4], [true, first == a]);
        assert_eq!(found[5..], [[true, false], [false, false]], "{first} first");
    }
    // And where the pedal goes up in between nothing is left of it.
    let ends = [(time(6), off(a)), (time(7), cc(66, 0)), (time(8), off(b))];
    assert_eq!(
        sounding(&[&begun[..], &ends].concat(), [a, b])[4..],
        [[true, true], [false, true], [false; 2]]
    );
    // One that lies under another already is caught, too.
    let begun = [(0, cc(68, 127)), (0, on(a, 90)), (time(2), on(b, 90)), (time(4), cc(66, 127))];
    let ends = [(time(6), off(a)), (time(8), off(b)), (time(10), cc(66, 0))];
    assert_eq!(sounding(&[&begun[..], &ends].concat(), [a, b])[4..], [[true; 2], [true; 2], [false; 2]]);
}
