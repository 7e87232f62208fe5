//! What a player's hands do to one string, in physical terms.
//!
//! A [`Gesture`] is an instruction with SI values; [`TimedGesture`] puts it on a string at an exact
//! sample. The instrument turns gestures into the slowly varying forces and positions of a
//! [`Drive`](crate::Drive); nothing here knows about MIDI.

use crate::contact::ContactLaw;
use crate::error::{Error, limited, ranged};

/// The parameters of one finger (or palm, or thumb): a mass on a lossy, nonlinear spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Mass, kg, 1e-7 to 1e3.
    pub mass: f64,
    /// Stiffness of the pad, N/m^exponent, 1e-3 to 1e30, and no more than can be told from rounding at the string's rate.
    pub stiffness: f64,
    /// Exponent of the contact law, 1 to 5.
    pub exponent: f64,
    /// Hunt–Crossley damping of the pad, s/m, 0 to 1e5.
    pub damping: f64,
    /// The hand's own damping, N s/m, 0 to 1e5.
    pub hand_damping: f64,
}

/// One number of a [`Touch`].
struct TouchNumber {
    /// As it is called in files.
    key: &'static str,
    /// What it may be.
    range: [f64; 2],
    /// What both ends of its range are in; empty for a mere number.
    unit: &'static str,
    /// Where it is.
    of: fn(&mut Touch) -> &mut f64,
}

impl TouchNumber {
    fn value(&self, mut touch: Touch) -> f64 {
        *(self.of)(&mut touch)
    }
}

impl Touch {
    /// Its numbers, in the order in which they are checked.
    const NUMBERS: [TouchNumber; 5] = [
        TouchNumber { key: "mass", range: [1e-7, 1e3], unit: "kg", of: |touch| &mut touch.mass },
        TouchNumber {
            key: "stiffness",
            range: ContactLaw::STIFFNESS,
            unit: "N/m^exponent",
            of: |touch| &mut touch.stiffness,
        },
        TouchNumber {
            key: "exponent",
            range: ContactLaw::EXPONENT,
            unit: "",
            of: |touch| &mut touch.exponent,
        },
        TouchNumber { key: "damping", range: [0.0, 1e5], unit: "s/m", of: |touch| &mut touch.damping },
        TouchNumber {
            key: "hand_damping",
            range: [0.0, 1e5],
            unit: "N s/m",
            of: |touch| &mut touch.hand_damping,
        },
    ];

    /// Whether there can be such a finger: what [`Touch::check`] asks, without the words, which take memory.
    pub(crate) fn is_possible(&self) -> bool {
        Self::NUMBERS.iter().all(|number| {
            let [low, high] = number.range;
            (low..=high).contains(&number.value(*self))
        })
    }

    /// Brings each of them into its range.
    pub(crate) fn limit(&mut self) {
        for TouchNumber { range, of, .. } in Self::NUMBERS {
            let value = of(self);
            *value = limited(*value, range);
        }
    }

    /// Refuses values outside their range; `name` says whose they are.
    ///
    /// # Errors
    /// At the first of them.
    pub fn check(&self, name: &str) -> Result<(), Error> {
        Self::NUMBERS.iter().try_for_each(|number| {
            let TouchNumber { key, range, unit, .. } = *number;
            // The full name is put together only for a refusal: whoever places a good finger between steps allocates nothing.
            ranged(key, number.value(*self), range, unit).map(drop).map_err(|error| error.under(name))
        })
    }
}

/// One of the places for fingers on a string, from 0 to [`FINGERS_PER_STRING`] − 1.
pub type FingerSlot = usize;

/// How many fingers may be near one string of an instrument at the same time: two that stop it, two parts
/// of the hand that silences it, two of the hand that plucks it, and a capo.
pub const FINGERS_PER_STRING: usize = 7;

/// The largest force of a hand either way, N, in scenes, too: far below where differences of forces overflow.
pub const MOST_FORCE: f64 = 1e6;

/// The highest place for a finger over a string, m; in scenes it is the lowest below it, too.
pub const MOST_CLEARANCE: f64 = 10.0;

/// The largest velocity that a string or a finger may begin with, m/s.
pub const FASTEST: f64 = 1e3;

