//! The promise: what a note has for itself acts on that note and on no other. One whose key is down under the note that sounds
//! has it when it comes back, one that waits for a string when it comes.

use std::sync::LazyLock;

use low_action::performance::{Expression, PlayerEvent, StringDeed};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, RATE, play as play_by};
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

fn play(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    play_by(&mut GUITAR.player(EXACT), events)
}

fn has(key: u8, expression: Expression) -> PlayerEvent {
    PlayerEvent::Note { channel: 0, key, expression }
}

/// A3 held, B3 hammered over it, then something about either, then B3 let go of.
fn hammered(said: PlayerEvent) -> Vec<TimedGesture> {
    let hammer = [(0, cc(68, 127)), (0, on(57, 90)), (24_000, on(59, 90))];
    play(&[&hammer[..], &[(36_000, said), (48_000, off(59)), (96_000, off(57))]].concat())
}

/// When fingers are told to press harder or less hard, and so many N.
fn presses(gestures: &[TimedGesture]) -> Vec<(u64, f64)> {
    let force = |g: &TimedGesture| match g.gesture {
        Gesture::Press { force, .. } => Some((g.time, force)),
        _ => None,
    };
    gestures.iter().filter_map(force).collect()
}

/// How often the string is bent between two samples.
fn bends(gestures: &[TimedGesture], from: u64, to: u64) -> usize {
    let bent = |g: &&TimedGesture| matches!(g.gesture, Gesture::Bend { .. }) && (from..to).contains(&g.time);
    gestures.iter().filter(bent).count()
}

#[test]
fn a_key_under_the_one_that_sounds_is_pressed_for_its_own_note() {
    let pressed = |key| presses(&hammered(has(key, Expression::Pressure(1.0))));
    let nobody = pressed(60);
    let at =
        |found: &[(u64, f64)], time| found.iter().any(|&press| press.0 == time && !nobody.contains(&press));
    // The key that sounds at once, and no longer than it sounds.
    let over = pressed(59);
    assert!(at(&over, 36_000), "{over:?}, for nobody {nobody:?}");
    // The one under it when it is back.
    let under = pressed(57);
    assert!(!at(&under, 36_000) && at(&under, 48_000), "{under:?}, for nobody {nobody:?}");
    // So hard it presses until its key is up.
    let last = |found: &[(u64, f64)]| found.iter().rev().find(|press| press.0 < 96_000).map(|press| press.1);
    let usual = last(&nobody).expect("it presses");
    assert!(last(&under).is_some_and(|force| (force / usual - 2.5).abs() < 1e-9), "{under:?}");
    // The other's pressure has gone with it.
    assert_eq!(last(&over), Some(usual), "{over:?}");
}

#[test]
fn a_key_under_the_one_that_sounds_swings_for_its_own_note() {
    let swings = |key| {
        let gestures = hammered(has(key, Expression::Vibrato(1.0)));
        [bends(&gestures, 36_000, 48_000), bends(&gestures, 49_000, 96_000)]
    };
    let [before, after] = swings(59);
    assert!(before > 10 && after == 0, "{before} and {after}");
    let [before, after] = swings(57);
    assert!(before == 0 && after > 40, "{before} and {after}");
}

/// What a channel says is of all its notes, also of those that are to come back, and the last word counts.
#[test]
fn a_channel_swings_and_presses_the_note_that_comes_back() {
    let hammer = [(0, cc(68, 127)), (0, on(57, 90)), (24_000, on(59, 90))];
    let own = [(30_000, has(57, Expression::Vibrato(1.0))), (36_000, cc(1, 0))];
    let back = [(48_000, off(59)), (96_000, off(57))];
    assert_eq!(bends(&play(&[&hammer[..], &own, &back].concat()), 49_000, 96_000), 0);
    let pressure = [(36_000, PlayerEvent::ChannelPressure { channel: 0, pressure: 1.0 })];
    let usual = presses(&play(&[&hammer[..], &back].concat()));
    let pressed = presses(&play(&[&hammer[..], &pressure, &back].concat()));
    let after = |found: &[(u64, f64)]| found.iter().filter(|press| press.0 > 48_000).count();
    assert_eq!(after(&pressed), after(&usual), "nothing presses less hard when it is back");
}

