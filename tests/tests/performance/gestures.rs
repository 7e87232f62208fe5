//! The promise: notes become gestures of two hands. Every key finds its own string, its release ends that
//! note and no other, nothing hangs, and the result depends on when things happen, never on how time is
//! cut into blocks.

use std::sync::LazyLock;

use low_action::performance::{Performance, PlayerEvent, Style};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::cases::cases;
use low_action_tests::hands::{
    EXACT, Neck, any_left, of_string, play as play_by, play_in_blocks, stopped_at_last,
};
use proptest::prelude::*;

/// A quarter of a second, samples.
const WHILE: u64 = 12_000;

/// The electric guitar, whose strings are 0 (E4) to 5 (E2).
static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

/// A player who has not touched it yet.
fn player(style: Style) -> Performance {
    GUITAR.player(style)
}

fn on(key: u8) -> PlayerEvent {
    PlayerEvent::NoteOn { channel: 0, key, velocity: 0.5 }
}

fn off(key: u8) -> PlayerEvent {
    PlayerEvent::NoteOff { channel: 0, key }
}

fn controller(number: u8, value: u8) -> PlayerEvent {
    PlayerEvent::Controller { channel: 0, number, value: f32::from(value) / 127.0 }
}

/// Plays events and what follows until every hand is gone.
fn play(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    play_by(&mut player(EXACT), events)
}

/// (time, string) of the plucks.
fn plucks(gestures: &[TimedGesture]) -> Vec<(u64, usize)> {
    let pluck = |g: &&TimedGesture| matches!(g.gesture, Gesture::Pluck { .. });
    gestures.iter().filter(pluck).map(|g| (g.time, g.string)).collect()
}

/// (time, string) at which dampers come down: always two, in the slots 2 and 3.
fn dampings(gestures: &[TimedGesture]) -> Vec<(u64, usize)> {
    let [one, other] = [2, 3].map(|slot| -> Vec<(u64, usize)> {
        let damper = |g: &&TimedGesture| matches!(g.gesture, Gesture::Place { finger, .. } if finger == slot);
        gestures.iter().filter(damper).map(|g| (g.time, g.string)).collect()
    });
    assert_eq!(one, other, "the two dampers of a string come down together");
    one
}

#[test]
fn a_fretted_note_is_a_finger_and_a_pluck_at_once() {
    let gestures = play(&[(100, on(67))]);
    let [place, press, pluck] = &gestures[..] else { panic!("{gestures:?}") };
    assert!(gestures.iter().all(|gesture| gesture.time == 100 && gesture.string == 0));
    let Gesture::Place { finger, position, clearance, .. } = place.gesture else { panic!("{place:?}") };
    // Behind the third fret: between the second and the third of a 0.6477 m scale.
    assert!(position > 0.0706 && position < 0.1031, "{position} m");
    assert!(clearance > 0.0 && clearance < 1e-3);
    assert!(matches!(press.gesture, Gesture::Press { finger: presses, force, duration }
        if presses == finger && force > 1.0 && duration > 0.0));
    assert!(matches!(pluck.gesture, Gesture::Pluck { position, force, .. } if position > 0.5 && force > 0.0));
    // An open string takes the pluck alone.
    assert_eq!(play(&[(0, on(64))]).len(), 1);
}

#[test]
fn force_grows_with_velocity() {
    let force = |velocity| {
        let gestures = play(&[(0, PlayerEvent::NoteOn { channel: 0, key: 64, velocity })]);
        match gestures[0].gesture {
            Gesture::Pluck { force, .. } => force,
            other => panic!("{other:?}"),
        }
    };
    let hardest = GUITAR.setup.player.pluck_force;
    assert!((force(1.0) - hardest).abs() < 1e-12);
    assert_eq!(force(5.0), force(1.0), "no more than the hardest");
    for step in 1..127 {
        assert!(force(step as f32 / 127.0) < force((step + 1) as f32 / 127.0));
    }
    assert!(force(1.0 / 127.0) > 0.0);
}

