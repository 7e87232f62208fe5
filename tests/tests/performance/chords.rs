//! The promise: no note of a chord is lost whose key stays down. One that does not fit on the strings is moved by an octave or comes
//! a moment later, at no held note's cost if its own key is up by then; a strum reaches the strings one after another at the speed asked for; and keyswitches say how
//! to play without sounding themselves.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{InputMode, Performance, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::cases::cases;
use low_action_tests::hands::{self, EXACT, Neck, RATE, play};
use low_action_tests::stage::{cc, off, on};
use proptest::prelude::*;

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

/// With few strings, on which a capo leaves many keys no string in their own octave.
static BASSES: LazyLock<[Neck; 2]> = LazyLock::new(|| ["bass", "ukulele"].map(Neck::of));

fn player() -> Performance {
    GUITAR.player(EXACT)
}

/// (time, string, force) of the plucks, in order of time.
fn plucks(gestures: &[TimedGesture]) -> Vec<(u64, usize, f64)> {
    let mut plucks = hands::plucks(gestures);
    plucks.sort_by_key(|pluck| pluck.0);
    plucks
}

#[test]
fn neighbours_on_one_string_are_moved_to_others() {
    // F2, F♯2, G2 are on the lowest string only.
    let mut player = player();
    let gestures = play(&mut player, &[(0, on(41, 90)), (0, on(42, 90)), (0, on(43, 90))]);
    let strings: Vec<usize> = plucks(&gestures).iter().map(|pluck| pluck.1).collect();
    assert_eq!(strings.len(), 3, "{gestures:?}");
    assert!(plucks(&gestures).iter().all(|pluck| pluck.0 == 0), "all at once");
    let compromises = player.compromises();
    assert_eq!((compromises.moved_by_octaves, compromises.arpeggiated, compromises.left_out), (2, 0, 0));
    // They are let go of by their own keys.
    assert!((41..44).all(|key| player.sounds(0, key)));
}

#[test]
fn what_finds_no_string_comes_later() {
    let keys = [40, 47, 52, 55, 59, 64, 67, 71];
    let mut events: Vec<(u64, PlayerEvent)> = keys.iter().map(|&key| (0, on(key, 90))).collect();
    let mut performance = player();
    let times: Vec<u64> = plucks(&play(&mut performance, &events)).iter().map(|pluck| pluck.0).collect();
    assert_eq!(times[..6], [0; 6]);
    // A string that rings is stilled first, in at most 3 ms.
    for (time, asked) in times[6..].iter().zip([3360, 6720]) {
        assert!((asked..asked + 144).contains(time), "{times:?}");
    }
    assert_eq!(times.len(), 8);
    assert_eq!(performance.compromises().arpeggiated, 2);
    // Keys that go up before their notes have come are heard nevertheless, and end.
    events.extend(keys.iter().map(|&key| (480, off(key))));
    let mut performance = player();
    assert_eq!(plucks(&play(&mut performance, &events)).len(), 8);
    assert!((0..128).all(|key| !performance.sounds(0, key)));
    // The same chord again before they have come: each has its own end.
    let again: Vec<(u64, PlayerEvent)> = [(0, true), (480, false), (960, true), (1440, false)]
        .into_iter()
        .flat_map(|(at, down)| keys.iter().map(move |&key| (at, if down { on(key, 90) } else { off(key) })))
        .collect();
    let mut performance = player();
    assert_eq!(plucks(&play(&mut performance, &again)).len(), 16);
    assert!((0..128).all(|key| !performance.sounds(0, key)));
    // Everything stopping stops them too.
    events.push((960, PlayerEvent::AllNotesOff));
    assert_eq!(plucks(&play(&mut player(), &events)).len(), 6);
}

