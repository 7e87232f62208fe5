//! How far a string is over a skyline.

use pulp::{Simd, WithSimd};

use super::lanes::{part_of, rows, vectors};
use crate::field::Field;
use crate::skyline::{CLEARED, Clearance};

/// How far groups of points are over a skyline.
pub(super) struct Clear<'a> {
    pub displacement: &'a Field,
    pub skyline: &'a Field,
    pub clearances: &'a mut [Clearance],
}

impl WithSimd for Clear<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let groups = rows(self.displacement).chunks(CLEARED).zip(rows(self.skyline).chunks(CLEARED));
        for (clearance, (points, tops)) in self.clearances.iter_mut().zip(groups) {
            for part in 0..vectors::<S>() {
                let far = simd.splat_f64s(f64::INFINITY);
                let (mut over, mut lowest) = (far, far);
                for (point, top) in points.iter().zip(tops) {
                    let point = part_of::<S>(point, part);
                    over = simd.min_f64s(over, simd.sub_f64s(point, part_of::<S>(top, part)));
                    lowest = simd.min_f64s(lowest, point);
                }
                S::as_mut_simd_f64s(&mut clearance.over).0[part] = over;
                S::as_mut_simd_f64s(&mut clearance.lowest).0[part] = lowest;
            }
        }
    }
}
