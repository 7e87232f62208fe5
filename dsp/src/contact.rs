//! The one contact law: board, frets and fingers alike.
//!
//! A contact stores Φ(η) = K/(α+1)·\[η\]₊^(α+1) when the penetration η is positive. Between step
//! n − 1 and n + 1 the penetration changes by r and the force is the discrete gradient
//! λ(r) = (Φ(ηⁿ⁻¹ + r) − Φ(ηⁿ⁻¹))/r, plus P r for a lossy (Hunt–Crossley) one, and never pulls:
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
    General,
}

/// A power-law spring: Φ(η) = K/(α+1)·\[η\]₊^(α+1), straight beyond the [`knee`](ContactLaw::knee).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw {
    stiffness: f64,
    exponent: f64,
    power: Power,
    /// 1/(α + 1).
    share: f64,
    knee: f64,
    /// φ, Φ and φ′ at the knee.
    at_knee: Knee,
}

/// A law where it becomes straight.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Knee {
    force: f64,
    energy: f64,
    slope: f64,
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
    pub(crate) const fn known(stiffness: f64, exponent: f64) -> Self {
        let power = match exponent {
            1.0 => Power::One,
            1.5 => Power::ThreeHalves,
            2.0 => Power::Two,
            2.5 => Power::FiveHalves,
            3.0 => Power::Three,
            _ => Power::General,
        };
        // There is no knee.
        let at_knee = Knee { force: 0.0, energy: 0.0, slope: 0.0 };
        ContactLaw { stiffness, exponent, power, share: 1.0 / (exponent + 1.0), knee: f64::INFINITY, at_knee }
    }

    /// The same law, growing no steeper than `slope`, N/m: beyond the penetration where φ′ reaches it the
    /// force goes on as a straight line. With α = 1 that is a smaller stiffness.
    pub fn no_steeper_than(&self, slope: f64) -> Self {
        if self.exponent == 1.0 {
            return self.with_stiffness(self.stiffness.min(slope));
        }
        let knee = libm::pow(slope / (self.exponent * self.stiffness), 1.0 / (self.exponent - 1.0));
        if knee < self.knee { self.straight_beyond(knee.max(LEAST_KNEE)) } else { *self }
    }

    /// The same law with something in between that gives way by `flexibility`, m/N: beyond the penetration where it gives way
    /// more easily than the contact itself, the force goes on as a straight line.
    pub fn giving_way(&self, flexibility: f64) -> Self {
        let slope = 1.0 / flexibility;
        if self.exponent > 1.0 || slope >= self.stiffness {
            return self.no_steeper_than(slope);
        }
        let (force, energy) = (slope * LEAST_KNEE, 0.0);
        ContactLaw { knee: LEAST_KNEE, at_knee: Knee { force, energy, slope }, ..*self }
    }

    fn straight_beyond(&self, knee: f64) -> Self {
        let (force, energy) = self.curved(knee);
        let slope = self.exponent * force / knee;
        ContactLaw { knee, at_knee: Knee { force, energy, slope }, ..*self }
    }

    /// How much of a penetration the contact itself is pressed in by, m: beyond the knee by as much as its force takes, and
    /// what is between gives way by the rest.
    pub fn own_penetration(&self, penetration: f64) -> f64 {
        if penetration <= self.knee {
            return penetration;
        }
        libm::pow(self.straight(penetration).0 / self.stiffness, 1.0 / self.exponent).min(penetration)
    }

    /// The penetration beyond which the force grows as a straight line, m.
    pub fn knee(&self) -> f64 {
        self.knee
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

    /// φ(η) = Φ′(η), K\[η\]₊^α up to the knee: the static force, N.
    #[inline(always)]
    pub fn force(&self, penetration: f64) -> f64 {
        self.stored(penetration).0
    }

    /// φ(η) of what the contact itself is pressed in by at most: up to the knee, N. Beyond it something else gives way.
    #[inline(always)]
    pub fn own_force(&self, penetration: f64) -> f64 {
        if penetration > self.knee { self.at_knee.force } else { self.curved(penetration).0 }
    }

    /// φ(η) and Φ(η).
    #[inline(always)]
    fn stored(&self, penetration: f64) -> (f64, f64) {
        if penetration > self.knee { self.straight(penetration) } else { self.curved(penetration) }
    }

    /// K\[η\]₊^α and K\[η\]₊^(α+1)/(α+1).
    #[inline(always)]
    fn curved(&self, penetration: f64) -> (f64, f64) {
        if penetration <= 0.0 {
            return (0.0, 0.0);
        }
        let e = penetration;
        // (What takes long, a root or a power, is multiplied by last: nothing else then waits for it.)
        let (whole, last) = match self.power {
            Power::One => (e, 1.0),
            Power::ThreeHalves => (e, e.sqrt()),
            Power::Two => (e * e, 1.0),
            Power::FiveHalves => (e * e, e.sqrt()),
            Power::Three => (e * e * e, 1.0),
            Power::General => (1.0, libm::pow(e, self.exponent)),
        };
        let force = self.stiffness * whole;
        (force * last, force * (e * self.share) * last)
    }

    /// Force and energy beyond the knee.
    #[inline(always)]
    fn straight(&self, penetration: f64) -> (f64, f64) {
        let (Knee { force, energy, slope }, beyond) = (self.at_knee, penetration - self.knee);
        (force + slope * beyond, energy + (force + 0.5 * slope * beyond) * beyond)
    }

    /// φ′(η), the static stiffness, N/m.
    #[inline(always)]
    pub fn slope(&self, penetration: f64) -> f64 {
        if penetration <= 0.0 {
            return if self.exponent == 1.0 && penetration == 0.0 { self.stiffness } else { 0.0 };
        }
        if penetration > self.knee {
            return self.at_knee.slope;
        }
        self.exponent * self.curved(penetration).0 / penetration
    }

    /// Φ(η), the stored energy, J.
    #[inline(always)]
    pub fn energy(&self, penetration: f64) -> f64 {
        self.stored(penetration).1
    }

    /// The penetration at which the static force is `force`, m.
    pub fn penetration_at(&self, force: f64) -> f64 {
        if force <= 0.0 {
            return 0.0;
        }
        let curved = libm::pow(force / self.stiffness, 1.0 / self.exponent);
        if curved <= self.knee {
            return curved;
        }
        self.knee + (force - self.at_knee.force) / self.at_knee.slope
    }

    /// The discrete gradient λ and its slope dλ/dr over a change `r` from the penetration `before`,
    /// whose energy and force are given.
    #[inline(always)]
    pub fn gradient(&self, before: &Before, r: f64) -> (f64, f64) {
        let after = before.penetration + r;
        if after <= NOTHING && before.penetration <= NOTHING {
            return (0.0, 0.0);
        }
        if before.penetration > 0.0 && after > 0.0 {
            let (low, high) = (before.penetration.min(after), before.penetration.max(after));
            if high <= self.knee {
                return self.pressed_gradient(before, r);
            }
            if low >= self.knee {
                // On the straight part λ is the force half way, whatever the change.
                return (self.straight(0.5 * (low + high)).0, 0.5 * self.at_knee.slope);
            }
            return self.gradient_across(before, r);
        }
        // Out of contact at one end: nothing is subtracted from what is stored at the other.
        let (force, energy) = self.stored(after);
        // (A division need not wait for the root.)
        let inverse = 1.0 / r;
        let lambda = (energy - before.energy) * inverse;
        (lambda, ((force - lambda) * inverse).max(0.0))
    }

    /// The same in contact at both ends, a and b: with s = √a and t = √b the differences of powers are divided by
    /// b − a = (t + s)(t − s) once and for all, so that no digit is lost however near a is to b, and nothing is decided
    /// by how near. For α = 3/2, b^(5/2) − a^(5/2) = (t − s)(t⁴ + t³s + t²s² + ts³ + s⁴).
    #[inline(always)]
    fn pressed_gradient(&self, before: &Before, r: f64) -> (f64, f64) {
        let (a, s) = (before.penetration, before.root);
        let b = a + r;
        // λ over K/(α + 1), and its slope likewise.
        let (lambda, slope) = match self.power {
            Power::One => (a + b, 1.0),
            Power::ThreeHalves => {
                let t = b.sqrt();
                let inverse = 1.0 / (s + t);
                let sum = (a * a + b * (a + b)) + (s * t) * (a + b);
                let slope = t * (3.0 * b + 4.0 * a) + s * (6.0 * b + 2.0 * a);
                (sum * inverse, 0.5 * slope * (inverse * inverse))
            }
            Power::Two => (a * a + b * (a + b), a + 2.0 * b),
            Power::FiveHalves => {
                let t = b.sqrt();
                let inverse = 1.0 / (s + t);
                let square = a * a + b * (a + b);
                let sum = (a * a + b * b) * (a + b) + (s * t) * square;
                let slope = t * (5.0 * b * b + a * (8.0 * b + 4.0 * a))
                    + s * (10.0 * b * b + a * (6.0 * b + 2.0 * a));
                (sum * inverse, 0.5 * slope * (inverse * inverse))
            }
            Power::Three => ((a * a + b * b) * (a + b), 3.0 * b * b + a * (2.0 * b + a)),
            Power::General => return self.general_gradient(before, r),
        };
        let stiffness = self.stiffness * self.share;
        (stiffness * lambda, stiffness * slope)
    }

    /// The same for other exponents: as a quotient, or about the midpoint where that would lose
    /// digits.
    #[inline(never)]
    fn general_gradient(&self, before: &Before, r: f64) -> (f64, f64) {
        let alpha = self.exponent;
        let middle = before.penetration + 0.5 * r;
        if r.abs() < NEARLY_STILL * middle {
            // λ about the midpoint m: λ = φ(m)[1 + α(α−1)/24 (r/m)²], its slope likewise.
            let force = self.curved(middle).0;
            let x = r / middle;
            let curved = alpha * (alpha - 1.0);
            let lambda = force * (1.0 + curved / 24.0 * x * x);
            let slope = force / middle * (0.5 * alpha + curved * x * (1.0 / 12.0 + (alpha - 2.0) / 48.0 * x));
            return (lambda, slope);
        }
        let (force, energy) = self.curved(before.penetration + r);
        let lambda = (energy - before.energy) / r;
        (lambda, ((force - lambda) / r).max(0.0))
    }

    /// The same in contact on both sides of the knee: the works on both parts add up.
    #[cold]
    #[inline(never)]
    fn gradient_across(&self, before: &Before, r: f64) -> (f64, f64) {
        let after = before.penetration + r;
        let (low, high) = (before.penetration.min(after), before.penetration.max(after));
        let at_knee = Before::new(self, self.knee);
        let (below, beyond) = (low - self.knee, high - self.knee);
        let curved = self.pressed_gradient(&at_knee, below).0;
        let lambda = (self.straight(0.5 * (self.knee + high)).0 * beyond - curved * below) / (high - low);
        let steepest = self.at_knee.slope;
        let slope = if (high - low) < NEARLY_STILL * high {
            0.5 * steepest
        } else {
            ((self.force(after) - lambda) / r).clamp(0.0, steepest)
        };
        (lambda, slope)
    }
}

