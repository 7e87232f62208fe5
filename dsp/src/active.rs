//! A contact that acts in the present step: what the solver must know of it, and what it found.

use crate::contact::{Before, ContactLaw};
use crate::grid::Reading;
use crate::response::Row;

/// One active contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Active {
    /// Its index: contacts first, then fingers.
    pub slot: usize,
    /// The string under it at n + 1.
    pub reading: Reading,
    /// +1 when it pushes the string up (board, fret), −1 when down (finger).
    pub sign: f64,
    /// Contact law.
    pub law: ContactLaw,
    /// P = βK[ηⁿ]^α/(2k), N/m.
    pub lossy: f64,
    /// Penetration and energy at n − 1.
    pub before: Before,
    /// What the penetration loses between n − 1 and n + 1 besides the string's own motion to n + 1, m.
    pub rest: f64,
    /// The force that the string's prediction already holds, N; 0 when the solution begins.
    pub base: f64,
    /// The change of penetration under the base forces, −c when the solution begins, m.
    pub centre: f64,
    /// bⁿ⁺¹ − bⁿ⁻¹, how far the barrier itself rose, m.
    pub raised: f64,
    /// k²/(M + Rk/2) of a finger, 0 of the board, m/N.
    pub own_mobility: f64,
    /// k²/(ρhs), m/N.
    pub mobility: f64,
    /// z = (hgᵀv)·sign.
    pub pull: f64,
    /// The change of penetration that is expected, m: where the solution begins.
    pub expected: f64,
    /// The force found, N.
    pub force: f64,
    /// The change of penetration, m.
    pub change: f64,
    /// λ at that change, N: what the stored energy explains.
    pub lambda: f64,
    /// The force law at that change, N.
    pub required: f64,
    /// Its slope, N/m.
    pub slope: f64,
}

impl Active {
    /// Evaluates the law at a change of penetration.
    #[inline(always)]
    pub fn evaluate(&mut self, change: f64) {
        let (lambda, slope) = self.law.gradient(&self.before, change);
        self.change = change;
        self.lambda = lambda;
        let required = lambda + self.lossy * change;
        if required > 0.0 {
            self.required = required;
            self.slope = slope + self.lossy;
        } else {
            self.required = 0.0;
            self.slope = 0.0;
        }
    }
}

impl Row for Active {
    #[inline]
    fn span(&self) -> (usize, usize) {
        self.reading.span()
    }
    #[inline]
    fn coupling(&self, other: &Self) -> f64 {
        self.mobility * (self.sign * other.sign * self.reading.overlap(&other.reading))
    }
    #[inline]
    fn own_mobility(&self) -> f64 {
        self.own_mobility
    }
    #[inline]
    fn pull(&self) -> f64 {
        self.pull
    }
}
