//! How fingers land on a string and leave it.

/// How a finger leaves a string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Leaving {
    /// Speed it reaches, m/s.
    pub speed: f64,
    /// Time in which its force turns from pressing to lifting, s.
    pub turning: f64,
}

/// How it leaves when the next note is about to sound, at the hardest: 1 mm away after 3 ms.
pub(crate) const QUICK_LIFT: Leaving = Leaving { speed: 0.5, turning: 0.001 };
/// How far the finger of the softest note lets the string rise in one of its periods, in which its force turns, m: what takes
/// a period the string hardly answers. The harder a note, the quicker the finger before it goes.
pub(crate) const RISE: f64 = 0.001;
/// How much faster a finger is in haste: its hand brakes it this many times less, and one. Setting a string down slowly lets
/// what is plucked meanwhile leak past the finger: held that lightly at fret 12, up to 9 dB of it in 20 ms.
pub(crate) const HASTE: f64 = 9.0;
/// Time in which a finger that is in no hurry has set its string down, s: over the 1 mm of most frets at 0.04 m/s.
pub(crate) const SETTLING: f64 = 0.03;
/// How much more slowly a finger lands for a soft note, whose pluck its landing would drown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SoftLanding {
    /// For notes as hard as this it lands as fast as it can (velocity 45), for softer ones more slowly by the square.
    pub from: f64,
    /// How many times more slowly at most: in more time most of what was plucked would leak past it at fret 12.
    pub most: f64,
    /// Notes softer than this (velocity 23) would be drowned even so, and have a finger that is slower, whatever leaks.
    pub drowned: f64,
    /// The slowest of all, as a multiple of what the hand's own damping gives.
    pub slowest: f64,
}

/// The usual. (Fitted to landings on seven frets of sixteen strings of nine instruments.)
pub(crate) const SOFT_LANDING: SoftLanding =
    SoftLanding { from: 0.21, most: 1.6, drowned: 0.077, slowest: 2.0 };
/// How a finger comes down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coming {
    /// Strength of the note that it comes for, 0 to 1.
    pub strength: f64,
    /// In what haste it is, 0 (none) to 1.
    pub haste: f64,
    /// From when to when a hand stills the string, s from now.
    pub stilled: Option<[f64; 2]>,
    /// Whether it is to have the string down under that hand, ahead of the stroke.
    pub ahead: bool,
}

/// As fast as it can.
pub(crate) const AT_ONCE: Coming = Coming { strength: 1.0, haste: 1.0, stilled: None, ahead: false };
/// By how much a finger is to be slower than the way to the fret asks for: the string hardly moves before the finger's pad has been
/// pressed in. Fitted: from 1.08 to 1.17 would be best on frets 3 to 12 of seven strings of four instruments.
pub(crate) const LANDING_LAG: f64 = 1.13;
/// How long before a hand that stills the string goes a finger comes at most, as a part of the period, however long it then takes to move
/// the string: on high frets of short strings soft notes lose level if it comes sooner.
pub(crate) const MET_BEFORE: f64 = 0.2;
/// How much later than by what its hand asks for a finger in haste has a string down that another hand stills, s: both that hand and the
/// waves which it sends hold it back, by 0.4 to 1.8 ms on frets 1 to 9 of four strings of three instruments.
pub(crate) const SET_DOWN: f64 = 0.0015;
/// Longest time in which the force of a finger that lands rises, as a part of the period: speed is to be constant.
pub(crate) const LANDING_RISE: f64 = 0.25;
/// Least way down to a fret that is reckoned with, m.
pub(crate) const LEAST_WAY: f64 = 1e-5;
/// The most that a hand brakes a finger that lands, N s/m: what lets go quickly then has to pull with 180 N already.
pub(crate) const MOST_DAMPING: f64 = 350.0;
/// How the finger of a note that is over goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Parting {
    /// How long the dampers rest before it begins to leave, s, while it relaxes.
    pub relaxing: f64,
    /// How it leaves then.
    pub easing: Leaving,
}

/// The usual: 40 dB take 0.15 s, and a hand that relaxes as fast as that is itself heard through a bridge; and so slowly that
/// the string rises from the fret without a sound.
pub(crate) const RESTING: Parting = Parting { relaxing: 0.4, easing: FINGER_EASING };
/// Of a finger that has tapped, and is to be off the string before it taps again; but no sooner than the dampers have come to rest,
/// in whose 10 ms a string that hangs high over its fret would sound by being let up.
pub(crate) const TAPPING: Parting =
    Parting { relaxing: 0.004, easing: Leaving { speed: 0.05, turning: 0.036 } };
/// What a fretting finger goes on pressing with when a note has ended, as a multiple of the force at
/// which the string would leave the fret.
pub(crate) const HOLDING: f64 = 1.25;
/// How a finger leaves a quiet string.
pub(crate) const FINGER_EASING: Leaving = Leaving { speed: 0.005, turning: 0.5 };
/// How the dampers leave after it; they bend the string much less.
pub(crate) const DAMPER_EASING: Leaving = Leaving { speed: 0.01, turning: 0.2 };

/// What a hand takes of a string that its fingers have left, 1/s, and for how long, s: 156 dB, so that nothing is left to ring where
/// nobody would hear it for half a minute.
pub(crate) const LAID_ALONG: (f64, f64) = (60.0, 0.3);
