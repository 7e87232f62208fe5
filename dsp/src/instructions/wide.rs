//! Vectors as a library has them.

use pulp::Simd;

use super::{By, Pass, Vectors};
use crate::field::{LANES, Row};

/// The instructions of a set that is `S`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide<S>(pub S);

impl<S: Simd> Vectors for Wide<S> {
    type Vector = S::f64s;

    const PARTS: usize = LANES / S::F64_LANES;

    #[inline(always)]
    fn run<P: Pass>(self, pass: P) -> P::Output {
        self.0.vectorize(By(pass, self))
    }

    #[inline(always)]
    fn part(self, row: &Row, part: usize) -> S::f64s {
        S::as_simd_f64s(row).0[part]
    }

    #[inline(always)]
    fn put(self, row: &mut Row, part: usize, vector: S::f64s) {
        S::as_mut_simd_f64s(row).0[part] = vector;
    }

    #[inline(always)]
    fn splat(self, value: f64) -> S::f64s {
        self.0.splat_f64s(value)
    }

    #[inline(always)]
    fn add(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.add_f64s(a, b)
    }

    #[inline(always)]
    fn sub(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.sub_f64s(a, b)
    }

    #[inline(always)]
    fn mul(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.mul_f64s(a, b)
    }

    #[inline(always)]
    fn abs(self, a: S::f64s) -> S::f64s {
        self.0.abs_f64s(a)
    }

    #[inline(always)]
    fn max(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.max_f64s(a, b)
    }

    #[inline(always)]
    fn min(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.min_f64s(a, b)
    }

    #[inline(always)]
    fn clear_below(self, value: S::f64s, size: S::f64s, least: S::f64s) -> S::f64s {
        // Numbers that are not negative are in order as integers, too. (Chosen by what compares numbers, they would be by its signs,
        // found first.)
        let [size, least] = [size, least].map(|number| self.0.transmute_i64s_f64s(number));
        let none = self.0.splat_f64s(0.0);
        self.0.select_f64s(self.0.less_than_i64s(size, least), none, value)
    }
}