#[test]
fn a_release_ends_its_own_note_and_no_other() {
    let gestures = play(&[
        (0, on(64)),
        (0, on(59)),
        (0, PlayerEvent::NoteOn { channel: 1, key: 55, velocity: 0.5 }),
        (WHILE, off(55)),
        (WHILE, PlayerEvent::NoteOff { channel: 1, key: 64 }),
        (WHILE, off(60)),
        (2 * WHILE, off(59)),
    ]);
    assert_eq!(dampings(&gestures), [(2 * WHILE, 1)]);
    // A stolen note's release must not cut the note that took its string: E2 and F2 share one.
    let gestures = play(&[(0, on(40)), (WHILE, on(41)), (2 * WHILE, off(40)), (3 * WHILE, off(41))]);
    let [(0, 5), (later, 5)] = plucks(&gestures)[..] else { panic!("{gestures:?}") };
    // The hand stills the string first, in at most 3 ms.
    assert!((WHILE..WHILE + 144).contains(&later), "{later}");
    assert_eq!(dampings(&gestures), [(3 * WHILE, 5)]);
}

#[test]
fn after_a_note_every_finger_leaves() {
    let gestures = play(&[(0, on(64)), (0, on(62)), (WHILE, off(64)), (WHILE, off(62))]);
    assert!(!any_left(&gestures));
    assert_eq!(dampings(&gestures).len(), 2);
    // The fretting finger stays down until the string is quiet.
    let lift = gestures.iter().find(|g| matches!(g.gesture, Gesture::Lift { finger: 0, .. }));
    assert!(lift.expect("it leaves").time >= WHILE + 7_200);
}

#[test]
fn a_key_that_comes_again_is_struck_on_its_string() {
    let gestures = play(&[(0, on(62)), (WHILE, off(62)), (WHILE + 200, on(62)), (3 * WHILE, off(62))]);
    let struck = plucks(&gestures);
    assert_eq!((struck.len(), struck[0].1), (2, struck[1].1));
    // The finger that is still there presses again; no other lands.
    let landings = gestures.iter().filter(|g| {
        matches!(g.gesture, Gesture::Place { finger: 0 | 1, touch, .. }
        if touch.stiffness == GUITAR.setup.player.fretting.touch.stiffness)
    });
    assert_eq!(landings.count(), 1);
}

#[test]
fn a_repeated_key_outlives_the_release_of_its_first_press() {
    // Many files let go of the first press only after the second, or at the same tick.
    for late in [0, 10, 500] {
        let gestures = play(&[(0, on(62)), (WHILE, on(62)), (WHILE + late, off(62)), (3 * WHILE, off(62))]);
        assert_eq!(dampings(&gestures), [(3 * WHILE, plucks(&gestures)[0].1)], "{late} samples late");
    }
    // Each press has a release of its own: `presses.rs`.
}

#[test]
fn a_note_of_no_length_is_heard() {
    let gestures = play(&[(0, on(64)), (0, off(64))]);
    assert_eq!(plucks(&gestures), [(0, 0)]);
    let (damped, _) = dampings(&gestures)[0];
    assert!((960..=4_800).contains(&damped), "damped after {damped} samples");
}

#[test]
fn another_fret_of_the_string_takes_another_finger() {
    // D♯2 does not exist here; F2 then G2 are both on the lowest string only.
    let gestures = play(&[(0, on(41)), (WHILE, on(43))]);
    let fingers: Vec<(u64, &Gesture)> = gestures.iter().map(|g| (g.time, &g.gesture)).collect();
    assert!(matches!(fingers[0], (0, Gesture::Place { finger: 0, .. })));
    assert!(fingers.iter().any(|f| matches!(f, (WHILE, Gesture::Lift { finger: 0, .. }))));
    // When the hand that stills the string for it is about to go.
    let soon = WHILE..WHILE + 240;
    assert!(fingers.iter().any(|f| soon.contains(&f.0) && matches!(f.1, Gesture::Place { finger: 1, .. })));
}

#[test]
fn the_sustain_pedal_holds_what_keys_let_go_of() {
    let gestures = play(&[
        (0, on(64)),
        (10, controller(64, 127)),
        (WHILE, off(64)),
        (2 * WHILE, on(59)),
        (3 * WHILE, controller(64, 0)),
        (4 * WHILE, off(59)),
    ]);
    assert_eq!(dampings(&gestures), [(3 * WHILE, 0), (4 * WHILE, 1)]);
}

