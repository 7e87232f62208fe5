//! The contact law and the solution of all contacts at once.

use nalgebra::{DMatrix, DVector};

use crate::numbers::largest;

/// A power-law contact, Φ(η) = K/(α+1) \[η\]₊^(α+1).
#[derive(Clone, Copy, Debug)]
pub struct Law {
    /// Stiffness K, N/m^α.
    pub stiffness: f64,
    /// Exponent α, at least 1.
    pub exponent: f64,
}

impl Law {
    /// The static force Φ′(η), N.
    pub(super) fn force(&self, penetration: f64) -> f64 {
        self.stiffness * penetration.max(0.0).powf(self.exponent)
    }

    /// The stored energy Φ(η), J.
    pub(super) fn energy(&self, penetration: f64) -> f64 {
        self.stiffness / (self.exponent + 1.0) * penetration.max(0.0).powf(self.exponent + 1.0)
    }

    /// λ = (Φ(η⁻ + r) − Φ(η⁻))/r, written so that nothing cancels however small r is: with both ends in
    /// contact Φ(η⁻ + r)/Φ(η⁻) − 1 = exp((α+1) ln(1 + r/η⁻)) − 1.
    pub fn quotient(&self, before: f64, change: f64) -> f64 {
        if change == 0.0 {
            self.force(before)
        } else if before > 0.0 && before + change > 0.0 {
            self.energy(before) * ((self.exponent + 1.0) * (change / before).ln_1p()).exp_m1() / change
        } else {
            (self.energy(before + change) - self.energy(before)) / change
        }
    }

    /// dλ/dr = (Φ′(η⁻ + r) − λ)/r; for tiny r its limit Φ″(η⁻)/2 (only Newton's speed depends on it).
    fn quotient_slope(&self, before: f64, change: f64) -> f64 {
        if before > 0.0 && change.abs() < 1e-4 * before {
            self.stiffness * self.exponent * before.powf(self.exponent - 1.0) / 2.0
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
