//! How many steps a string takes in a sample of the host's: whole numbers and halves.

use std::fmt;

/// Steps in a sample, as a number of halves that is 2 or more. Of an odd number of halves two samples in a row share
/// one step: the string takes one step more in the first of them than in the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ratio {
    halves: usize,
}

impl Ratio {
    /// One step a sample, the least there is.
    pub const ONE: Ratio = Ratio { halves: 2 };

    /// So many halves of a step a sample; one step where that is less.
    pub fn of_halves(halves: usize) -> Ratio {
        Ratio { halves: halves.max(Self::ONE.halves) }
    }

    /// Steps a sample.
    pub fn value(self) -> f64 {
        0.5 * self.halves as f64
    }

    /// Halves of a step in a sample.
    pub fn halves(self) -> usize {
        self.halves
    }

    /// 1 where two samples share a step, 0 where each has its own.
    pub(crate) fn shared(self) -> usize {
        self.halves % 2
    }

    /// Steps that begin before the sample of this index does, the first of two that share one being of index 0.
    pub(crate) fn steps_before(self, sample: usize) -> usize {
        (self.halves * sample).div_ceil(2)
    }
}

impl fmt::Display for Ratio {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value().fmt(out)
    }
}
