//! The promise: a wheel that slides a finger hurries it no more than a note does, however far and fast it is turned, at once or in a
//! hundred steps a second. The finger is soon where the wheel has it, and comes home fret by fret.

use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, StringGeometry};
use low_action_tests::hands::Neck;
use low_action_tests::numbers::largest;
use low_action_tests::stage::{LOOK, Stage, at, decibels, octave, on, peak, wheel};

const RATE: f64 = 48_000.0;
/// Times between its messages, s: as keyboards send them, and as tracks of a host do.
const DENSE: f64 = 0.005;
/// The fastest slide, m/s, and what rounding to samples makes of it.
const FASTEST: f64 = 1.001;

/// A note under a wheel that goes from place to place (semitones) from 0.5 s on, in such a time each (s; 0 at once).
fn turned(key: u8, velocity: u8, places: &[(f64, f64)]) -> Vec<(f64, PlayerEvent)> {
    let announced = octave();
    let mut events = [&announced[..], &[(0.0, on(key, velocity))]].concat();
    let (mut from, mut time) = (0.0, 0.5);
    for &(to, duration) in places {
        let steps = (duration / DENSE).round().max(1.0);
        for step in 1..=steps as u32 {
            let part = f64::from(step) / steps;
            events.push((time + duration * part, wheel(from + (to - from) * part)));
        }
        (from, time) = (to, time + duration);
    }
    events
}

/// Where the finger that stops a string is after each look, m from the nut.
fn places(stage: &mut Stage, events: &[(f64, PlayerEvent)], seconds: f64) -> Vec<f64> {
    let mut places = Vec::new();
    stage.watch(events, seconds, |_, instrument| {
        let fretting = instrument.state(0).fingers().iter().take(2).flatten().next();
        places.push(fretting.map_or(0.0, |finger| finger.position));
    });
    places
}

fn geometry(setup: &str, string: usize) -> StringGeometry {
    Neck::of(setup).strings[string].geometry.clone()
}

/// Ways of a wheel, and where it has a finger in the end, frets from that of the note.
const WAYS: [(&[(f64, f64)], usize); 6] = [
    (&[(12.0, 0.0)], 12),
    (&[(12.0, 0.1)], 12),
    (&[(7.0, 0.03)], 7),
    (&[(12.0, 0.05), (0.0, 0.05), (9.0, 0.1)], 9),
    (&[(10.0, 0.2), (5.0, 0.0), (10.0, 0.0), (5.0, 0.1)], 5),
    (&[(8.0, 0.02), (4.0, 0.02), (8.0, 0.02), (4.0, 0.02), (8.0, 0.02), (4.0, 0.02)], 4),
];

/// (At 10 ms a semitone it went over the first frets at 3 m/s.)
#[test]
fn a_finger_slid_by_a_wheel_goes_as_fast_as_hands_do_and_is_soon_there() {
    for (setup, string, open, fret) in [("electric", 2, 55, 2), ("bass", 2, 33, 3), ("classical", 0, 64, 1)] {
        let neck = geometry(setup, string);
        let mut stage = Stage::alone(setup, string);
        for (way, frets) in WAYS {
            let turns: f64 = way.iter().map(|&(_, duration)| duration).sum();
            let places = places(&mut stage, &turned(open + fret, 90, way), 1.5);
            let speeds = places[at(0.45) / LOOK as usize..].windows(2);
            let fastest = largest(speeds.map(|two| (two[1] - two[0]).abs() * RATE / LOOK as f64));
            let end = neck.finger_position(usize::from(fret) + frets);
            let longest = end - neck.finger_position(usize::from(fret));
            let off = |time: f64| (places[at(time) / LOOK as usize] - end).abs();
            println!("{setup} {string}, {way:?}: {fastest:.2} m/s, {:.4} m off at last", off(1.49));
            assert!(fastest < FASTEST, "{setup} {string}, {way:?}: at {fastest} m/s");
            // From where it has gone meanwhile, at most as far as all the way: nothing is owed for turns that are over.
            let due = 0.5 + turns + longest / FASTEST + 0.02;
            assert!(off(due) < 1e-4, "{setup} {string}, {way:?}: {} m off at {due} s", off(due));
        }
    }
}

/// As much louder than its note as one that slides from note to note. (It was up to 17 dB louder than notes of velocity 30.)
#[test]
fn it_is_about_as_loud_as_the_note() {
    for (setup, string, open, fret) in [
        ("electric", 2, 55, 2),
        ("electric", 4, 45, 2),
        ("bass", 2, 33, 3),
        ("classical", 2, 55, 2),
        ("flamenco", 2, 55, 2),
    ] {
        let mut stage = Stage::alone(setup, string);
        for way in [
            &[(12.0, 0.0)][..],
            &[(12.0, 0.1)],
            &[(5.0, 0.1)],
            &[(7.0, 0.42)],
            &[(-2.0, 0.1)],
            &[(7.0, 0.05), (0.0, 0.05)],
        ] {
            for (velocity, most) in [(30, 8.0), (64, 7.0), (100, 4.0)] {
                let sound = &stage.play(&turned(open + fret, velocity, way), 1.4).strings[0];
                let louder = decibels(peak(&sound[at(0.5)..]) / peak(&sound[..at(0.4)]));
                println!("{setup} {string}, {way:?}, velocity {velocity}: {louder:.1} dB");
                assert!(louder < most, "{setup} {string}, {way:?}, velocity {velocity}: {louder} dB louder");
            }
        }
    }
}

/// Under a wheel that goes back slowly, also where pulling alone would reach as far. (It went home over three frets at once as soon
/// as pulling reached as far, which is heard as two semitones beside the wheel for a moment.)
#[test]
fn a_finger_comes_home_fret_by_fret() {
    for (setup, string, key, top) in [("electric", 1, 60, 5.0), ("steel", 1, 60, 3.0), ("bass", 2, 36, 6.0)] {
        let neck = geometry(setup, string);
        let events = turned(key, 90, &[(top, 1.0), (0.0, 1.0)]);
        let played = Stage::alone(setup, string).play(&events, 2.8);
        let home = played.gestures.iter().rev().filter(|timed| timed.time > at(1.5) as u64);
        let mut slides: Vec<f64> = home
            .filter_map(|timed| match timed.gesture {
                Gesture::Slide { position, .. } => Some(position),
                _ => None,
            })
            .collect();
        slides.reverse();
        let fret = |position: f64| neck.frets.partition_point(|crown| *crown < position) + 1;
        let frets: Vec<usize> = slides.into_iter().map(fret).collect();
        println!("{setup}: {frets:?}");
        assert!(frets.len() >= 3, "{setup}: {frets:?}");
        assert!(frets.windows(2).all(|two| two[0] == two[1] + 1), "{setup}: {frets:?}");
    }
}
