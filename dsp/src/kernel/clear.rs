//! How far a string is over a skyline.

use super::rows::rows;
use crate::field::Field;
use crate::instructions::{Pass, Vectors};
use crate::skyline::{CLEARED, Clearance};

/// How far groups of points are over a skyline.
pub(super) struct Clear<'a> {
    pub displacement: &'a Field,
    pub skyline: &'a Field,
    pub clearances: &'a mut [Clearance],
}

impl Pass for Clear<'_> {
    type Output = ();

    #[inline(always)]
    fn by<V: Vectors>(self, simd: V) {
        let groups = rows(self.displacement).chunks(CLEARED).zip(rows(self.skyline).chunks(CLEARED));
        for (clearance, (points, tops)) in self.clearances.iter_mut().zip(groups) {
            for part in 0..V::PARTS {
                let far = simd.splat(f64::INFINITY);
                let (mut over, mut lowest) = (far, far);
                for (point, top) in points.iter().zip(tops) {
                    let point = simd.part(point, part);
                    over = simd.min(over, simd.sub(point, simd.part(top, part)));
                    lowest = simd.min(lowest, point);
                }
                simd.put(&mut clearance.over, part, over);
                simd.put(&mut clearance.lowest, part, lowest);
            }
        }
    }
}
