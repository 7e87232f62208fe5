//! What the passes ask of an instruction set.

use super::Pass;
use crate::field::{self, Row};

/// Vectors of an instruction set, and what can be done with them, number by number.
pub(crate) trait Vectors: Copy {
    /// Some lanes of a row, side by side.
    type Vector: Copy;

    /// How many of them a row has.
    const PARTS: usize;

    /// Runs what was compiled for these instructions, in a function of its own.
    fn run<P: Pass>(self, pass: P) -> P::Output;

    /// The `part`-th vector of a row.
    fn part(self, row: &Row, part: usize) -> Self::Vector;

    /// Puts it there.
    fn put(self, row: &mut Row, part: usize, vector: Self::Vector);

    /// The same number in every lane.
    fn splat(self, value: f64) -> Self::Vector;

    fn add(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    fn sub(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    fn mul(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// The smaller one, or `b` where there is none.
    fn min(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;

    /// Whether any number of a row is no more than `most`.
    #[inline(always)]
    fn any_at_most(self, row: &Row, most: f64) -> bool {
        field::any_at_most(row, most)
    }

    /// `value`, but 0 where its square is less than `least`; and the sum with the squares of the others.
    fn add_squares(self, sum: Self::Vector, value: Self::Vector, least: Self::Vector) -> [Self::Vector; 2];

    /// The sum over a row's lanes, [in the order of all sets](field::total).
    #[inline(always)]
    fn total(self, row: &Row) -> f64 {
        field::total(row)
    }

    /// The sum with a product, rounded twice.
    #[inline(always)]
    fn add_product(self, sum: Self::Vector, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        self.add(sum, self.mul(a, b))
    }
}
