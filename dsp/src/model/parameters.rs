//! The physical numbers of one string.

use crate::digits::plain;
use crate::error::{Error, within};
use crate::scene::StringSpec;

/// The physical numbers of one string: the first four above 0, the others 0 or more, all of them finite, and `loss_0` at most 1e12.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StringParameters {
    /// Length, m.
    pub length: f64,
    /// Mass per length, kg/m.
    pub linear_density: f64,
    /// Tension at rest, N.
    pub tension: f64,
    /// The largest tension that bends will reach, N; the grid is made for it.
    pub tension_limit: f64,
    /// Young's modulus of the core, Pa.
    pub youngs_modulus: f64,
    /// Radius of the core, m.
    pub core_radius: f64,
    /// Loss of all frequencies alike, 1/s.
    pub loss_0: f64,
    /// Loss that grows with frequency, m²/s.
    pub loss_1: f64,
    /// Whether stretching raises the tension.
    pub tension_modulation: bool,
}

/// What scenes and set-ups may ask for; a model bears more.
impl StringParameters {
    /// Mass per length, kg/m.
    pub(crate) const LINEAR_DENSITY: [f64; 2] = [1e-7, 1e2];
    /// Tension at rest, N.
    pub(crate) const TENSION: [f64; 2] = [1e-3, 1e6];
    /// Young's modulus of the core, Pa.
    pub(crate) const YOUNGS_MODULUS: [f64; 2] = [0.0, 1e13];
    /// Radius of the core, m.
    pub(crate) const CORE_RADIUS: [f64; 2] = [0.0, 0.1];
    /// Loss of all frequencies alike, 1/s.
    pub(crate) const LOSS_0: [f64; 2] = [0.0, 1e4];
    /// Loss that grows with frequency, m²/s.
    pub(crate) const LOSS_1: [f64; 2] = [0.0, 1e2];
}

impl StringParameters {
    /// The string of a scene at its first moment.
    pub fn from_spec(spec: &StringSpec) -> Self {
        let string = StringParameters {
            length: spec.length,
            linear_density: spec.linear_density,
            tension: spec.tension.at(0.0),
            tension_limit: spec.tension.largest(),
            youngs_modulus: spec.youngs_modulus,
            core_radius: spec.core_radius,
            loss_0: 0.0,
            loss_1: 0.0,
            tension_modulation: spec.tension_modulation,
        };
        let [loss_0, loss_1] = spec.losses_of(&string);
        StringParameters { loss_0, loss_1, ..string }
    }

    /// Refuses what no string can have.
    pub(super) fn check(&self) -> Result<(), Error> {
        let above_zero = [
            ("length", self.length, "m"),
            ("linear_density", self.linear_density, "kg/m"),
            ("tension", self.tension, "N"),
            ("tension_limit", self.tension_limit, "N"),
        ];
        for (name, value, unit) in above_zero {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::range(
                    name,
                    plain(value),
                    format!("it must be above 0 {unit}, and finite"),
                ));
            }
        }
        let zero_or_more = [
            ("youngs_modulus", self.youngs_modulus, "Pa"),
            ("core_radius", self.core_radius, "m"),
            ("loss_1", self.loss_1, "m²/s"),
        ];
        for (name, value, unit) in zero_or_more {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::range(
                    name,
                    plain(value),
                    format!("it must be 0 {unit} or more, and finite"),
                ));
            }
        }
        within("loss_0", self.loss_0, 0.0, MOST_LOSS, "1/s").map(drop)
    }

    /// Axial stiffness EA, N, of the core.
    pub fn axial_stiffness(&self) -> f64 {
        self.youngs_modulus * std::f64::consts::PI * self.core_radius * self.core_radius
    }

    /// What stretching adds to the tension, EA/(2L)·∫(∂ₓu)² dx, N, by the sum of squared differences between neighbours (m²) on a
    /// grid of a spacing (m); 0 without tension modulation.
    pub(crate) fn stretch_tension(&self, stretching: f64, spacing: f64) -> f64 {
        if !self.tension_modulation {
            return 0.0;
        }
        self.axial_stiffness() / (2.0 * self.length * spacing) * stretching
    }

    /// κ² = EI/ρ, m⁴/s².
    pub fn kappa_squared(&self) -> f64 {
        let r = self.core_radius;
        self.youngs_modulus * std::f64::consts::PI * r * r * r * r / 4.0 / self.linear_density
    }

    /// γ², 1/m², of a wave of a frequency, Hz, on the string under its tension at rest: what solves ω² = c²γ² + κ²γ⁴.
    pub fn wavenumber_squared(&self, frequency: f64) -> f64 {
        let omega = std::f64::consts::TAU * frequency;
        let (c2, kappa2, omega2) = (self.tension / self.linear_density, self.kappa_squared(), omega * omega);
        // Written so that nothing cancels, however little the string resists bending, and that it need not at all.
        2.0 * omega2 / (c2 + (c2 * c2 + 4.0 * kappa2 * omega2).sqrt())
    }
}

/// The largest loss σ₀ of a model, 1/s.
///
/// A step leaves (1 − σ₀k)/(1 + σ₀k) of a motion, which doubles know to 2⁻⁵³, and the loss that is realised is made of what lies
/// between that and −1, 2/(1 + σ₀k): known to σ₀k/2⁵⁴ of itself. From σ₀k = 2⁵³ on nothing lies between them, and the loss would be
/// infinite. This one is realised to seven digits at the slowest rate that there is, 1 kHz. (From 1/k on a motion turns round in
/// each step, and dies away the more slowly.)
const MOST_LOSS: f64 = 1e12;
