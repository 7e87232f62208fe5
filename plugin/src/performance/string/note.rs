//! A note: what it is to be, and what is remembered of it while it sounds.

use crate::performance::articulation::Articulation;
use crate::performance::variation::Deviation;

/// A note to begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Start {
    /// Its channel.
    pub channel: u8,
    /// Its key, as sent.
    pub key: u8,
    /// Fret, 0 for the open string.
    pub fret: usize,
    /// Part of the hardest pluck's force.
    pub strength: f64,
    /// How this pluck differs from the usual.
    pub deviation: Deviation,
    /// What the note has for itself.
    pub manner: Manner,
    /// What the hands are told to do.
    pub articulation: Articulation,
    /// The partial that a harmonic is of what sounds.
    pub order: u32,
    /// How long the stroke has yet to go to this string, s.
    pub wait: f64,
    /// Factor of the force for this string of a strum.
    pub accent: f64,
}

impl Start {
    /// How hard the string is plucked, 1 for the hardest velocity, everything counted.
    pub(super) fn force(&self) -> f64 {
        self.strength * self.deviation.force * self.manner.force * self.accent
    }
}

/// What a note can have for itself, beside what holds for all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Manner {
    /// Moves the pluck away from the saddle, m.
    pub place: f64,
    /// Factor of the pluck's force.
    pub force: f64,
    /// Factor of the finger's force.
    pub pressure: f64,
    /// Tuning, semitones.
    pub tuning: f64,
    /// Depth of the vibrato, 0 to 1.
    pub vibrato: f64,
}

impl Manner {
    /// Nothing special.
    pub const PLAIN: Self = Self { place: 0.0, force: 1.0, pressure: 1.0, tuning: 0.0, vibrato: 0.0 };
}

/// The note on a string, from its pluck until it is damped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Note {
    pub channel: u8,
    pub key: u8,
    pub since: u64,
    pub key_down: bool,
    /// Whether the sostenuto pedal caught it.
    pub caught: bool,
    /// Sample of the last key press of this very note while it was already down. The note-off of
    /// the press before may come a moment later and must not end the new one.
    pub pressed_again: Option<u64>,
    /// Its fret.
    pub fret: usize,
    /// How hard it was begun.
    pub strength: f64,
    /// Whether a bar stops it.
    pub bar: bool,
    /// How long a slide to the next note takes, s, if that is how they are connected.
    pub slide: Option<f64>,
    /// Whether it was bent less far than asked.
    pub bent_short: bool,
}
