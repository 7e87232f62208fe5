//! What the strings were given: every gesture, a flat record for each.

use low_action_dsp::{Gesture, TimedGesture, Touch};
use serde::Serialize;

use super::Clock;

/// A gesture, with the numbers that it has.
#[derive(Debug, Default, Serialize)]
pub(super) struct LabelledGesture {
    /// From 1.
    string: usize,
    sample: u64,
    /// s.
    time: f64,
    gesture: &'static str,
    /// From 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    finger: Option<usize>,
    /// m from the nut.
    #[serde(skip_serializing_if = "Option::is_none")]
    position: Option<f64>,
    /// m.
    #[serde(skip_serializing_if = "Option::is_none")]
    clearance: Option<f64>,
    /// m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    speed: Option<f64>,
    /// N.
    #[serde(skip_serializing_if = "Option::is_none")]
    force: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tension_ratio: Option<f64>,
    /// 1/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    loss: Option<f64>,
    /// s.
    #[serde(skip_serializing_if = "Option::is_none")]
    duration: Option<f64>,
    /// s.
    #[serde(skip_serializing_if = "Option::is_none")]
    release: Option<f64>,
    #[serde(flatten)]
    touch: Option<LabelledTouch>,
}

/// What kind of finger.
#[derive(Debug, Serialize)]
struct LabelledTouch {
    /// kg.
    mass: f64,
    /// N/m^exponent.
    stiffness: f64,
    exponent: f64,
    /// s/m.
    damping: f64,
    /// N s/m.
    hand_damping: f64,
}

/// The gestures that a sound has, in their order.
pub(super) fn gestures(gestures: &[TimedGesture], clock: Clock) -> Vec<LabelledGesture> {
    let heard = gestures.iter().filter(|gesture| clock.has(gesture.time));
    heard.map(|gesture| LabelledGesture::of(gesture, clock)).collect()
}

impl LabelledGesture {
    fn of(&TimedGesture { time, string, gesture }: &TimedGesture, clock: Clock) -> Self {
        let at = Self { string: string + 1, sample: time, time: clock.seconds(time), ..Self::default() };
        let of = |finger: usize| Some(finger + 1);
        match gesture {
            Gesture::Pluck { position, force, duration, release } => Self {
                gesture: "pluck",
                position: Some(position),
                force: Some(force),
                duration: Some(duration),
                release: Some(release),
                ..at
            },
            Gesture::Place { finger, touch, position, clearance } => Self {
                gesture: "place",
                finger: of(finger),
                position: Some(position),
                clearance: Some(clearance),
                touch: Some(touch.into()),
                ..at
            },
            Gesture::Throw { finger, touch, position, clearance, speed } => Self {
                gesture: "throw",
                finger: of(finger),
                position: Some(position),
                clearance: Some(clearance),
                speed: Some(speed),
                touch: Some(touch.into()),
                ..at
            },
            Gesture::Press { finger, force, duration } => Self {
                gesture: "press",
                finger: of(finger),
                force: Some(force),
                duration: Some(duration),
                ..at
            },
            Gesture::Slide { finger, position, duration } => Self {
                gesture: "slide",
                finger: of(finger),
                position: Some(position),
                duration: Some(duration),
                ..at
            },
            Gesture::Lift { finger, force, duration } => Self {
                gesture: "lift",
                finger: of(finger),
                force: Some(force),
                duration: Some(duration),
                ..at
            },
            Gesture::Still { loss, duration } => {
                Self { gesture: "still", loss: Some(loss), duration: Some(duration), ..at }
            }
            Gesture::Bend { tension_ratio, duration } => {
                Self { gesture: "bend", tension_ratio: Some(tension_ratio), duration: Some(duration), ..at }
            }
        }
    }
}

impl From<Touch> for LabelledTouch {
    fn from(Touch { mass, stiffness, exponent, damping, hand_damping }: Touch) -> Self {
        Self { mass, stiffness, exponent, damping, hand_damping }
    }
}
