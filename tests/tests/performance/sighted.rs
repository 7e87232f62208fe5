//! Promise: what somebody does to a string they see is what happens: a pluck where they point, a finger that stops the
//! string where they hold it, slides after them and leaves; notes and endings go on as ever, and nonsense does no harm.

use low_action::performance::{PlayerEvent, StringDeed};
use low_action_dsp::Gesture;
use low_action_tests::hands::any_left;
use low_action_tests::pitch::off_key;
use low_action_tests::stage::{Stage, at, cc, off, on, peak};

fn touched(deed: StringDeed) -> PlayerEvent {
    PlayerEvent::Touched { string: 0, deed }
}

fn pluck(position: f32, force: f32) -> PlayerEvent {
    touched(StringDeed::Pluck { position, force })
}

fn press(position: f64) -> PlayerEvent {
    touched(StringDeed::Press { position: position as f32 })
}

/// The string D3 of the electric guitar, and a place to pluck it.
fn string() -> (Stage, f32) {
    let stage = Stage::alone("electric", 3);
    let place = stage.instrument.geometry(0).length as f32 - 0.12;
    (stage, place)
}

#[test]
fn a_pluck_falls_where_it_is_pointed() {
    let (mut stage, _) = string();
    let played = stage.play(&[(0.1, pluck(0.4, 0.7))], 1.0);
    let plucks: Vec<_> =
        played.gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. })).collect();
    let [only] = plucks[..] else { panic!("{plucks:?}") };
    assert_eq!(only.time, 4800);
    let Gesture::Pluck { position, force, .. } = only.gesture else { unreachable!("they are all plucks") };
    assert!((position - 0.4).abs() < 1e-6 && (force - 0.7).abs() < 1e-6);
    assert!(off_key(&played.strings[0][at(0.3)..], 50.0).abs() < 5.0, "the open string");
}

#[test]
fn a_finger_stops_the_string_slides_and_leaves() {
    let (mut stage, place) = string();
    let geometry = stage.instrument.geometry(0).clone();
    let (fifth, seventh) = (geometry.finger_position(5), geometry.finger_position(7));
    let mut events = vec![(0.0, press(fifth)), (0.1, pluck(place, 0.8))];
    // A slide as a mouse makes one.
    events
        .extend((0..30).map(|n| {
            (1.0 + 0.01 * f64::from(n), press(fifth + (seventh - fifth) * f64::from(n + 1) / 30.0))
        }));
    events.push((2.2, touched(StringDeed::Lift)));
    let played = stage.play(&events, 3.4);
    let sound = &played.strings[0];
    for (from, to, key) in [(0.3, 1.0, 55.0), (1.5, 2.2, 57.0), (2.5, 3.4, 50.0)] {
        let off = off_key(&sound[at(from)..at(to)], key);
        assert!(off.abs() < 8.0, "{off} cents from key {key}");
    }
    let placed = played.gestures.iter().filter(|g| matches!(g.gesture, Gesture::Throw { .. })).count();
    assert_eq!(placed, 1, "one finger did it all");
}

#[test]
fn it_can_be_silenced_and_plays_on() {
    let (mut stage, place) = string();
    for silencing in [touched(StringDeed::Damp), PlayerEvent::AllNotesOff] {
        let played = stage.play(&[(0.0, pluck(place, 0.8)), (0.5, silencing), (2.5, pluck(place, 0.8))], 3.0);
        let sound = &played.strings[0];
        let (before, after) = (peak(&sound[at(0.4)..at(0.5)]), peak(&sound[at(1.5)..at(1.6)]));
        assert!(after < 0.01 * before, "{before} before, {after} after");
        assert!(peak(&sound[at(2.6)..at(2.7)]) > 0.5 * before, "it does not sound again");
    }
}

#[test]
fn a_note_takes_the_string_back() {
    let (mut stage, place) = string();
    let finger = stage.instrument.geometry(0).finger_position(9);
    let played = stage.play(
        &[
            (0.0, press(finger)),
            (0.05, pluck(place, 0.5)),
            (0.4, on(52, 90)),
            (1.2, off(52)),
            (1.3, pluck(place, 0.5)),
        ],
        3.0,
    );
    let sound = &played.strings[0];
    let off = off_key(&sound[at(0.6)..at(1.2)], 52.0);
    assert!(off.abs() < 8.0, "{off} cents from its key");
    // Plucked while the note was being damped: the dampers and the note's finger leave, and it rings open.
    assert!(off_key(&sound[at(1.8)..], 50.0).abs() < 5.0);
    assert!(peak(&sound[at(2.8)..]) > 0.02);
}

#[test]
fn nonsense_does_no_harm() {
    let (mut stage, place) = string();
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1e30, 0.0];
    let mut events = Vec::new();
    for (index, &a) in odd.iter().enumerate() {
        for (step, &b) in odd.iter().enumerate() {
            let time = 0.02 * (6 * index + step) as f64;
            events.push((time, pluck(a, b)));
            events.push((time, touched(StringDeed::Press { position: b })));
            events.push((time + 0.01, PlayerEvent::Touched { string: 200, deed: StringDeed::Damp }));
        }
    }
    events.push((0.8, touched(StringDeed::Lift)));
    events.push((0.81, touched(StringDeed::Lift)));
    events.push((1.0, PlayerEvent::AllNotesOff));
    events.push((3.0, pluck(place, 0.8)));
    let sound = &stage.play(&events, 4.0).strings[0];
    assert!(sound.iter().all(|sample| sample.is_finite()));
    assert!(off_key(&sound[at(3.2)..], 50.0).abs() < 5.0);
}

