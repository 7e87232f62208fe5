//! The contact law and the solution of all contacts at once.

use nalgebra::{DMatrix, DVector};

use crate::numbers::largest;

/// A power-law contact, Φ(η) = K/(α+1) \[η\]₊^(α+1), that may go on along its tangent from some penetration on.
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// Stiffness K, N/m^α.
    pub stiffness: f64,
    /// Exponent α, at least 1.
    pub exponent: f64,
    /// The penetration from which the force is a straight line, m; infinite of a plain law.
    pub knee: f64,
}

impl Law {
    /// A plain law of stiffness K, N/m^α, and exponent α.
    pub fn new(stiffness: f64, exponent: f64) -> Self {
        Law { stiffness, exponent, knee: f64::INFINITY }
    }

    /// In series with a spring that gives way by so much, m/N: the force follows the law to where φ′ = αKη^(α−1) is that of the
    /// spring, and its tangent from there on. Of an exponent above 1.
    pub fn giving_way(self, flexibility: f64) -> Self {
        let Law { stiffness, exponent, .. } = self;
        Law { knee: (exponent * stiffness * flexibility).powf(-1.0 / (exponent - 1.0)), ..self }
    }

    /// Φ′ and Φ″ of the power, N and N/m.
    fn power(&self, penetration: f64) -> (f64, f64) {
        let (deep, alpha) = (penetration.max(0.0), self.exponent);
        (self.stiffness * deep.powf(alpha), self.stiffness * alpha * deep.powf(alpha - 1.0))
    }

    /// The part of a penetration before the knee, and the part beyond it, m.
    fn parts(&self, penetration: f64) -> (f64, f64) {
        (penetration.min(self.knee), (penetration - self.knee).max(0.0))
    }

    /// The static force Φ′(η), N.
    pub(super) fn force(&self, penetration: f64) -> f64 {
        let (bent, beyond) = self.parts(penetration);
        let (force, slope) = self.power(bent);
        if beyond > 0.0 { force + slope * beyond } else { force }
    }

    /// The same, but no more than at the knee, N.
    pub(super) fn force_at_most_of_the_knee(&self, penetration: f64) -> f64 {
        self.power(penetration.min(self.knee)).0
    }

    /// Φ of the power, J.
    fn energy_of_power(&self, penetration: f64) -> f64 {
        self.stiffness / (self.exponent + 1.0) * penetration.max(0.0).powf(self.exponent + 1.0)
    }

    /// The stored energy Φ(η), J.
    pub(super) fn energy(&self, penetration: f64) -> f64 {
        let (bent, beyond) = self.parts(penetration);
        self.energy_of_power(bent) + self.work_beyond(0.0, beyond)
    }

    /// What pressing in from `x` to `y` beyond the knee stores, J: (y − x)(φ + φ′ (x + y)/2) with φ and φ′ of the knee.
    fn work_beyond(&self, x: f64, y: f64) -> f64 {
        if x == y {
            return 0.0;
        }
        let (force, slope) = self.power(self.knee);
        (y - x) * (force + slope * (x + y) / 2.0)
    }

    /// λ = (Φ(η⁻ + r) − Φ(η⁻))/r, written so that nothing cancels however small r is: with both ends in
    /// contact and before the knee Φ(η⁻ + r)/Φ(η⁻) − 1 = exp((α+1) ln(1 + r/η⁻)) − 1, and the work beyond the knee adds to that
    /// of the way to it.
    pub fn quotient(&self, before: f64, change: f64) -> f64 {
        if change == 0.0 {
            return self.force(before);
        }
        let ((bent, beyond), (bent_after, beyond_after)) = (self.parts(before), self.parts(before + change));
        if beyond > 0.0 && beyond_after > 0.0 {
            let (force, slope) = self.power(self.knee);
            return force + slope * (beyond + beyond_after) / 2.0;
        }
        // Where both are before the knee; across it the ways on both sides are differences without an error, and so is their sum.
        let bending = if beyond + beyond_after == 0.0 { change } else { bent_after - bent };
        let way = bending + (beyond_after - beyond);
        let work = if bent > 0.0 && bent_after > 0.0 {
            self.energy_of_power(bent) * ((self.exponent + 1.0) * (bending / bent).ln_1p()).exp_m1()
        } else {
            self.energy_of_power(bent_after) - self.energy_of_power(bent)
        };
        (work + self.work_beyond(beyond, beyond_after)) / way
    }

    /// dλ/dr = (Φ′(η⁻ + r) − λ)/r; for tiny r its limit Φ″(η⁻)/2 (only Newton's speed depends on it).
    fn quotient_slope(&self, before: f64, change: f64) -> f64 {
        if before > 0.0 && change.abs() < 1e-4 * before || before.min(before + change) > self.knee {
            self.power(before.min(self.knee)).1 / 2.0
        } else if change == 0.0 {
            0.0
        } else {
            (self.force(before + change) - self.quotient(before, change)) / change
        }
    }
}

/// One contact as the solver sees it in one sample.
pub(super) struct Contact {
    /// The law it follows.
    pub(super) law: Law,
    /// Penetration η⁻ one sample ago, m.
    pub(super) before: f64,
    /// Damping P of this sample, N/m.
    pub(super) damping: f64,
}

impl Contact {
    fn force(&self, change: f64) -> f64 {
        (self.law.quotient(self.before, change) + self.damping * change).max(0.0)
    }

    fn slope(&self, change: f64) -> f64 {
        if self.force(change) > 0.0 {
            self.law.quotient_slope(self.before, change) + self.damping
        } else {
            0.0
        }
    }
}

/// Finds f with f = force(r), r = −c − M f, by Newton's method in r over all contacts at once; each step is
/// halved until the mismatch shrinks, and the search ends when rounding no longer lets it.
pub(super) fn solve(contacts: &[Contact], c: &DVector<f64>, m: &DMatrix<f64>) -> DVector<f64> {
    let count = contacts.len();
    if count == 0 {
        return DVector::zeros(0);
    }
    let map = |r: &DVector<f64>, value: fn(&Contact, f64) -> f64| {
        DVector::from_fn(count, |i, _| value(&contacts[i], r[i]))
    };
    let mismatch = |r: &DVector<f64>| r + c + m * map(r, Contact::force);
    let mut r = -c;
    loop {
        let residual = mismatch(&r);
        let slopes = map(&r, Contact::slope);
        let jacobian = DMatrix::from_fn(count, count, |i, j| f64::from(i == j) + m[(i, j)] * slopes[j]);
        let step = -jacobian.lu().solve(&residual).expect("1 + M D has eigenvalues of at least 1");
        let better = (0..10)
            .map(|halvings| 0.5_f64.powi(halvings))
            .map(|length| (length, &r + &step * length))
            .find(|(length, trial)| mismatch(trial).norm() < (1.0 - length / 4.0) * residual.norm());
        match better {
            Some((_, trial)) => r = trial,
            None => {
                let size = |vector: &DVector<f64>| largest(vector.iter().map(|value| value.abs()));
                let (left, scale) = (size(&residual), largest([size(c), size(&r)]));
                assert!(
                    left <= 1e-10 * scale,
                    "the reference's contacts did not converge: {left:e} of {scale:e} m left"
                );
                // What is left of r is below its last digit; in f it need not be.
                return map(&r, Contact::force) + slopes.component_mul(&step);
            }
        }
    }
}