#[test]
fn what_comes_late_with_its_key_up_takes_no_string_from_a_held_note() {
    let keys = [40, 45, 50, 55, 59, 64, 67, 71];
    let held = [40, 47, 52, 56, 59, 64];
    let first = [keys.map(|key| (0, on(key, 90))), keys.map(|key| (2400, off(key)))].concat();
    // With strings to hammer on, too, and when it falls within the chord's first moments, as it is still being placed.
    for (legato, time) in [0, 127].into_iter().flat_map(|legato| [2880, 3300].map(|time| (legato, time))) {
        let chord = held.map(|key| (time, on(key, 90)));
        let mut performance = player();
        let events = [&[(0, cc(68, legato))][..], &first, &chord].concat();
        let gestures = play(&mut performance, &events);
        assert_eq!(plucks(&gestures).len(), 12, "{legato}, {time}");
        assert!(held.iter().all(|&key| performance.sounds(0, key)), "{legato}, {time}");
        let dampers = |g: &&TimedGesture| matches!(g.gesture, Gesture::Place { finger: 2, .. });
        assert!(!gestures.iter().any(|g| g.time > time + 200 && dampers(&g)), "nothing is damped");
        let compromises = performance.compromises();
        assert_eq!((compromises.arpeggiated, compromises.left_out), (0, 2), "{legato}, {time}");
    }
    // Beside five of them the sixth string is for both.
    let chord = held[..5].iter().map(|&key| (2880, on(key, 90)));
    let mut performance = player();
    let struck = plucks(&play(&mut performance, &first.iter().copied().chain(chord).collect::<Vec<_>>()));
    assert_eq!((struck.len(), performance.compromises().left_out), (13, 0));
    assert!(held[..5].iter().all(|&key| performance.sounds(0, key)));
    // And those that only a pedal keeps make room.
    let pedal = [(2880, cc(64, 127))];
    let chord = held.map(|key| (2880, on(key, 90)));
    let up = held.map(|key| (3000, off(key)));
    let mut performance = player();
    let struck = plucks(&play(&mut performance, &[&first[..], &pedal, &chord, &up].concat()));
    assert_eq!((struck.len(), performance.compromises().left_out), (14, 0));
}

/// What its key has done while it waited is nothing to another note of that key.
#[test]
fn a_note_that_comes_late_with_its_key_up_ends_by_itself() {
    let ms = |time: f64| (time * RATE) as u64;
    let chord = [64, 59, 57, 55, 50, 45, 40].map(|key| (ms(0.1), on(key, 90)));
    let again = [(0.11, off(55)), (0.14, off(57)), (0.15, on(55, 120)), (0.16, off(40))];
    let again = again.map(|(time, event)| (ms(time), event));
    let mut performance = player();
    let mut gestures = Vec::new();
    for (time, event) in chord.into_iter().chain(again) {
        performance.event(time, event, &mut gestures);
    }
    performance.advance(ms(0.9), &mut gestures);
    let struck = plucks(&gestures);
    // The late one comes when the next of its key sounds on another string.
    let [held, late] = [struck[6], struck[7]];
    assert!(struck.len() == 8 && held.0 < ms(0.16) && late.0 > ms(0.17), "{struck:?}");
    let damped = |string| {
        let dampers = |g: &&TimedGesture| matches!(g.gesture, Gesture::Place { finger: 2 | 3, .. });
        gestures.iter().filter(dampers).any(|g| g.string == string && g.time > ms(0.17))
    };
    assert_eq!((damped(held.1), damped(late.1)), (false, true), "{held:?}, {late:?}");
    assert!(performance.sounds(0, 55));
    performance.event(ms(1.0), off(55), &mut gestures);
    assert!(!performance.sounds(0, 55));
}

#[test]
fn a_strum_goes_over_the_strings_at_one_speed() {
    let chord = [40, 47, 52, 56, 59, 64];
    let strum = |settings: &[(u8, u8)], keys: &[u8]| {
        let mut events: Vec<(u64, PlayerEvent)> =
            settings.iter().map(|&(n, value)| (0, cc(n, value))).collect();
        events.extend(keys.iter().map(|&key| (0, on(key, 90))));
        plucks(&play(&mut player(), &events))
    };
    // 0.4 s over all strings at 127: 19200 samples, a fifth of it from each string to the next.
    let down = strum(&[(21, 127)], &chord);
    let places: Vec<(u64, usize)> = down.iter().map(|&(time, string, _)| (time, string)).collect();
    assert_eq!(places, [(0, 5), (3840, 4), (7680, 3), (11520, 2), (15360, 1), (19200, 0)]);
    let up = strum(&[(21, 127), (22, 1)], &chord);
    assert_eq!((up[0].1, up[5].1), (0, 5));
    // Three strings take two fifths.
    let three = strum(&[(21, 127)], &[40, 47, 52]);
    assert_eq!(three.iter().map(|pluck| pluck.0).collect::<Vec<_>>(), [0, 3840, 7680]);
    // The accent makes it grow or fall.
    let forces = |accent| strum(&[(21, 64), (24, accent)], &chord).iter().map(|p| p.2).collect::<Vec<f64>>();
    let even = forces(64)[0];
    for (accent, way) in [(127, 0.7), (0, -0.7)] {
        for (n, force) in forces(accent).into_iter().enumerate() {
            // From 0.7 less than the middle one's on the first string to 0.7 more on the last, or the other way.
            let expected = even * (1.0 + way * (2.0 * n as f64 / 5.0 - 1.0));
            assert!((force / expected - 1.0).abs() < 1e-12, "CC 24 = {accent}, string {n}: {force} N");
        }
    }
    assert!(forces(64).iter().all(|force| (force / forces(64)[0] - 1.0).abs() < 1e-12));
}

