//! How the player moves: the constants of playing that no set-up changes.

use low_action_dsp::FingerSlot;

/// Slots the fretting fingers take in turn. A new finger lands in the next one while the last is
/// still being lifted, and the one before that has long gone.
pub(crate) const FRETTING_SLOTS: usize = 3;
/// Slot of the finger or palm that damps.
pub(crate) const DAMPER_SLOT: FingerSlot = 3;

/// How force follows velocity: amplitude as its square, the response General MIDI level 2
/// recommends (40 log₁₀ of velocity over its maximum, in dB).
pub(crate) const VELOCITY_EXPONENT: i32 = 2;
/// Softest pluck, as a part of the hardest, so that velocity 1 is a touch and not nothing.
pub(crate) const SOFTEST: f64 = 0.002;
/// Farthest from the saddle a pluck may be, as a part of the sounding length: past the middle it
/// sounds the same mirrored, and the hands would meet.
pub(crate) const FARTHEST_PLUCK: f64 = 0.45;
/// Nearest to the saddle a pluck may be, m: a fingertip's half width.
pub(crate) const NEAREST_PLUCK: f64 = 0.006;
/// Shortest note, s from pluck to damping. It ends the push of any pluck and lets a note of no
/// length at all be heard as a staccato.
pub(crate) const SHORTEST_NOTE: f64 = 0.03;

/// Force that pulls a finger off, as a part of the force that pressed it.
pub(crate) const LIFT_FORCE: f64 = 0.5;
/// Time in which a finger's force turns from pressing to lifting, s, when the next note hides it.
pub(crate) const QUICK_LIFT: f64 = 0.002;
/// The same when nothing hides it, s: many periods of any string, so that the string follows
/// quietly instead of being plucked by the departing finger.
pub(crate) const GENTLE_LIFT: f64 = 0.12;
/// How long the damper rests before the fretting finger goes, s: 40 dB take at most 0.15 s.
pub(crate) const UNFRET_AFTER: f64 = 0.18;
/// How long the damper rests in all, s: until the departing finger has stopped sounding too.
pub(crate) const UNDAMP_AFTER: f64 = 0.45;

/// Fastest change of pitch by tension, semitones a second; strong fingers bend a tone in 20 ms.
pub(crate) const BEND_SPEED: f64 = 100.0;
/// Shortest ramp of a bend, s: longer than the steps of most wheels, so that they do not show.
pub(crate) const BEND_RAMP: f64 = 0.012;
/// Least time between two changes of a bend's goal, s.
pub(crate) const BEND_INTERVAL: f64 = 0.003;