#[test]
fn the_messages_that_stop_everything_do() {
    let pedal = (10, controller(64, 127));
    let held = [(0, on(64)), pedal, (0, on(59))];
    let ends = |stop: &[(u64, PlayerEvent)]| {
        let mut events = held.to_vec();
        events.extend(stop);
        dampings(&play(&events)).into_iter().map(|(time, _)| time).collect::<Vec<_>>()
    };
    assert_eq!(ends(&[(WHILE, controller(120, 0))]), [WHILE, WHILE], "all sound off");
    assert_eq!(ends(&[(WHILE, PlayerEvent::AllNotesOff)]), [WHILE, WHILE], "the transport stops");
    // All notes off lets go of keys; the pedal goes on holding until it comes up.
    assert!(ends(&[(WHILE, controller(123, 0))]).is_empty());
    assert_eq!(ends(&[(WHILE, controller(123, 0)), (2 * WHILE, controller(64, 0))]), [2 * WHILE; 2]);
    // Reset all controllers lifts the pedal; keys that are down stay.
    assert_eq!(ends(&[(WHILE, off(64)), (2 * WHILE, controller(121, 0))]), [2 * WHILE]);
    // None of them reaches another channel.
    for number in [120, 121, 123] {
        let other = PlayerEvent::Controller { channel: 1, number, value: 0.0 };
        assert!(ends(&[(WHILE, other)]).is_empty());
    }
}

#[test]
fn the_wheel_bends_by_tension_and_no_farther_than_the_string_allows() {
    let max_bend = GUITAR.setup.max_bend;
    let ratios = |events: &[(u64, PlayerEvent)]| -> Vec<f64> {
        let bend = |g: &TimedGesture| match g.gesture {
            Gesture::Bend { tension_ratio, duration } => {
                assert!(duration >= 0.01, "smooth and no faster than a hand: {duration} s");
                Some(tension_ratio)
            }
            _ => None,
        };
        play(events).iter().filter_map(bend).collect()
    };
    let wheel = |time, value| (time, PlayerEvent::PitchBend { channel: 0, value });
    // A semitone is the sixth root of 2 in tension: pitch goes with its square root.
    let [up, down] = ratios(&[(0, on(64)), wheel(WHILE, 1.0), wheel(2 * WHILE, -0.5)])[..] else { panic!() };
    assert!((up - 2_f64.powf(2.0 / 6.0)).abs() < 1e-12);
    assert!((down - 2_f64.powf(-1.0 / 6.0)).abs() < 1e-12);
    // A range of an octave is announced; the string stops at its own limit.
    let octave = [(0, controller(101, 0)), (0, controller(100, 0)), (0, controller(6, 12)), (1, on(64))];
    let far = ratios(&[&octave[..], &[wheel(WHILE, 1.0)]].concat());
    assert!(far[0] <= 2_f64.powf(max_bend / 6.0) * 1.001 && far[0] > 2_f64.powf(2.5 / 6.0), "{far:?}");
    // A note that begins with the wheel turned is bent from the start: its string was at rest, and nobody heard how.
    let turned = play(&[wheel(0, 1.0), (WHILE, on(64))]);
    let bends: Vec<_> = turned.iter().filter(|g| matches!(g.gesture, Gesture::Bend { .. })).collect();
    let [TimedGesture { time: WHILE, gesture: Gesture::Bend { tension_ratio, duration }, .. }] = bends[..]
    else {
        panic!("{bends:?}")
    };
    assert!((tension_ratio - 2_f64.powf(2.0 / 6.0)).abs() < 1e-12 && *duration < 1e-4, "{bends:?}");
    // Another channel's wheel does nothing.
    assert!(ratios(&[(0, on(64)), (WHILE, PlayerEvent::PitchBend { channel: 3, value: 1.0 })]).is_empty());
    // However fast the wheel shakes, goals come at a bounded rate and end at the last.
    let shaken: Vec<(u64, PlayerEvent)> =
        std::iter::once((0, on(64))).chain((0..10_000).map(|n| wheel(n, (n as f32 * 0.01).sin()))).collect();
    let goals = ratios(&shaken);
    assert!(goals.len() < 100, "{}", goals.len());
}

