//! The promise: an instrument whose strings no finger can press down is played with a bar, unless hands are told otherwise. It lies
//! where its notes are in tune, and fingers rest behind it, so that nothing throbs there.

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, Setup, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, RATE, any_left, play, wheel};
use low_action_tests::numbers::{largest, smallest};
use low_action_tests::pitch::off_key;
use low_action_tests::stage::{Stage, amplitude, at, cc, decibels, hertz, level, off, on, peak};

/// Heaviest finger, kg, and a bar with the hand that holds it is heavier.
const FINGER: f64 = 0.05;

/// Masses of what is laid on the strings, kg.
fn laid(gestures: &[TimedGesture]) -> Vec<f64> {
    let mass = |gesture: &TimedGesture| match gesture.gesture {
        Gesture::Place { touch, .. } | Gesture::Throw { touch, .. } => Some(touch.mass),
        _ => None,
    };
    gestures.iter().filter_map(mass).collect()
}

fn stopped_by(instrument: &str, told: &[PlayerEvent]) -> Vec<f64> {
    let mut performance = Neck::of(instrument).player(EXACT);
    let key = PlayerEvent::NoteOn { channel: 0, key: 67, velocity: 0.7 };
    let events: Vec<_> = told.iter().chain([&key]).map(|&event| (0, event)).collect();
    laid(&play(&mut performance, &events))
}

#[test]
fn a_bar_stops_what_fingers_cannot_reach() {
    let stopped = stopped_by("lap-steel", &[]);
    assert!(stopped.iter().any(|&mass| mass > FINGER), "a bar: {stopped:?} kg");
    // As usual again, and as a harmonic.
    let stopped = stopped_by("lap-steel", &[cc(23, 2), cc(23, 0)]);
    assert!(stopped.iter().any(|&mass| mass > FINGER), "a bar again: {stopped:?} kg");
    for way in [1, 2] {
        let stopped = stopped_by("lap-steel", &[cc(23, way)]);
        let by_a_finger = !stopped.is_empty() && stopped.iter().all(|&mass| mass < FINGER);
        assert!(by_a_finger, "CC 23 = {way}: {stopped:?} kg");
    }
    let stopped = stopped_by("electric", &[]);
    assert!(!stopped.is_empty() && stopped.iter().all(|&mass| mass < FINGER), "a finger: {stopped:?} kg");
}

/// Frets that a bar is laid over: those whose notes are as high as any that are played so.
const FRETS: std::ops::RangeInclusive<u8> = 1..=19;

/// Calls somebody for each string of `lap-steel` and of `electric` with CC 23 = 3, with a stage, what the string is, and its open key.
fn on_every_string(each: impl Fn(&mut Stage, &str, u8) + Sync) {
    std::thread::scope(|scope| {
        for setup in ["lap-steel", "electric"] {
            let (each, strings) = (&each, Setup::shipped(setup).expect("it comes with the program").string);
            scope.spawn(move || {
                for (string, spec) in strings.iter().enumerate() {
                    each(&mut Stage::alone(setup, string), &format!("{setup} {string}"), spec.pitch as u8);
                }
            });
        }
    });
}

/// What a bar does on its string for so long, s.
fn barred(stage: &mut Stage, key: u8, seconds: f64) -> Vec<f32> {
    stage.play(&[(0.0, cc(23, 3)), (0.0, on(key, 64))], seconds).strings.remove(0)
}

/// Stiff strings bend round a bar, which gives way, and its weight stretches them: right over the frets they would be up to 10.5 cents
/// sharp. (1.0 at most is found.)
#[test]
fn it_lies_where_its_notes_are_in_tune() {
    on_every_string(|stage, name, open| {
        let off = |fret: u8| off_key(&barred(stage, open + fret, 1.6)[at(0.4)..], f64::from(open + fret));
        let off: Vec<f64> = FRETS.map(off).collect();
        println!("{name}: {off:.1?}");
        assert!(off.iter().all(|off| off.abs() < 1.5), "{name}: {off:.1?} cents");
    });
}

