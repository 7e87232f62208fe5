//! What becomes of notes, told beside the gestures as it is decided: for whoever labels what is heard.
//!
//! Gestures alone do not say which key a string sounds for, or how the hand thinks of what it does.

use low_action_dsp::Gesture;

use super::articulation::Stroke;

/// What becomes of the note of a string. Those of one string come in order of time, except that a
/// [`Sounds`](Self::Sounds) may be told up to a millisecond ahead, as plucks are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Annotation {
    /// The hands turn to another note: the one before is over. This one is heard once it [sounds](Self::Sounds), if that is not
    /// called off.
    Begins(NewNote),
    /// Hands make the string sound for its note: once, or with every stroke of a tremolo.
    Sounds(Excitation),
    /// Its key is up, whatever a pedal or the hands do then.
    Released,
    /// The dampers come to rest on the string: its note is over.
    Damped,
    /// It is bent less far than asked.
    BentShort,
    /// What bends the string goes for another goal.
    Bent {
        /// Semitones over the fret of the note, by tension, by a finger that slides, or both.
        semitones: f64,
        /// Time taken, s.
        duration: f64,
        /// How far tension is to do that.
        pull: Pull,
    },
}

/// How far a string is pulled, and what stops it then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pull {
    /// By how much hands take that to raise what sounds, semitones.
    pub semitones: f64,
    /// The tension, as a multiple of the string's own.
    pub ratio: f64,
    /// The fret at which a finger or a capo stretches the string, 0 where none does or nothing is pulled.
    pub fret: usize,
}

impl Default for Pull {
    /// A straight string.
    fn default() -> Self {
        Self { semitones: 0.0, ratio: 1.0, fret: 0 }
    }
}

impl Pull {
    /// A string is pulled so far, and stretched at a fret; what stretches a straight one is nothing to a bend.
    pub(crate) fn new(semitones: f64, ratio: f64, fret: usize) -> Self {
        Self { semitones, ratio, fret: if ratio == 1.0 { 0 } else { fret } }
    }
}

/// A note that hands turn to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewNote {
    /// Its channel, 0 to 15.
    pub channel: u8,
    /// Its key, as sent.
    pub key: u8,
    /// How hard its key was struck, 0 to 1.
    pub velocity: f64,
    /// Sample at which that was, or at which the key above it went up.
    pub asked: u64,
    /// Whether it has sounded before, and comes back as the key above it goes up.
    pub returned: bool,
    /// Fret, 0 for the open string.
    pub fret: usize,
    /// The partial that a harmonic is of what sounds over the fret.
    pub partial: Option<u32>,
    /// How hard the palm rests on the string, 0 to 1.
    pub palm: f64,
}

/// What makes a string sound, and what touches it then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excitation {
    /// What hands do.
    pub technique: Technique,
    /// The gesture that does it: a pluck, a finger thrown at the string, a slide; none where hands only lie down, or do nothing.
    pub gesture: Option<Gesture>,
    /// What stops the string.
    pub stop: Stopped,
    /// Where that presses, or slides to, m from the nut; none at the nut itself.
    pub finger: Option<f64>,
    /// Where a light finger touches the string, m from the nut: for a harmonic, or to mute it.
    pub touch: Option<f64>,
    /// The partial at whose node a thumb grazes the string, of what sounds over the fret.
    pub pinched: Option<u32>,
}

/// How hands make a string sound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Technique {
    /// A pluck; with a plectrum a stroke towards the high strings.
    Pluck,
    /// A stroke back.
    UpStroke,
    /// A push towards the board.
    RestStroke,
    /// The thumb is thrown at the string.
    Slap,
    /// The string is snapped against the frets.
    Pop,
    /// A pluck beside the thumb, which grazes a node.
    Pinch,
    /// The finger that stops the string is thrown at it, which was silent or is to sound anew.
    Tap,
    /// The same on a string that sounds for another note; a bar is laid.
    HammerOn,
    /// The finger that stopped the string plucks it as it leaves.
    PullOff,
    /// The finger that stops the string moves along it.
    Slide,
    /// Nothing: what sounds goes on as this note.
    Continued,
}

impl Technique {
    /// Of a stroke of the right hand.
    pub(crate) fn of(stroke: Stroke) -> Self {
        match stroke {
            Stroke::Down | Stroke::Alternate => Self::Pluck,
            Stroke::Up => Self::UpStroke,
            Stroke::Rest => Self::RestStroke,
            Stroke::Slap => Self::Slap,
            Stroke::Pop => Self::Pop,
            Stroke::Pinch => Self::Pinch,
            Stroke::Tap => Self::Tap,
        }
    }
}

/// What stops a string.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// Nothing but the nut.
    Nut,
    /// A capo.
    Capo,
    /// A finger.
    Finger,
    /// A bar.
    Bar,
}

/// A note that is not played, and has never been any string's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unplayed {
    /// Its channel, 0 to 15.
    pub channel: u8,
    /// Its key, as sent.
    pub key: u8,
    /// How hard its key was struck, 0 to 1.
    pub velocity: f64,
    /// Sample at which that was.
    pub asked: u64,
    /// Why it is not played.
    pub why: Why,
}

/// Why a note is not played, in the words of [`Compromises`](super::Compromises).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Why {
    /// There were too many, or all was to be silent.
    LeftOut,
    /// No string gives it.
    WithoutString,
    /// It is one with another.
    Doubled,
}

/// An annotation of one string at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedAnnotation {
    /// Sample index, as a gesture's.
    pub time: u64,
    /// String index, 0 for the first string of the set-up.
    pub string: usize,
    /// What becomes of its note.
    pub annotation: Annotation,
}
