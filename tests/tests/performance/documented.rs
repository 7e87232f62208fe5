//! The promise: hands do what `docs/gestures.md` says, in its numbers.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::setup::tension_ratio;
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{EXACT, Neck, RATE, play};
use low_action_tests::numbers::largest;
use low_action_tests::stage::{cc, off, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));

/// What hands do who never do anything twice in different ways.
fn gestures(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    play(&mut GUITAR.player(EXACT), events)
}

/// Place from the saddle (m), force (N) and duration (s) of the one pluck of the open E4 under a controller.
fn pluck(controller: u8, value: u8) -> [f64; 3] {
    let gestures = gestures(&[(0, cc(controller, value)), (0, on(64, 80))]);
    let plucks: Vec<_> = gestures
        .iter()
        .filter_map(|timed| match timed.gesture {
            Gesture::Pluck { position, force, duration, .. } => Some([position, force, duration]),
            _ => None,
        })
        .collect();
    let [[position, force, duration]] = plucks[..] else { panic!("{gestures:?}") };
    [GUITAR.strings[0].geometry.length - position, force, duration]
}

/// The one throw of a note at the hardest or the softest: time (samples), finger, mass (kg), place (m) and speed (m/s).
fn throw(stroke: u8, key: u8, velocity: u8) -> (u64, usize, f64, f64, f64) {
    let gestures = gestures(&[(0, cc(22, stroke)), (0, on(key, velocity))]);
    assert!(gestures.iter().all(|timed| !matches!(timed.gesture, Gesture::Pluck { .. })), "{gestures:?}");
    let throws: Vec<_> = gestures
        .iter()
        .filter_map(|timed| match timed.gesture {
            Gesture::Throw { finger, touch, position, speed, .. } => {
                Some((timed.time, finger, touch.mass, position, speed))
            }
            _ => None,
        })
        .collect();
    let [throw] = throws[..] else { panic!("{gestures:?}") };
    throw
}

/// Velocities and controllers are single numbers, 6e-8 of them off.
fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-6 * expected.abs()
}

#[test]
fn strokes_differ_from_a_pluck_by_their_factors() {
    let plain = pluck(22, 0);
    // Force, duration, and how much nearer to the saddle, m.
    for (stroke, [force, duration, nearer]) in
        [(1, [0.85, 0.8, 0.004]), (3, [-0.8, 1.5, 0.0]), (5, [3.0, 1.0, 0.0])]
    {
        let found = pluck(22, stroke);
        assert!(near(found[0], plain[0] - nearer), "stroke {stroke}: {} m", found[0]);
        assert!(near(found[1], force * plain[1]), "stroke {stroke}: {} N of {}", found[1], plain[1]);
        assert!(near(found[2], duration * plain[2]), "stroke {stroke}: {} s of {}", found[2], plain[2]);
    }
    let player = &GUITAR.setup.player;
    assert!(near(plain[0], player.pluck_position) && near(plain[2], player.pluck_duration));
    assert!(near(plain[1], player.pluck_force * (80.0_f64 / 127.0).powf(1.5)));
}

#[test]
fn brightness_moves_the_pluck_by_80_millimetres() {
    let usual = GUITAR.setup.player.pluck_position;
    // 64 is the middle, and as far from 0 as from 128, which there is not.
    for value in [0, 30, 64, 127] {
        let (found, expected) = (pluck(74, value)[0], usual - 0.08 * (f64::from(value) - 64.0) / 64.0);
        assert!(near(found, expected), "{value}: {found} m instead of {expected} m");
    }
}

#[test]
fn a_thumb_of_12_grams_is_thrown_past_the_last_fret() {
    let (time, finger, mass, place, speed) = throw(4, 64, 127);
    let last = *GUITAR.strings[0].geometry.frets.last().expect("it has frets");
    assert!(mass == 0.012 && near(speed, 1.65) && place > last, "{mass} kg, {speed} m/s, {place} m");
    assert!((0.05..0.06).contains(&throw(4, 64, 1).4));
    // It bounces off after 5 ms.
    let gestures = gestures(&[(0, cc(22, 4)), (0, on(64, 127))]);
    let lift =
        |timed: &&TimedGesture| matches!(timed.gesture, Gesture::Lift { finger: f, .. } if f == finger);
    let lifted = gestures.iter().find(lift).expect("it leaves").time - time;
    assert_eq!(lifted, (0.005 * RATE) as u64);
}

