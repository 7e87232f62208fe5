//! Vectors of two lanes, held as what a register holds.
//!
//! The library's have a number in each of two fields. The compiler takes such a structure apart into two numbers, and where a vector goes
//! from one row to the next has it put together from them again for every instruction. (Of wider ones it makes whole registers.)

#[cfg(target_arch = "aarch64")]
use std::arch::aarch64::float64x2_t as Register;
#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::__m128d as Register;

#[cfg(target_arch = "aarch64")]
use pulp::aarch64::Neon as Set;
#[cfg(target_arch = "x86_64")]
use pulp::x86::V2 as Set;
use pulp::{Simd, cast};

use super::{By, Pass, Vectors};
use crate::field::{LANES, Row};

/// Two lanes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Two(pub Set);

impl Vectors for Two {
    type Vector = Register;

    const PARTS: usize = LANES / 2;

    #[inline(always)]
    fn run<P: Pass>(self, pass: P) -> P::Output {
        Simd::vectorize(self.0, By(pass, self))
    }

    #[inline(always)]
    fn part(self, row: &Row, part: usize) -> Register {
        cast::<[f64; 2], _>(row.as_chunks().0[part])
    }

    #[inline(always)]
    fn put(self, row: &mut Row, part: usize, vector: Register) {
        row.as_chunks_mut::<2>().0[part] = cast(vector);
    }

    #[inline(always)]
    fn splat(self, value: f64) -> Register {
        cast([value; 2])
    }

    #[inline(always)]
    fn add(self, a: Register, b: Register) -> Register {
        #[cfg(target_arch = "x86_64")]
        return self.0.sse2._mm_add_pd(a, b);
        #[cfg(target_arch = "aarch64")]
        return self.0.neon.vaddq_f64(a, b);
    }

    #[inline(always)]
    fn sub(self, a: Register, b: Register) -> Register {
        #[cfg(target_arch = "x86_64")]
        return self.0.sse2._mm_sub_pd(a, b);
        #[cfg(target_arch = "aarch64")]
        return self.0.neon.vsubq_f64(a, b);
    }

    #[inline(always)]
    fn mul(self, a: Register, b: Register) -> Register {
        #[cfg(target_arch = "x86_64")]
        return self.0.sse2._mm_mul_pd(a, b);
        #[cfg(target_arch = "aarch64")]
        return self.0.neon.vmulq_f64(a, b);
    }

    #[inline(always)]
    fn min(self, a: Register, b: Register) -> Register {
        #[cfg(target_arch = "x86_64")]
        return self.0.sse2._mm_min_pd(a, b);
        #[cfg(target_arch = "aarch64")]
        return self.0.neon.vbslq_f64(self.0.neon.vcltq_f64(a, b), a, b);
    }

    #[inline(always)]
    fn add_squares(self, sum: Register, value: Register, least: Register) -> [Register; 2] {
        let square = self.mul(value, value);
        #[cfg(target_arch = "x86_64")]
        let [value, square] = {
            let below = self.0.sse2._mm_cmplt_pd(square, least);
            [value, square].map(|number| self.0.sse2._mm_andnot_pd(below, number))
        };
        #[cfg(target_arch = "aarch64")]
        let [value, square] = {
            let below = self.0.neon.vcltq_f64(square, least);
            [value, square].map(|number| self.0.neon.vbslq_f64(below, self.splat(0.0), number))
        };
        [value, self.add(sum, square)]
    }
}