/// By how much a level comes up again after it has fallen, dB.
fn comes_up(levels: impl Iterator<Item = f64>) -> f64 {
    let (mut lowest, mut most) = (f64::INFINITY, 0.0);
    for level in levels {
        lowest = level.min(lowest);
        most = largest([most, level - lowest]);
    }
    most
}

/// What is shut in behind a bar has partials in common with what sounds over frets 12 and 19, and would throb with it: up to 11.7 dB,
/// and 27 dB of the first partial. (0.4 dB at most is found, as long as windows are seen in which low strings have no whole periods,
/// and nothing of the first partial.)
#[test]
fn nothing_throbs_behind_it() {
    on_every_string(|stage, name, open| {
        for fret in [5, 7, 12, 19] {
            let sound = barred(stage, open + fret, 3.0);
            let windows = || sound[at(0.15)..].windows(at(0.05)).step_by(at(0.01));
            let all = comes_up(windows().map(level));
            let pitch = hertz(f64::from(open + fret));
            let first = comes_up(windows().map(|part| decibels(amplitude(part, RATE, pitch))));
            println!("{name}, fret {fret}: {all:.1} dB, the first partial {first:.1} dB");
            assert!(all < 1.0 && first < 1.0, "{name}, fret {fret}: {all:.1} dB, {first:.1} dB");
        }
    });
}

/// A finger rests behind the bar wherever that goes, and neither stays when the note is over or the string sounds open.
#[test]
fn a_finger_rests_behind_it_and_goes_where_it_goes() {
    let vibrato_and_wheel = [(0.2, cc(1, 127)), (0.3, wheel(0, 1.0)), (0.6, wheel(0, -1.0)), (0.7, cc(1, 0))];
    let up_and_down = [(0.0, cc(5, 40)), (0.3, on(74, 90)), (0.8, off(74))];
    for (what, events) in [("wheel and vibrato", &vibrato_and_wheel[..]), ("slides", &up_and_down)] {
        let begun = [(0.0, cc(68, 127)), (0.0, on(67, 90))];
        let mut apart = Vec::new();
        let events = [&begun, events, &[(1.2, off(67))]].concat();
        Stage::alone("lap-steel", 2).watch(&events, 3.5, |time, instrument| {
            let fingers = || instrument.state(0).fingers().iter().flatten();
            let bar = fingers().find(|finger| finger.touch.mass > FINGER).map(|bar| bar.position);
            let behind =
                bar.and_then(|bar| fingers().map(|finger| bar - finger.position).find(|&way| way > 0.0));
            if time < 1.2 {
                apart.push(behind.unwrap_or(f64::INFINITY));
            } else if time > 3.4 {
                assert_eq!(fingers().count(), 0, "{what}");
            }
        });
        // 4 cm, or two fifths of what is left to the nut.
        let (nearest, farthest) = (smallest(apart.iter().copied()), largest(apart));
        assert!(nearest > 0.01 && farthest < 0.0401, "{what}: from {nearest} to {farthest} m behind it");
    }
    // The open string, hammered from and pulled off to, has none, and no other gesture leaves one behind.
    let pulled = [(0, cc(68, 127)), (0, on(55, 90)), (9_600, on(60, 90)), (24_000, off(60))];
    let mut player = Neck::of("lap-steel").player(EXACT);
    let gestures = play(&mut player, &pulled);
    assert!(laid(&gestures).len() >= 2 && !any_left(&gestures), "{gestures:?}");
}

/// Who has a bar has it under harmonics, too: over the octave below, where no string has the key as a partial. (A finger that pressed
/// the string down through 8 mm had 18 of these keys up to 73 cents sharp, and two were dead.)
#[test]
fn harmonics_are_in_tune_over_it() {
    let mut stage = Stage::new(&Setup::shipped("lap-steel").expect("it comes with the program"));
    let mut over_a_bar = 0;
    for key in 50..=93 {
        let played = stage.play(&[(0.0, cc(23, 1)), (0.0, on(key, 90))], 0.8);
        over_a_bar += usize::from(laid(&played.gestures).iter().any(|&mass| mass > FINGER));
        let sound = mixed(&played.strings);
        let (off, heard) = (off_key(&sound[at(0.2)..], f64::from(key)), &sound[at(0.2)..at(0.4)]);
        let loud = decibels(amplitude(heard, RATE, hertz(f64::from(key) + 0.01 * off)));
        println!("{key}: {off:.1} cents, {loud:.1} dBFS");
        // The fifth partial sounds 14 cents under its key.
        assert!((-16.0..8.0).contains(&off), "{key}: {off} cents");
        assert!(loud > -50.0, "{key}: {loud} dBFS");
    }
    assert_eq!(over_a_bar, 26, "keys that are over a bar, and not over an open string");
}

