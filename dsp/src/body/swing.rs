//! One step of all modes of a body, as many side by side as the instruction set has lanes. Sums run down each lane and are added up
//! in a fixed order, so that every instruction set gives the same bits.

use super::coefficients::Coefficients;
use crate::field::Row;
use crate::instructions::{Pass, Vectors};

/// A step to come, under a force on the bridge, N.
pub(super) struct Swing<'a> {
    pub force: f64,
    pub coefficients: &'a [Coefficients],
    pub place: &'a mut [Row],
    pub motion: &'a mut [Row],
}

impl Pass for Swing<'_> {
    /// Where the bridge is then, m, and the sound pressure of the step, Pa.
    type Output = [f64; 2];

    #[inline(always)]
    fn by<V: Vectors>(self, simd: V) -> [f64; 2] {
        let count = self.coefficients.len();
        let (place, motion) = (&mut self.place[..count], &mut self.motion[..count]);
        let force = simd.splat(self.force);
        let (mut lifts, mut pressures) = (Row::default(), Row::default());
        for part in 0..V::PARTS {
            let (mut lift, mut pressure) = (simd.splat(0.0), simd.splat(0.0));
            for at in 0..count {
                let row = &self.coefficients[at];
                let of = |row: &Row| simd.part(row, part);
                let (old, from) = (of(&motion[at]), of(&place[at]));
                let driven = simd.mul(of(&row.force), force);
                let pulled = simd.sub(driven, simd.mul(of(&row.spring), from));
                let new = simd.add(simd.mul(of(&row.kept), old), pulled);
                let to = simd.add(from, new);
                simd.put(&mut motion[at], part, new);
                simd.put(&mut place[at], part, to);
                lift = simd.add(lift, simd.mul(of(&row.bridge), to));
                let change = simd.sub(new, old);
                pressure = simd.add(pressure, simd.mul(of(&row.pressure), change));
            }
            simd.put(&mut lifts, part, lift);
            simd.put(&mut pressures, part, pressure);
        }
        [lifts, pressures]
            .map(|row| ((row[0] + row[1]) + (row[2] + row[3])) + ((row[4] + row[5]) + (row[6] + row[7])))
    }
}
