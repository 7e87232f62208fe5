//! Parameters that are one of a few things. Saved by identifier, so that they can be reordered.

use nice_plug::prelude::Enum;

use crate::engine::Quality;

/// The set-ups that come with the program, as the host sees them.
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
    /// A bass whose strings rattle along the frets.
    #[id = "buzzing-bass"]
    #[name = "Buzzing bass"]
    BuzzingBass,
    /// A bass whose strings are thrown against the frets.
    #[id = "slap-bass"]
    #[name = "Slap bass"]
    SlapBass,
    /// A bass without frets.
    #[id = "fretless-bass"]
    #[name = "Fretless bass"]
    FretlessBass,
    /// A very low electric guitar, heard at the bridge.
    #[id = "low-action-funk"]
    #[name = "Low-action funk"]
    LowActionFunk,
    /// An electric guitar with one fret worn down.
    #[id = "worn-fret"]
    #[name = "Worn fret"]
    WornFret,
    /// An electric guitar under fingers that hardly press.
    #[id = "light-fingers"]
    #[name = "Light fingers"]
    LightFingers,
    /// A steel-string guitar nobody has set up.
    #[id = "school-guitar"]
    #[name = "School guitar"]
    SchoolGuitar,
    /// An electric guitar with old flat-wound strings.
    #[id = "flatwound-jazz"]
    #[name = "Flat-wound jazz"]
    FlatwoundJazz,
    /// Four open strings over a curved bridge.
    #[id = "tanpura"]
    #[name = "Tanpura"]
    Tanpura,
    /// An electric guitar with a curved bridge.
    #[id = "sitar"]
    #[name = "Electric sitar"]
    Sitar,
}

impl InstrumentChoice {
    /// The name of the set-up, as the command line knows it.
    pub fn set_up(self) -> &'static str {
        match self {
            Self::Electric => "electric",
            Self::Classical => "classical",
            Self::Steel => "steel",
            Self::Bass => "bass",
            Self::BuzzingBass => "buzzing-bass",
            Self::SlapBass => "slap-bass",
            Self::FretlessBass => "fretless-bass",
            Self::LowActionFunk => "low-action-funk",
            Self::WornFret => "worn-fret",
            Self::LightFingers => "light-fingers",
            Self::SchoolGuitar => "school-guitar",
            Self::FlatwoundJazz => "flatwound-jazz",
            Self::Tanpura => "tanpura",
            Self::Sitar => "sitar",
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
