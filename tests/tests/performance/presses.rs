//! The promise: a note ends with as many note-offs of its key as it had note-ons, so that notes of one key that overlap are as
//! long as they are written. Where each note-on has its note-off nothing is left sounding; where one is missing the string
//! rings on until another note takes it or a message stops it.

use std::sync::LazyLock;

use low_action::performance::{Performance, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::cases::cases;
use low_action_tests::hands::{EXACT, Neck, any_left, count_plucks as plucks, play as play_by};
use low_action_tests::stage::{cc, off, on};
use proptest::prelude::*;

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
/// A quarter of a second, samples.
const WHILE: u64 = 12_000;
const KEY: u8 = 62;

fn play(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    play_by(&mut GUITAR.player(EXACT), events)
}

/// When dampers come down.
fn ends(gestures: &[TimedGesture]) -> Vec<u64> {
    let damper = |g: &&TimedGesture| matches!(g.gesture, Gesture::Place { finger: 2, .. });
    gestures.iter().filter(damper).map(|g| g.time).collect()
}

fn press(time: u64) -> (u64, PlayerEvent) {
    (time, on(KEY, 80))
}

fn release(time: u64) -> (u64, PlayerEvent) {
    (time, off(KEY))
}

#[test]
fn notes_of_one_key_that_overlap_are_as_long_as_they_are_written() {
    for late in [0, 10, 500, 1_440, 1_441, 6_000, 20_000] {
        let first = [press(0), press(WHILE), release(WHILE + late)];
        // The next one comes after both have ended, as short or as long.
        let again = [release(3 * WHILE), press(5 * WHILE), release(6 * WHILE)];
        let gestures = play(&[first, again].concat());
        assert_eq!(ends(&gestures), [3 * WHILE, 6 * WHILE], "{late} samples late");
        assert_eq!(plucks(&gestures), 3);
    }
    // Each of a run reaches into the next.
    let run: Vec<_> = (0..8).flat_map(|n| [press(n * WHILE), release((n + 1) * WHILE + 3_000)]).collect();
    let mut run = run;
    run.sort_by_key(|event| event.0);
    let gestures = play(&run);
    assert_eq!((plucks(&gestures), ends(&gestures)), (8, vec![8 * WHILE + 3_000]));
}

/// Two tracks at one channel, in unison: one pluck, as long as the longer.
#[test]
fn a_unison_ends_with_the_longer_of_its_notes() {
    let gestures = play(&[press(0), press(0), release(WHILE), release(2 * WHILE)]);
    assert_eq!((plucks(&gestures), ends(&gestures)), (1, vec![2 * WHILE]));
}

/// A key may come back while others are above it: all its presses count for what sounds then.
#[test]
fn a_key_that_comes_back_under_legato_counts_all_its_presses() {
    let other = |time| (time, on(KEY + 2, 80));
    let legato = (0, cc(68, 127));
    let held = [legato, press(0), other(WHILE), press(2 * WHILE), release(3 * WHILE)];
    let mut player = GUITAR.player(EXACT);
    // One press is left: it is not time to go back to the other.
    let gestures = play_by(&mut player, &held);
    assert!(gestures.iter().all(|gesture| gesture.time < 3 * WHILE), "{gestures:?}");
    let all = [&held[..], &[release(4 * WHILE), (5 * WHILE, off(KEY + 2))]].concat();
    player.reset();
    assert_eq!(ends(&play_by(&mut player, &all)), [5 * WHILE]);
    // The first of them is let go of while the other sounds.
    let below = [legato, press(0), press(10), other(WHILE), release(2 * WHILE), release(3 * WHILE)];
    player.reset();
    assert_eq!(
        ends(&play_by(&mut player, &[&below[..], &[(4 * WHILE, off(KEY + 2))]].concat())),
        [4 * WHILE]
    );
}

#[test]
fn a_note_without_its_note_off_rings_until_it_is_stopped() {
    let missing = [press(0), press(WHILE), release(2 * WHILE)];
    assert!(ends(&play(&missing)).is_empty(), "as a note-on without a note-off does");
    let stopped = |by| ends(&play(&[&missing[..], &[(3 * WHILE, by)]].concat()));
    for by in [cc(120, 0), cc(123, 0), PlayerEvent::AllNotesOff] {
        assert_eq!(stopped(by), [3 * WHILE], "{by:?}");
    }
    // What has stopped is not counted: the next note is one of its own.
    for by in [cc(120, 0), cc(123, 0), PlayerEvent::AllNotesOff] {
        let next = [(3 * WHILE, by), press(5 * WHILE), release(6 * WHILE)];
        assert_eq!(ends(&play(&[&missing[..], &next].concat())), [3 * WHILE, 6 * WHILE], "{by:?}");
    }
    // So it is where another note has had the string (E2 and F2 have one between them).
    let string = [(0, on(40, 80)), (10, on(40, 80)), (WHILE, on(41, 80)), (2 * WHILE, off(41))];
    let next = [(3 * WHILE, on(40, 80)), (4 * WHILE, off(40))];
    assert_eq!(ends(&play(&[&string[..], &next].concat())), [2 * WHILE, 4 * WHILE]);
}

#[test]
fn a_pedal_that_was_down_when_everything_stopped_holds_again_when_it_is_pressed() {
    for pedal in [64, 66] {
        let stopped = [press(0), (10, cc(pedal, 127)), (WHILE, PlayerEvent::AllNotesOff), release(WHILE)];
        let next = [press(4 * WHILE), (5 * WHILE, cc(pedal, 127)), release(6 * WHILE)];
        let up = [(8 * WHILE, cc(pedal, 0))];
        let gestures = play(&[&stopped[..], &next, &up].concat());
        assert_eq!(ends(&gestures), [WHILE, 8 * WHILE], "CC {pedal}");
        // Until then it holds nothing.
        let gestures = play(&[&stopped[..], &[press(4 * WHILE), release(6 * WHILE)]].concat());
        assert_eq!(ends(&gestures), [WHILE, 6 * WHILE], "CC {pedal}");
    }
}

/// Notes of a few neighbouring keys, each with its note-off, so that they overlap in all ways and take strings from one another.
fn score() -> impl Strategy<Value = Vec<(u64, PlayerEvent)>> {
    let note = (0..40_u64, 1..30_u64, 40..46_u8)
        .prop_map(|(start, length, key)| [(600 * start, on(key, 80)), (600 * (start + length), off(key))]);
    prop::collection::vec(note, 1..40).prop_map(|notes| {
        let mut events = notes.concat();
        events.sort_by_key(|event| event.0);
        events
    })
}

proptest! {
    #![proptest_config(cases(256))]

    #[test]
    fn nothing_is_left_where_each_note_on_has_its_note_off(events in score(), legato: bool) {
        let mut player: Performance = GUITAR.player(EXACT);
        let told = [(0, cc(68, if legato { 127 } else { 0 }))];
        let gestures = play_by(&mut player, &[&told[..], &events].concat());
        prop_assert!((0..128).all(|key| !player.sounds(0, key)), "sounds");
        prop_assert!(!any_left(&gestures), "a finger is left");
    }
}

/// A host that chokes a note wants it to end, whatever its pedals say.
#[test]
fn a_choke_ends_a_note_that_a_pedal_keeps() {
    let choke = |time| (time, PlayerEvent::NoteEnd { channel: 0, key: KEY });
    for pedal in [64, 66] {
        // While the key is down, and when it is up already.
        let down = [press(0), (10, cc(pedal, 127)), choke(WHILE)];
        assert_eq!(ends(&play(&down)), [WHILE], "pedal {pedal}");
        let up = [press(0), (10, cc(pedal, 127)), release(5_000), choke(WHILE)];
        assert_eq!(ends(&play(&up)), [WHILE], "pedal {pedal}, the key up");
    }
    // Struck twice, it ends once and for all.
    let mut player = GUITAR.player(EXACT);
    play_by(&mut player, &[press(0), press(100), choke(WHILE)]);
    assert!(!player.sounds(0, KEY));
}

/// It is heard nevertheless, but no pedal keeps it.
#[test]
fn a_choke_ends_a_note_that_waits_for_a_string() {
    let keys = [40, 47, 52, 55, 59, 64, 67, 71];
    let chord = keys.map(|key| (0, on(key, 90)));
    let choked = keys.map(|key| (480, PlayerEvent::NoteEnd { channel: 0, key }));
    let mut player = GUITAR.player(EXACT);
    let pedal = [(0, cc(64, 127))];
    let gestures = play_by(&mut player, &[&pedal[..], &chord, &choked].concat());
    assert_eq!(plucks(&gestures), 8);
    assert!(keys.iter().all(|&key| !player.sounds(0, key)), "the pedal keeps what was choked");
    // One that is struck again before it comes is another note.
    let again = keys.map(|key| (960, on(key, 90)));
    let mut player = GUITAR.player(EXACT);
    play_by(&mut player, &[&pedal[..], &chord, &choked, &again].concat());
    assert!(keys.iter().filter(|&&key| player.sounds(0, key)).count() >= 6, "struck again, and pedal");
}

/// As the damper of a piano's string stays up, however often its key is struck under the pedal.
#[test]
fn the_sostenuto_pedal_holds_a_key_that_is_struck_again() {
    let mut player = GUITAR.player(EXACT);
    let events = [press(0), (4_000, cc(66, 127)), release(8_000), press(WHILE), release(2 * WHILE)];
    play_by(&mut player, &events);
    assert!(player.sounds(0, KEY));
    let up = (5 * WHILE + 4 * WHILE, cc(66, 0));
    play_by(&mut player, &[up]);
    assert!(!player.sounds(0, KEY));
}

/// Also from a key that is down under the one that sounds: it comes back held by nothing but itself.
#[test]
fn the_sostenuto_pedal_lets_go_of_a_key_under_another() {
    let other = KEY + 2;
    for up in [cc(66, 0), cc(121, 0)] {
        let caught = [(0, cc(68, 127)), press(0), (4_000, cc(66, 127)), (WHILE, on(other, 80))];
        let mut player = GUITAR.player(EXACT);
        let up = [(2 * WHILE, up), (3 * WHILE, off(other))];
        let back = play_by(&mut player, &[&caught[..], &up].concat());
        assert!(player.sounds(0, KEY) && ends(&back).is_empty(), "{up:?}: its key is down");
        assert_eq!(ends(&play_by(&mut player, &[release(20 * WHILE)])), [20 * WHILE], "{up:?}");
    }
}

/// Its key is down when the pedal falls, whether there is a string for it yet or not.
#[test]
fn the_sostenuto_pedal_catches_notes_that_wait_for_a_string() {
    let keys = [40, 47, 52, 55, 59, 64, 67, 71];
    let chord = keys.map(|key| (0, on(key, 90)));
    // The pedal falls at 10 ms and the keys go up at 20; the last two come at 70 and 140.
    let up = keys.map(|key| (960, off(key)));
    let heard = |pedals: &[(u64, PlayerEvent)]| {
        let mut player = GUITAR.player(EXACT);
        let mut events = [&chord[..], &up, pedals].concat();
        events.sort_by_key(|event| event.0);
        play_by(&mut player, &events);
        keys.iter().filter(|&&key| player.sounds(0, key)).count()
    };
    // Of six that are caught two give way to two that are, too.
    let caught = (480, cc(66, 127));
    assert_eq!(heard(&[caught]), 6);
    // None is where it goes up again, or all is put back, before they come; or where it falls when their keys are up.
    for pedals in [
        &[caught, (1_440, cc(66, 0))][..],
        &[caught, (1_440, cc(121, 0))],
        &[(1_440, cc(66, 127))],
        &[caught, (12_000, cc(66, 0))],
    ] {
        assert_eq!(heard(pedals), 0, "{pedals:?}");
    }
}

/// However often a key is struck while its thumb is still on the way, that bounces off once, and the palm comes back once. (Each stroke
/// had a bounce of its own, and seven of them found no room.)
#[test]
fn a_thumb_that_strikes_again_at_once_bounces_off_once() {
    let mut events = vec![(0, cc(22, 4)), (0, cc(65, 127)), (0, cc(20, 64)), (0, on(KEY - 2, 80))];
    events.extend((0..20).map(|n| (WHILE + 60 * n, press(0).1)));
    events.push((3 * WHILE, off(KEY - 2)));
    let gestures = play(&events);
    let bounce = |g: &&TimedGesture| matches!(g.gesture, Gesture::Lift { finger: 4, .. }) && g.time > WHILE;
    let last = WHILE + 60 * 19;
    let bounces = gestures.iter().filter(bounce).filter(|g| (last..2 * WHILE).contains(&g.time)).count();
    assert_eq!(bounces, 1, "{gestures:#?}");
}
