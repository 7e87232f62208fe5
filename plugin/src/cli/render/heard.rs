//! What is known of a sound once it has been played.

use crate::cli::wav::Findings;
use crate::performance::Compromises;

/// What is known of a sound once it has been played.
pub(super) struct Heard {
    /// Of the stereo sound.
    pub mix: Findings,
    /// Of the strings' own, where these were asked for, or labels.
    pub strings: Vec<Findings>,
    pub compromises: Compromises,
    pub lost_events: u64,
    pub samples: u64,
    /// Where it ends before it is quiet.
    pub cut: Option<Cut>,
}

/// The end of a sound that goes on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cut {
    /// How long after the song, s.
    pub after: f64,
    /// How loud it was then, as a part of the song's peak.
    pub level: f64,
}

impl Cut {
    /// How far it was below the song's peak then, dB.
    pub(super) fn below_peak(&self) -> f64 {
        -20.0 * libm::log10(self.level)
    }
}

impl Heard {
    /// Samples of all sounds that were no finite numbers.
    pub(super) fn not_finite(&self) -> u64 {
        self.strings.iter().chain([&self.mix]).map(|findings| findings.not_finite).sum()
    }
}