/// Fast enough for its first partial to be 1.35 times as large as that of a pluck, and 0.1 m/s more, if it could be as fast as that. The
/// softest takes several periods and is brought to its speed by the force of the hand, which brakes it.
#[test]
fn a_tap_comes_as_fast_as_it_is_to_be_loud() {
    // On the lowest string, where its way takes so small a part of a period that it gathers nothing.
    let (_, finger, _, place, hard) = throw(7, 42, 127);
    let (string, player) = (&GUITAR.strings[5], &GUITAR.setup.player);
    let part = player.pluck_position / (string.geometry.length - place);
    let asked =
        1.35 * player.pluck_force * (std::f64::consts::PI * part).sin() / string.geometry.wave_impedance;
    assert!(near(hard, 0.1 + asked / (1.0 + asked / 2.7)), "{hard} m/s");
    let gestures = gestures(&[(0, cc(22, 7)), (0, on(69, 1))]);
    let braked = gestures.iter().find_map(|timed| match timed.gesture {
        Gesture::Throw { finger: f, touch, .. } if f == finger => Some(touch.hand_damping),
        _ => None,
    });
    let presses = gestures.iter().filter_map(|timed| match timed.gesture {
        Gesture::Press { finger: f, force, .. } if f == finger => Some(force),
        _ => None,
    });
    let forces: Vec<f64> = presses.collect();
    let [first, last] = forces[..] else { panic!("{gestures:?}") };
    let soft = last / braked.expect("it is thrown");
    assert!((0.105..0.115).contains(&soft) && near(first, 0.2 * last), "{soft} m/s, {forces:?} N");
}

/// Wherever the plectrum is meanwhile.
#[test]
fn a_tap_is_as_fast_beside_the_saddle() {
    let speed = |moved: f64| {
        let mut touching = Touching::new(0.0, 2.0);
        touching.pluck_position = moved;
        let events = [(0, cc(22, 7)), (0, on(66, 80))];
        let gestures = GUITAR.told(InputMode::Keyboard, &touching, &events);
        gestures.iter().find_map(|timed| match timed.gesture {
            Gesture::Throw { speed, .. } => Some(speed),
            _ => None,
        })
    };
    assert_eq!(speed(-0.1), speed(0.0));
}

#[test]
fn pitch_changes_by_100_semitones_a_second_at_most() {
    let bends = |gestures: &[TimedGesture]| -> Vec<f64> {
        let duration = |timed: &TimedGesture| match timed.gesture {
            Gesture::Bend { duration, .. } => Some(duration),
            _ => None,
        };
        gestures.iter().filter_map(duration).collect()
    };
    let wheel = |time, value| (time, PlayerEvent::PitchBend { channel: 0, value });
    // Down by 2 semitones, then up by 4.
    let turned = bends(&gestures(&[(0, on(64, 80)), wheel(4800, -1.0), wheel(9600, 1.0)]));
    assert!(matches!(turned[..], [down, up] if near(down, 0.02) && near(up, 0.04)), "{turned:?} s");
    // The arm, by 12 on the string that sounds.
    let mut player = GUITAR.player(EXACT);
    play(&mut player, &[(0, on(64, 80))]);
    let mut done = Vec::new();
    player.touch(192_000, &Touching { tremolo_arm: -12.0, ..Touching::new(0.0, 2.0) }, &mut done);
    player.advance(196_800, &mut done);
    done.retain(|timed| timed.string == 0);
    let armed = bends(&done);
    assert!(matches!(armed[..], [down] if near(down, 0.12)), "{armed:?} s");
}

#[test]
fn a_vibrato_swings_at_5_5_hertz_by_half_a_semitone() {
    let events = [(0, cc(1, 127)), (0, on(64, 80)), (2 * RATE as u64, off(64))];
    let pulls: Vec<(f64, f64)> = gestures(&events)
        .iter()
        .filter_map(|timed| match timed.gesture {
            Gesture::Bend { tension_ratio, .. } => Some((timed.time as f64 / RATE, tension_ratio)),
            _ => None,
        })
        .collect();
    // Where it passes the straight string upwards, between two goals.
    let passes: Vec<f64> = pulls
        .windows(2)
        .filter(|pair| pair[0].1 <= 1.0 && pair[1].1 > 1.0)
        .map(|pair| {
            let part = (1.0 - pair[0].1) / (pair[1].1 - pair[0].1);
            pair[0].0 + part * (pair[1].0 - pair[0].0)
        })
        .filter(|&time| time < 2.0)
        .collect();
    assert!(passes.len() >= 10, "it swings {} times in two seconds", passes.len());
    let turns = passes.len() as f64 - 1.0;
    let rate = turns / (passes[passes.len() - 1] - passes[0]);
    // Straight lines through fifteen goals a turn are within 1 % of a turn of where the sine passes.
    assert!((rate / 5.5 - 1.0).abs() < 0.02 / turns, "{rate} Hz over {turns} turns");
    // The nearest of fifteen goals is within 12 degrees of the peak, whose cosine is 0.978.
    let farthest = largest(pulls.iter().map(|pull| pull.1));
    let [least, most] = [0.978, 1.0].map(|part| tension_ratio(0.5 * part));
    assert!((least..=most + 1e-12).contains(&farthest), "{farthest} is not between {least} and {most}");
}

#[test]
fn pressure_makes_a_finger_press_up_to_2_5_times_as_hard() {
    let pressure = PlayerEvent::ChannelPressure { channel: 0, pressure: 1.0 };
    let gestures = gestures(&[(0, on(69, 80)), (9600, pressure)]);
    let forces: Vec<f64> = gestures
        .iter()
        .filter_map(|timed| match timed.gesture {
            Gesture::Press { force, .. } => Some(force),
            _ => None,
        })
        .collect();
    let [usual, pressed] = forces[..] else { panic!("{gestures:?}") };
    assert!(near(pressed, 2.5 * usual), "{usual} N and {pressed} N");
}
