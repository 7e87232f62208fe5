//! A note: what it is to be, and what is remembered of it while it sounds.

use super::deeds::Struck;
use crate::performance::articulation::{Articulation, Stop, Stroke};
use crate::performance::technique::{FIRMEST, SETTLING};
use crate::performance::variation::Deviation;

/// A note to begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Start {
    /// Its channel.
    pub channel: u8,
    /// Its key, as sent.
    pub key: u8,
    /// How hard it was struck, 0 to 1.
    pub velocity: f64,
    /// Sample at which that was.
    pub asked: u64,
    /// How often the key went down for it.
    pub presses: u32,
    /// Whether the sostenuto pedal caught that key before and still holds it.
    pub caught: bool,
    /// Fret, 0 for the open string.
    pub fret: usize,
    /// Part of the hardest pluck's force.
    pub strength: f64,
    /// How this pluck differs from the usual.
    pub deviation: Deviation,
    /// What the note has for itself.
    pub manner: Manner,
    /// Bend by its channel's wheel, semitones.
    pub wheel: f64,
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

    /// The stroke of the right hand that it has, or that a tremolo has of it if it is begun by another hand.
    pub(super) fn stroke(&self) -> Stroke {
        match (self.articulation.stroke, self.articulation.stop) {
            // A thumb beside the plectrum would take up the partial that another finger lets through.
            (Stroke::Tap, _) | (Stroke::Pinch, Stop::Harmonic) => Stroke::Down,
            (stroke, _) => stroke,
        }
    }

    /// In what haste its finger comes, 0 to 1. One that came as fast as for a stroke at once would be heard before a stroke that
    /// has yet to go to its string; one that has the time takes it.
    pub(super) fn haste(&self) -> f64 {
        (1.0 - self.wait / SETTLING).clamp(0.0, 1.0)
    }
}

/// What a note can have for itself, beside what holds for all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Manner {
    /// Moves the pluck away from the saddle, m.
    pub place: f64,
    /// Factor of the pluck's force.
    pub force: f64,
    /// Factor of the finger's force, as keys are pressed.
    pub pressure: f64,
    /// Another one, of the note alone.
    pub firmness: f64,
    /// Tuning, semitones.
    pub tuning: f64,
    /// Depth of the vibrato, 0 to 1.
    pub vibrato: f64,
}

impl Manner {
    /// Nothing special.
    pub const PLAIN: Self =
        Self { place: 0.0, force: 1.0, pressure: 1.0, firmness: 1.0, tuning: 0.0, vibrato: 0.0 };

    /// Factor of the finger's force, everything counted.
    pub(super) fn firm(&self) -> f64 {
        self.pressure * self.firmness
    }

    /// That of a note by now, with the pluck that it began with.
    pub(crate) fn by_now(self, now: &Self) -> Self {
        Self { place: self.place, force: self.force, ..*now }
    }

    /// This, under what another channel says for all.
    pub(crate) fn under(&self, all: &Self) -> Self {
        Self {
            place: self.place + all.place,
            force: self.force * all.force,
            pressure: (self.pressure * all.pressure).min(FIRMEST),
            firmness: self.firmness * all.firmness,
            tuning: self.tuning + all.tuning,
            vibrato: self.vibrato.max(all.vibrato),
        }
    }
}

/// The note on a string, from its pluck until it is damped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Note {
    pub channel: u8,
    pub key: u8,
    /// How hard that was struck, 0 to 1.
    pub velocity: f64,
    /// Sample at which it began, or came back.
    pub began: u64,
    /// Sample at which it is first heard, which a stroke that has some way to go makes later.
    pub since: u64,
    /// Sample by which a finger that waits until a hand that stills the string has gone has met it; that at which the note began if none
    /// does.
    pub met: u64,
    /// How often its key went down that has not gone up again: each press has a note-off of its own.
    pub presses: u32,
    /// Whether the sostenuto pedal caught it.
    pub caught: bool,
    /// Its fret.
    pub fret: usize,
    /// How late its finger goes when the note before comes back, s.
    pub(super) goes_late: f64,
    /// How it was struck last, or would be: what a tremolo goes on with.
    pub(super) struck: Struck,
    /// What it has for itself; pressure and vibrato are its own or its channel's, whichever was said last.
    pub manner: Manner,
    /// How hard the palm rests on it, 0 to 1.
    pub palm: f64,
    /// Whether a bar stops it.
    pub bar: bool,
    /// The partial that a harmonic is.
    pub partial: Option<u32>,
    /// Whether fingers that rest on the string mute it.
    pub muted: bool,
    /// How long a slide to the next note takes, s, if that is how they are connected.
    pub slide: Option<f64>,
    /// Whether it was bent less far than asked.
    pub bent_short: bool,
}

impl Note {
    /// Whether its key is down.
    pub fn key_down(&self) -> bool {
        self.presses > 0
    }

    /// Whether it is touched lightly instead of stopped: no hammer and no pull leads from there and back.
    pub fn touched(&self) -> bool {
        self.partial.is_some() || self.muted
    }

    /// Whether it is the note of a key of a channel.
    pub fn is(&self, channel: u8, key: u8) -> bool {
        (self.channel, self.key) == (channel, key)
    }
}