/// (time, place, force) of the last pluck.
fn last_pluck(gestures: &[TimedGesture]) -> (u64, f64, f64) {
    let pluck = |g: &TimedGesture| match g.gesture {
        Gesture::Pluck { position, force, .. } => Some((g.time, position, force)),
        _ => None,
    };
    gestures.iter().filter_map(pluck).max_by_key(|pluck| pluck.0).expect("it is plucked")
}

#[test]
fn a_note_that_waits_for_a_string_is_plucked_as_it_was_told_meanwhile() {
    // The highest two of eight wait for 70 and 140 ms.
    let chord = [40, 47, 52, 55, 59, 64, 67, 71].map(|key| (0, on(key, 90)));
    let told = |said: &[(u64, PlayerEvent)]| last_pluck(&play(&[&chord[..], said].concat()));
    let key = {
        let mut player = GUITAR.player(EXACT);
        for &(time, event) in &chord {
            player.event(time, event, &mut Vec::new());
        }
        player.advance(5_000, &mut Vec::new());
        (0..128).find(|&key| player.awaits(0, key)).expect("one still waits")
    };
    let (time, place, force) = told(&[]);
    // The hand stills the string that it takes over, in up to 10 ms.
    assert!((6_720..=6_720 + 480).contains(&time), "{time}");
    let softer = told(&[(2_400, has(key, Expression::PluckForce(0.5)))]);
    assert_eq!((softer.0, softer.1), (time, place));
    assert!((softer.2 / force - 0.5).abs() < 1e-9, "{} N of {force}", softer.2);
    let nearer = told(&[(2_400, has(key, Expression::Brightness(1.0)))]);
    assert!(nearer.1 > place && nearer.2 == force, "{} m, {place} m", nearer.1);
}

#[test]
fn what_is_said_of_a_pluck_counts_at_its_sample_after_its_note_on() {
    let half = (0, has(64, Expression::PluckForce(0.5)));
    let [plain, after, before] = [&[(0, on(64, 90))][..], &[(0, on(64, 90)), half], &[half, (0, on(64, 90))]]
        .map(|events| last_pluck(&play(events)).2);
    assert!((after / plain - 0.5).abs() < 1e-9);
    assert_eq!(before, plain);
}

/// A host may say anything: a factor that is no number is not 0, which would silence the note.
#[test]
fn what_is_no_number_says_nothing() {
    type Said = fn(f32) -> Expression;
    let all: [Said; 9] = [
        Expression::Tuning,
        Expression::Pressure,
        Expression::Brightness,
        Expression::Vibrato,
        Expression::PluckPlace,
        Expression::PluckForce,
        Expression::Swell,
        Expression::Gain,
        Expression::FingerForce,
    ];
    // On a stopped note: something before, at its sample, while it sounds, and on the one that is hammered over it.
    let hammer =
        [(0, cc(68, 127)), (0, on(57, 90)), (24_000, on(59, 90)), (48_000, off(59)), (96_000, off(57))];
    let plain = play(&hammer);
    for (index, said) in all.into_iter().enumerate() {
        for amount in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for (time, key) in [(0, 57), (12_000, 57), (24_000, 59), (36_000, 57), (36_000, 59)] {
                let mut events = hammer.to_vec();
                let after = events.iter().take_while(|event| event.0 <= time).count();
                events.insert(after, (time, has(key, said(amount))));
                assert_eq!(play(&events), plain, "expression {index} of {amount} at {time} for key {key}");
            }
        }
    }
}

