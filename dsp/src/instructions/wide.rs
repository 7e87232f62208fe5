//! Vectors as a library has them.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::_CMP_LT_OQ;

#[cfg(target_arch = "x86_64")]
use pulp::f64x4;
#[cfg(target_arch = "x86_64")]
use pulp::x86::{V3, V4};
use pulp::{Scalar128b, Simd};

use super::{By, Pass, Vectors};
use crate::field::{LANES, Row};

/// The instructions of a set that is `S`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide<S>(pub S);

impl<S: ClearBelow> Vectors for Wide<S> {
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
    fn min(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.min_f64s(a, b)
    }

    #[inline(always)]
    fn clear_below(self, value: S::f64s, size: S::f64s, least: S::f64s) -> S::f64s {
        self.0.clear_below(value, size, least)
    }
}

/// What not every set does best in the same way.
pub(super) trait ClearBelow: Simd {
    /// `value`, but 0 where `size` is less than `least`.
    #[inline(always)]
    fn clear_below(self, value: Self::f64s, size: Self::f64s, least: Self::f64s) -> Self::f64s {
        self.select_f64s(self.less_than_f64s(size, least), self.splat_f64s(0.0), value)
    }
}

impl ClearBelow for Scalar128b {}

#[cfg(target_arch = "x86_64")]
impl ClearBelow for V4 {}

/// A mask is as wide as the numbers and covers them as it is: chosen by it, they would be by its signs, found first.
#[cfg(target_arch = "x86_64")]
impl ClearBelow for V3 {
    #[inline(always)]
    fn clear_below(self, value: f64x4, size: f64x4, least: f64x4) -> f64x4 {
        let below = self.avx._mm256_cmp_pd::<_CMP_LT_OQ>(pulp::cast(size), pulp::cast(least));
        pulp::cast(self.avx._mm256_andnot_pd(below, pulp::cast(value)))
    }
}
