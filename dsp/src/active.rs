//! A contact that acts in the present step: what the solver must know of it, and what it found.

use std::ops::{Deref, DerefMut};

use crate::contact::{Before, ContactLaw};
use crate::grid::Reading;
use crate::response::Coupled;
use crate::touching::Free;

/// One active contact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Active {
    /// Its index: contacts first, then fingers.
    pub slot: usize,
    /// Which finger it is, if it is one.
    pub number: u64,
    /// The string under it at n + 1.
    pub reading: Reading,
    /// Where that is, m from the nut, of a finger; of a fixed contact no number.
    pub position: f64,
    /// +1 when it pushes the string up (board, fret), −1 when down (finger).
    pub sign: f64,
    /// Contact law.
    pub law: ContactLaw,
    /// P = βφ(ηⁿ)/(2k), N/m, no more than the law is steep at most; and what a kinked contact radiates.
    pub lossy: f64,
    /// Penetration and energy at n − 1.
    pub before: Before,
    /// What the penetration loses between n − 1 and n + 1 besides the string's own motion to n + 1, m.
    pub rest: f64,
    /// The force that the string's prediction already holds, N; 0 when the solution begins.
    pub base: f64,
    /// The change of penetration under the base forces, −c when the solution begins, m. Known once the string is predicted.
    pub centre: f64,
    /// bⁿ⁺¹ − bⁿ⁻¹, how far the barrier itself rose, m.
    pub raised: f64,
    /// k²/(M + Rk/2) of a finger, 0 of the board, m/N.
    pub own_mobility: f64,
    /// k²/(ρhs), m/N.
    pub mobility: f64,
    /// z = (hgᵀv)·sign. Known once the string is predicted.
    pub pull: f64,
    /// The force found, N.
    pub force: f64,
    /// The change of penetration, m; before the solution the one that is expected, where it begins.
    pub change: f64,
    /// λ at that change, N: what the stored energy explains.
    pub lambda: f64,
    /// The force law at that change, N.
    pub required: f64,
    /// Its slope, N/m.
    pub slope: f64,
}

impl Active {
    /// A contact of which nothing is known yet.
    pub const NOTHING: Active = Active {
        slot: usize::MAX,
        number: 0,
        reading: Reading::NOTHING,
        position: f64::NAN,
        sign: 1.0,
        law: ContactLaw::known(1.0, 1.0),
        lossy: 0.0,
        before: Before::NOTHING,
        rest: 0.0,
        base: 0.0,
        centre: 0.0,
        raised: 0.0,
        own_mobility: 0.0,
        mobility: 0.0,
        pull: 0.0,
        force: 0.0,
        change: 0.0,
        lambda: 0.0,
        required: 0.0,
        slope: 0.0,
    };

    /// Learns how the string would move under it without contact forces.
    #[inline(always)]
    pub fn meet(&mut self, free: Free) {
        self.centre = -(self.sign * free.motion + self.rest);
        self.pull = self.sign * free.curvature;
    }

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

impl Coupled for Active {
    #[inline]
    fn span(&self) -> (usize, usize) {
        self.reading.span()
    }
    #[inline]
    fn coupling(&self, other: &Self) -> f64 {
        self.mobility * (self.sign * other.sign * self.reading.overlap(&other.reading))
    }
    #[inline]
    fn own_coupling(&self) -> f64 {
        self.mobility * self.reading.own_overlap()
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

/// The active contacts of a step. Each is put together where it then stands: one that was written number by number and then
/// copied in whole vectors would be waited for until it is in memory.
#[derive(Debug, Clone)]
pub(crate) struct ActiveSet {
    places: Vec<Active>,
    count: usize,
}

impl ActiveSet {
    /// Room for so many.
    pub fn with_capacity(capacity: usize) -> Self {
        ActiveSet { places: vec![Active::NOTHING; capacity], count: 0 }
    }

    /// None is active.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// None is active, and none was.
    pub fn forget(&mut self) {
        self.places.fill(Active::NOTHING);
        self.count = 0;
    }

    /// One more, of which everything is still to be written.
    #[inline(always)]
    pub fn next(&mut self) -> &mut Active {
        let next = &mut self.places[self.count];
        self.count += 1;
        next
    }

    /// Takes the one at a position out; those after it move up.
    pub fn remove(&mut self, position: usize) -> Active {
        self[position..].rotate_left(1);
        self.count -= 1;
        self.places[self.count]
    }
}

impl Deref for ActiveSet {
    type Target = [Active];
    #[inline(always)]
    fn deref(&self) -> &[Active] {
        &self.places[..self.count]
    }
}

impl DerefMut for ActiveSet {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [Active] {
        &mut self.places[..self.count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Who is taken out is told, and the others stay in their order, whichever it is.
    #[test]
    fn who_is_taken_out_leaves_the_others_in_order() {
        for out in 0..3 {
            let mut set = ActiveSet::with_capacity(3);
            for slot in 0..3 {
                *set.next() = Active { slot, ..Active::NOTHING };
            }
            assert_eq!(set.remove(out).slot, out);
            let left: Vec<usize> = set.iter().map(|active| active.slot).collect();
            let others: Vec<usize> = (0..3).filter(|slot| *slot != out).collect();
            assert_eq!(left, others, "without {out}");
        }
    }
}