/// A finger goes over the frets no oftener than a bend needs: those it passes are heard.
#[test]
fn a_wheel_near_the_limit_does_not_clatter_over_the_frets() {
    let slides = |range: f64, turns: &[f64]| {
        let mut performance = GUITAR.player(Style { variation: 0.0, seed: 0, bend_range: range });
        let wheel = |(n, &semitones): (usize, &f64)| {
            (WHILE + n as u64 * 960, PlayerEvent::PitchBend { channel: 0, value: (semitones / range) as f32 })
        };
        let events: Vec<_> =
            std::iter::once((0, on(65))).chain(turns.iter().enumerate().map(wheel)).collect();
        let gestures = play_by(&mut performance, &events);
        gestures.iter().filter(|timed| matches!(timed.gesture, Gesture::Slide { .. })).count()
    };
    let most = GUITAR.setup.max_bend;
    // A wheel turned to a limit may be an 8191st of its way beyond.
    assert_eq!(slides(12.0, &[most * (1.0 + 1.0 / 8191.0)]), 0);
    assert_eq!(slides(12.0, &[most + 0.05]), 1);
    let vibrato: Vec<f64> = (0..80).map(|n| most - 0.2 + 0.4 * (0.6 * f64::from(n)).sin()).collect();
    assert_eq!(slides(12.0, &vibrato), 1);
    // And comes back.
    assert_eq!(slides(12.0, &[&vibrato[..], &[0.0]].concat()), 2);
    // Between two frets beyond the limit it stays on one.
    let vibrato: Vec<f64> = (0..80).map(|n| most + 1.5 + 0.2 * (0.6 * f64::from(n)).sin()).collect();
    assert_eq!(slides(12.0, &vibrato), 1);
}

#[test]
fn a_note_that_cannot_be_bent_as_far_as_asked_is_counted_once() {
    let short = |key: u8, turns: &[f32], neck: &Neck| {
        let mut performance = neck.player(Style { variation: 0.0, seed: 0, bend_range: 12.0 });
        let wheel = |(n, &value): (usize, &f32)| {
            ((2 + n as u64) * WHILE, PlayerEvent::PitchBend { channel: 0, value })
        };
        let events = std::iter::once((WHILE, on(key))).chain(turns.iter().enumerate().map(wheel));
        play_by(&mut performance, &events.collect::<Vec<_>>());
        performance.compromises().bent_short
    };
    let most = (GUITAR.setup.max_bend / 12.0) as f32;
    // An open string is pulled as far as it goes; a finger slides as far as there are frets, and then pulls.
    for (key, turns, expected) in [
        (64, &[most, -most][..], 0),
        (64, &[1.0, 0.0, -1.0, 1.0], 1),
        (65, &[1.0], 0),
        (76, &[0.999], 0),
        (76, &[-0.999], 0),
        (86, &[0.5], 1),
        (65, &[-0.1, -1.0], 1),
    ] {
        assert_eq!(short(key, turns, &GUITAR), expected, "key {key}, wheel {turns:?}");
    }
    // On a bare board the finger glides.
    let bass = Neck::of("fretless-bass");
    for (key, turns, expected) in [(50, &[0.7_f32, 0.2][..], 0), (44, &[-1.0], 1)] {
        assert_eq!(short(key, turns, &bass), expected, "key {key} of a bare board, wheel {turns:?}");
    }
}

#[test]
fn a_hundred_notes_at_once_are_all_heard_and_none_hangs() {
    let mut performance = player(EXACT);
    let mut events: Vec<(u64, PlayerEvent)> = (14..114).map(|key| (0, on(key))).collect();
    // Keys are held until the last of them has come, 94 times 70 ms later.
    events.extend((14..114).map(|key| (40 * WHILE, off(key))));
    let gestures = play_by(&mut performance, &events);
    assert_eq!(plucks(&gestures).len(), 100);
    assert_eq!(dampings(&gestures).len(), 6);
    assert_eq!((performance.compromises().arpeggiated, performance.compromises().left_out), (94, 0));
    assert!(!any_left(&gestures));
}

#[test]
fn keys_no_string_gives_move_by_octaves() {
    let mut performance = player(EXACT);
    // E1 sounds as E2, the open low string; G8 moves down to a fret the first string has.
    let gestures = play_by(&mut performance, &[(0, on(28)), (WHILE, off(28)), (2 * WHILE, on(127))]);
    assert_eq!(plucks(&gestures), [(0, 5), (2 * WHILE, 0)]);
    assert_eq!(dampings(&gestures), [(WHILE, 5)], "released by the key as it was sent");
    assert_eq!(performance.compromises().moved_by_octaves, 2);
}

