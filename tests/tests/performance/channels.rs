//! The promise: messages of one channel stand between notes of another without touching them. What a chord is to be does not
//! depend on the order of events within a sample; in MPE the first channel speaks for all.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{Expression, InputMode, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{self, EXACT, Neck, control, note, of_string, play, wheel};
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
/// A barre at the sixth fret.
const BARRE: [u8; 6] = [46, 53, 58, 61, 65, 70];

/// What hands make of events, each with its sample.
fn mpe(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    GUITAR.told(InputMode::Mpe, &Touching::default(), events)
}

fn keyboard(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    GUITAR.told(InputMode::Keyboard, &Touching::default(), events)
}

/// (time, string, force) of the plucks, in order of strings.
fn plucks(gestures: &[TimedGesture]) -> Vec<(u64, usize, f64)> {
    let mut plucks = hands::plucks(gestures);
    plucks.sort_by_key(|pluck| pluck.1);
    plucks
}

#[test]
fn what_other_channels_say_between_its_notes_does_not_tear_a_chord_apart() {
    let members = || BARRE.into_iter().zip(1_u8..);
    let together: Vec<_> = members().map(|(key, channel)| (0, note(channel, key))).collect();
    // As a clip of a host has it that was recorded from such a keyboard.
    let apart: Vec<_> = members()
        .flat_map(|(key, channel)| {
            [
                (0, control(channel, 74, 64)),
                (0, wheel(channel, 0.0)),
                (0, note(channel, key)),
                (0, PlayerEvent::ChannelPressure { channel: channel + 7, pressure: 0.5 }),
            ]
        })
        .collect();
    let barre = mpe(&together);
    assert_eq!(plucks(&barre).len(), 6);
    assert_eq!(plucks(&mpe(&apart)), plucks(&barre));
    // A strum goes over the whole of it.
    let strum: Vec<_> = [(0, control(0, 21, 127))].into_iter().chain(apart).collect();
    let mut times: Vec<u64> = plucks(&mpe(&strum)).iter().map(|pluck| pluck.0).collect();
    times.dedup();
    assert_eq!(times.len(), 6, "{times:?}");
}

#[test]
fn keys_that_go_up_between_its_notes_do_not_tear_a_chord_apart() {
    // Six tracks, one after another at each instant: what they begin begins together.
    let open = [40, 45, 50, 55, 59, 64];
    let first = open.map(|key| (0, on(key, 90)));
    let mixed = open.into_iter().zip(BARRE).flat_map(|(key, next)| [off(key), on(next, 90)]);
    let sorted = open.map(off).into_iter().chain(BARRE.map(|key| on(key, 90)));
    let then = |events: &mut dyn Iterator<Item = PlayerEvent>| {
        let all: Vec<_> = first.into_iter().chain(events.map(|event| (24_000, event))).collect();
        plucks(&keyboard(&all))
    };
    assert_eq!(then(&mut mixed.into_iter()), then(&mut sorted.into_iter()));
}

#[test]
fn the_first_channel_speaks_for_all_that_is_still_to_come() {
    let force = |expression: u8| plucks(&mpe(&[(0, control(0, 11, expression)), (4800, note(3, 60))]))[0].2;
    assert!((force(64) / force(127) - 64.0 / 127.0).abs() < 1e-6);
    let bends = |depth: u8| {
        let gestures = mpe(&[(0, control(0, 1, depth)), (4800, note(3, 60)), (24_000, control(3, 1, 0))]);
        gestures.iter().filter(|g| g.time > 9600 && matches!(g.gesture, Gesture::Bend { .. })).count()
    };
    assert_eq!(bends(0), 0);
    assert!(bends(127) > 20, "it swings");
}

#[test]
fn the_reach_that_one_member_announces_is_that_of_all() {
    let slides = |events: &[(u64, PlayerEvent)]| {
        let bent = [(0, note(2, 60)), (4800, wheel(2, 0.25))];
        let gestures = mpe(&events.iter().chain(&bent).copied().collect::<Vec<_>>());
        let (string, to) = gestures
            .iter()
            .filter_map(|g| match g.gesture {
                Gesture::Slide { position, .. } => Some((g.string, position)),
                _ => None,
            })
            .next_back()
            .expect("it is too far to pull");
        let geometry = &GUITAR.strings[string].geometry;
        let nearest = (1..=geometry.frets.len())
            .min_by(|&a, &b| {
                let off = |fret| (geometry.finger_position(fret) - to).abs();
                off(a).total_cmp(&off(b))
            })
            .expect("there are frets");
        geometry.open_pitch + nearest as f64
    };
    assert_eq!(slides(&[]), 72.0);
    let announced = [(101, 0), (100, 0), (6, 24)].map(|(number, value)| (0, control(1, number, value)));
    assert_eq!(slides(&announced), 66.0);
}

