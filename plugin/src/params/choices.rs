//! Parameters that are one of a few things. Saved by identifier, so that they can be reordered.

use nice_plug::prelude::Enum;

use crate::engine::Quality;

/// The built-in instruments, as the host sees them.
#[derive(Enum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstrumentChoice {
    /// A six-string electric guitar, .010 to .046, 22 frets.
    #[id = "electric"]
    #[name = "Electric guitar"]
    Electric,
    /// A six-string classical guitar with nylon strings.
    #[id = "classical"]
    #[name = "Classical guitar"]
    Classical,
    /// A six-string steel-strung acoustic guitar.
    #[id = "steel"]
    #[name = "Steel-string guitar"]
    Steel,
    /// A four-string electric bass.
    #[id = "bass"]
    #[name = "Electric bass"]
    Bass,
}

impl InstrumentChoice {
    /// The name of the built-in set-up, as the command line knows it.
    pub fn set_up(self) -> &'static str {
        match self {
            Self::Electric => "electric",
            Self::Classical => "classical",
            Self::Steel => "steel",
            Self::Bass => "bass",
        }
    }
}

/// How much computing.
#[derive(Enum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum QualityChoice {
    /// Least.
    #[id = "draft"]
    Draft,
    /// For playing.
    #[id = "live"]
    Live,
    /// For a finished recording.
    #[id = "studio"]
    Studio,
    /// For comparison.
    #[id = "reference"]
    Reference,
}

impl QualityChoice {
    /// The engine's quality.
    pub fn quality(self) -> Quality {
        match self {
            Self::Draft => Quality::Draft,
            Self::Live => Quality::Live,
            Self::Studio => Quality::Studio,
            Self::Reference => Quality::Reference,
        }
    }
}

/// How much computing when the host renders offline.
#[derive(Enum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum RenderChoice {
    /// As in real time.
    #[id = "same"]
    #[name = "As live"]
    Same,
    /// Least.
    #[id = "draft"]
    Draft,
    /// For playing.
    #[id = "live"]
    Live,
    /// For a finished recording.
    #[id = "studio"]
    Studio,
    /// For comparison.
    #[id = "reference"]
    Reference,
}

impl RenderChoice {
    /// The engine's quality, given the one chosen for playing.
    pub fn quality(self, live: Quality) -> Quality {
        match self {
            Self::Same => live,
            Self::Draft => Quality::Draft,
            Self::Live => Quality::Live,
            Self::Studio => Quality::Studio,
            Self::Reference => Quality::Reference,
        }
    }
}

/// What the channels of incoming notes mean.
#[derive(Enum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputChoice {
    /// MPE once a keyboard announces it (registered parameter 6), a keyboard until then.
    #[id = "auto"]
    #[name = "Auto"]
    Auto,
    /// The player picks string and fret for every note.
    #[id = "keyboard"]
    #[name = "Keyboard"]
    Keyboard,
    /// Channel 1 is the first string, and so on: a guitar controller.
    #[id = "strings"]
    #[name = "Channel per string"]
    Strings,
    /// The same from channel 11.
    #[id = "strings_11"]
    #[name = "Channel per string, from 11"]
    StringsFrom11,
    /// Each note has a channel; channel 1 bends all.
    #[id = "mpe"]
    #[name = "MPE"]
    Mpe,
}
