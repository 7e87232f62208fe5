//! What a player's hands do to one string, in physical terms.
//!
//! A [`Gesture`] is an instruction with SI values; [`TimedGesture`] puts it on a string at an exact
//! sample. The instrument turns gestures into the slowly varying forces and positions of a
//! [`Drive`](crate::Drive); nothing here knows about MIDI.

/// The parameters of one finger (or palm, or thumb): a mass on a lossy, nonlinear spring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Mass, kg, above 0.
    pub mass: f64,
    /// Stiffness of the pad, N/m^exponent, above 0.
    pub stiffness: f64,
    /// Exponent of the contact law, 1 to 5.
    pub exponent: f64,
    /// Hunt–Crossley damping of the pad, s/m, 0 or more.
    pub damping: f64,
    /// The hand's own damping, N s/m, 0 or more.
    pub hand_damping: f64,
}

/// One of the places for fingers on a string, from 0 to [`FINGERS_PER_STRING`] − 1.
pub type FingerSlot = usize;

/// How many fingers may be near one string of an instrument at the same time: two that stop it, two parts
/// of the hand that silences it, one of the hand that plucks it, and a capo.
pub const FINGERS_PER_STRING: usize = 6;

/// Something a hand does to one string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gesture {
    /// A raised-cosine push of a point of the string that ends in a sudden release, equation \[4\].
    Pluck {
        /// Place, m from the nut.
        position: f64,
        /// Largest force, N, up is positive; 0 or more pushes away from the board.
        force: f64,
        /// Length of the push, s.
        duration: f64,
    },
    /// Puts a finger over the string, at rest, touching nothing. A finger already in that slot is
    /// taken away first.
    Place {
        /// Which finger.
        finger: FingerSlot,
        /// What kind of finger.
        touch: Touch,
        /// Place, m from the nut.
        position: f64,
        /// Height of the pad above the string's present displacement, m.
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
        /// Height of the pad above the string's present displacement, m.
        clearance: f64,
        /// Speed towards the board, m/s, 0 or more; limited to what a hand can do.
        speed: f64,
    },
    /// Brings a finger's force to a new value along a smooth ramp.
    Press {
        /// Which finger.
        finger: FingerSlot,
        /// Force at the end of the ramp, N, positive towards the board.
        force: f64,
        /// Length of the ramp, s; 0 is at once.
        duration: f64,
    },
    /// Moves a finger along the string at constant speed.
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
        /// Force that pulls it up, N, above 0.
        force: f64,
        /// Length of the ramp from the present force, s.
        duration: f64,
    },
    /// Changes the string's tension along a smooth ramp (a bend or a tremolo arm).
    Bend {
        /// Tension at the end of the ramp as a multiple of the string's own; limited to what the
        /// string's grid was built for.
        tension_ratio: f64,
        /// Length of the ramp, s.
        duration: f64,
    },
}

/// A gesture on one string at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedGesture {
    /// Sample index, counted from the instrument's start.
    pub time: u64,
    /// String index, 0 for the first string of the set-up.
    pub string: usize,
    /// What happens.
    pub gesture: Gesture,
}

/// (1 − cos(πt/t_p))/2 for 0 ≤ t ≤ t_p: the push of a pluck, equation \[4\], which grows to 1 and ends
/// there at once.
pub fn raised_cosine(since: f64, duration: f64) -> f64 {
    if duration <= 0.0 {
        return 1.0;
    }
    0.5 * (1.0 - libm::cos(std::f64::consts::PI * (since / duration)))
}
