//! The promise: with a channel per string the rules of notes that overlap hold on every string by itself. What is hammered,
//! pulled or slid on one string is so on several at the same sample, in whatever order their messages come.

use std::sync::LazyLock;

use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, count_plucks as plucks, of_string, play};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
const BY_STRINGS: InputMode = InputMode::Strings { first: 0, from_last: false };
/// The open keys of its strings, which are those of channels 0 to 5.
const OPEN: [u8; 6] = [64, 59, 55, 50, 45, 40];
/// When the second chord begins, samples.
const NEXT: u64 = 24_000;

fn on(string: u8, fret: u8) -> PlayerEvent {
    PlayerEvent::NoteOn { channel: string, key: OPEN[usize::from(string)] + fret, velocity: 0.7 }
}

fn off(string: u8, fret: u8) -> PlayerEvent {
    PlayerEvent::NoteOff { channel: string, key: OPEN[usize::from(string)] + fret }
}

fn control(string: u8, number: u8) -> PlayerEvent {
    PlayerEvent::Controller { channel: string, number, value: 1.0 }
}

/// What hands do to strings whose notes are connected, by slides if so, from the second chord on.
fn connected(slides: bool, events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    let mut player = GUITAR.player(EXACT);
    player.set_input(BY_STRINGS);
    let told = (0..6).flat_map(|string| {
        [Some(68), slides.then_some(65)].into_iter().flatten().map(move |number| (0, control(string, number)))
    });
    let events: Vec<_> = told.chain(events.iter().copied()).collect();
    play(&mut player, &events).into_iter().filter(|gesture| gesture.time >= NEXT).collect()
}

fn count(gestures: &[TimedGesture], kind: impl Fn(&Gesture) -> bool) -> usize {
    gestures.iter().filter(|timed| kind(&timed.gesture)).count()
}

#[test]
fn several_strings_at_once_are_connected_as_one_is() {
    for (from, to, slides) in [(5, 7, false), (7, 5, false), (5, 0, false), (5, 9, true)] {
        for strings in [&[1_u8, 2][..], &[2, 1], &[0, 1, 2, 3, 4, 5]] {
            let first = strings.iter().map(|&string| (0, on(string, from)));
            let second = strings.iter().map(|&string| (NEXT, on(string, to)));
            let together = connected(slides, &first.clone().chain(second).collect::<Vec<_>>());
            for &string in strings {
                let alone = connected(slides, &[(0, on(string, from)), (NEXT, on(string, to))]);
                let string = usize::from(string);
                assert!(!alone.is_empty());
                assert_eq!(
                    of_string(&together, string),
                    of_string(&alone, string),
                    "fret {from} to {to} on string {string} of {strings:?}"
                );
            }
        }
    }
}

/// Keys of other strings that go up between them are not theirs.
#[test]
fn a_hammer_on_one_string_leaves_plucks_on_others() {
    // One string goes on, the next is out of reach, the third had no note.
    let first = [(0, on(1, 5)), (0, on(2, 3))];
    let second =
        [(NEXT, on(1, 7)), (NEXT, off(2, 3)), (NEXT, on(2, 12)), (NEXT, off(1, 5)), (NEXT, on(3, 5))];
    let gestures = connected(false, &[&first[..], &second].concat());
    assert_eq!([1, 2, 3].map(|string| plucks(&of_string(&gestures, string))), [0, 1, 1]);
    let thrown = |gesture: &Gesture| matches!(gesture, Gesture::Throw { .. });
    assert_eq!(count(&of_string(&gestures, 1), thrown), 1);
}

/// A strum of what is out of reach stays one where the notes before it end between its own.
#[test]
fn notes_out_of_reach_are_strummed() {
    let strings = 0..6_u8;
    let first = strings.clone().map(|string| (0, on(string, 1)));
    let strum = strings.clone().map(|string| (NEXT - 1, control(string, 21)));
    let second = strings.flat_map(|string| [(NEXT, on(string, 12)), (NEXT, off((string + 1) % 6, 1))]);
    let gestures = connected(false, &first.chain(strum).chain(second).collect::<Vec<_>>());
    let mut times: Vec<u64> = gestures
        .iter()
        .filter(|timed| matches!(timed.gesture, Gesture::Pluck { .. }))
        .map(|timed| timed.time)
        .collect();
    times.sort_unstable();
    // 0.4 s over the six strings, which still ring: before the first stroke the hand has to come, at most 3 ms.
    assert!((NEXT..NEXT + 144).contains(&times[0]), "{times:?}");
    assert_eq!(times[1..], [1, 2, 3, 4, 5].map(|way| NEXT + 3_840 * way));
}

/// Those that have had no note, too.
#[test]
fn the_palm_of_a_channel_waits_on_its_string() {
    let palm = |told: &[(u64, PlayerEvent)]| {
        let mut player = GUITAR.player(EXACT);
        player.set_input(BY_STRINGS);
        let laid =
            |timed: &TimedGesture| matches!(timed.gesture, Gesture::Place { .. }).then_some(timed.string);
        let mut strings: Vec<_> = play(&mut player, told).iter().filter_map(laid).collect();
        strings.sort_unstable();
        strings.dedup();
        strings
    };
    assert_eq!(palm(&[(0, control(2, 20))]), [2]);
    // A keyswitch of any channel speaks for all: the fourth from the first key on is the palm.
    let switches = (0, PlayerEvent::Controller { channel: 0, number: 27, value: 1.0 / 127.0 });
    let switch = (1, PlayerEvent::NoteOn { channel: 3, key: 4, velocity: 0.7 });
    assert_eq!(palm(&[switches, switch]), [0, 1, 2, 3, 4, 5]);
}