#[test]
fn strokes_go_back_and_forth() {
    let mut events = vec![(0, cc(22, 2))];
    events.extend((0..4).map(|n| (n * 9600, on(64, 90))));
    let forces: Vec<f64> = plucks(&play(&mut player(), &events)).iter().map(|pluck| pluck.2).collect();
    assert_eq!(forces[0], forces[2]);
    assert!((forces[1] / forces[0] - 0.85).abs() < 1e-12 && forces[1] == forces[3]);
    // A tremolo at 20 strokes a second for a second, the first at once; it ends with its note.
    let tremolo = [(0, cc(25, 127)), (0, on(64, 90)), (48_000, off(64))];
    let struck = plucks(&play(&mut player(), &tremolo));
    assert!((20..=21).contains(&struck.len()), "{}", struck.len());
    assert!(struck.windows(2).all(|pair| pair[1].0 - pair[0].0 == 2400));
    assert!(struck.last().is_some_and(|last| last.0 <= 48_000));
}

#[test]
fn keyswitches_are_off_until_asked_for_and_can_be_moved() {
    let events = [(0, on(12, 90)), (0, on(64, 90))];
    // Off, C0 is a note like any other, three octaves too low.
    assert_eq!(plucks(&play(&mut player(), &events)).len(), 2);
    for first in [12, 20] {
        let mut performance = player();
        let touching = Touching { keyswitches: Some(first), ..Touching::new(0.0, 2.0) };
        performance.touch(0, &touching, &mut Vec::new());
        // Rest stroke: the third.
        let gestures =
            play(&mut performance, &[(0, on(first + 2, 90)), (0, off(first + 2)), (10, on(64, 90))]);
        let struck = plucks(&gestures);
        assert!(matches!(struck[..], [(10, 0, force)] if force < 0.0), "{struck:?}");
        assert!(!performance.sounds(0, first + 2));
    }
    // One that comes at the note's own sample, and after it, still counts.
    let mut performance = player();
    performance.event(0, cc(27, 12), &mut Vec::new());
    let late = play(&mut performance, &[(0, on(64, 90)), (0, on(14, 90))]);
    assert!(matches!(plucks(&late)[..], [(0, 0, force)] if force < 0.0));
}

#[test]
fn a_keyswitch_for_a_string_holds_while_it_is_down() {
    let string = |events: &[(u64, PlayerEvent)]| {
        let mut performance = player();
        performance.event(0, cc(27, 12), &mut Vec::new());
        plucks(&play(&mut performance, events))[0].1
    };
    assert_eq!(string(&[(10, on(64, 90))]), 0);
    assert_eq!(string(&[(0, on(26, 90)), (10, on(64, 90))]), 2);
    assert_eq!(string(&[(0, on(26, 90)), (5, off(26)), (10, on(64, 90))]), 0);
    // A string that does not have the note is not forced.
    assert_eq!(string(&[(0, on(24, 90)), (10, on(40, 90))]), 5);
}

#[test]
fn a_palm_of_one_strings_channel_leaves_the_others_alone() {
    let mut performance = player();
    performance.set_input(InputMode::Strings { first: 0, from_last: false });
    let palm = PlayerEvent::Controller { channel: 1, number: 20, value: 1.0 };
    let note = |channel, key| PlayerEvent::NoteOn { channel, key, velocity: 0.7 };
    let gestures = play(&mut performance, &[(0, palm), (0, note(0, 64)), (0, note(1, 59)), (0, note(2, 55))]);
    let palms: Vec<usize> = gestures
        .iter()
        .filter(|g| matches!(g.gesture, Gesture::Place { finger: 4, .. }))
        .map(|g| g.string)
        .collect();
    assert_eq!(palms, [1]);
}

/// When the last of so many notes has come, if none could have another octave, samples.
fn last_of(notes: usize) -> u64 {
    notes as u64 * 3360
}

/// Two chords of all keys at two channels: as many wait as there are keys, and the rest is counted.
#[test]
fn what_is_left_out_is_counted() {
    let mut performance = player();
    let mut gestures = Vec::new();
    for channel in 0..2 {
        for key in 0..128 {
            performance.event(0, PlayerEvent::NoteOn { channel, key, velocity: 0.5 }, &mut gestures);
        }
    }
    performance.advance(10 * RATE as u64, &mut gestures);
    assert_eq!((plucks(&gestures).len(), performance.compromises().left_out), (128, 128));
}

