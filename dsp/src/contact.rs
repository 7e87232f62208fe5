//! The one contact law: board, frets and fingers alike.
//!
//! A contact stores Φ(η) = K/(α+1)·\[η\]₊^(α+1) when the penetration η is positive. Between step
//! n − 1 and n + 1 the penetration changes by r and the force is the discrete gradient
//! λ(r) = (Φ(ηⁿ⁻¹ + r) − Φ(ηⁿ⁻¹))/r, plus P r for a lossy (Hunt–Crossley) one, and never pulls:
//! f = max(0, λ + P r). This f is non-decreasing in r because Φ is convex, and
//! (f − λ) r ≥ 0, so a contact never creates energy.

mod gradient;

use std::ops::RangeInclusive;

use crate::error::Error;
pub use gradient::Before;

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
    /// What a stiffness K may be, N/m^α.
    pub(crate) const STIFFNESS: RangeInclusive<f64> = 1e-3..=1e30;
    /// What an exponent α may be.
    pub(crate) const EXPONENT: RangeInclusive<f64> = 1.0..=5.0;

    /// A law of stiffness K > 0 (N/m^α) and exponent 1 ≤ α ≤ 5.
    ///
    /// # Errors
    /// When either is out of range; `name` says whose they are.
    pub fn new(name: &str, stiffness: f64, exponent: f64) -> Result<Self, Error> {
        // The full name is put together only for a refusal: whoever places a good finger between steps allocates nothing.
        let within = |of, value, range: RangeInclusive<f64>, unit| {
            crate::error::within(of, value, *range.start(), *range.end(), unit)
        };
        within("stiffness", stiffness, Self::STIFFNESS, "N/m^exponent")
            .and_then(|_| within("exponent", exponent, Self::EXPONENT, ""))
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
            if self.knee == f64::INFINITY {
                return self.with_stiffness(self.stiffness.min(slope));
            }
            // With a knee it is straight from the start, and less steep than its stiffness.
            return if slope < self.at_knee.slope { self.straight_at_once(slope) } else { *self };
        }
        let knee = libm::pow(slope / (self.exponent * self.stiffness), 1.0 / (self.exponent - 1.0));
        if knee < LEAST_KNEE {
            return self.straight_at_once(slope);
        }
        if knee < self.knee { self.straight_beyond(knee) } else { *self }
    }

    /// The same law as a straight line from the start.
    fn straight_at_once(&self, slope: f64) -> Self {
        let (force, energy) = (slope * LEAST_KNEE, 0.0);
        ContactLaw { knee: LEAST_KNEE, at_knee: Knee { force, energy, slope }, ..*self }
    }

    /// The same law with something in between that gives way by `flexibility`, m/N: beyond the penetration where it gives way
    /// more easily than the contact itself, the force goes on as a straight line.
    pub fn giving_way(&self, flexibility: f64) -> Self {
        let slope = 1.0 / flexibility;
        if self.exponent > 1.0 || slope >= self.stiffness {
            return self.no_steeper_than(slope);
        }
        self.straight_at_once(slope)
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

    /// The same law with another stiffness: every force and energy in proportion to it, beyond the knee too, which stays
    /// where it is.
    pub fn with_stiffness(&self, stiffness: f64) -> Self {
        let times = stiffness / self.stiffness;
        let Knee { force, energy, slope } = self.at_knee;
        let at_knee = Knee { force: force * times, energy: energy * times, slope: slope * times };
        ContactLaw { stiffness, at_knee, ..*self }
    }

    /// φ(η) = Φ′(η), K\[η\]₊^α up to the knee: the static force, N.
    #[inline(always)]
    pub fn force(&self, penetration: f64) -> f64 {
        self.stored(penetration).0
    }

    /// φ(η) of what the contact itself is pressed in by at most, N: up to the knee, where something else
    /// [gives way](ContactLaw::giving_way) beyond it.
    #[inline(always)]
    pub fn own_force(&self, penetration: f64) -> f64 {
        if penetration > self.knee { self.at_knee.force } else { self.curved(penetration).0 }
    }

    /// φ(η) and Φ(η).
    #[inline(always)]
    fn stored(&self, penetration: f64) -> (f64, f64) {
        self.stored_from(penetration, self.root(penetration))
    }

    /// The same where the [root](ContactLaw::root) is known.
    #[inline(always)]
    fn stored_from(&self, penetration: f64, root: f64) -> (f64, f64) {
        if penetration > self.knee { self.straight(penetration) } else { self.curved_from(penetration, root) }
    }

    /// K\[η\]₊^α and K\[η\]₊^(α+1)/(α+1).
    #[inline(always)]
    fn curved(&self, penetration: f64) -> (f64, f64) {
        self.curved_from(penetration, self.root(penetration))
    }

    /// √\[η\]₊ where the powers are made of it, and otherwise 0.
    #[inline(always)]
    fn root(&self, penetration: f64) -> f64 {
        match self.power {
            Power::ThreeHalves | Power::FiveHalves => penetration.max(0.0).sqrt(),
            Power::One | Power::Two | Power::Three | Power::General => 0.0,
        }
    }

    /// As [`curved`](ContactLaw::curved) where the [root](ContactLaw::root) is known.
    #[inline(always)]
    fn curved_from(&self, penetration: f64, root: f64) -> (f64, f64) {
        if penetration <= 0.0 {
            return (0.0, 0.0);
        }
        let e = penetration;
        // (What takes long, a root or a power, is multiplied by last: nothing else then waits for it.)
        let (whole, last) = match self.power {
            Power::One => (e, 1.0),
            Power::ThreeHalves => (e, root),
            Power::Two => (e * e, 1.0),
            Power::FiveHalves => (e * e, root),
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
}

/// The smallest knee, m: far below anything there is, and no power of it is 0.
const LEAST_KNEE: f64 = 1e-50;

#[cfg(test)]
mod tests {
    use super::ContactLaw;

    /// Also where the exponent is so near to 1 that the law is too steep from the first touch on.
    #[test]
    fn no_law_is_steeper_than_it_may_be() {
        for exponent in [1.0, 1.0001, 1.01, 1.05, 1.5, 5.0] {
            for stiffness in [1e3, 1e9, 1e15] {
                let law = ContactLaw::new("test", stiffness, exponent)
                    .expect("it is in range")
                    .no_steeper_than(1e8);
                for penetration in [1e-45, 1e-30, 1e-12, 1e-6, 1e-3] {
                    let slope = law.slope(penetration);
                    assert!(
                        slope <= 1e8 * (1.0 + 1e-12),
                        "{stiffness}, {exponent}: {slope} at {penetration}"
                    );
                }
            }
        }
    }

    /// Before the knee and beyond it, whatever the knee came from.
    #[test]
    fn another_stiffness_changes_all_forces_alike() {
        let law = |exponent| ContactLaw::new("test", 1e9, exponent).expect("it is in range");
        let laws = [
            law(1.5),
            law(1.5).no_steeper_than(1e6),
            law(1.0001).no_steeper_than(1e6),
            law(1.0).giving_way(1e-6),
        ];
        for law in laws {
            assert_eq!(law.with_stiffness(law.stiffness()), law);
            let stiffer = law.with_stiffness(8.0 * law.stiffness());
            for penetration in [1e-12, 1e-6, 1e-4, 1e-2] {
                let pairs = [
                    (law.force(penetration), stiffer.force(penetration)),
                    (law.energy(penetration), stiffer.energy(penetration)),
                    (law.slope(penetration), stiffer.slope(penetration)),
                ];
                for (before, now) in pairs {
                    assert!(
                        (now / before - 8.0).abs() < 1e-12,
                        "{law:?} at {penetration}: {before} to {now}"
                    );
                }
            }
        }
    }

    /// A contact of which something gives way by 1 mm/N behind it, of an exponent.
    const FLEXIBILITY: f64 = 1e-3;

    fn plain_and_giving_way(exponent: f64) -> [ContactLaw; 2] {
        let plain = ContactLaw::new("test", 2e7, exponent).expect("it is in range");
        [plain, plain.giving_way(FLEXIBILITY)]
    }

    /// Below the knee the contact alone decides; the knee is where it gives way as easily as what is behind it; and beyond it the
    /// force goes on along the tangent, and the energy is what that takes.
    #[test]
    fn what_gives_way_is_the_softer_of_the_two() {
        for exponent in [1.2, 1.5, 2.0, 2.3, 3.0, 5.0] {
            let [plain, law] = plain_and_giving_way(exponent);
            let knee = law.knee();
            // αKη^(α−1) = 1/C.
            let expected = libm::pow(1.0 / (exponent * 2e7 * FLEXIBILITY), 1.0 / (exponent - 1.0));
            assert!((knee / expected - 1.0).abs() < 1e-14, "{exponent}: {knee} m, {expected} m");
            for part in [1e-6, 0.1, 0.5, 1.0] {
                let deep = part * knee;
                assert_eq!(law.force(deep), plain.force(deep));
                assert_eq!(law.energy(deep), plain.energy(deep));
                assert_eq!(law.slope(deep), plain.slope(deep));
                assert_eq!(law.own_force(deep), plain.force(deep));
            }
            for part in [1.5, 3.0, 100.0] {
                let beyond = (part - 1.0) * knee;
                let force = plain.force(knee) + beyond / FLEXIBILITY;
                let energy = plain.energy(knee) + 0.5 * (plain.force(knee) + force) * beyond;
                // Some roundings of powers and sums.
                let near = |value: f64, expected: f64| (value / expected - 1.0).abs() < 1e-14;
                let deep = part * knee;
                assert!(near(law.force(deep), force), "{exponent}: {} N, {force} N", law.force(deep));
                assert!(near(law.energy(deep), energy), "{exponent}: {} J, {energy} J", law.energy(deep));
                assert!(near(law.slope(deep), 1.0 / FLEXIBILITY), "{exponent}: {} N/m", law.slope(deep));
                assert!(near(law.own_force(deep), plain.force(knee)));
                assert!(near(law.penetration_at(force), deep));
            }
        }
    }

    /// Two springs of exponent 1 are one: the softer of the two, from the first touch on.
    #[test]
    fn of_two_straight_springs_the_softer_one_is_left() {
        let [plain, law] = plain_and_giving_way(1.0);
        for deep in [1e-9, 1e-6, 1e-3] {
            let force = deep / FLEXIBILITY;
            assert!((law.force(deep) / force - 1.0).abs() < 1e-14, "{deep}: {} N", law.force(deep));
            assert!((law.energy(deep) / (0.5 * force * deep) - 1.0).abs() < 1e-14);
            assert!(law.own_force(deep) < 1e-14 * force, "the contact itself is hardly pressed in");
        }
        // Behind a softer contact, what hardly gives way changes nothing.
        let hard = plain.giving_way(0.9 / 2e7);
        assert_eq!(hard, plain);
    }

    /// A contact is pressed in as its law says of the force that there is, and the rest is what gives way.
    #[test]
    fn what_a_contact_is_pressed_in_by_has_its_force() {
        for exponent in [1.0, 1.2, 1.5, 2.3, 5.0] {
            let [plain, law] = plain_and_giving_way(exponent);
            let scale = if exponent > 1.0 { law.knee() } else { 1e-6 };
            for part in [0.1, 0.9, 1.0, 1.1, 3.0, 1e3] {
                let deep = part * scale;
                let own = law.own_penetration(deep);
                assert!(
                    (plain.force(own) / law.force(deep) - 1.0).abs() < 1e-14,
                    "{exponent}: {own} of {deep} m"
                );
                assert!(own <= deep, "{exponent}: {own} of {deep} m");
                assert_eq!(own == deep, exponent > 1.0 && part <= 1.0, "{exponent}: {own} of {deep} m");
                assert_eq!(plain.own_penetration(deep), deep);
            }
        }
    }
}
