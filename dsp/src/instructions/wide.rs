//! Vectors as a library has them.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::{__m256d, _CMP_LE_OQ, _CMP_LT_OQ, _CMP_NLT_UQ};

#[cfg(target_arch = "x86_64")]
use pulp::x86::{V3, V4};
use pulp::{Scalar128b, Simd};
#[cfg(target_arch = "x86_64")]
use pulp::{f64x4, f64x8};

use super::{By, Pass, Vectors};
use crate::field::{self, LANES, Row};

/// The instructions of a set that is `S`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide<S>(pub S);

impl<S: Special> Vectors for Wide<S> {
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
    fn min(self, a: S::f64s, b: S::f64s) -> S::f64s {
        self.0.min_f64s(a, b)
    }

    #[inline(always)]
    fn any_at_most(self, row: &Row, most: f64) -> bool {
        Special::any_at_most(self.0, row, most)
    }

    #[inline(always)]
    fn add_squares(self, sum: S::f64s, value: S::f64s, least: S::f64s) -> [S::f64s; 2] {
        Special::add_squares(self.0, sum, value, least)
    }

    #[inline(always)]
    fn total(self, row: &Row) -> f64 {
        Special::total(self.0, row)
    }
}

/// What not every set does best in the same way.
pub(super) trait Special: Simd {
    /// [`Vectors::add_squares`].
    #[inline(always)]
    fn add_squares(self, sum: Self::f64s, value: Self::f64s, least: Self::f64s) -> [Self::f64s; 2] {
        let (zero, square) = (self.splat_f64s(0.0), self.mul_f64s(value, value));
        let below = self.less_than_f64s(square, least);
        let [value, square] = [value, square].map(|number| self.select_f64s(below, zero, number));
        [value, self.add_f64s(sum, square)]
    }

    /// [`Vectors::any_at_most`].
    #[inline(always)]
    fn any_at_most(self, row: &Row, most: f64) -> bool {
        field::any_at_most(row, most)
    }

    /// [`Vectors::total`].
    #[inline(always)]
    fn total(self, row: &Row) -> f64 {
        field::total(row)
    }
}

impl Special for Scalar128b {}

#[cfg(target_arch = "x86_64")]
impl Special for V4 {
    /// What is masked takes no instruction of its own.
    #[inline(always)]
    fn add_squares(self, sum: f64x8, value: f64x8, least: f64x8) -> [f64x8; 2] {
        let set = self.avx512f;
        let [sum, value, least] = [sum, value, least].map(pulp::cast);
        let square = set._mm512_mul_pd(value, value);
        let moves = set._mm512_cmp_pd_mask::<_CMP_NLT_UQ>(square, least);
        let moving = set._mm512_maskz_mov_pd(moves, value);
        [moving, set._mm512_mask_add_pd(sum, moves, sum, square)].map(pulp::cast)
    }

    #[inline(always)]
    fn any_at_most(self, row: &Row, most: f64) -> bool {
        let row = pulp::cast(Self::as_simd_f64s(row).0[0]);
        self.avx512f._mm512_cmp_pd_mask::<_CMP_LE_OQ>(row, pulp::cast(self.splat_f64s(most))) != 0
    }

    #[inline(always)]
    fn total(self, row: &Row) -> f64 {
        let set = self.avx512f;
        let row = pulp::cast(Self::as_simd_f64s(row).0[0]);
        let [first, second] = [set._mm512_castpd512_pd256(row), set._mm512_extractf64x4_pd::<1>(row)];
        total_of_halves(*self, first, second)
    }
}

#[cfg(target_arch = "x86_64")]
impl Special for V3 {
    /// A mask is as wide as the numbers and covers them as it is: chosen by it, they would be by its signs, found first.
    #[inline(always)]
    fn add_squares(self, sum: f64x4, value: f64x4, least: f64x4) -> [f64x4; 2] {
        let set = self.avx;
        let square = pulp::cast(self.mul_f64s(value, value));
        let below = set._mm256_cmp_pd::<_CMP_LT_OQ>(square, pulp::cast(least));
        let square = set._mm256_andnot_pd(below, square);
        let value = set._mm256_andnot_pd(below, pulp::cast(value));
        [pulp::cast(value), self.add_f64s(sum, pulp::cast(square))]
    }

    #[inline(always)]
    fn any_at_most(self, row: &Row, most: f64) -> bool {
        let most = pulp::cast(self.splat_f64s(most));
        let below = |part: usize| {
            let part = pulp::cast(Self::as_simd_f64s(row).0[part]);
            self.avx._mm256_cmp_pd::<_CMP_LE_OQ>(part, most)
        };
        self.avx._mm256_movemask_pd(self.avx._mm256_or_pd(below(0), below(1))) != 0
    }

    #[inline(always)]
    fn total(self, row: &Row) -> f64 {
        let [first, second] = [0, 1].map(|part| pulp::cast(Self::as_simd_f64s(row).0[part]));
        total_of_halves(self, first, second)
    }
}

/// [`field::total`] of a row's two halves: each lane of the one with its own of the other, these in pairs side by side, then both pairs.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
fn total_of_halves(set: V3, first: __m256d, second: __m256d) -> f64 {
    let lanes = set.avx._mm256_add_pd(first, second);
    let pairs = set.avx._mm256_hadd_pd(lanes, lanes);
    let [one, other] = [set.avx._mm256_castpd256_pd128(pairs), set.avx._mm256_extractf128_pd::<1>(pairs)];
    set.sse2._mm_cvtsd_f64(set.sse2._mm_add_sd(one, other))
}