/// Its own share comes on top of what its channel's controllers say, in whatever order they come.
#[test]
fn what_is_said_of_a_pluck_adds_to_what_its_channel_says() {
    let pluck = |told: &[(u64, PlayerEvent)], said: &[Expression]| {
        let said = said.iter().map(|&expression| (0, has(64, expression)));
        last_pluck(&play(&told.iter().copied().chain([(0, on(64, 90))]).chain(said).collect::<Vec<_>>()))
    };
    let channel = [(0, cc(74, 32)), (0, cc(2, 64)), (0, cc(11, 100))];
    let (_, plain_place, plain_force) = pluck(&[], &[]);
    let (_, place, force) = pluck(&channel, &[]);
    assert!(place < plain_place && force < 0.5 * plain_force, "the channel says nothing");
    // Nothing of its own takes nothing away.
    let nothing = [Expression::PluckPlace(0.0), Expression::PluckForce(1.0), Expression::Brightness(0.5)];
    assert_eq!(pluck(&channel, &nothing), (0, place, force));
    let close = |one: f64, other: f64| (one - other).abs() < 1e-7;
    // 5 mm away from the saddle, which is where places end, and half of 80 mm towards it.
    let told = pluck(&channel, &[Expression::PluckPlace(0.005), Expression::Brightness(0.75)]);
    assert!(close(told.1, place - 0.005 + 0.04), "{} m instead of {place} m", told.1);
    let told = pluck(&channel, &[Expression::PluckForce(0.5)]);
    assert!(close(told.2, 0.5 * force), "{} N instead of {force} N", told.2);
}

/// As MIDI has it, sound controllers outlive a reset of all controllers.
#[test]
fn a_reset_leaves_the_place_of_plucks() {
    let pluck = |told: &[u8]| {
        let told = told.iter().map(|&number| (0, cc(number, if number == 121 { 0 } else { 100 })));
        last_pluck(&play(&told.chain([(0, on(64, 90))]).collect::<Vec<_>>()))
    };
    assert_ne!(pluck(&[74]), pluck(&[]));
    assert_eq!(pluck(&[74, 121]), pluck(&[74]));
    assert_ne!(pluck(&[2, 11]), pluck(&[]));
    assert_eq!(pluck(&[2, 11, 121]), pluck(&[]));
}

/// A host moves parameters for a note alone, and its player presses and expresses it: neither undoes what the other does.
#[test]
fn what_a_host_and_a_player_say_of_a_note_multiplies() {
    let force = |said: &[Expression]| {
        let said = said.iter().map(|&expression| (0, has(64, expression)));
        last_pluck(&play(&[(0, on(64, 90))].into_iter().chain(said).collect::<Vec<_>>())).2
    };
    let [moved, swell] = [Expression::PluckForce(0.5), Expression::Swell(0.25)];
    for said in [[moved, swell], [swell, moved]] {
        assert!((force(&said) / force(&[]) - 0.125).abs() < 1e-9, "{said:?}");
    }
    // So does the volume that hosts give a note, up to 12 dB.
    for (gain, factor) in [(1.0, 1.0), (0.5, 0.5), (0.0, 0.0), (4.0, 4.0), (1000.0, 4.0), (-1.0, 0.0)] {
        let found = force(&[Expression::Gain(gain), moved]) / force(&[]);
        assert!((found - 0.5 * factor).abs() < 1e-9, "{found} for a gain of {gain}");
    }
    assert_eq!(force(&[Expression::Gain(1.0)]), force(&[]));
    // How hard the finger presses at last, at fret 7: at the note's own sample, while it sounds, or when it has come back.
    let pressed = |told: &[(u64, PlayerEvent)]| {
        let note = [(0, cc(68, 127)), (0, on(57, 90))];
        let gestures = play(&[&note[..], told].concat());
        presses(&gestures).last().expect("it presses").1
    };
    let usual = pressed(&[]);
    let firm = |time| (time, has(57, Expression::FingerForce(0.5)));
    let hard = |time| (time, has(57, Expression::Pressure(1.0)));
    let all = |time| (time, PlayerEvent::ChannelPressure { channel: 0, pressure: 1.0 });
    let over = [(24_000, on(59, 90)), (96_000, off(59))];
    for told in [
        &[firm(0), hard(0)][..],
        &[hard(0), firm(0)],
        &[firm(0), hard(12_000)],
        &[hard(12_000), firm(24_000)],
        &[firm(0), all(12_000)],
        &[all(12_000), firm(24_000)],
        &[over[0], firm(36_000), hard(48_000), over[1]],
        &[over[0], hard(36_000), firm(48_000), over[1]],
    ] {
        let factor = pressed(told) / usual;
        assert!((factor - 1.25).abs() < 1e-9, "{factor}: {told:?}");
    }
}