#[test]
fn a_keyswitch_counts_for_the_notes_of_its_sample_whichever_comes_first() {
    let touching = Touching { keyswitches: Some(12), ..Touching::default() };
    let hands = |events: &[PlayerEvent]| {
        let events: Vec<_> = events.iter().map(|&event| (0, event)).collect();
        GUITAR.told(InputMode::Keyboard, &touching, &events)
    };
    // A harmonic, back to plain, and a string.
    let [harmonic, plain, third] = [on(20, 90), on(12, 90), on(26, 90)];
    assert_eq!(hands(&[on(64, 90), harmonic]), hands(&[harmonic, on(64, 90)]));
    assert_eq!(hands(&[harmonic, on(76, 90), plain]), hands(&[on(76, 90)]));
    assert_eq!(hands(&[on(64, 90), third]), hands(&[third, on(64, 90)]));
    assert_eq!(plucks(&hands(&[on(64, 90), third]))[0].1, 2);
}

#[test]
fn a_string_that_one_channel_asks_for_is_no_other_channels() {
    let touching = Touching { keyswitches: Some(12), ..Touching::default() };
    let strings = |input, events: &[PlayerEvent]| {
        let events: Vec<_> = events.iter().map(|&event| (0, event)).collect();
        let found = plucks(&GUITAR.told(input, &touching, &events));
        found.iter().map(|pluck| pluck.1).collect::<Vec<_>>()
    };
    // Strings 3 and 5, of which each channel has its own.
    let [third, fifth] = [note(1, 26), note(2, 28)];
    let keyboard = |events: &[PlayerEvent]| strings(InputMode::Keyboard, events);
    assert_eq!(keyboard(&[third, note(1, 64)]), [2]);
    assert_eq!(keyboard(&[third, note(2, 64)]), [0]);
    for [first, second] in [[third, fifth], [fifth, third]] {
        assert_eq!(keyboard(&[first, second, note(1, 64)]), [2]);
        assert_eq!(keyboard(&[first, second, note(2, 64)]), [4]);
    }
    // One that goes up is up for its own channel alone.
    let up = PlayerEvent::NoteOff { channel: 1, key: 26 };
    assert_eq!(keyboard(&[third, note(2, 26), up, note(2, 64)]), [2]);
    assert_eq!(keyboard(&[third, note(2, 26), up, note(1, 64)]), [0]);
    // Where each note has a channel it is for all.
    assert_eq!(strings(InputMode::Mpe, &[third, note(2, 64)]), [2]);
    assert_eq!(strings(InputMode::Mpe, &[note(0, 26), note(2, 64)]), [2]);
}

#[test]
fn a_note_that_was_down_before_its_key_became_a_keyswitch_ends_with_it() {
    let mut player = GUITAR.player(EXACT);
    play(&mut player, &[(0, on(40, 90)), (4800, cc(27, 28)), (9600, off(40))]);
    assert!(!player.sounds(0, 40));
}

#[test]
fn a_string_asked_for_by_a_key_is_not_asked_for_after_everything_has_stopped() {
    let touching = Touching { keyswitches: Some(12), ..Touching::default() };
    let stopped = [(0, on(26, 90)), (4800, PlayerEvent::AllNotesOff)];
    let chord = [57, 60, 64].map(|key| (48_000, on(key, 90)));
    let after: Vec<_> = stopped.into_iter().chain(chord).collect();
    let strings = |events: &[(u64, PlayerEvent)]| {
        plucks(&GUITAR.told(InputMode::Keyboard, &touching, events))
            .iter()
            .map(|pluck| pluck.1)
            .collect::<Vec<_>>()
    };
    assert_eq!(strings(&after), strings(&chord));
}

/// Samples and tension ratios of the bends.
fn bends(gestures: &[TimedGesture]) -> Vec<(u64, f64)> {
    let ratio = |g: &TimedGesture| match g.gesture {
        Gesture::Bend { tension_ratio, .. } => Some((g.time, tension_ratio)),
        _ => None,
    };
    gestures.iter().filter_map(ratio).collect()
}

