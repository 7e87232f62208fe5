//! The promise: a tremolo is strokes at its rate while the key is down, no more and no others, and each stroke sounds the
//! note as the first did.

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Stage, amplitude, cc, decibels, hertz, off, on};

/// Times of the plucks of a string, s.
fn plucks(string: usize, events: &[(f64, PlayerEvent)], seconds: f64) -> Vec<f64> {
    let mut stage = Stage::alone("electric", string);
    let played = stage.play(events, seconds);
    let plucks = played.gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. }));
    plucks.map(|g| g.time as f64 / stage.rate).collect()
}

#[test]
fn a_tremolo_told_to_stop_and_go_on_has_one_rate() {
    let again = [(0.02, cc(25, 0)), (0.04, cc(25, 64))];
    let events = [&[(0.0, cc(25, 64)), (0.0, on(55, 90))], &again[..]].concat();
    let plucks = plucks(2, &events, 1.0);
    let rate = 3.0 + 17.0 * 64.0 / 127.0;
    assert!(plucks.len() > 10, "{plucks:?}");
    for pair in plucks[1..].windows(2) {
        let apart = (pair[1] - pair[0]) * rate;
        assert!((apart - 1.0).abs() < 0.01, "{apart} of a turn: {plucks:?}");
    }
}

#[test]
fn a_tremolo_ends_with_its_key_under_the_pedal() {
    let events = [(0.0, cc(25, 64)), (0.0, cc(64, 127)), (0.0, on(55, 90)), (0.4, off(55))];
    let plucks = plucks(2, &events, 1.0);
    assert!(plucks.len() > 3 && plucks.iter().all(|&time| time < 0.4), "{plucks:?}");
}

/// No finger taps where none presses: a harmonic that is to be tapped is plucked, and sounds at its key.
#[test]
fn only_what_is_pressed_is_tapped() {
    for (stop, key) in [(1, 77), (3, 69)] {
        let mut stage = Stage::alone("electric", 0);
        let played = stage.play(&[(0.0, cc(22, 7)), (0.0, cc(23, stop)), (0.0, on(key, 100))], 1.2);
        let sound = &played.strings[0][14_400..];
        let pitch = hertz(f64::from(key));
        let [asked, below] = [pitch, 0.5 * pitch].map(|pitch| amplitude(sound, stage.rate, pitch));
        let off = cents(frequency_near(sound, stage.rate, pitch), pitch);
        assert!(off.abs() < 10.0, "left hand {stop}: {off} cents");
        assert!(decibels(below / asked) < -20.0, "left hand {stop}: {} dB", decibels(below / asked));
        let plucks = played.gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. })).count();
        assert_eq!(plucks, 1, "left hand {stop}");
    }
}

/// Members of an MPE zone have tremolos of their own. A note that takes over another one's string has its own, and the other has
/// none again when it comes back.
#[test]
fn a_connected_note_has_the_tremolo_of_its_channel() {
    let to = |channel, event: PlayerEvent| match event {
        PlayerEvent::NoteOn { key, velocity, .. } => PlayerEvent::NoteOn { channel, key, velocity },
        PlayerEvent::NoteOff { key, .. } => PlayerEvent::NoteOff { channel, key },
        PlayerEvent::Controller { number, value, .. } => PlayerEvent::Controller { channel, number, value },
        other => other,
    };
    let mpe = [101, 100].map(|number| (0.0, cc(number, if number == 100 { 6 } else { 0 })));
    let events = [
        &mpe[..],
        &[(0.0, cc(6, 15)), (0.0, cc(68, 127)), (0.0, to(2, cc(25, 127)))],
        &[(0.0, to(1, on(57, 90))), (0.5, to(2, on(60, 90))), (1.0, to(2, off(60)))],
    ]
    .concat();
    let plucks = plucks(2, &events, 1.5);
    let before = plucks.iter().filter(|&&time| time > 0.1 && time < 0.5).count();
    let during = plucks.iter().filter(|&&time| (0.5..1.0).contains(&time)).count();
    // The pull-off is a pluck, too.
    let after = plucks.iter().filter(|&&time| time > 1.0 + 1.0 / 20.0).count();
    assert_eq!((before, after), (0, 0), "{plucks:?}");
    assert!((8..=10).contains(&during), "{plucks:?}");
}

/// Time (samples), force and place of the strokes of a note that begins at 0.1 s, from the second on.
fn strokes(told: &[(f64, PlayerEvent)]) -> Vec<(u64, f64, f64)> {
    let mut events = [told, &[(0.1, on(57, 90)), (1.4, off(57))]].concat();
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let pluck = |g: &TimedGesture| match g.gesture {
        Gesture::Pluck { force, position, .. } if g.time > 4_800 => Some((g.time, force, position)),
        _ => None,
    };
    Stage::alone("electric", 2).play(&events, 1.5).gestures.iter().filter_map(pluck).collect()
}

/// Whatever it is that begins the note, and wherever the hand is.
#[test]
fn a_tremolo_is_the_same_whether_it_begins_with_its_note_or_later() {
    let ways: [&[(u8, u8)]; 6] =
        [&[(22, 7)], &[(22, 1)], &[(22, 3)], &[(22, 5)], &[(74, 100)], &[(23, 1), (74, 30)]];
    for way in ways {
        let told: Vec<_> = way.iter().map(|&(number, value)| (0.0, cc(number, value))).collect();
        let from = |time| strokes(&[&told[..], &[(time, cc(25, 64))]].concat());
        let [with, later] = [0.0, 0.15].map(from);
        // 11.6 a second: half a stroke less in the time that the second comes later.
        assert!(with.len() >= 14, "{way:?}: {with:?}");
        assert!(with.len().abs_diff(later.len()) <= 1, "{way:?}: {} and {}", with.len(), later.len());
        for (n, (with, later)) in with.iter().zip(&later).enumerate() {
            assert!((with.1 - later.1).abs() < 1e-9, "{way:?}, stroke {n}: {with:?} and {later:?}");
            assert!((with.2 - later.2).abs() < 1e-4, "{way:?}, stroke {n}: {with:?} and {later:?}");
        }
    }
}

/// A note that takes over goes on with the strokes in turn, as hard as it is itself.
#[test]
fn a_tremolo_over_connected_notes_has_the_force_of_each() {
    let events = [(0.0, cc(25, 64)), (0.0, cc(68, 127)), (0.0, on(57, 120)), (0.5, on(60, 40))];
    let strokes =
        Stage::alone("electric", 2).play(&events, 1.0).gestures.into_iter().filter_map(|g| match g.gesture {
            Gesture::Pluck { force, .. } => Some((g.time, force)),
            _ => None,
        });
    let strokes: Vec<_> = strokes.collect();
    let (loud, soft): (Vec<_>, Vec<_>) = strokes.into_iter().partition(|stroke| stroke.0 < 24_000);
    assert!(loud.len() >= 5 && soft.len() >= 5, "{loud:?}, {soft:?}");
    for pair in loud.windows(2).chain(soft.windows(2)) {
        let ratio = (pair[1].1 / pair[0].1).min(pair[0].1 / pair[1].1);
        assert!((ratio - 0.85).abs() < 1e-9, "forth and back in turn: {pair:?}");
    }
    let [last, next] = [loud[loud.len() - 1].1, soft[0].1];
    assert!(next < 0.5 * last, "{last} N, then {next} N");
}
