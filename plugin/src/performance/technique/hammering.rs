//! Fingers that make a string sound by themselves: hammers, pulls and slides.

/// How fast a finger comes that is to make a string sound by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hammer {
    /// How much of the speed that makes the first partial as loud as a pluck does.
    pub part: f64,
    /// Speed of the softest, m/s; that of the others is added to it.
    pub slowest: f64,
    /// What is added stays below it however thin the string is if the note is as hard as can be, m/s; where that would ask for as much,
    /// it is half of it.
    pub limit: f64,
    /// Softer notes stay below less, by this power of their force: or those of thin strings would all be as fast as fingers are.
    pub effort: f64,
}

/// The usual. Fingertips reach 1 to 2 m/s. (Fitted to taps on five frets of nine strings of five instruments, and to runs of hammers.)
pub(crate) const HAMMER: Hammer = Hammer { part: 1.35, slowest: 0.1, limit: 2.7, effort: 0.6 };
/// Time in which a string comes up from a fret that its finger leaves, s, before another can strike it there.
pub(crate) const RISING: f64 = 0.003;
/// How much of the landing speed the hand behind it would keep up by its force alone: the finger is thrown,
/// and held back enough not to bounce.
pub(crate) const HAMMER_GRIP: f64 = 0.5;
/// How a finger gathers force and speed on its way, if that takes long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gathering {
    /// On ways that take no longer it gathers nothing, as a part of the period of what sounds.
    pub from: f64,
    /// On those that take as long, or longer, it gathers most, as a part of that.
    pub to: f64,
    /// How much of both it gathers then: as little is left at first as has the string moving within 3 ms.
    pub most: f64,
}

/// The usual. On a way of x periods the speed at the end is (1 + what is gathered) / x of a constant one: gathered from half a period
/// to nine tenths of one, it would be the same for all fingers that take so long.
pub(crate) const GATHERING: Gathering = Gathering { from: 0.2, to: 0.7, most: 0.8 };
/// Time in which it comes to press if it is thrown, s.
pub(crate) const HAMMER_LANDING: f64 = 0.001;
/// How fast a finger that is only held down behind another relaxes, and presses again, s: pressed on, it would
/// stretch the string and raise the note.
pub(crate) const ANCHOR_RAMP: (f64, f64) = (0.02, 0.003);
/// How fast a finger is set down behind another, m/s: before that one has left.
pub(crate) const BEHIND_SPEED: f64 = 0.5;
/// How fast one that is behind another already is at another fret, s, and how far off that may be, frets: where more go by under it
/// they are heard, and another comes down.
pub(crate) const BEHIND_SLIDE: f64 = 0.002;
pub(crate) const BEHIND_REACH: f64 = 2.0;
/// How a finger plucks the string that it pulls off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PullOff {
    /// How far it takes the string along, as a part of the usual pluck.
    pub part: f64,
    /// The most force that may take, as a multiple of what takes the string as far at the usual place.
    pub hardest: f64,
    /// How long it pulls, s: most of that is at its end, when the finger has ceased to press.
    pub duration: f64,
    /// How long the flesh takes to let go, s.
    pub release: f64,
}

/// The usual. (Fitted to notes plucked as hard, in runs of pull-offs from fret 12 to the open string on eight strings of five
/// instruments. Let go of at once so near to the fret, the string would be up to 14 dB brighter than it is plucked.)
pub(crate) const PULL_OFF: PullOff = PullOff { part: 0.7, hardest: 6.0, duration: 0.0025, release: 0.0002 };
/// Farthest a hammer or a pull reaches, frets: from the first finger to the last, stretched.
pub(crate) const HAMMER_REACH: usize = 5;
/// Fastest slide to another note, m/s: seven frets of a guitar in 0.17 s. Where frets go by much faster, they pluck the
/// string, and where they keep time with it, each adds to what the one before did.
pub(crate) const SLIDE_SPEED: f64 = 1.0;
/// Farthest a slide goes, frets; what lies beyond is plucked anew.
pub(crate) const SLIDE_REACH: usize = 12;
