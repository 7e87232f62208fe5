//! How the player moves: the constants of playing that no set-up changes.

use low_action_dsp::FingerSlot;

/// Slots the fretting fingers take in turn: a new finger lands in one while the last is being lifted
/// from the other, and the free one damps behind the finger when the note ends.
pub(crate) const FRETTING_SLOTS: usize = 2;
/// Slots of the edge of the hand that damps, and how far from the saddle each part of it rests, as
/// part of the set-up's damper position. One point alone would leave the partials ringing that have
/// a node there; a hand is wide, and a partial with nodes at both places is high and dies by itself.
pub(crate) const DAMPERS: [(FingerSlot, f64); 2] = [(2, 1.0), (3, 0.37)];
/// Where another damper rests behind a fretting finger, as a part of the way from the nut: what rings
/// there is hardly heard until the finger leaves and lets it out.
pub(crate) const BEHIND_FINGER: f64 = 0.62;
/// Nearest to the nut that one rests, m; shorter ends ring far above what is heard.
pub(crate) const NEAREST_NUT: f64 = 0.04;
/// Farthest from the saddle a damper rests, as a part of the sounding length.
pub(crate) const FARTHEST_DAMPER: f64 = 0.6;

/// How force follows velocity: its power of 1.5, so that velocity 64 is 9 dB and 32 is 18 dB below
/// the hardest. The square that General MIDI level 2 recommends for synthesizers would put soft notes
/// below the sound of the finger that stops them.
pub const VELOCITY_CURVE: f64 = 1.5;
/// Farthest from the saddle a pluck may be, as a part of the sounding length: past the middle it
/// sounds the same mirrored, and the hands would meet.
pub(crate) const FARTHEST_PLUCK: f64 = 0.45;
/// Nearest to the saddle a pluck may be, m: a fingertip's half width.
pub(crate) const NEAREST_PLUCK: f64 = 0.006;
/// Shortest note, s from pluck to damping. It ends the push of any pluck and lets a note of no
/// length at all be heard as a staccato.
pub(crate) const SHORTEST_NOTE: f64 = 0.03;

/// How a finger leaves a string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Leaving {
    /// Speed it reaches, m/s.
    pub speed: f64,
    /// Time in which its force turns from pressing to lifting, s.
    pub turning: f64,
}

/// How it leaves when the next note is about to sound: 1 mm away after 3 ms.
pub(crate) const QUICK_LIFT: Leaving = Leaving { speed: 0.5, turning: 0.001 };
/// How fast fingers are when they play loud: the hand damps the finger that stops the hardest note
/// this many times less, and one, than the softest. Setting a string down within 10 ms is a hammer-on,
/// which a loud pluck covers and a soft one does not; setting it down slowly lets the open string be
/// heard before the stopped one.
pub(crate) const HASTE: f64 = 5.0;
/// How long the dampers rest before the fretting finger begins to leave, s, while it relaxes: 40 dB
/// take 0.15 s, and a hand that relaxes as fast as that is itself heard through a bridge.
pub(crate) const RELAXING: f64 = 0.4;
/// What a fretting finger goes on pressing with when a note has ended, as a multiple of the force at
/// which the string would leave the fret.
pub(crate) const HOLDING: f64 = 1.25;
/// How it leaves then: so slowly that the string rises from the fret without a sound.
pub(crate) const FINGER_EASING: Leaving = Leaving { speed: 0.005, turning: 0.5 };
/// How the dampers leave after it; they bend the string much less.
pub(crate) const DAMPER_EASING: Leaving = Leaving { speed: 0.01, turning: 0.2 };

/// Fastest change of pitch by tension, semitones a second; strong fingers bend a tone in 20 ms.
pub(crate) const BEND_SPEED: f64 = 100.0;
/// Shortest ramp of a bend, s: longer than the steps of most wheels, so that they do not show.
pub(crate) const BEND_RAMP: f64 = 0.012;
/// Least time between two changes of a bend's goal, s.
pub(crate) const BEND_INTERVAL: f64 = 0.003;
/// How fast a finger's force follows the pressure on a key, s.
pub(crate) const PRESSURE_RAMP: f64 = 0.012;
/// A vibrato of the fretting hand: turns a second, and how far it goes at its deepest, semitones. Guitarists
/// keep to 4 to 7 Hz and a quarter to half a semitone.
pub(crate) const VIBRATO: (f64, f64) = (5.5, 0.5);
/// Time between two goals of a vibrato, s: fifteen to a turn.
pub(crate) const VIBRATO_STEP: f64 = 0.012;
/// How many times its usual force a finger presses at full pressure.
pub(crate) const FIRMEST: f64 = 2.5;
/// How far brightness moves the pluck from its usual place, m: towards the saddle at full, away at none.
pub(crate) const BRIGHTNESS_REACH: f64 = 0.08;