#[test]
fn a_note_that_comes_back_is_as_its_own_channel_has_it() {
    let connected = Touching { legato: true, ..Touching::default() };
    // The wheel of vibrato is still up.
    let events = [(0, cc(1, 127)), (0, on(55, 90)), (24_000, on(57, 90)), (48_000, off(57))];
    let swings = bends(&GUITAR.told(InputMode::Keyboard, &connected, &events));
    assert!(swings.iter().filter(|bend| bend.0 > 60_000).count() > 20, "it swings on");
    // The wheel that was turned was the other note's.
    let turned = 1.0 / 48.0;
    let events = [
        (0, note(1, 55)),
        (24_000, note(2, 57)),
        (30_000, wheel(2, turned)),
        (48_000, PlayerEvent::NoteOff { channel: 2, key: 57 }),
    ];
    let last = *bends(&GUITAR.told(InputMode::Mpe, &connected, &events)).last().expect("it was bent");
    assert!(last.0 >= 48_000 && (last.1 - 1.0).abs() < 1e-9, "{last:?}");
    // A note has its own tuning back.
    let tuned = PlayerEvent::Note { channel: 0, key: 55, expression: Expression::Tuning(0.5) };
    let events = [(0, on(55, 90)), (4800, tuned), (24_000, on(57, 90)), (48_000, off(57))];
    let tunings = bends(&GUITAR.told(InputMode::Keyboard, &connected, &events));
    let [first, straight, back] = tunings[..] else { panic!("{tunings:?}") };
    assert!(first.1 > 1.0 && (straight.1 - 1.0).abs() < 1e-9 && back.0 >= 48_000, "{tunings:?}");
}

#[test]
fn a_key_of_a_channel_that_let_go_of_all_does_not_come_back() {
    let connected = Touching { legato: true, ..Touching::default() };
    let mut player = GUITAR.player(EXACT);
    player.set_input(InputMode::Mpe);
    player.touch(0, &connected, &mut Vec::new());
    let released = [
        (0, note(1, 55)),
        (24_000, note(2, 57)),
        (30_000, control(1, 123, 0)),
        (48_000, PlayerEvent::NoteOff { channel: 2, key: 57 }),
    ];
    play(&mut player, &released);
    assert!(!player.sounds(1, 55) && !player.sounds(2, 57));
    // The key that is still down comes back where the other channel lets go of all.
    player.reset();
    play(&mut player, &[(0, note(1, 55)), (24_000, note(2, 57)), (30_000, control(2, 123, 0))]);
    assert!(player.sounds(1, 55) && !player.sounds(2, 57));
}

#[test]
fn a_strum_goes_no_farther_than_silence() {
    let chord = [40, 47, 52, 56, 59, 64].map(|key| (0, on(key, 90)));
    for silence in [PlayerEvent::AllNotesOff, cc(120, 0)] {
        let events: Vec<_> = [(0, cc(21, 127))].into_iter().chain(chord).chain([(2400, silence)]).collect();
        let gestures = keyboard(&events);
        let late = plucks(&gestures).into_iter().filter(|pluck| pluck.0 > 2400).count();
        assert_eq!(late, 0, "{silence:?}");
        assert_eq!(plucks(&gestures).len(), 1, "the first string has been struck");
        // Nor where all keys have gone up before, as hosts have it when they stop.
        let released = [40, 47, 52, 56, 59, 64].map(|key| (1200, off(key)));
        let before = events.len() - 1;
        let events = [&events[..before], &released, &events[before..]].concat();
        let struck = plucks(&keyboard(&events));
        assert!(struck.len() == 1 && struck[0].0 < 1200, "{silence:?}: {struck:?}");
    }
}

/// Tension in semitones, as it was last asked for before a sample.
fn bent_by(gestures: &[TimedGesture], time: u64) -> f64 {
    let mut ratios = gestures.iter().filter(|g| g.time < time).filter_map(|g| match g.gesture {
        Gesture::Bend { tension_ratio, .. } => Some(tension_ratio),
        _ => None,
    });
    6.0 * ratios.next_back().unwrap_or(1.0).log2()
}

