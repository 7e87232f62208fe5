//! The one contact law: board, frets and fingers alike.
//!
//! A contact stores Φ(η) = K/(α+1)·\[η\]₊^(α+1) when the penetration η is positive. Between step
//! n − 1 and n + 1 the penetration changes by r and the force is the discrete gradient
//! λ(r) = (Φ(ηⁿ⁻¹ + r) − Φ(ηⁿ⁻¹))/r, plus P r for a lossy (Hunt–Crossley) pad, and never pulls:
//! f = max(0, λ + P r). This f is non-decreasing in r because Φ is convex, and
//! (f − λ) r ≥ 0, so a contact never creates energy.

use crate::error::Error;

/// How the power x^α is taken: exponents that occur often need no general power.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Power {
    One,
    ThreeHalves,
    Two,
    FiveHalves,
    Three,
    General(f64),
}

/// A power-law spring: Φ(η) = K/(α+1)·\[η\]₊^(α+1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw {
    stiffness: f64,
    exponent: f64,
    power: Power,
}

impl ContactLaw {
    /// A law of stiffness K > 0 (N/m^α) and exponent 1 ≤ α ≤ 5.
    ///
    /// # Errors
    /// When either is out of range; `name` says whose they are.
    pub fn new(name: &str, stiffness: f64, exponent: f64) -> Result<Self, Error> {
        // The full name is put together only for a refusal: fingers are placed while processing, where
        // nothing may be allocated.
        crate::error::within("stiffness", stiffness, 1e-3, 1e30, "N/m^exponent")
            .and_then(|_| crate::error::within("exponent", exponent, 1.0, 5.0, ""))
            .map_err(|error| error.under(name))?;
        Ok(Self::known(stiffness, exponent))
    }

    /// A law whose numbers are known to be good.
    pub(crate) fn known(stiffness: f64, exponent: f64) -> Self {
        let power = match exponent {
            1.0 => Power::One,
            1.5 => Power::ThreeHalves,
            2.0 => Power::Two,
            2.5 => Power::FiveHalves,
            3.0 => Power::Three,
            alpha => Power::General(alpha),
        };
        ContactLaw { stiffness, exponent, power }
    }

    /// Stiffness K, N/m^α.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Exponent α.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// The same law with another stiffness.
    pub fn with_stiffness(&self, stiffness: f64) -> Self {
        ContactLaw { stiffness, ..*self }
    }

    /// φ(η) = Φ′(η) = K\[η\]₊^α, the static force, N.
    #[inline(always)]
    pub fn force(&self, penetration: f64) -> f64 {
        if penetration <= 0.0 {
            return 0.0;
        }
        let e = penetration;
        let power = match self.power {
            Power::One => e,
            Power::ThreeHalves => e * e.sqrt(),
            Power::Two => e * e,
            Power::FiveHalves => e * e * e.sqrt(),
            Power::Three => e * e * e,
            Power::General(alpha) => libm::pow(e, alpha),
        };
        self.stiffness * power
    }

    /// φ′(η), the static stiffness, N/m.
    #[inline(always)]
    pub fn slope(&self, penetration: f64) -> f64 {
        if penetration <= 0.0 {
            return if self.exponent == 1.0 && penetration == 0.0 { self.stiffness } else { 0.0 };
        }
        self.exponent * self.force(penetration) / penetration
    }

    /// Φ(η), the stored energy, J.
    #[inline(always)]
    pub fn energy(&self, penetration: f64) -> f64 {
        self.force(penetration) * penetration.max(0.0) / (self.exponent + 1.0)
    }

    /// The penetration at which the static force is `force`, m.
    pub fn penetration_at(&self, force: f64) -> f64 {
        if force <= 0.0 { 0.0 } else { libm::pow(force / self.stiffness, 1.0 / self.exponent) }
    }

    /// The discrete gradient λ and its slope dλ/dr over a change `r` from the penetration `before`,
    /// whose energy and force are given.
    #[inline(always)]
    pub fn gradient(&self, before: &Before, r: f64) -> (f64, f64) {
        let after = before.penetration + r;
        if after <= 0.0 && before.penetration <= 0.0 {
            return (0.0, 0.0);
        }
        let alpha = self.exponent;
        let middle = before.penetration + 0.5 * r;
        if r.abs() < NEARLY_STILL * middle {
            // λ about the midpoint m: λ = φ(m)[1 + α(α−1)/24 (r/m)²], its slope likewise.
            let force = self.force(middle);
            let x = r / middle;
            let curved = alpha * (alpha - 1.0);
            let lambda = force * (1.0 + curved / 24.0 * x * x);
            let slope = force / middle * (0.5 * alpha + curved * x * (1.0 / 12.0 + (alpha - 2.0) / 48.0 * x));
            return (lambda, slope);
        }
        let force = self.force(after);
        let energy = force * after.max(0.0) / (alpha + 1.0);
        let lambda = (energy - before.energy) / r;
        (lambda, ((force - lambda) / r).max(0.0))
    }
}

/// Below this |r|/η the quotient λ loses more digits to cancellation than the series to its next
/// term: 2e-16/1e-3 against (1e-3)⁴·α(α−1)(α−2)(α−3)/1920.
const NEARLY_STILL: f64 = 1e-3;

/// A contact as it was one step before the present one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Before {
    /// Penetration ηⁿ⁻¹, m.
    pub penetration: f64,
    /// Φ(ηⁿ⁻¹), J.
    pub energy: f64,
}

impl Before {
    /// The past of a contact of the given law.
    #[inline(always)]
    pub fn new(law: &ContactLaw, penetration: f64) -> Self {
        Before { penetration, energy: law.energy(penetration) }
    }
}
