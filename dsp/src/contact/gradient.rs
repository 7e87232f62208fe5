//! The discrete gradient of a contact's energy, and its slope.

use super::{ContactLaw, Power};

impl ContactLaw {
    /// The discrete gradient λ and its slope dλ/dr over a change `r` from the penetration `before`,
    /// whose energy and force are given.
    #[inline(always)]
    pub fn gradient(&self, before: &Before, r: f64) -> (f64, f64) {
        let after = before.penetration + r;
        if before.penetration > NOTHING && after > NOTHING {
            if before.penetration <= self.knee && after <= self.knee {
                return self.pressed_gradient(before, r);
            }
            if before.penetration >= self.knee && after >= self.knee {
                // On the straight part λ is the force half way, whatever the change.
                return (self.straight(0.5 * (before.penetration + after)).0, 0.5 * self.at_knee.slope);
            }
            return self.gradient_across(before, r);
        }
        if before.penetration <= NOTHING && after <= NOTHING {
            return (0.0, 0.0);
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
    /// by how near. For α = 3/2, b^(5/2) − a^(5/2) = (t − s)(t⁴ + t³s + t²s² + ts³ + s⁴). (`docs/physics.md`, section 7, calls
    /// a, b, s and t η₁, η₂, p₁ and p₂.)
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
    /// √\[ηⁿ⁻¹\]₊, m^½, where the law asks for it.
    root: f64,
}

impl Before {
    /// Out of contact.
    pub(crate) const NOTHING: Before = Before { penetration: 0.0, energy: 0.0, root: 0.0 };

    /// The past of a contact of the given law.
    #[inline(always)]
    pub fn new(law: &ContactLaw, penetration: f64) -> Self {
        Self::with_force(law, penetration).0
    }

    /// The same with the static force φ(ηⁿ⁻¹), N.
    #[inline(always)]
    pub(crate) fn with_force(law: &ContactLaw, penetration: f64) -> (Self, f64) {
        let root = law.root(penetration);
        let (force, energy) = law.stored_from(penetration, root);
        (Before { penetration, energy, root }, force)
    }

    /// Out of contact by so much less than nothing, m.
    #[inline(always)]
    pub(crate) fn apart(penetration: f64) -> Self {
        Before { penetration, ..Self::NOTHING }
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

    /// ∫₀¹ f(x) dx of what is smooth but for a kink at `kink`, if that is on the way.
    fn integral_over(kink: f64, f: impl Fn(f64) -> f64) -> f64 {
        // (There is none where a law has no knee.)
        let kink = if kink > 0.0 && kink < 1.0 { kink } else { 1.0 };
        kink * integral(|x| f(kink * x)) + (1.0 - kink) * integral(|x| f(kink + (1.0 - kink) * x))
    }

    /// A law that is straight from about `knee` on, m: for it may grow no steeper than it is there, or for what gives way behind it.
    fn bent_at(law: &ContactLaw, knee: f64) -> [ContactLaw; 2] {
        let slope = law.slope(knee);
        [law.no_steeper_than(slope), law.giving_way(1.0 / slope)]
    }

    /// λ = ∫₀¹ φ(a + xr) dx and its slope ∫₀¹ xφ′(a + xr) dx, whatever the exponent, however small the change, and wherever the
    /// law becomes straight; and λr is the difference of what is stored.
    #[test]
    fn the_discrete_gradient_is_the_mean_of_the_law() {
        let mut across = 0;
        for exponent in [1.0, 1.5, 2.0, 2.3, 2.5, 3.0, 4.7] {
            let plain = ContactLaw::new("test", 3e9, exponent).expect("it is in range");
            for before in [1e-9_f64, 1e-6, 2e-4] {
                for part in [1e-15, 1e-9, 1e-5, 0.9e-3, 1.1e-3, 0.03, 0.4, 3.0] {
                    for r in [part * before, -part * before / (1.0 + part)] {
                        let (low, high) = (before.min(before + r), before.max(before + r));
                        let inside = [0.001, 0.3, 0.5, 0.97].map(|part| low + part * (high - low));
                        let knees = [0.2 * low, 0.999 * low, low, high, 1.001 * high, 5.0 * high];
                        let bent = inside.into_iter().chain(knees).flat_map(|knee| bent_at(&plain, knee));
                        // A tenth of the stiffness of the law itself, which is one of an exponent of 1 from the start.
                        let softer = plain.giving_way(10.0 / plain.slope(high));
                        for law in [plain, softer].into_iter().chain(bent) {
                            across += u32::from(law.knee() > low && law.knee() < high);
                            assert_is_the_mean(&law, before, r);
                        }
                    }
                }
            }
        }
        println!("{across} laws with a knee on the way");
        assert!(across > 1000);
    }

    fn assert_is_the_mean(law: &ContactLaw, before: f64, r: f64) {
        let exponent = law.exponent();
        let past = Before::new(law, before);
        let (lambda, slope) = law.gradient(&past, r);
        let at = |x: f64| before + x * r;
        let kink = (law.knee() - before) / r;
        let mean = integral_over(kink, |x| law.force(at(x)));
        let steep = integral_over(kink, |x| x * law.slope(at(x)));
        // Exponents without a closed form are taken as a quotient, which loses three digits of λ
        // and six of its slope, or as a series.
        let (force, stiffness) = if (2.0 * exponent).fract() == 0.0 { (4e-15, 8e-15) } else { (2e-12, 2e-9) };
        let (low, high) = (before.min(before + r), before.max(before + r));
        let across = law.knee() > low && law.knee() < high;
        // Across a knee the slope is a quotient, too, which over a thousandth of the way loses three digits and those that
        // the force has lost; and on less than that way it is that of the knee, from which the law's own is off by
        // α − 1 times as much.
        let stiffness = match (across, (high - low) / high < 1e-3) {
            (false, _) => stiffness,
            (true, false) => 2e3 * force,
            (true, true) => 1e-3 * (exponent - 1.0) + force,
        };
        let name = format!("{exponent}, {before}, {r}, knee at {}", law.knee());
        assert!((lambda / mean - 1.0).abs() < force, "{name}: {lambda} {mean}");
        assert!((slope / steep - 1.0).abs() < stiffness, "{name}: slope {slope} {steep}");
        let (stored, then) = (law.energy(before + r), law.energy(before));
        let off = lambda * r - (stored - then);
        assert!(off.abs() < 4e-15 * (stored + then), "{name}: {off:e}");
    }
}
