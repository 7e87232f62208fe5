//! The promise: who starts again, or is handed another instrument, forgets the music but not what was announced once: the capo,
//! keyswitches, how far wheels reach, MPE.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{Expression, Performance, PlayerEvent};
use low_action_dsp::{FINGERS_PER_STRING, Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, RATE, play, wheel};
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
static BASS: LazyLock<Neck> = LazyLock::new(|| Neck::of("bass"));
static FRETLESS: LazyLock<Neck> = LazyLock::new(|| Neck::of("fretless-bass"));

/// A registered parameter, of the first channel.
fn registered(number: u8, value: u8) -> [(u64, PlayerEvent); 3] {
    [(0, cc(101, 0)), (0, cc(100, number)), (0, cc(6, value))]
}

/// The largest ratio of tensions asked for, and the last place that a finger slides to.
fn bent(gestures: &[TimedGesture]) -> (f64, Option<f64>) {
    let ratios = gestures.iter().filter_map(|g| match g.gesture {
        Gesture::Bend { tension_ratio, .. } => Some(tension_ratio),
        _ => None,
    });
    let mut slides = gestures.iter().filter_map(|g| match g.gesture {
        Gesture::Slide { position, .. } => Some(position),
        _ => None,
    });
    (ratios.fold(1.0, f64::max), slides.next_back())
}

#[test]
fn a_player_who_starts_again_knows_what_was_announced() {
    let turned = [(0, on(62, 90)), (4_800, wheel(0, 1.0))];
    let of = |player: &mut Performance| bent(&play(player, &turned));
    let mut player = GUITAR.player(EXACT);
    let usual = of(&mut player);
    player.reset();
    play(&mut player, &registered(0, 12));
    player.restart();
    let wide = of(&mut player);
    assert!(wide.1.is_some() && usual.1.is_none(), "an octave is too far to pull, {usual:?}, {wide:?}");
    player.reset();
    assert_eq!(of(&mut player), usual, "all is forgotten where that is asked for");

    // The first channel speaks for the others in MPE, and their wheels reach four octaves.
    play(&mut player, &registered(6, 15));
    player.restart();
    let others = [(0, PlayerEvent::NoteOn { channel: 3, key: 60, velocity: 0.8 }), (4_800, wheel(3, 0.25))];
    assert!(bent(&play(&mut player, &others)).1.is_some());
}

#[test]
fn capo_and_keyswitches_stay_where_they_are() {
    // With the capo no string has the lowest key.
    let lowest = [(0, on(41, 90))];
    let moved = |player: &mut Performance| {
        let before = player.compromises().moved_by_octaves;
        play(player, &lowest);
        player.compromises().moved_by_octaves - before
    };
    let mut player = GUITAR.player(EXACT);
    assert_eq!(moved(&mut player), 0);
    play(&mut player, &[(200_000, cc(26, 3)), (200_000, cc(27, 100))]);
    player.restart();
    assert_eq!(moved(&mut player), 1);
    let pressed = play(&mut player, &[(200_000, on(102, 90))]);
    assert!(pressed.iter().all(|g| g.time < 200_000), "a keyswitch is not played");

    // Another instrument has it, too.
    let mut bass = BASS.player(EXACT);
    play(&mut bass, &[(0, on(28, 90))]);
    assert_eq!(bass.compromises().moved_by_octaves, 0);
    bass.take_over(&player, false);
    let before = bass.compromises().moved_by_octaves;
    play(&mut bass, &[(400_000, on(28, 90))]);
    assert_eq!(bass.compromises().moved_by_octaves, before + 1);
}

/// Where fingers and capo are at the end, m from the nut, by string and slot, and how tight each string is pulled.
fn stands(gestures: &[TimedGesture]) -> ([[Option<f64>; FINGERS_PER_STRING]; 4], [f64; 4]) {
    let (mut places, mut ratios) = ([[None; FINGERS_PER_STRING]; 4], [1.0; 4]);
    for timed in gestures {
        match timed.gesture {
            Gesture::Place { finger, position, .. }
            | Gesture::Throw { finger, position, .. }
            | Gesture::Slide { finger, position, .. } => places[timed.string][finger] = Some(position),
            Gesture::Lift { finger, .. } => places[timed.string][finger] = None,
            Gesture::Bend { tension_ratio, .. } => ratios[timed.string] = tension_ratio,
            _ => {}
        }
    }
    (places, ratios)
}