/// A penetration, m, that is none: for smaller ones the inverse of a change is no number.
const NOTHING: f64 = 1e-300;

/// The smallest knee, m: far below anything there is, and no power of it is 0.
const LEAST_KNEE: f64 = 1e-50;

/// Below this |r|/η the quotient λ loses more digits to cancellation than the series to its next
/// term: 2e-16/1e-3 against (1e-3)⁴·α(α−1)(α−2)(α−3)/1920.
const NEARLY_STILL: f64 = 1e-3;

/// A contact as it was one step before the present one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Before {
    /// Penetration ηⁿ⁻¹, m.
    pub penetration: f64,
    /// Φ(ηⁿ⁻¹), J.
    pub energy: f64,
    /// √\[ηⁿ⁻¹\]₊, m^½.
    root: f64,
}

impl Before {
    /// Out of contact.
    pub(crate) const NOTHING: Before = Before { penetration: 0.0, energy: 0.0, root: 0.0 };

    /// The past of a contact of the given law.
    #[inline(always)]
    pub fn new(law: &ContactLaw, penetration: f64) -> Self {
        Before { penetration, energy: law.energy(penetration), root: penetration.max(0.0).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::{Before, ContactLaw};
    use crate::pickup::FIELD;

    /// ∫₀¹ f(x) dx by the rule of five that pickups have, in each of many pieces.
    fn integral(f: impl Fn(f64) -> f64) -> f64 {
        const PIECES: usize = 64;
        let piece = |index: usize| -> f64 {
            let at = |x: f64| (index as f64 + 0.5 + 0.5 * x) / PIECES as f64;
            FIELD.iter().map(|(x, weight)| 0.5 * weight * f(at(*x))).sum()
        };
        (0..PIECES).map(piece).sum::<f64>() / PIECES as f64
    }

    /// λ = ∫₀¹ φ(a + xr) dx and its slope ∫₀¹ xφ′(a + xr) dx, whatever the exponent and however small the change; and
    /// λr is the difference of what is stored.
    #[test]
    fn the_discrete_gradient_is_the_mean_of_the_law() {
        for exponent in [1.0, 1.5, 2.0, 2.3, 2.5, 3.0, 4.7] {
            let law = ContactLaw::new("test", 3e9, exponent).expect("it is in range");
            for before in [1e-9, 1e-6, 2e-4] {
                for part in [1e-15, 1e-9, 1e-5, 0.9e-3, 1.1e-3, 0.03, 0.4, 3.0] {
                    for r in [part * before, -part * before / (1.0 + part)] {
                        let past = Before::new(&law, before);
                        let (lambda, slope) = law.gradient(&past, r);
                        let at = |x: f64| before + x * r;
                        let (mean, steep) =
                            (integral(|x| law.force(at(x))), integral(|x| x * law.slope(at(x))));
                        // Exponents without a closed form are taken as a quotient, which loses three digits of λ
                        // and six of its slope, or as a series.
                        let (force, stiffness) =
                            if (2.0 * exponent).fract() == 0.0 { (4e-15, 8e-15) } else { (2e-12, 2e-9) };
                        assert!(
                            (lambda / mean - 1.0).abs() < force,
                            "{exponent}, {before}, {r}: {lambda} {mean}"
                        );
                        assert!(
                            (slope / steep - 1.0).abs() < stiffness,
                            "{exponent}, {before}, {r}: {slope}"
                        );
                        let (stored, then) = (law.energy(before + r), law.energy(before));
                        let off = lambda * r - (stored - then);
                        assert!(off.abs() < 4e-15 * (stored + then), "{exponent}, {before}, {r}: {off:e}");
                    }
                }
            }
        }
    }
}
