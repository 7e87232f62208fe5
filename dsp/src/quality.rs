//! The qualities a player chooses between: speed against accuracy, as measured in `docs/trade.md`.

use std::fmt;
use std::str::FromStr;

use crate::scene::Stencil;
use crate::settings::EngineSettings;

/// How much computing a sound may take.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quality {
    /// Least work: every string at the host's rate, contacts to 1e-8 m. The thinnest strings ring too short at the highest
    /// frets. Below 32 kHz grids are as fine as those of `Live`, or frets would be out of tune.
    Draft,
    /// For playing: grids no wider than 9 mm, so that the thinnest strings take one and a half steps a sample; contacts
    /// to 1e-9 m.
    #[default]
    Live,
    /// For a finished recording: grids no wider than 3 mm.
    Studio,
    /// For comparison: grids of 1.5 mm, or as near to that as a rate of 400 kHz comes.
    Reference,
}

/// The widest grid for playing, m.
const OF_LIVE: f64 = 9e-3;

/// From this rate on, Hz, grids of one step a sample tell frets of the set-ups that come with the program apart: none that is in tune
/// in `live` is more than 3.3 cents off there, where at 24 kHz the first are a semitone off.
const ENOUGH_FOR_FRETS: f64 = 32e3;

impl Quality {
    /// All of them, from least to most work.
    pub const ALL: [Self; 4] = [Self::Draft, Self::Live, Self::Studio, Self::Reference];

    /// Iterations at most and tolerance, m, of contacts where there is not time enough: sound that does not
    /// break matters more than a buzz that is right in every sample.
    pub const RELAXED: (usize, f64) = (4, 1e-8);

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Live => "live",
            Self::Studio => "studio",
            Self::Reference => "reference",
        }
    }

    /// What it gives and takes, in a few words for those who choose: work beside `live` in whole numbers, and bounds on what
    /// is off, from what is measured in `docs/trade.md` for a host's rate of 48 kHz. Whoever shows more words shows these too.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Draft => "least work, buzz within 50 %",
            Self::Live => "within 1 cent, buzz within 25 %",
            Self::Studio => "4 × the work, buzz within 15 %",
            Self::Reference => "10 × the work, buzz within 12 %",
        }
    }

    /// What it means for an instrument at a sample rate in Hz.
    pub fn settings(self, sample_rate: f64) -> EngineSettings {
        let (widest_spacing, max_iterations, tolerance) = match self {
            Self::Draft if sample_rate < ENOUGH_FOR_FRETS => (OF_LIVE, 20, 1e-8),
            Self::Draft => (f64::INFINITY, 20, 1e-8),
            Self::Live => (OF_LIVE, 20, 1e-9),
            Self::Studio => (3e-3, 50, 1e-14),
            Self::Reference => (1.5e-3, 200, 1e-16),
        };
        let stencil = Stencil::Wide;
        EngineSettings { sample_rate, widest_spacing, stencil, max_iterations, tolerance }
    }
}

impl fmt::Display for Quality {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.name())
    }
}

impl FromStr for Quality {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|quality| quality.name() == name)
            // (Who asks for one says which was asked for.)
            .ok_or_else(|| {
                let [others @ .., last] = Self::ALL.map(Self::name);
                format!("must be {} or {last}", others.join(", "))
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_and_others_are_told_what_there_is() {
        assert!(Quality::ALL.into_iter().all(|quality| quality.name().parse() == Ok(quality)));
        // What was wrong stands before it on the command line.
        assert_eq!("best".parse::<Quality>(), Err("must be draft, live, studio or reference".to_owned()));
    }
}
