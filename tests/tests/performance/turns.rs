//! The promise: strokes back and forth turn once for each chord, wherever its notes are played and however many there are: where
//! each string has a channel, too, and where some of them wait for a string.

use std::sync::LazyLock;

use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, control, note, play};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
const BY_STRINGS: InputMode = InputMode::Strings { first: 0, from_last: false };
/// The open keys of its strings.
const OPEN: [u8; 6] = [64, 59, 55, 50, 45, 40];
const MS: u64 = 48;

/// Whether each stroke goes back, in order of time: those that do push for a shorter time.
fn strokes(input: InputMode, events: &[(u64, PlayerEvent)]) -> Vec<bool> {
    let mut player = GUITAR.player(EXACT);
    player.set_input(input);
    let told: Vec<_> = (0..16).map(|channel| (0, control(channel, 22, 2))).collect();
    let mut gestures = play(&mut player, &[&told[..], events].concat());
    gestures.sort_by_key(|gesture| gesture.time);
    let usual = GUITAR.setup.player.pluck_duration;
    let stroke = |gesture: &TimedGesture| match gesture.gesture {
        Gesture::Pluck { duration, .. } => Some(duration < usual),
        _ => None,
    };
    gestures.iter().filter_map(stroke).collect()
}

#[test]
fn a_strum_over_strings_with_channels_goes_one_way() {
    for apart in [0, 5 * MS, 25 * MS] {
        let chord = |from: u64| (0..6_u8).map(move |string| (from + apart * u64::from(string), string));
        let events: Vec<_> = [0, 24_000, 48_000]
            .into_iter()
            .flat_map(chord)
            .map(|(time, string)| (time, note(string, OPEN[usize::from(string)] + 2)))
            .collect();
        let found = strokes(BY_STRINGS, &events);
        assert_eq!(found, [[false; 6], [true; 6], [false; 6]].concat(), "{apart} samples apart");
    }
    // One note after another is one stroke each, on one string and across.
    let run: Vec<_> =
        (0..6_u8).map(|n| (4_800 * u64::from(n), note(n / 2, OPEN[usize::from(n / 2)] + 3))).collect();
    assert_eq!(strokes(BY_STRINGS, &run), [false, true, false, true, false, true]);
}

/// Of eight keys two find no string, in any octave: they come 70 and 140 ms after the others.
#[test]
fn notes_that_wait_for_a_string_go_the_way_of_their_chord() {
    let keys = [40, 45, 50, 55, 59, 64, 67, 71];
    for next in [24_000, 24_000 + 1] {
        let chords = [0, next].into_iter().flat_map(|time| keys.map(|key| (time, note(0, key))));
        let off = keys.map(|key| (12_000, PlayerEvent::NoteOff { channel: 0, key }));
        let mut events: Vec<_> = chords.chain(off).collect();
        events.sort_by_key(|event| event.0);
        let found = strokes(InputMode::Keyboard, &events);
        assert_eq!(found, [[false; 8], [true; 8]].concat());
    }
    // What begins just after one of them turns: it is no part of that chord.
    let late = keys.map(|key| (0, note(0, key)));
    let found = strokes(InputMode::Keyboard, &[&late[..], &[(150 * MS, note(0, 76))]].concat());
    assert_eq!(found, [&[false; 8][..], &[true]].concat());
}
