//! One string of an instrument.

use serde::{Deserialize, Serialize};

use super::PITCH;
use crate::error::{Error, ranged, within};
use crate::model::StringParameters;

/// One string of an instrument.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SetupString {
    /// Name, such as `E4`.
    pub name: String,
    /// Pitch of the open string as a MIDI note number, 0 to 127, fractions allowed; 69 is 440 Hz.
    pub pitch: f64,
    /// Mass per length, kg/m, 1e-7 to 1e2.
    pub linear_density: f64,
    /// Young's modulus of the core, Pa, 0 to 1e13.
    pub youngs_modulus: f64,
    /// Radius of the core, m, 0 to 0.1.
    pub core_radius: f64,
    /// Loss of all frequencies alike, 1/s, 0 to 1e4: the amplitude of a partial of wavenumber γ decays as
    /// exp(−(loss_0 + loss_1 γ²)t), to a thousandth in T60 = ln(1000)/(loss_0 + loss_1 γ²).
    pub loss_0: f64,
    /// Loss that grows with frequency, m²/s, 0 to 1e2.
    pub loss_1: f64,
    /// How strongly the pickup senses this string, as a factor beside the other strings, 0 to 100.
    #[serde(default = "alike")]
    pub level: f64,
    /// Place in the stereo picture, −1 (left) to 1 (right).
    #[serde(default)]
    pub pan: f64,
}

fn alike() -> f64 {
    1.0
}

impl SetupString {
    /// How fast a partial (1 for the lowest, or between two) of a string of such a length, m, dies away, 1/s: σ₀ + σ₁γ², with the wavenumber γ
    /// that it has where both ends are fixed; 0 without losses.
    pub fn decay(&self, length: f64, partial: f64) -> f64 {
        let wavenumber = std::f64::consts::PI * partial / length;
        self.loss_0 + self.loss_1 * wavenumber * wavenumber
    }

    pub(super) fn check(&self, name: &str) -> Result<(), Error> {
        ranged(&format!("{name}.pitch"), self.pitch, PITCH, "as a MIDI note number")?;
        for (key, value, range, unit) in [
            ("linear_density", self.linear_density, StringParameters::LINEAR_DENSITY, "kg/m"),
            ("youngs_modulus", self.youngs_modulus, StringParameters::YOUNGS_MODULUS, "Pa"),
            ("core_radius", self.core_radius, StringParameters::CORE_RADIUS, "m"),
            ("loss_0", self.loss_0, StringParameters::LOSS_0, "1/s"),
            ("loss_1", self.loss_1, StringParameters::LOSS_1, "m²/s"),
        ] {
            ranged(&format!("{name}.{key}"), value, range, unit)?;
        }
        within(&format!("{name}.level"), self.level, 0.0, 100.0, "")?;
        within(&format!("{name}.pan"), self.pan, -1.0, 1.0, "").map(drop)
    }
}
