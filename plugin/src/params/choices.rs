//! Parameters that are one of a few things. Saved by identifier, so that they can be reordered; what the program has
//! a list of elsewhere is taken from that list.

use std::sync::OnceLock;

use nice_plug::prelude::Enum;

use crate::engine::Quality;
use crate::performance::InputMode;
use crate::setups::SHIPPED;

/// Words that live as long as the program.
type Words = OnceLock<Vec<&'static str>>;

/// Identifiers as hosts show them: `buzzing-bass` is "Buzzing bass".
fn titles(words: &'static Words, ids: impl Iterator<Item = &'static str>) -> &'static [&'static str] {
    let title = |id: &str| -> &'static str {
        let mut letters = id.chars();
        let first = letters.next().map(|letter| letter.to_ascii_uppercase());
        let title: String = first.into_iter().chain(letters).collect();
        title.replace('-', " ").leak()
    };
    words.get_or_init(|| ids.map(title).collect())
}

/// A set-up that comes with the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InstrumentChoice(usize);

impl InstrumentChoice {
    /// The set-up of a name, if there is one.
    pub fn named(name: &str) -> Option<Self> {
        SHIPPED.iter().position(|known| *known == name).map(Self)
    }

    /// The name of the set-up, as the command line knows it.
    pub fn id(self) -> &'static str {
        SHIPPED.get(self.0).unwrap_or(&SHIPPED[0])
    }
}

impl Enum for InstrumentChoice {
    fn variants() -> &'static [&'static str] {
        static TITLES: Words = Words::new();
        titles(&TITLES, SHIPPED.into_iter())
    }

    fn ids() -> Option<&'static [&'static str]> {
        Some(&SHIPPED)
    }

    fn to_index(self) -> usize {
        self.0
    }

    fn from_index(index: usize) -> Self {
        Self(if index < SHIPPED.len() { index } else { 0 })
    }
}

/// How much computing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QualityChoice(pub Quality);

impl Enum for QualityChoice {
    fn variants() -> &'static [&'static str] {
        // Hosts show no other explanation.
        static TITLES: Words = Words::new();
        let said = Quality::ALL
            .into_iter()
            .map(|quality| -> &'static str { format!("{}: {}", quality.name(), quality.summary()).leak() });
        titles(&TITLES, said)
    }

    fn ids() -> Option<&'static [&'static str]> {
        static IDS: Words = Words::new();
        Some(IDS.get_or_init(|| Quality::ALL.into_iter().map(Quality::name).collect()))
    }

    fn to_index(self) -> usize {
        Quality::ALL.into_iter().position(|quality| quality == self.0).unwrap_or(0)
    }

    fn from_index(index: usize) -> Self {
        Self(*Quality::ALL.get(index).unwrap_or(&Quality::ALL[0]))
    }
}

/// How much computing when the host renders offline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RenderChoice {
    /// As much as in real time.
    Same,
    /// So much.
    Just(Quality),
    /// As much as in real time, but no less than for a finished recording.
    #[default]
    Better,
}

impl RenderChoice {
    /// The quality, given the one of real time.
    pub fn quality(self, live: Quality) -> Quality {
        match self {
            Self::Same => live,
            Self::Just(quality) => quality,
            Self::Better => live.max(Quality::Studio),
        }
    }
}

impl Enum for RenderChoice {
    fn variants() -> &'static [&'static str] {
        static TITLES: Words = Words::new();
        TITLES.get_or_init(|| [&["As live"], QualityChoice::variants(), &["Studio or better"]].concat())
    }

    fn ids() -> Option<&'static [&'static str]> {
        static IDS: Words = Words::new();
        let qualities = || QualityChoice::ids().unwrap_or_default();
        Some(IDS.get_or_init(|| [&["same"], qualities(), &["better"]].concat()))
    }

    fn to_index(self) -> usize {
        match self {
            Self::Same => 0,
            Self::Just(quality) => 1 + QualityChoice(quality).to_index(),
            Self::Better => 1 + Quality::ALL.len(),
        }
    }

    fn from_index(index: usize) -> Self {
        match index.checked_sub(1) {
            None => Self::Same,
            Some(index) => Quality::ALL.get(index).map_or(Self::Better, |quality| Self::Just(*quality)),
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
    /// Each channel is a string, from the first channel on: a guitar controller.
    #[id = "strings"]
    #[name = "Channel per string"]
    Strings,
    /// Each note has a channel; channel 1 bends all.
    #[id = "mpe"]
    #[name = "MPE"]
    Mpe,
}

impl InputChoice {
    /// What channels mean then; where each is a string, the first of them is `first_channel`, 1 to 16.
    pub fn mode(self, first_channel: u8, order: StringOrder) -> InputMode {
        match self {
            Self::Auto => InputMode::Auto,
            Self::Keyboard => InputMode::Keyboard,
            Self::Strings => InputMode::Strings {
                first: first_channel.saturating_sub(1),
                from_last: order == StringOrder::LastFirst,
            },
            Self::Mpe => InputMode::Mpe,
        }
    }
}

/// Which string has the first channel, where each channel is a string.
#[derive(Enum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum StringOrder {
    /// The first of the set-up, the highest on guitars.
    #[id = "first_first"]
    #[name = "First string first"]
    FirstFirst,
    /// The last of the set-up, the lowest on guitars.
    #[id = "last_first"]
    #[name = "Last string first"]
    LastFirst,
}

/// When overlapping notes on one string are connected by hammers, pulls and slides.
#[derive(Enum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum LegatoChoice {
    /// While the legato pedal (controller 68), the portamento switch (65) or a keyswitch says so.
    #[id = "pedal"]
    #[name = "By CC 68"]
    Pedal,
    /// Always.
    #[id = "always"]
    #[name = "Always"]
    Always,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_consistent<T: Enum + Copy + PartialEq + std::fmt::Debug>() {
        let ids = T::ids().expect("there are identifiers");
        assert_eq!(ids.len(), T::variants().len());
        assert!((0..ids.len()).all(|index| T::from_index(index).to_index() == index));
        assert!(T::from_index(ids.len() + 7).to_index() < ids.len());
    }

    #[test]
    fn places_identifiers_and_names_agree() {
        assert_consistent::<InstrumentChoice>();
        assert_consistent::<QualityChoice>();
        assert_consistent::<RenderChoice>();
        assert_eq!(InstrumentChoice::variants()[4], "Buzzing bass");
        assert_eq!(InstrumentChoice::from_index(3).id(), "bass");
        assert_eq!(RenderChoice::from_index(0), RenderChoice::Same);
        assert_eq!(RenderChoice::from_index(1), RenderChoice::Just(Quality::Draft));
    }
}