/// An open string.
#[test]
fn a_held_wheel_stands_for_what_it_is_told_to() {
    let mut player = GUITAR.player(EXACT);
    let mut gestures = Vec::new();
    player.touch(0, &Touching::new(0.0, 1.0), &mut gestures);
    for (time, event) in [(0, on(40, 90)), (4_800, wheel(0, 1.0))] {
        player.event(time, event, &mut gestures);
    }
    player.advance(9_600, &mut gestures);
    assert!((bent_by(&gestures, 9_600) - 1.0).abs() < 1e-9);
    player.touch(9_600, &Touching::new(0.0, 2.0), &mut gestures);
    player.advance(14_400, &mut gestures);
    assert!((bent_by(&gestures, 14_400) - 2.0).abs() < 1e-9);
    // A channel that bends all others reaches two semitones, whatever is set.
    player.touch(14_400, &Touching::new(0.0, 1.0), &mut gestures);
    player.advance(19_200, &mut gestures);
    player.set_input(InputMode::Mpe);
    player.advance(24_000, &mut gestures);
    let found = [19_200, 24_000].map(|time| bent_by(&gestures, time));
    assert!((found[0] - 1.0).abs() < 1e-9 && (found[1] - 2.0).abs() < 1e-9, "{found:?}");
}

/// Samples and strings of the plucks, every pluck exactly alike.
fn strummed_by(input: InputMode, events: &[(u64, PlayerEvent)]) -> Vec<(u64, usize)> {
    let found = plucks(&GUITAR.told(input, &Touching::new(0.0, 2.0), events));
    found.iter().map(|pluck| (pluck.0, pluck.1)).collect()
}

#[test]
fn only_notes_of_channels_that_strum_are_strummed_whichever_comes_first() {
    let strummed = [40, 47, 52].map(|key| (0, note(1, key)));
    let struck = [56, 59, 64].map(|key| (0, note(2, key)));
    let told = [(0, control(1, 21, 127))];
    // 0.4 s over the six strings.
    let way = [(0, 5), (3_840, 4), (7_680, 3), (0, 2), (0, 1), (0, 0)];
    for (first, second) in [(strummed, struck), (struck, strummed)] {
        let mut found = strummed_by(InputMode::Keyboard, &[&told[..], &first, &second].concat());
        found.reverse();
        assert_eq!(found, way);
    }
    // Two times, two hands: each goes over its own strings.
    let both = [told[0], (0, control(2, 21, 64))];
    for (first, second) in [(strummed, struck), (struck, strummed)] {
        let found = strummed_by(InputMode::Keyboard, &[&both[..], &first, &second].concat());
        let times: Vec<u64> = found.iter().rev().map(|pluck| pluck.0).collect();
        let step = (3_840.0 * 64.0 / 127.0_f64).round() as u64;
        assert_eq!(times[..4], [0, 3_840, 7_680, 0]);
        assert!(times[4].abs_diff(step) <= 1 && times[5].abs_diff(2 * step) <= 1, "{times:?}");
    }
}

#[test]
fn a_strum_of_all_channels_is_one_in_whatever_order_its_notes_come() {
    let way = [0, 1, 2, 3, 4, 5].map(|string| (19_200 - 3_840 * string as u64, string));
    let members = BARRE.into_iter().zip(1_u8..).map(|(key, channel)| (0, note(channel, key)));
    let [up, mut down] = [(); 2].map(|()| members.clone().collect::<Vec<_>>());
    down.reverse();
    for notes in [up, down] {
        // A stroke that one of them has for itself goes the same way.
        let told = [(0, control(0, 21, 127)), (0, control(3, 22, 5))];
        let found = strummed_by(InputMode::Mpe, &[&told[..], &notes].concat());
        assert_eq!(found, way);
    }
}

/// A keyswitch for a string is a key: what lets go of all keys lets go of it.
#[test]
fn letting_go_of_all_keys_lets_go_of_keyswitches() {
    let touching = Touching { keyswitches: Some(12), ..Touching::default() };
    // The twelve for ways of playing are followed by one for each string: the last one's.
    const SWITCH: u8 = 12 + 12 + 5;
    let string_of = |between: &[(u64, PlayerEvent)]| {
        let asked = (0, on(SWITCH, 90));
        let all: Vec<_> =
            [asked].into_iter().chain(between.iter().copied()).chain([(4_800, on(52, 90))]).collect();
        plucks(&GUITAR.told(InputMode::Keyboard, &touching, &all))[0].1
    };
    let asked = string_of(&[]);
    let free = string_of(&[(100, off(SWITCH))]);
    assert_ne!(asked, free);
    for message in [123, 120] {
        assert_eq!(string_of(&[(100, cc(message, 0))]), free, "{message}");
    }
    assert_eq!(string_of(&[(100, control(3, 123, 0))]), asked, "another channel's keys");
}

