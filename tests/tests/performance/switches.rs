//! The promise: a keyswitch has the hands play as its controllers would; each takes the place of the one before, and leaves
//! how long slides and strums take.

use std::sync::LazyLock;

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, play};
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

/// The first of the keyswitches.
const FIRST: u8 = 12;
/// As one of `docs/gestures.md`: what the controllers say that do the same. (No number of 7 bits is a palm of 0.6: 76 is a
/// little less.)
const SWITCHES: [&[(u8, u8)]; 12] = [
    &[],
    &[(22, 2)],
    &[(22, 3)],
    &[(20, 76)],
    &[(22, 4)],
    &[(22, 5)],
    &[(22, 6)],
    &[(22, 7)],
    &[(23, 1)],
    &[(23, 2)],
    &[(68, 127)],
    &[(68, 127), (65, 127)],
];
/// The one for the palm.
const PALM: usize = 3;

/// What hands do who have been told so: two notes that overlap, one by itself, and a chord.
fn played(told: &[PlayerEvent]) -> Vec<TimedGesture> {
    let phrase = [
        (4800, on(65, 90)),
        (12_000, on(68, 90)),
        (24_000, off(65)),
        (24_000, off(68)),
        (48_000, on(67, 90)),
        (60_000, off(67)),
        (96_000, on(52, 90)),
        (96_000, on(59, 90)),
    ];
    // Slides of half a second, strums of 0.2 s that grow.
    let before = [cc(27, FIRST), cc(5, 85), cc(21, 64), cc(24, 127)];
    let events: Vec<_> = before.iter().chain(told).map(|&event| (0, event)).chain(phrase).collect();
    play(&mut GUITAR.player(EXACT), &events)
}

fn by_controllers(controllers: &[(u8, u8)]) -> Vec<TimedGesture> {
    played(&controllers.iter().map(|&(number, value)| cc(number, value)).collect::<Vec<_>>())
}

fn by_switches(switches: &[u8]) -> Vec<TimedGesture> {
    played(&switches.iter().flat_map(|&n| [on(FIRST + n, 90), off(FIRST + n)]).collect::<Vec<_>>())
}

#[test]
fn each_does_as_its_controllers() {
    let expected = SWITCHES.map(by_controllers);
    for (number, gestures) in expected.iter().enumerate() {
        let alike = expected.iter().filter(|other| *other == gestures).count();
        assert_eq!(alike, 1, "the phrase does not show what {number} does");
        if number != PALM {
            assert_eq!(by_switches(&[number as u8]), *gestures, "the switch +{number}");
        }
    }
}

/// Gesture by gesture its palm lies between those of two neighbouring values of the controller.
#[test]
fn the_palm_is_that_of_a_pressure_of_0_6() {
    let [less, more] = [76, 77].map(|value| by_controllers(&[(20, value)]));
    let found = by_switches(&[PALM as u8]);
    assert_eq!([less.len(), more.len()], [found.len(); 2]);
    let mut between = 0;
    for ((less, found), more) in less.iter().zip(&found).zip(&more) {
        let numbers = |gesture: &Gesture| match *gesture {
            Gesture::Place { position, .. } => position,
            Gesture::Press { force, .. } | Gesture::Lift { force, .. } => force,
            _ => 0.0,
        };
        let [least, most] = [&less.gesture, &more.gesture].map(numbers);
        let here = numbers(&found.gesture);
        assert!((least.min(most)..=least.max(most)).contains(&here), "{less:?}, {found:?}, {more:?}");
        between += u32::from(least != most && here != least && here != most);
        assert!((less.time, less.string) == (found.time, found.string), "{less:?}, {found:?}");
    }
    // It comes down and presses at four plucks.
    assert!(between >= 8, "{between} gestures of the palm");
}

/// (A palm comes when it is asked for, and goes again where another switch follows.)
#[test]
fn each_takes_the_place_of_the_one_before() {
    let from_the_first_note = |switches: &[u8]| {
        let mut gestures = by_switches(switches);
        gestures.retain(|timed| timed.time > 0);
        gestures
    };
    for last in 0..12 {
        let alone = from_the_first_note(&[last]);
        for before in (0..12).filter(|&before| before != last) {
            assert_eq!(from_the_first_note(&[before, last]), alone, "+{last} after +{before}");
        }
    }
}