/// What strings sound together.
fn mixed(strings: &[Vec<f32>]) -> Vec<f32> {
    (0..strings[0].len()).map(|n| strings.iter().map(|string| string[n]).sum()).collect()
}

/// Under the hand that ends its note it is down as soon as one under a finger, and so it is over a capo.
#[test]
fn its_notes_end_as_others_do() {
    for (setup, capo) in [("lap-steel", 0), ("electric", 0), ("electric", 3)] {
        for string in [0, 3, 5] {
            let mut stage = Stage::alone(setup, string);
            let open = stage.instrument.geometry(0).open_pitch as u8;
            for fret in [5, 12, 19] {
                let key = open + fret;
                let events = [(0.0, cc(26, capo)), (0.0, cc(23, 3)), (0.0, on(key, 64)), (0.5, off(key))];
                let played = stage.play(&events, 4.5);
                let heard = |from: f64, to: f64| decibels(peak(&played.strings[0][at(from)..at(to)]));
                let down = heard(0.65, 0.7) - heard(0.47, 0.5);
                assert!(down < -40.0, "{setup} {string}, capo {capo}, fret {fret}: {down:.1} dB");
                assert!(heard(2.5, 4.5) < -100.0, "{setup} {string}, capo {capo}, fret {fret} rings on");
                assert!(!any_left(&played.gestures), "{setup} {string}, capo {capo}, fret {fret}");
            }
        }
    }
}

/// One that is going is laid anew: it came down so slowly that the open string sounded first, for 120 ms after a rest of 0.88 s.
#[test]
fn it_lies_there_when_its_note_comes_again() {
    let mut stage = Stage::alone("lap-steel", 3);
    for rest in [0.2, 0.45, 0.6, 0.75, 0.8, 0.88, 0.95, 1.2] {
        let again = 0.3 + rest;
        let events = [(0.0, on(55, 90)), (0.3, off(55)), (again, on(55, 90))];
        let sound = &stage.play(&events, again + 0.5).strings[0];
        let off = [(0.02, 0.12), (0.1, 0.5)]
            .map(|(from, to)| off_key(&sound[at(again + from)..at(again + to)], 55.0));
        assert!(off.iter().all(|off| off.abs() < 4.0), "{rest} s: {off:?} cents");
    }
}

/// It would have to press strings down that lie millimetres above their frets: they would be a third of a semitone sharp.
#[test]
fn no_capo_is_laid_there() {
    let (steel, guitar) = (Neck::of("lap-steel"), Neck::of("electric"));
    let notes = [62, 69, 50].map(|key| (0, on(key, 90)));
    let with_capo = [&[(0, cc(26, 5))][..], &notes].concat();
    assert_eq!(play(&mut steel.player(EXACT), &with_capo), play(&mut steel.player(EXACT), &notes));
    // Another instrument that takes over has it where it was asked for, whether strings go on or not.
    let capo = |gesture: &TimedGesture| matches!(gesture.gesture, Gesture::Place { finger: 5, .. });
    for go_on in [false, true] {
        let mut first = steel.player(EXACT);
        first.event(0, cc(26, 5), &mut Vec::new());
        let mut next = guitar.player(EXACT);
        next.take_over(&first, go_on);
        let gestures = play(&mut next, &[(10, on(64, 90))]);
        assert!(gestures.iter().any(capo), "strings go on: {go_on}");
        let mut announced = guitar.player(EXACT);
        announced.announce(&first.announced());
        assert!(play(&mut announced, &[(0, on(64, 90))]).iter().any(capo));
    }
}