/// One event is as good as one for each note that it means.
#[test]
fn what_is_said_of_all_notes_is_said_of_each() {
    let begin = [(0, note(1, 55)), (0, note(2, 60)), (0, note(2, 64))];
    let expression = Expression::Tuning(0.5);
    let bends = |said: &[(u64, PlayerEvent)]| {
        let all: Vec<_> = begin.iter().chain(said).copied().collect();
        let bends = keyboard(&all).into_iter().filter(|g| matches!(g.gesture, Gesture::Bend { .. }));
        let mut strings: Vec<_> = bends.map(|g| (g.string, g.time)).collect();
        strings.sort_unstable();
        strings
    };
    let each = |keys: &[(u8, u8)]| {
        let one = |&(channel, key): &(u8, u8)| (9_600, PlayerEvent::Note { channel, key, expression });
        bends(&keys.iter().map(one).collect::<Vec<_>>())
    };
    let all = |channel, key| bends(&[(9_600, PlayerEvent::Notes { channel, key, expression })]);
    assert_eq!(each(&[(1, 55), (2, 60), (2, 64)]).len(), 3);
    assert_eq!(all(None, None), each(&[(1, 55), (2, 60), (2, 64)]));
    assert_eq!(all(Some(2), None), each(&[(2, 60), (2, 64)]));
    assert_eq!(all(None, Some(60)), each(&[(2, 60)]));
    assert_eq!(all(Some(1), Some(60)), []);
}

/// A melody goes on over the notes of another channel, at its sample or a moment before it.
#[test]
fn what_other_channels_play_is_no_reason_to_pluck() {
    let melody = [(0, cc(68, 127)), (0, note(0, 64)), (24_000, note(0, 66))];
    let exact =
        |events: &[(u64, PlayerEvent)]| GUITAR.told(InputMode::Keyboard, &Touching::new(0.0, 2.0), events);
    let alone = exact(&melody);
    assert_eq!(plucks(&alone).len(), 1);
    for time in [23_500, 24_000] {
        let mut both = [&melody[..], &[(time, note(1, 40))]].concat();
        both.sort_by_key(|event| event.0);
        let both = exact(&both);
        assert_eq!(plucks(&both).iter().map(|pluck| pluck.1).collect::<Vec<_>>(), [0, 5], "{time}");
        assert_eq!(of_string(&both, 0), of_string(&alone, 0), "{time}");
    }
}

/// Where channels are voices of one player, whichever puts everything back does so for the capo of the same sample's notes.
#[test]
fn a_channel_that_is_reset_takes_the_capo_from_the_notes_to_come() {
    let played = |channel| {
        let events =
            [(0, cc(26, 5)), (100, note(0, 42)), (100, control(channel, 121, 0)), (24_000, note(0, 40))];
        keyboard(&events)
    };
    assert_eq!(played(1), played(0));
    // In MPE only the first one speaks of the capo.
    let last = |channel| plucks(&mpe(&[(0, cc(26, 5)), (100, control(channel, 121, 0)), (200, note(1, 40))]));
    assert_ne!(last(2), last(0));
}

/// Notes that wait for a string hear what is said of those that sound.
#[test]
fn what_is_said_of_all_notes_is_said_of_those_to_come() {
    let seven = [40, 45, 50, 55, 59, 64, 67].map(|key| (0, note(0, key)));
    let after = |told: &[(u64, PlayerEvent)]| {
        let mut gestures = keyboard(told);
        gestures.retain(|timed| timed.time > 12_000);
        gestures.iter().filter(|timed| matches!(timed.gesture, Gesture::Bend { .. })).count()
    };
    let [swings, ceases] = [127, 0].map(|depth| control(0, 1, depth));
    assert!(after(&[&[(0, swings)], &seven[..]].concat()) > 100);
    assert_eq!(after(&[&[(0, swings)], &seven[..], &[(960, ceases)]].concat()), 0);
    assert_eq!(after(&[&[(0, swings)], &seven[..], &[(960, control(0, 121, 0))]].concat()), 0);
}
