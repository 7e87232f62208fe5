//! One step of all modes of a body, as many side by side as the instruction set has lanes. Sums run down each lane and are added up
//! in a fixed order, so that every instruction set gives the same bits.

use pulp::{Simd, WithSimd};

use super::coefficients::{Coefficients, Row};
use crate::kernel::{part_of, vectors};

/// A step to come, under a force on the bridge, N.
pub(super) struct Swing<'a> {
    pub force: f64,
    pub coefficients: &'a [Coefficients],
    pub place: &'a mut [Row],
    pub motion: &'a mut [Row],
}

impl WithSimd for Swing<'_> {
    /// Where the bridge is then, m, and the sound pressure of the step, Pa.
    type Output = [f64; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [f64; 2] {
        let count = self.coefficients.len();
        let (place, motion) = (&mut self.place[..count], &mut self.motion[..count]);
        let force = simd.splat_f64s(self.force);
        let (mut lifts, mut pressures) = (Row::default(), Row::default());
        for part in 0..vectors::<S>() {
            let (mut lift, mut pressure) = (simd.splat_f64s(0.0), simd.splat_f64s(0.0));
            for at in 0..count {
                let row = &self.coefficients[at];
                let of = |row: &Row| part_of::<S>(row, part);
                let (old, from) = (of(&motion[at]), of(&place[at]));
                let driven = simd.mul_f64s(of(&row.force), force);
                let pulled = simd.sub_f64s(driven, simd.mul_f64s(of(&row.spring), from));
                let new = simd.add_f64s(simd.mul_f64s(of(&row.kept), old), pulled);
                let to = simd.add_f64s(from, new);
                S::as_mut_simd_f64s(&mut motion[at]).0[part] = new;
                S::as_mut_simd_f64s(&mut place[at]).0[part] = to;
                lift = simd.add_f64s(lift, simd.mul_f64s(of(&row.bridge), to));
                let change = simd.sub_f64s(new, old);
                pressure = simd.add_f64s(pressure, simd.mul_f64s(of(&row.pressure), change));
            }
            S::as_mut_simd_f64s(&mut lifts).0[part] = lift;
            S::as_mut_simd_f64s(&mut pressures).0[part] = pressure;
        }
        [lifts, pressures]
            .map(|row| ((row[0] + row[1]) + (row[2] + row[3])) + ((row[4] + row[5]) + (row[6] + row[7])))
    }
}
