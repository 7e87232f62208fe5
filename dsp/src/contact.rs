//! The one contact law: board, frets and fingers alike.
//!
//! A contact stores Φ(η) = K/(α+1)·\[η\]₊^(α+1) when the penetration η is positive. Between step
//! n − 1 and n + 1 the penetration changes by r and the force is the discrete gradient
//! λ(r) = (Φ(ηⁿ⁻¹ + r) − Φ(ηⁿ⁻¹))/r, plus P r for a lossy (Hunt–Crossley) one, and never pulls:
//! f = max(0, λ + P r). This f is non-decreasing in r because Φ is convex, and
//! (f − λ) r ≥ 0, so a contact never creates energy.

mod gradient;

use crate::error::{Error, ranged};
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
    pub(crate) const STIFFNESS: [f64; 2] = [1e-3, 1e30];
    /// What an exponent α may be.
    pub(crate) const EXPONENT: [f64; 2] = [1.0, 5.0];

    /// A law of stiffness K, 1e-3 to 1e30 N/m^α, and exponent α, 1 to 5.
    ///
    /// # Errors
    /// When either is out of range; `name` says whose they are.
    pub fn new(name: &str, stiffness: f64, exponent: f64) -> Result<Self, Error> {
        ranged("stiffness", stiffness, Self::STIFFNESS, "N/m^exponent")
            .and_then(|_| ranged("exponent", exponent, Self::EXPONENT, ""))
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
        // With a knee it is nowhere steeper than beyond that.
        if self.knee < f64::INFINITY && self.at_knee.slope <= slope {
            return *self;
        }
        if self.exponent == 1.0 {
            if self.knee == f64::INFINITY {
                return self.with_stiffness(self.stiffness.min(slope));
            }
            // With a knee it is straight from the start, and less steep than its stiffness.
            return self.straight_at_once(slope);
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
    /// where it is. It is not looked at here: a [model](crate::Model::new) refuses those of frets and board that are out of range.
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
        self.own_part(penetration, self.force(penetration))
    }

    /// The same where φ(η) is known.
    #[inline(always)]
    pub(crate) fn own_part(&self, penetration: f64, force: f64) -> f64 {
        if penetration > self.knee { self.at_knee.force } else { force }
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
            // One that is straight from the start has the slope beyond its knee there, too.
            let first = if self.knee > LEAST_KNEE { self.stiffness } else { self.at_knee.slope };
            return if self.exponent == 1.0 && penetration == 0.0 { first } else { 0.0 };
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
mod tests;
