//! The promise: with a channel per string the channel below theirs, MIDI's global one, speaks for all strings: what it says is what
//! each of their channels would say.

use std::sync::LazyLock;

use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::TimedGesture;
use low_action_tests::hands::{EXACT, Neck, control, note, play, wheel};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
/// The open keys of its strings.
const OPEN: [u8; 6] = [64, 59, 55, 50, 45, 40];

/// What a channel says at a sample, whichever it is.
type Said = (u64, fn(u8) -> PlayerEvent);

/// The first channel of the strings, and the one that speaks for all of them.
const GLOBAL: [(u8, u8); 4] = [(0, 15), (1, 0), (10, 9), (4, 3)];

/// What hands do, told by some channels, to strings that have channels from one on: a chord that is let go of, with what is said
/// before, during and after it.
fn played(first: u8, by: &[u8], said: &[Said]) -> Vec<TimedGesture> {
    let mut player = GUITAR.player(EXACT);
    player.set_input(InputMode::Strings { first, from_last: false });
    let chord = |time: u64, fret: u8| {
        (0..6_u8).map(move |string| (time, note(first + string, OPEN[usize::from(string)] + fret)))
    };
    let off = |time: u64, fret: u8| {
        (0..6_u8).map(move |string| {
            let key = OPEN[usize::from(string)] + fret;
            (time, PlayerEvent::NoteOff { channel: first + string, key })
        })
    };
    let notes = chord(1_000, 3).chain(chord(24_000, 5)).chain(off(30_000, 3)).chain(off(48_000, 5));
    let told = said.iter().flat_map(|&(time, event)| by.iter().map(move |&channel| (time, event(channel))));
    let mut events: Vec<_> = notes.chain(told).collect();
    events.sort_by_key(|event| event.0);
    let mut gestures = play(&mut player, &events);
    // Each string's own, in the order of what is done to it.
    gestures.sort_by_key(|gesture| gesture.string);
    gestures
}

#[test]
fn it_speaks_for_all_strings() {
    let said: [(&str, &[Said]); 14] = [
        ("sustain", &[(0, |c| control(c, 64, 127)), (96_000, |c| control(c, 64, 0))]),
        ("sostenuto", &[(25_000, |c| control(c, 66, 127)), (96_000, |c| control(c, 66, 0))]),
        ("legato", &[(0, |c| control(c, 68, 127))]),
        ("slides", &[(0, |c| control(c, 65, 127)), (0, |c| control(c, 5, 30))]),
        ("strokes", &[(500, |c| control(c, 22, 1)), (12_000, |c| control(c, 22, 3))]),
        ("palm", &[(0, |c| control(c, 20, 100)), (30_000, |c| control(c, 20, 30))]),
        ("tremolo", &[(0, |c| control(c, 25, 60))]),
        ("mutes", &[(12_000, |c| control(c, 23, 2))]),
        ("vibrato", &[(12_000, |c| control(c, 1, 90))]),
        ("force", &[(0, |c| control(c, 11, 60))]),
        ("place", &[(0, |c| control(c, 74, 90))]),
        ("wheel", &[(500, |c| wheel(c, 0.5)), (36_000, |c| wheel(c, 0.0))]),
        ("pressure", &[(12_000, |channel| PlayerEvent::ChannelPressure { channel, pressure: 0.8 })]),
        ("all keys up", &[(12_000, |c| control(c, 123, 0))]),
    ];
    for (first, global) in GLOBAL {
        let strings: Vec<u8> = (first..first + 6).collect();
        let plain = played(first, &[], &[]);
        for (what, said) in said {
            let all = played(first, &[global], said);
            assert_ne!(all, plain, "{what}, first channel {first}");
            assert_eq!(all, played(first, &strings, said), "{what}, first channel {first}");
        }
    }
}

/// What strings have been told themselves stays, as in MPE: wheels add to one another.
#[test]
fn strings_keep_what_they_say_themselves() {
    let both = |by: &[u8]| played(0, by, &[(500, |c| wheel(c, if c == 15 { 0.5 } else { 0.25 }))]);
    let sum = played(0, &[15], &[(500, |c| wheel(c, 0.75))]);
    assert_eq!(both(&[0, 1, 2, 3, 4, 5, 15]), sum);
}

/// How far wheels reach: their own, too. What a string's channel announces after it counts for that string.
#[test]
fn it_announces_the_reach_of_every_wheel() {
    const FIFTH: [Said; 3] =
        [(0, |c| control(c, 101, 0)), (0, |c| control(c, 100, 0)), (0, |c| control(c, 6, 7))];
    const TURNED: Said = (12_000, |c| wheel(c, 0.25));
    for (first, global) in GLOBAL {
        let strings: Vec<u8> = (first..first + 6).collect();
        let told = |announced: &[u8]| {
            let mut player = GUITAR.player(EXACT);
            player.set_input(InputMode::Strings { first, from_last: false });
            let mut events: Vec<(u64, PlayerEvent)> = Vec::new();
            for (time, said) in FIFTH {
                events.extend(announced.iter().map(|&channel| (time, said(channel))));
            }
            // The last string has another one.
            events.extend(FIFTH[..2].iter().map(|&(_, said)| (1, said(first + 5))));
            events.push((1, control(first + 5, 6, 3)));
            events.extend(strings.iter().zip(OPEN).map(|(&channel, open)| (1_000, note(channel, open + 3))));
            events.extend(strings.iter().map(|&channel| (TURNED.0, TURNED.1(channel))));
            let mut gestures = play(&mut player, &events);
            gestures.sort_by_key(|gesture| gesture.string);
            gestures
        };
        assert_ne!(told(&[global]), told(&[]), "first channel {first}");
        assert_eq!(told(&[global]), told(&strings), "first channel {first}");
    }
}

/// Others that are no string's say nothing, and neither does one that is below the strings and a string's own.
#[test]
fn no_other_channel_speaks_for_strings() {
    let palm: [Said; 1] = [(0, |c| control(c, 20, 100))];
    let plain = played(0, &[], &[]);
    assert_eq!(played(0, &[6, 7, 14], &palm), plain);
    // A pedal that only it holds falls where channels mean something else.
    let mut player = GUITAR.player(EXACT);
    player.set_input(InputMode::Strings { first: 0, from_last: false });
    let off = PlayerEvent::NoteOff { channel: 2, key: 60 };
    let mut out = Vec::new();
    for (time, event) in (0..).zip([control(15, 64, 127), note(2, 60), off]) {
        player.event(time, event, &mut out);
    }
    player.advance(9_600, &mut out);
    assert!(player.sounds(2, 60));
    player.set_input(InputMode::Keyboard);
    player.advance(9_601, &mut out);
    assert!(!player.sounds(2, 60));
}