/// Where frets come under them, or go, fingers and capo are where the other neck has them. (They stayed where they were, 41 cents flat
/// on a bare board.)
#[test]
fn fingers_on_strings_that_go_on_are_where_the_new_neck_has_them() {
    let hammered = [(0, cc(68, 127)), (0, on(33, 90)), (9_600, on(36, 90))];
    // An open string, and a stopped one beside it: pulled by a quarter of a semitone, and as far as its finger has to slide for.
    let open = [(0, on(33, 90)), (0, on(39, 90))];
    let bent = [&open[..], &[(4_800, wheel(0, 0.125))]].concat();
    let far = [&registered(0, 12)[..], &open, &[(4_800, wheel(0, 0.5))]].concat();
    let over = [(0, cc(26, 3)), (0, on(31, 90)), (0, on(38, 90)), (0, on(45, 90))];
    for events in [&[(0, on(33, 90)), (0, on(41, 90))][..], &hammered, &bent, &far, &over] {
        for [from, to] in [[&*BASS, &*FRETLESS], [&*FRETLESS, &*BASS]] {
            let (old, mut gestures) = from.after(events, 48_000, Vec::new());
            let mut new = to.player(EXACT);
            new.take_over(&old, true);
            new.touch(48_000, &Touching::new(0.0, 2.0), &mut gestures);
            new.advance(96_000, &mut gestures);
            let [(places, ratios), (wanted, pulled)] =
                [gestures, to.after(events, 96_000, Vec::new()).1].map(|found| stands(&found));
            assert!(wanted.iter().flatten().any(Option::is_some), "nobody stops a string: {events:?}");
            for (string, (place, wanted)) in places.iter().zip(&wanted).enumerate() {
                for (slot, (place, wanted)) in place.iter().zip(wanted).enumerate() {
                    let there = match (place, wanted) {
                        (Some(place), Some(wanted)) => (place - wanted).abs() < 1e-9,
                        (place, wanted) => place.is_none() && wanted.is_none(),
                    };
                    assert!(there, "string {string}, finger {slot}: {place:?}, {wanted:?}, {events:?}");
                }
                let off = (ratios[string] - pulled[string]).abs();
                assert!(off < 1e-9, "string {string}: {ratios:?}, {pulled:?}, {events:?}");
            }
        }
    }
}

/// Force of the finger on the string, N, as last asked for.
fn pressed(gestures: &[TimedGesture]) -> Option<f64> {
    let mut forces = gestures.iter().filter_map(|g| match g.gesture {
        Gesture::Press { force, .. } => Some(force),
        _ => None,
    });
    forces.next_back()
}

/// Where strings go on, so do the fingers: with the new hands, and under a capo as far as the new neck goes.
#[test]
fn fingers_on_strings_that_go_on_press_as_the_new_hands_do() {
    let held = [(0, on(62, 90))];
    let mut player = GUITAR.player(EXACT);
    let mut gestures = Vec::new();
    player.touch(0, &Touching::default(), &mut gestures);
    for (time, event) in held {
        player.event(time, event, &mut gestures);
    }
    player.advance(12_000, &mut gestures);
    let before = pressed(&gestures).expect("a finger stops the string");
    let mut firm = GUITAR.setup.player.clone();
    firm.fretting.force *= 1.5;
    let mut next = Performance::new(GUITAR.strings.clone(), &firm, EXACT, RATE);
    next.take_over(&player, true);
    let mut gestures = Vec::new();
    next.touch(12_000, &Touching::default(), &mut gestures);
    next.advance(24_000, &mut gestures);
    let after = pressed(&gestures).expect("it presses on");
    assert!((after / before - 1.5).abs() < 1e-9, "{before} N, then {after} N");

    // A capo past the last fret but five goes as far as that of the new neck.
    let strings = |frets: usize| {
        let mut strings = GUITAR.strings.clone();
        strings.iter_mut().for_each(|string| string.geometry.frets.truncate(frets));
        strings
    };
    let of = |frets| Performance::new(strings(frets), &GUITAR.setup.player, EXACT, RATE);
    let (mut long, mut short, mut own) = (of(22), of(12), of(12));
    play(&mut long, &[(0, cc(26, 15))]);
    short.take_over(&long, true);
    play(&mut own, &[(0, cc(26, 15))]);
    let capo = |player: &mut Performance| {
        let gestures = play(player, &[(400_000, on(60, 90))]);
        let mut placed = gestures.iter().filter_map(|g| match g.gesture {
            Gesture::Place { position, .. } => Some(position),
            _ => None,
        });
        placed.next().expect("the capo comes")
    };
    assert_eq!(capo(&mut short), capo(&mut own));
}

/// On other strings notes end; but those that were begun for them are struck there.
#[test]
fn what_is_held_since_the_change_was_asked_for_is_struck_again() {
    let mut player = GUITAR.player(EXACT);
    let tuned = PlayerEvent::Note { channel: 0, key: 45, expression: Expression::Tuning(0.5) };
    // A note from before, one that has ended, one that was struck twice and tuned.
    let events = [
        (0, on(62, 90)),
        (6_000, on(50, 90)),
        (6_000, on(45, 90)),
        (7_000, on(45, 90)),
        (7_000, tuned),
        (8_000, off(50)),
    ];
    let mut gestures = Vec::new();
    for (time, event) in events {
        player.event(time, event, &mut gestures);
    }
    player.advance(12_000, &mut gestures);
    let mut bass = BASS.player(EXACT);
    bass.take_over(&player, false);
    bass.strike_again(&player, 6_000);
    let mut gestures = Vec::new();
    bass.event(24_000, off(45), &mut gestures);
    let plucks = gestures.iter().filter(|g| matches!(g.gesture, Gesture::Pluck { .. })).map(|g| g.time);
    assert_eq!(plucks.collect::<Vec<_>>(), [12_000]);
    assert!(bent(&gestures).0 > 1.0, "its tuning is lost");
    assert!(bass.sounds(0, 45), "it was struck twice");
    bass.event(36_000, off(45), &mut gestures);
    assert!(!bass.sounds(0, 45));
}
