//! The qualities a player chooses between: speed against accuracy, as measured in `docs/trade.md`.

use std::fmt;
use std::str::FromStr;

use crate::scene::Stencil;
use crate::settings::EngineSettings;

/// How much computing a sound may take.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quality {
    /// Least work: every string at the host's rate, the corrected stencil, contacts to 1e-9 m.
    Draft,
    /// For playing: the wide stencil, light strings at a multiple of the host's rate, contacts to 1e-10 m.
    #[default]
    Live,
    /// For a finished recording: finer grids for all but the heaviest strings.
    Studio,
    /// For comparison: grids as fine as anybody could hear.
    Reference,
}

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

    /// What it means for an instrument at a sample rate in Hz.
    pub fn settings(self, sample_rate: f64) -> EngineSettings {
        let (widest_spacing, stencil, max_iterations, tolerance) = match self {
            Self::Draft => (f64::INFINITY, Stencil::Corrected, 8, 1e-9),
            Self::Live => (6.3e-3, Stencil::Wide, 20, 1e-10),
            Self::Studio => (3e-3, Stencil::Wide, 50, 1e-14),
            Self::Reference => (1.5e-3, Stencil::Wide, 200, 1e-16),
        };
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
            .ok_or_else(|| format!("unknown quality {name:?}: must be draft, live, studio or reference"))
    }
}