#[test]
fn a_capo_is_a_nut_for_those_who_point_too() {
    let (mut stage, place) = string();
    let sound = &stage.play(&[(0.0, cc(26, 3)), (0.1, pluck(place, 0.7))], 1.0).strings[0];
    let off = off_key(&sound[at(0.2)..], 53.0);
    assert!(off.abs() < 8.0, "{off} cents");
    // A finger that comes and goes leaves it there.
    let finger = stage.instrument.geometry(0).finger_position(7);
    let events = [(0.0, cc(26, 3)), (0.1, press(finger)), (0.8, touched(StringDeed::Lift))];
    let sound = &stage.play(&[&events[..], &[(0.9, pluck(place, 0.7))]].concat(), 1.8).strings[0];
    let off = off_key(&sound[at(1.0)..], 53.0);
    assert!(off.abs() < 8.0, "{off} cents");
}

/// A capo that is easing off a string that falls silent comes back for a pluck, and for a finger.
#[test]
fn a_capo_that_is_leaving_comes_back() {
    let (mut stage, place) = string();
    let finger = stage.instrument.geometry(0).finger_position(7);
    for wait in [0.2, 0.5, 0.7, 0.85] {
        let note = [(0.0, cc(26, 3)), (0.0, on(57, 90)), (0.5, off(57))];
        let plucked = [(0.5 + wait, pluck(place, 0.7))];
        let pressed = [
            (0.5 + wait, press(finger)),
            (0.6 + wait, touched(StringDeed::Lift)),
            (0.7 + wait, pluck(place, 0.7)),
        ];
        for (pointed, from) in [(&plucked[..], 0.6), (&pressed[..], 0.8)] {
            let sound = &stage.play(&[&note[..], pointed].concat(), from + wait + 0.9).strings[0];
            let off = off_key(&sound[at(from + wait)..], 53.0);
            assert!(off.abs() < 8.0, "after {wait} s: {off} cents");
        }
    }
}

/// The hand stills a string that somebody has plucked, which takes its time, but not for ever after.
#[test]
fn a_note_waits_for_no_string_that_was_plucked_long_ago() {
    let (mut stage, place) = string();
    let mut struck = |seconds: u64| {
        let mut gestures = Vec::new();
        stage.performance.reset();
        stage.performance.event(0, pluck(place, 0.5), &mut gestures);
        let time = seconds * 48_000;
        stage.performance.event(time, on(50, 90), &mut gestures);
        stage.performance.advance(time + 4_800, &mut gestures);
        let last = gestures.iter().rfind(|timed| matches!(timed.gesture, Gesture::Pluck { .. }));
        last.expect("the note is struck").time - time
    };
    assert!(struck(1) > 0);
    assert_eq!(struck(31), 0);
}

/// No key ends what is plucked under a capo, but the string must rest some time.
#[test]
fn a_string_plucked_under_a_capo_comes_to_rest() {
    let (mut stage, place) = string();
    let mut gestures = Vec::new();
    stage.performance.event(0, cc(26, 3), &mut gestures);
    stage.performance.event(0, pluck(place, 0.7), &mut gestures);
    stage.performance.advance(29 * 48_000, &mut gestures);
    assert!(any_left(&gestures), "the capo must stay while the string sounds");
    stage.performance.advance(34 * 48_000, &mut gestures);
    assert!(!any_left(&gestures));
}

/// A palm waits for a note, but not for ever: it goes after what is plucked by hand as after notes.
#[test]
fn a_palm_that_came_with_a_pointed_pluck_leaves() {
    let (mut stage, place) = string();
    let finger = stage.instrument.geometry(0).finger_position(5);
    let [plucked, pressed] =
        [&[(5.0, pluck(place, 0.8))][..], &[(5.0, press(finger)), (5.1, touched(StringDeed::Lift))]];
    // The one that was laid when the controller came has gone by then; another one comes.
    let told = [(0.0, cc(20, 100))];
    for deeds in [plucked, pressed] {
        let alone = stage.play(&told, 5.0).gestures;
        assert!(!alone.is_empty() && !any_left(&alone));
        let played = [&told[..], deeds].concat();
        let soon = stage.play(&played, 6.5).gestures;
        assert!(any_left(&soon), "no palm comes: {deeds:?}");
        assert!(!any_left(&stage.play(&played, 7.5).gestures), "it stays: {deeds:?}");
    }
    // One under a note stays as long as that.
    let held = [(0.0, cc(20, 100)), (0.1, on(52, 90)), (0.5, pluck(place, 0.8))];
    let lifts = |played: &[_]| {
        let is_palm = |gesture| matches!(gesture, Gesture::Lift { finger: 4, .. });
        stage.play(played, 4.0).gestures.iter().filter(|timed| is_palm(timed.gesture)).count()
    };
    assert_eq!([&held[..2], &held].map(lifts), [0, 0]);
}
