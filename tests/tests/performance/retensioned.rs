//! The promise: a bend is as wide on every fret. What stops the string adds to its tension, and a wheel that stands turned takes
//! that into account as soon as it changes: unheard on a string at rest, with the hand's ramp on one that sounds.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{Annotation, GestureSink, InputMode, PlayerEvent, StringDeed, TimedAnnotation};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, RATE, control, note, play, wheel};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{Stage, at, hertz, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

/// The lowest string and its channel where each string has one of its own.
const LOW: u8 = 5;

/// What bends the lowest string: sample, factor of tension, and seconds.
fn bends(events: &[(u64, PlayerEvent)]) -> Vec<(u64, f64, f64)> {
    let connected = Touching { legato: true, ..Touching::new(0.0, 2.0) };
    let input = InputMode::Strings { first: 0, from_last: false };
    found(&GUITAR.told(input, &connected, events))
}

fn found(gestures: &[TimedGesture]) -> Vec<(u64, f64, f64)> {
    let bend = |g: &TimedGesture| match g.gesture {
        Gesture::Bend { tension_ratio, duration } => Some((g.time, tension_ratio, duration)),
        _ => None,
    };
    gestures.iter().filter_map(bend).collect()
}

fn ends(key: u8) -> PlayerEvent {
    PlayerEvent::NoteOff { channel: LOW, key }
}

/// The factor for two semitones on a fret that is stopped before the wheel turns.
fn for_fret(fret: u8) -> f64 {
    let [(_, ratio, _)] = bends(&[(0, note(LOW, 40 + fret)), (24_000, wheel(LOW, 1.0))])[..] else {
        panic!()
    };
    ratio
}

#[test]
fn a_wheel_that_stands_turned_bends_every_fret_as_far() {
    let (open, fretted) = (for_fret(0), for_fret(12));
    assert!((open - 2_f64.powf(2.0 / 6.0)).abs() < 1e-12 && fretted > open + 0.005, "{open}, {fretted}");
    // Turned while the string rests, then a note with a finger, and one without.
    let played = [(0, note(LOW, 40)), (9_600, ends(40)), (96_000, wheel(LOW, 1.0))];
    let then = [(192_000, note(LOW, 52)), (201_600, ends(52)), (384_000, note(LOW, 40))];
    let all = bends(&[&played[..], &then].concat());
    let [(96_000, first, _), (192_000, second, at_once), (384_000, third, _)] = all[..] else {
        panic!("{all:?}")
    };
    assert_eq!([first, second, third], [open, fretted, open]);
    assert!(at_once <= 1.0 / RATE, "nobody hears it: {at_once} s");
}

#[test]
fn where_the_string_sounds_it_takes_the_time_of_a_hand() {
    let (open, fretted) = (for_fret(0), for_fret(5));
    // A hammer, and the pull that follows as its key goes up; or plucks.
    let turned = [(0, note(LOW, 40)), (9_600, wheel(LOW, 1.0))];
    let hammered = [(48_000, note(LOW, 45)), (72_000, ends(45))];
    let plucked = [(47_999, ends(40)), (48_000, note(LOW, 45)), (71_999, ends(45)), (72_000, note(LOW, 40))];
    for then in [&hammered[..], &plucked] {
        let all = bends(&[&turned[..], then].concat());
        let [(9_600, first, _), (48_000, second, up), (72_000, third, down)] = all[..] else {
            panic!("{all:?}")
        };
        assert_eq!([first, second, third], [open, fretted, open]);
        assert!(up >= 0.01 && down >= 0.01, "{all:?}");
    }
}

/// A finger that is to strike the string waits until it is up, and somebody may press one down without a key.
#[test]
fn fingers_that_come_otherwise_count_too() {
    let plain = for_fret(5);
    let tapped = [
        (0, control(LOW, 22, 7)),
        (0, note(LOW, 52)),
        (4_800, wheel(LOW, 1.0)),
        (47_999, ends(52)),
        (48_000, note(LOW, 45)),
    ];
    let all = bends(&tapped);
    assert_eq!(all.last().expect("it is bent").1, plain, "{all:?}");

    let touched = |deed| PlayerEvent::Touched { string: LOW, deed };
    let place = GUITAR.strings[usize::from(LOW)].geometry.finger_position(5) as f32;
    let (press, lift) = (StringDeed::Press { position: place }, StringDeed::Lift);
    let turned = [(0, note(LOW, 40)), (4_800, wheel(LOW, 1.0)), (9_600, ends(40))];
    let pressed = [(192_000, touched(press)), (240_000, touched(lift))];
    let all = bends(&[&turned[..], &pressed].concat());
    let ratios: Vec<f64> = all.iter().map(|bend| bend.1).collect();
    assert_eq!(ratios, [for_fret(0), plain, for_fret(0)], "{all:?}");
}

/// Where nothing is bent nothing is done.
#[test]
fn straight_strings_are_not_pulled() {
    let notes = [(0, on(40, 90)), (9_600, off(40)), (96_000, on(52, 90)), (105_600, on(45, 90))];
    let mut player = GUITAR.player(EXACT);
    assert_eq!(found(&play(&mut player, &notes)), []);
}

/// Two semitones by a wheel that is turned between the notes, or stays where it is.
#[test]
fn what_is_heard_is_in_tune() {
    let mut stage = Stage::alone("electric", usize::from(LOW));
    for keys in [[40, 52], [52, 40], [45, 57]] {
        let events =
            [(0.0, on(keys[0], 90)), (0.2, off(keys[0])), (0.3, wheel(0, 1.0)), (2.0, on(keys[1], 90))];
        let sound = &stage.play(&events, 3.4).strings[0];
        let pitch = hertz(f64::from(keys[1]) + 2.0);
        let off = cents(frequency_near(&sound[at(2.5)..], RATE, pitch), pitch);
        assert!(off.abs() < 2.0, "{keys:?}: {off} cents");
    }
}

/// What bends are told to go to, semitones.
#[derive(Default)]
struct Told(Vec<f64>);

impl GestureSink for Told {
    fn gesture(&mut self, _: TimedGesture) {}

    fn annotation(&mut self, told: TimedAnnotation) {
        if let Annotation::Bent { semitones, .. } = told.annotation {
            self.0.push(semitones);
        }
    }
}

/// Two semitones are the most that this string is pulled; on a fret its grid has no room for all of it.
#[test]
fn a_bend_is_told_to_go_as_far_as_it_goes() {
    let mut stage = Stage::alone("steel", usize::from(LOW));
    for fret in [0, 12] {
        let events = [(0.0, on(40 + fret, 90)), (0.3, wheel(0, 1.0))];
        let sound = stage.play(&events, 1.8).strings.remove(0);
        stage.performance.reset();
        let mut told = Told::default();
        for (time, event) in events {
            stage.performance.event((time * RATE) as u64, event, &mut told);
        }
        stage.performance.advance(RATE as u64, &mut told);
        let [semitones] = told.0[..] else { panic!("{:?}", told.0) };
        assert!(if fret == 0 { semitones == 2.0 } else { (1.92..1.97).contains(&semitones) }, "{semitones}");
        let pitch = hertz(f64::from(40 + fret) + semitones);
        let off = cents(frequency_near(&sound[at(0.8)..], RATE, pitch), pitch);
        assert!(off.abs() < 2.5, "fret {fret}, told {semitones}: {off} cents");
    }
}