/// (time, ratio of tensions, seconds) of what bends the string.
fn bent(gestures: &[TimedGesture]) -> Vec<(u64, f64, f64)> {
    let bend = |g: &TimedGesture| match g.gesture {
        Gesture::Bend { tension_ratio, duration } => Some((g.time, tension_ratio, duration)),
        _ => None,
    };
    gestures.iter().filter_map(bend).collect()
}

/// A hand bends a string before it plucks it, but does not hurry where that is heard.
#[test]
fn a_note_on_a_string_at_rest_begins_in_tune() {
    let tuned = (0, has(64, Expression::Tuning(1.0)));
    let wheel = |time| (time, PlayerEvent::PitchBend { channel: 0, value: 0.5 });
    for events in [&[(0, on(64, 90)), tuned][..], &[wheel(0), (0, on(64, 90))], &[(0, on(64, 90)), wheel(0)]]
    {
        let found = bent(&play(events));
        let [(0, ratio, seconds)] = found[..] else { panic!("{found:?}") };
        assert!(seconds <= 1.0 / RATE, "{seconds} s");
        // By a semitone, 2^(2/12).
        assert!((ratio - 1.122462).abs() < 1e-6, "{ratio}");
    }
    // What comes later is heard, and so is what is bent while another note sounds or ends.
    for before in [&[][..], &[(10, off(64))], &[(10, off(64)), (40, on(64, 90))]] {
        let found = bent(&play(&[&[(0, on(64, 90))], before, &[wheel(40)]].concat()));
        assert!(found.len() == 1 && found[0].2 > 0.005, "{found:?}");
    }
}

#[test]
fn the_tuning_of_a_note_goes_with_it() {
    let tuned = [(0, on(64, 90)), (0, has(64, Expression::Tuning(1.0))), (9_600, off(64))];
    let again = [(96_000, on(64, 90))];
    let found = bent(&play(&[&tuned[..], &again].concat()));
    let [_, (time, ratio, _)] = found[..] else { panic!("{found:?}") };
    assert!((9_600..96_000).contains(&time) && (ratio - 1.0).abs() < 1e-12, "{time}: {ratio}");
    // Or with the mouse that takes the string while it ends.
    let deed = StringDeed::Pluck { position: 0.5, force: 1.0 };
    let found = bent(&play(&[&tuned[..], &[(9_700, PlayerEvent::Touched { string: 0, deed })]].concat()));
    let [_, (9_700.., ratio, _)] = found[..] else { panic!("{found:?}") };
    assert!(found[1].0 < 12_000 && (ratio - 1.0).abs() < 1e-12, "{found:?}");
}

/// A wheel bends strings, and leaves them to whom it has bent them for: what the mouse plucks has no channel of its own.
#[test]
fn the_wheel_of_its_last_note_bends_what_is_plucked_without_a_key() {
    let pluck =
        |string| PlayerEvent::Touched { string, deed: StringDeed::Pluck { position: 0.5, force: 1.0 } };
    let wheel = |channel| (100_000, PlayerEvent::PitchBend { channel, value: 0.5 });
    // Key 64 is the first string's.
    let bends = |channel| {
        let note = [(0, on(64, 90)), (9_600, off(64)), (96_000, pluck(0))];
        bent(&play(&[&note[..], &[wheel(channel)]].concat())).len()
    };
    assert_eq!([bends(0), bends(1)], [1, 0]);
    // One that has had no note is bent by none.
    assert_eq!(bent(&play(&[(0, pluck(5)), wheel(0)])), []);
}