/// What `render` says of notes is of each once, whatever happens to it.
#[test]
fn a_note_that_moves_or_waits_twice_is_one() {
    // E1 sounds as E2, for which F2 leaves no string: it moves again.
    let mut performance = player();
    assert_eq!(plucks(&play(&mut performance, &[(0, on(28, 90)), (0, on(41, 90))])).len(), 2);
    assert_eq!(performance.compromises().moved_by_octaves, 1);
    // The first of two that wait finds all strings taken by a chord of its very sample.
    let chord = [40, 47, 52, 55, 59, 64, 67, 71].map(|key| (0, on(key, 90)));
    let barre = [46, 53, 58, 61, 65, 70].map(|key| (3360, on(key, 90)));
    let mut performance = player();
    let times: Vec<u64> =
        plucks(&play(&mut performance, &[&chord[..], &barre].concat())).iter().map(|pluck| pluck.0).collect();
    assert_eq!((times.len(), times[12] > 3360), (14, true), "{times:?}");
    assert_eq!(performance.compromises().arpeggiated, 2);
    // What is left out has not been moved: of all keys at once, twice, no more than have been played.
    let mut performance = player();
    let all = |time| (0..128).map(move |key| (time, on(key, 90)));
    let mut gestures = Vec::new();
    for (time, event) in all(0).chain(all(100)) {
        performance.event(time, event, &mut gestures);
    }
    performance.advance(20 * RATE as u64, &mut gestures);
    let (played, compromises) = (plucks(&gestures).len() as u64, performance.compromises());
    assert_eq!(played + compromises.left_out, 256);
    assert!(compromises.left_out > 0 && compromises.moved_by_octaves <= played, "{played}, {compromises:?}");
}

/// A key struck twice at one moment sounds once, which is counted; on two channels it is two notes.
#[test]
fn doubled_notes_are_counted() {
    for (channel, expected) in [(0, (1, 1)), (1, (2, 0))] {
        let mut player = player();
        let again = PlayerEvent::NoteOn { channel, key: 64, velocity: 0.5 };
        let gestures = play(&mut player, &[(0, on(64, 90)), (0, again)]);
        assert_eq!((plucks(&gestures).len(), player.compromises().doubled), expected, "channel {channel}");
    }
}

proptest! {
    #![proptest_config(cases(200))]

    /// Whatever keys are struck together, up to all there are, each of them sounds: at once, or 70 ms after another.
    #[test]
    fn every_note_of_a_chord_is_played(keys in prop::collection::hash_set(0..128_u8, 1..=128)) {
        let mut performance = player();
        let mut gestures = Vec::new();
        for &key in &keys {
            performance.event(0, on(key, 90), &mut gestures);
        }
        let late = last_of(keys.len());
        performance.advance(late + 1, &mut gestures);
        prop_assert!(!performance.is_behind());
        prop_assert_eq!(plucks(&gestures).len(), keys.len());
        prop_assert_eq!(performance.compromises().left_out, 0);
    }
}

proptest! {
    #![proptest_config(cases(200))]

    /// Nor does a capo that comes while notes wait keep any of them from sounding, as long as their keys may be down.
    #[test]
    fn no_note_waits_for_ever_for_what_a_capo_has_made_impossible(
        setup in 0..BASSES.len(),
        keys in prop::collection::hash_set(20..70_u8, 1..=20),
        capo in 1..=12_u8,
        when in 0..12_000_u64,
    ) {
        let mut performance = BASSES[setup].player(EXACT);
        let mut gestures = Vec::new();
        for &key in &keys {
            performance.event(0, on(key, 90), &mut gestures);
        }
        performance.event(when, cc(26, capo), &mut gestures);
        performance.advance(when + last_of(keys.len()) + 1, &mut gestures);
        prop_assert!(!performance.is_behind());
        prop_assert_eq!(plucks(&gestures).len(), keys.len());
        prop_assert_eq!(performance.compromises().left_out, 0);
    }
}

/// Two notes for a string that the next instrument does not have: the second waits for the first.
#[test]
fn a_note_for_a_string_that_is_no_more_does_not_wait_for_ever() {
    let channel = 5;
    let mut player = player();
    player.set_input(InputMode::Strings { first: 0, from_last: false });
    let mut gestures = Vec::new();
    for key in [52, 55] {
        player.event(0, PlayerEvent::NoteOn { channel, key, velocity: 0.8 }, &mut gestures);
    }
    player.advance(10, &mut gestures);
    assert!(player.is_behind());
    let mut bass = Neck::of("bass").player(EXACT);
    bass.take_over(&player, false);
    bass.advance(48_000, &mut gestures);
    assert!(!bass.is_behind());
    assert_eq!(bass.compromises().left_out, 1);
}