#[test]
fn variation_is_seeded_small_and_off_at_zero() {
    let phrase: Vec<(u64, PlayerEvent)> = (0..200).map(|n| (n * WHILE, on(64))).collect();
    let take = |variation, seed| play_by(&mut player(Style { variation, seed, bend_range: 2.0 }), &phrase);
    assert_eq!(take(1.0, 5), take(1.0, 5));
    assert_ne!(take(1.0, 5), take(1.0, 6));
    assert_eq!(take(0.0, 5), take(0.0, 6));
    for ((time, _), (exact, _)) in plucks(&take(1.0, 5)).into_iter().zip(plucks(&take(0.0, 5))) {
        assert!((exact..=exact + 48).contains(&time), "{time} for {exact}: at most a millisecond late");
    }
}

#[test]
fn reset_forgets_everything() {
    let phrase =
        [(0, controller(64, 127)), (0, on(88)), (5, PlayerEvent::PitchBend { channel: 0, value: 1.0 })];
    let mut performance = player(Style { variation: 1.0, ..EXACT });
    let first = play_by(&mut performance, &phrase);
    performance.reset();
    assert_eq!(play_by(&mut performance, &phrase), first);
}

/// Any event, sensible or not, its numbers with those that are none.
fn any_event() -> impl Strategy<Value = PlayerEvent> {
    let value = prop_oneof![4 => -1.5_f32..1.5, 1 => prop::num::f32::ANY];
    prop_oneof![
        6 => (0..18_u8, 20..100_u8, value.clone())
            .prop_map(|(channel, key, velocity)| PlayerEvent::NoteOn { channel: channel / 6, key, velocity }),
        1 => (any::<u8>(), any::<u8>(), prop::num::f32::ANY)
            .prop_map(|(channel, key, velocity)| PlayerEvent::NoteOn { channel, key, velocity }),
        5 => (0..18_u8, 20..100_u8).prop_map(|(channel, key)| PlayerEvent::NoteOff { channel: channel / 6, key }),
        2 => (0..3_u8, prop::sample::select(vec![6, 38, 64, 100, 101, 120, 121, 123, 7]), value.clone())
            .prop_map(|(channel, number, value)| PlayerEvent::Controller { channel, number, value }),
        2 => (0..3_u8, value).prop_map(|(channel, value)| PlayerEvent::PitchBend { channel, value }),
        1 => Just(PlayerEvent::AllNotesOff),
    ]
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn blocks_do_not_matter_and_nothing_hangs(
        steps in prop::collection::vec((prop_oneof![Just(0_u64), 0..5000_u64], any_event()), 1..120),
        block in 1..2000_u64,
    ) {
        let events = stopped_at_last(steps);
        let whole = play(&events);

        let blocks = play_in_blocks(&mut player(EXACT), &events, block);
        for string in 0..6 {
            prop_assert_eq!(of_string(&whole, string), of_string(&blocks, string));
        }
        prop_assert!(!any_left(&whole));
        for TimedGesture { gesture, .. } in whole {
            if let Gesture::Pluck { position, force, .. } = gesture {
                prop_assert!(force.is_finite() && force > 0.0 && position > 0.4 && position < 0.66);
            }
        }
    }
}

/// A finger that has slid or glided for the wheel stays there when its note is over, and pulling makes up for what the wheel does
/// then: it would otherwise pull all of the bend on top of what the finger has done.
#[test]
fn a_wheel_that_goes_back_after_a_note_does_not_bend_it_farther() {
    for (neck, key, range, turns) in [
        // Five frets up, and one less.
        (&*GUITAR, 60, 12.0, [5.0, 4.0]),
        (&Neck::of("classical"), 60, 2.0, [2.0, 1.2]),
        (&Neck::of("fretless-bass"), 35, 2.0, [1.0, 0.9]),
    ] {
        let wheel = |semitones: f32| PlayerEvent::PitchBend { channel: 0, value: semitones / range };
        let [there, back] = turns.map(wheel);
        let style = Style { variation: 0.0, seed: 0, bend_range: f64::from(range) };
        let events =
            [(0, on(key)), (WHILE, there), (2 * WHILE, off(key)), (2 * WHILE + 960, back), (3 * WHILE, back)];
        let gestures = play_by(&mut neck.player(style), &events);
        assert!(gestures.iter().any(|g| matches!(g.gesture, Gesture::Slide { .. })));
        let ratios = gestures.iter().filter(|g| g.time > 2 * WHILE).filter_map(|g| match g.gesture {
            Gesture::Bend { tension_ratio, .. } => Some(tension_ratio),
            _ => None,
        });
        let ratios: Vec<_> = ratios.collect();
        assert!(!ratios.is_empty() && ratios.iter().all(|&ratio| ratio < 1.0), "{key}: {ratios:?}");
    }
}