/// Something a hand does to one string.
///
/// A place beyond the string is moved to the nearest on it; one that is no number, to the middle. Durations have no upper limit, and a
/// string does not sleep before they are over. Except for plucks and stilling, a duration below 0, or that is no number, means at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gesture {
    /// A push of a point of the string that grows as a raised cosine (`docs/physics.md`, section 1), and lets go at once or as it
    /// grew. Left out while as many as [`PUSHES`](crate::drive::PUSHES) others are under way.
    Pluck {
        /// Place, m from the nut.
        position: f64,
        /// Largest force, N, up is positive; 0 or more pushes away from the board. Left out above [`MOST_FORCE`].
        force: f64,
        /// How long the push grows, s; one of 0 or less does not. Left out where it is not finite.
        duration: f64,
        /// How long it takes to let go after that, s: 0 or less, as a plectrum does, is at once. Left out where it is not finite.
        release: f64,
    },
    /// Puts a finger over the string, at rest, touching nothing, in the place of the one that is in that slot. What cannot be
    /// (a touch or clearance out of range, a pad too stiff for the string's rate, a slot that is not there) is left out, and
    /// what is in the slot stays.
    Place {
        /// Which finger.
        finger: FingerSlot,
        /// What kind of finger.
        touch: Touch,
        /// Place, m from the nut.
        position: f64,
        /// Height of the pad above the string's present displacement, m, up to [`MOST_CLEARANCE`]; below 0 is 0.
        clearance: f64,
    },
    /// Throws a finger at the string: over it as by `Place`, but already on its way to it.
    Throw {
        /// Which finger.
        finger: FingerSlot,
        /// What kind of finger.
        touch: Touch,
        /// Place, m from the nut.
        position: f64,
        /// Height of the pad above the string's present displacement, m, up to [`MOST_CLEARANCE`]; below 0 is 0.
        clearance: f64,
        /// Speed towards the board, m/s, 0 or more; limited to what a hand can do, 10 m/s.
        speed: f64,
    },
    /// Brings a finger's force to a new value along a smooth ramp.
    Press {
        /// Which finger.
        finger: FingerSlot,
        /// Force at the end of the ramp, N, positive towards the board. Left out above [`MOST_FORCE`].
        force: f64,
        /// Length of the ramp, s; 0 is at once.
        duration: f64,
    },
    /// Moves a finger along the string at constant speed, 10 m/s at most.
    Slide {
        /// Which finger.
        finger: FingerSlot,
        /// Place reached, m from the nut.
        position: f64,
        /// Time taken, s.
        duration: f64,
    },
    /// Pulls a finger off the string along a smooth ramp; it is taken away once it is clear.
    Lift {
        /// Which finger.
        finger: FingerSlot,
        /// Force that pulls it up, N, above 0. Left out above [`MOST_FORCE`].
        force: f64,
        /// Length of the ramp from the present force, s.
        duration: f64,
    },
    /// Lays a hand along the whole string, so softly that it presses it nowhere and only brakes it: for a while the loss σ₀ of the
    /// string is raised. It takes the place of one that is there. Left out where its loss is below 0, or its loss or its duration is
    /// not finite. Once its time is over the string counts as one that nobody plays, on which idle hands lie
    /// ([`idle_loss`](crate::setup::Player::idle_loss)), until it is plucked or something is thrown at it. If that has happened
    /// meanwhile, as under a hand that stills a string for a stroke, the string stays one that is played.
    Still {
        /// What it adds to the loss, 1/s, up to what brings the string to rest in a step; where hands lie there because nobody plays
        /// the string, the greater of both.
        loss: f64,
        /// How long, s; one of 0 or less is nothing.
        duration: f64,
    },
    /// Changes the string's tension along a smooth ramp (a bend or a tremolo arm).
    Bend {
        /// Tension at the end of the ramp as a multiple of the string's own, 0.05 at least and at most what the string's grid
        /// was built for; one that is not finite is 1.
        tension_ratio: f64,
        /// Length of the ramp, s.
        duration: f64,
    },
}

/// A gesture on one string at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedGesture {
    /// Sample index, counted from the instrument's start or last reset; a hand-over does not interrupt it
    /// ([`Instrument::now`](crate::Instrument::now)).
    pub time: u64,
    /// String index, 0 for the first string of the set-up.
    pub string: usize,
    /// What happens.
    pub gesture: Gesture,
}

/// The push of a pluck in one step, as a part of its force: the mean from half a step before to half a step after `since` of
/// what grows as (1 − cos(πt/t_p))/2 for 0 ≤ t ≤ t_p and falls in the same way for t_r after that (`docs/physics.md`, section 1).
///
/// All in s: `since` the pluck began, `step` from one sample to the next, `duration` t_p, `release` t_r. With t_r = 0 the push
/// ends at once where it is strongest. Taken at the samples alone it would be too long or too short by up to half a step, and
/// one that ends between two samples might not push at all; by means the string gets what the push gives, (t_p + t_r)/2 in all,
/// wherever samples fall.
pub fn pluck_push(since: f64, step: f64, duration: f64, release: f64) -> f64 {
    let falls = if release >= LONG * step {
        falling(since - duration, step, release)
    } else {
        // What falls has grown, seen from its end.
        growing(duration + release - since, step, release)
    };
    growing(since, step, duration) + falls
}

/// A release of so many steps is seen from its beginning: from its end, half a step would be off by a millionth, and in the end be
/// no time at all.
const LONG: f64 = (1u64 << 32) as f64;

/// The part of a long release that falls, so long after the peak: the same all over a step, as far as the step is in it.
fn falling(since: f64, step: f64, release: f64) -> f64 {
    let within = (0.5 + since / step).min(0.5 + (release - since) / step).clamp(0.0, 1.0);
    0.5 * within * (1.0 + libm::cos(std::f64::consts::PI * (since / release).clamp(0.0, 1.0)))
}

/// The part of it that grows.
fn growing(since: f64, step: f64, duration: f64) -> f64 {
    let (from, to) = ((since - 0.5 * step).max(0.0), (since + 0.5 * step).min(duration));
    // Less than the smallest normal number has no inverse, and what is that of a longer one than this may be none. It does not
    // push in any time there is.
    if from >= to || !(1e-300..=1e300).contains(&duration) {
        return 0.0;
    }
    // ∫cos over an interval is its length times cos(middle)·sin(x)/x, x half its length: no small difference of large numbers.
    let scale = std::f64::consts::PI / duration;
    let half = 0.5 * scale * (to - from);
    let mean = libm::cos(scale * (0.5 * (from + to))) * (libm::sin(half) / half);
    0.5 * (1.0 - mean) * ((to - from) / step)
}
