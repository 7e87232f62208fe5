//! The hand that plucks: strokes of every kind, the palm, the thumb.

use low_action_dsp::Touch;

/// How a stroke differs from the usual one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Striking {
    /// Its force as a multiple; below 0 it goes towards the board.
    pub force: f64,
    /// How long it pushes, as a multiple.
    pub duration: f64,
    /// How much nearer to the saddle it is, m.
    pub nearer: f64,
}

/// The usual stroke itself.
pub(crate) const DOWN_STROKE: Striking = Striking { force: 1.0, duration: 1.0, nearer: 0.0 };
/// A stroke back: less of the plectrum is under the string.
pub(crate) const UP_STROKE: Striking = Striking { force: 0.85, duration: 0.8, nearer: 0.004 };
/// A rest stroke: towards the board, with the flesh.
pub(crate) const REST_STROKE: Striking = Striking { force: -0.8, duration: 1.5, nearer: 0.0 };
/// A pop: three times as hard as a pluck.
pub(crate) const POP: Striking = Striking { force: 3.0, duration: 1.0, nearer: 0.0 };

/// How far the palm reaches from the saddle at the least and at full pressure, as a part of the length: 2 to
/// 6 cm on guitars, and no farther than this part of the way to the pluck.
pub(crate) const PALM_PLACE: (f64, f64) = (0.03, 0.09);
pub(crate) const PALM_BEFORE_PLUCK: f64 = 0.7;
/// Force of the palm then, as multiples of a match with the string. A damper R at a part x of the length takes
/// most out of the fundamental where R is a π-th of 1/x wave impedances: 3.5 of them, 1.8 matches, at the
/// farthest place.
pub(crate) const PALM_FORCE: (f64, f64) = (0.25, 2.0);
/// How fast the palm's force is there at a stroke, and how fast it follows its controller, s.
pub(crate) const PALM_LANDING: f64 = 0.001;
pub(crate) const PALM_RAMP: f64 = 0.03;
/// Strokes so many times as hard as the palm presses drown one that falls on the string as fast as is best.
pub(crate) const FALLING_PALM: f64 = 3.0;
/// How long it waits on a silent string for the next note, s: a bar of slow music. A string under it is computed.
pub(crate) const PALM_WAITS: f64 = 2.0;

/// The joint of a thumb, bone under thin flesh.
pub(crate) const THUMB: Touch =
    Touch { mass: 0.012, stiffness: 3e6, exponent: 1.8, damping: 0.2, hand_damping: 0.5 };
/// How fast it comes, m/s: at the softest, and added at the hardest.
pub(crate) const SLAP_SPEED: (f64, f64) = (0.05, 1.6);
/// From how high, m.
pub(crate) const SLAP_CLEARANCE: f64 = 5e-4;
/// What presses it at the hardest while it is on the string, N, what lifts it, N, and when, s.
pub(crate) const SLAP_FORCE: f64 = 2.0;
pub(crate) const SLAP_BOUNCE: f64 = 12.0;
pub(crate) const SLAP_TIME: f64 = 0.005;
/// How soon after that it is off the string, s, so that the palm can come back.
pub(crate) const SLAP_CLEAR: f64 = 0.005;
/// How far past the last fret it falls, as a part of the length.
pub(crate) const PAST_LAST_FRET: f64 = 0.012;

/// Lowest and highest partial that a thumb beside the plectrum lets through.
pub(crate) const PINCHED: (f64, f64) = (3.0, 9.0);
/// How firmly it grazes, as a multiple of a match with the string, and how long, s.
pub(crate) const GRAZE: f64 = 1.0;
pub(crate) const GRAZE_TIME: f64 = 0.04;
/// Where the plectrum is then, as a part of the way from the saddle to the thumb.
pub(crate) const BESIDE_THUMB: f64 = 0.75;
