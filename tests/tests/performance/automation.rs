//! The promise: hands follow what is automated, however dense it is. A finger's force and a palm are on their way all the time, not
//! when it stops; they are told so in no more goals than they need, and the last one is not lost.

use std::sync::LazyLock;

use low_action::controls::Touching;
use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::{Gesture, TimedGesture};
use low_action_tests::hands::{Neck, RATE, of_string};
use low_action_tests::stage::{cc, on};

static GUITAR: LazyLock<Neck> = LazyLock::new(|| Neck::of("electric"));
/// The slot of the palm.
const PALM: usize = 4;

/// What a finger presses with, N, at every sample of the first second, on one string.
fn forces(gestures: &[TimedGesture], slot: usize) -> Vec<f64> {
    let (mut force, mut goal, mut since, mut length) = (0.0, 0.0, 0, 0.0);
    let mut pressed = gestures
        .iter()
        .filter_map(|timed| match timed.gesture {
            Gesture::Press { finger, force, duration } if finger == slot => {
                Some((timed.time, force, duration))
            }
            _ => None,
        })
        .peekable();
    let mut forces = Vec::new();
    for time in 0..RATE as u64 {
        let part = |length: f64| if length > 0.0 { ((time - since) as f64 / length).min(1.0) } else { 1.0 };
        let x = part(length);
        let mut now = force + (goal - force) * x * x * (3.0 - 2.0 * x);
        while let Some((_, to, duration)) = pressed.next_if(|press| press.0 <= time) {
            (force, goal, since, length) = (now, to, time, duration * RATE);
            if length <= 0.0 {
                now = to;
            }
        }
        forces.push(now);
    }
    forces
}

/// What is done in the first second to the string that is plucked.
fn told(events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    let gestures = GUITAR.told(InputMode::Keyboard, &Touching::new(0.0, 2.0), events);
    let pluck = |timed: &&TimedGesture| matches!(timed.gesture, Gesture::Pluck { .. });
    let string = gestures.iter().find(pluck).expect("a note is played").string;
    let mut gestures = of_string(&gestures, string);
    gestures.retain(|timed| timed.time < RATE as u64);
    gestures
}

fn presses(gestures: &[TimedGesture], slot: usize) -> usize {
    let own = |g: &&TimedGesture| matches!(g.gesture, Gesture::Press { finger, .. } if finger == slot);
    gestures.iter().filter(own).count()
}

/// A swell of so many samples from 0.2 s on, one message each.
const SWELL: u64 = 24_000;

#[test]
fn a_fingers_force_follows_a_pressure_that_moves_at_every_sample() {
    let note = (0, on(62, 90));
    let pressure = |part: f32| PlayerEvent::ChannelPressure { channel: 0, pressure: part };
    let swell: Vec<_> = (0..=SWELL).map(|n| (9_600 + n, pressure(n as f32 / SWELL as f32))).collect();
    let slot = 0;
    let (still, firm) = (told(&[note]), told(&[note, (9_600, pressure(1.0))]));
    let [least, most] = [still, firm].map(|gestures| *forces(&gestures, slot).last().expect("a second"));
    assert!(most > 1.5 * least);
    let gestures = told(&[&[note][..], &swell].concat());
    let forces = forces(&gestures, slot);
    for (n, force) in forces[9_600..9_600 + SWELL as usize].iter().enumerate() {
        let asked = |n: f64| least + (most - least) * (n / SWELL as f64).clamp(0.0, 1.0);
        // No more than 40 ms behind.
        let [late, early] = [asked(n as f64 - 0.04 * RATE), asked(n as f64)];
        assert!((late - 1e-6..early + 1e-6).contains(force), "{n} samples: {force} N, {late} to {early}");
    }
    assert!((forces.last().expect("a second") / most - 1.0).abs() < 1e-9, "the last one is lost");
    assert!(presses(&gestures, slot) < SWELL as usize / 140, "{} goals", presses(&gestures, slot));
}

#[test]
fn a_palm_follows_a_controller_that_moves_all_the_time() {
    // Of 127 steps, in 0.2 s.
    let told_at_once = |value: u8| told(&[(0, cc(20, 1)), (0, on(62, 90)), (9_600, cc(20, value))]);
    let steps: Vec<_> = (1..=127).map(|value| (9_600 + 76 * u64::from(value), cc(20, value))).collect();
    let gestures = told(&[&[(0, cc(20, 1)), (0, on(62, 90))][..], &steps].concat());
    let found = forces(&gestures, PALM);
    let [half, all] = [64, 127].map(|value| *forces(&told_at_once(value), PALM).last().expect("a second"));
    let end = 9_600 + 76 * 127;
    assert!(half > 1.2 * found[9_600] && found[end] > half, "{} N of {half} and {all}", found[end]);
    assert_eq!(*found.last().expect("a second"), all, "the last one is lost");
    assert!(presses(&gestures, PALM) < 60, "{} goals", presses(&gestures, PALM));
}
