//! The sweep of a prediction: rows one after another, with what is needed of their neighbours in registers.

use pulp::{Simd, WithSimd};

use super::lanes::{Row, add_product, part_of, rows, rows_after, rows_before, rows_mut, total, vectors};
use super::{Products, Weights};
use crate::field::{Field, LANES};

/// Sums of a sweep in each lane.
#[derive(Clone, Copy)]
struct Sums<S: Simd> {
    /// |δu|².
    steepness: S::f64s,
    /// vᵀ(w − d).
    change: S::f64s,
    /// vᵀv.
    curvature: S::f64s,
    /// dᵀd.
    motion: S::f64s,
}

/// Weights in every lane.
struct Splat<S: Simd> {
    motion: S::f64s,
    near: [S::f64s; 3],
    beside: S::f64s,
}

/// What a sweep knows of the rows around the present one.
struct Around<S: Simd> {
    /// u two rows ahead.
    ahead: S::f64s,
    /// Differences u − (u of the row before): of the present row and the next two.
    slopes: [S::f64s; 3],
    /// v from two rows before to one ahead.
    v: [S::f64s; 4],
    /// d of the row before and of this one.
    d: [S::f64s; 2],
}

impl<S: Simd> Around<S> {
    /// Around the first row, of the three rows of u before it and the three from it on, and two of d.
    #[inline(always)]
    fn first(simd: S, u: [S::f64s; 6], d: [S::f64s; 2]) -> Self {
        let slopes = [
            simd.sub_f64s(u[1], u[0]),
            simd.sub_f64s(u[2], u[1]),
            simd.sub_f64s(u[3], u[2]),
            simd.sub_f64s(u[4], u[3]),
            simd.sub_f64s(u[5], u[4]),
        ];
        let v = [
            simd.sub_f64s(slopes[1], slopes[0]),
            simd.sub_f64s(slopes[2], slopes[1]),
            simd.sub_f64s(slopes[3], slopes[2]),
            simd.sub_f64s(slopes[4], slopes[3]),
        ];
        Around { ahead: u[5], slopes: [slopes[2], slopes[3], slopes[4]], v, d }
    }

    /// v and w of the present row, given u three rows ahead and d one; goes on to the next.
    ///
    /// The difference of differences is exact but for rounding of the differences themselves, so that the
    /// force on a smooth string is good to its own last digits and not to those of u.
    #[inline(always)]
    fn step<const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &mut self,
        simd: S,
        weights: &Splat<S>,
        (u, d, keep): (S::f64s, S::f64s, S::f64s),
        sums: &mut Sums<S>,
    ) -> [S::f64s; 2] {
        let [slope, next, last] = self.slopes;
        let far = simd.sub_f64s(u, self.ahead);
        let v = [self.v[0], self.v[1], self.v[2], self.v[3], simd.sub_f64s(far, last)];
        let here = self.d[1];
        let mut value = simd.mul_f64s(weights.near[0], v[2]);
        if REACH > 0 {
            let beside = simd.add_f64s(v[1], v[3]);
            value = simd.add_f64s(value, simd.mul_f64s(weights.near[1], beside));
        }
        if REACH > 1 {
            let far = simd.add_f64s(v[0], v[4]);
            value = simd.add_f64s(value, simd.mul_f64s(weights.near[2], far));
        }
        if LOSS {
            let beside = simd.add_f64s(self.d[0], d);
            value = simd.add_f64s(value, simd.mul_f64s(weights.beside, beside));
        }
        value = simd.add_f64s(value, simd.mul_f64s(weights.motion, here));
        let w = simd.mul_f64s(keep, value);
        let curvature = simd.mul_f64s(keep, v[2]);
        let slope = simd.mul_f64s(keep, slope);
        add_product(simd, &mut sums.steepness, slope, slope);
        add_product(simd, &mut sums.motion, here, here);
        if STRETCH {
            add_product(simd, &mut sums.change, curvature, simd.sub_f64s(w, here));
            add_product(simd, &mut sums.curvature, curvature, curvature);
        }
        *self = Around { ahead: u, slopes: [next, last, far], v: [v[1], v[2], v[3], v[4]], d: [here, d] };
        [curvature, w]
    }
}

/// Some lanes of all rows, on the way through them.
struct Lanes<'a, S: Simd> {
    simd: S,
    part: usize,
    weights: &'a Splat<S>,
    keep: &'a [Row],
    around: Around<S>,
    sums: Sums<S>,
    v: &'a mut [Row],
    w: &'a mut [Row],
}

impl<S: Simd> Lanes<'_, S> {
    /// Predicts a row from u three rows ahead and d one.
    #[inline(always)]
    fn predict<const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &mut self,
        at: usize,
        u: &Row,
        d: &Row,
    ) {
        let part = self.part;
        let ahead = (part_of::<S>(u, part), part_of::<S>(d, part), part_of::<S>(&self.keep[at], part));
        let sums = &mut self.sums;
        let [v, w] = self.around.step::<REACH, STRETCH, LOSS>(self.simd, self.weights, ahead, sums);
        S::as_mut_simd_f64s(&mut self.v[at]).0[part] = v;
        S::as_mut_simd_f64s(&mut self.w[at]).0[part] = w;
    }
}

/// The sweep of a prediction: v, the undivided second difference of u, and w, the motion in the next step were there no
/// contact and no tension modulation, both 0 where nothing moves; and their products.
pub(super) struct Predict<'a, const REACH: usize, const STRETCH: bool, const LOSS: bool> {
    pub weights: &'a Weights,
    /// u and d.
    pub from: (&'a Field, &'a Field),
    /// v and w.
    pub to: (&'a mut Field, &'a mut Field),
    /// 1 at each point that moves, 0 elsewhere.
    pub keep: &'a Field,
}

impl<const REACH: usize, const STRETCH: bool, const LOSS: bool> WithSimd
    for Predict<'_, REACH, STRETCH, LOSS>
{
    type Output = Products;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Products {
        let Predict { weights, from: (u, d), to: (v, w), keep } = self;
        let splat = Splat::<S> {
            motion: simd.splat_f64s(weights.motion),
            near: weights.near.map(|weight| simd.splat_f64s(weight)),
            beside: simd.splat_f64s(weights.beside),
        };
        let (u_before, u_after, d_before, d_after) =
            (rows_before::<3>(u), rows_after::<3>(u), rows_before::<1>(d), rows_after::<1>(d));
        let (u, d, keep, v, w) = (rows(u), rows(d), rows(keep), rows_mut(v), rows_mut(w));
        let count = u.len();
        let (d, keep, v, w) = (&d[..count], &keep[..count], &mut v[..count], &mut w[..count]);
        let mut totals = [[0.0; LANES]; 4];
        for part in 0..vectors::<S>() {
            let zero = simd.splat_f64s(0.0);
            let mut lanes = Lanes {
                simd,
                part,
                weights: &splat,
                keep,
                around: Around::first(
                    simd,
                    [
                        part_of::<S>(&u_before[0], part),
                        part_of::<S>(&u_before[1], part),
                        part_of::<S>(&u_before[2], part),
                        part_of::<S>(&u[0], part),
                        part_of::<S>(&u[1], part),
                        part_of::<S>(&u[2], part),
                    ],
                    [part_of::<S>(&d_before[0], part), part_of::<S>(&d[0], part)],
                ),
                sums: Sums { steepness: zero, change: zero, curvature: zero, motion: zero },
                v,
                w,
            };
            for at in 0..count - 3 {
                lanes.predict::<REACH, STRETCH, LOSS>(at, &u[at + 3], &d[at + 1]);
            }
            lanes.predict::<REACH, STRETCH, LOSS>(count - 3, &u_after[0], &d[count - 2]);
            lanes.predict::<REACH, STRETCH, LOSS>(count - 2, &u_after[1], &d[count - 1]);
            lanes.predict::<REACH, STRETCH, LOSS>(count - 1, &u_after[2], &d_after[0]);
            let Sums { steepness, change, curvature, motion } = lanes.sums;
            for (total, sum) in totals.iter_mut().zip([steepness, change, curvature, motion]) {
                S::as_mut_simd_f64s(total).0[part] = sum;
            }
        }
        let [steepness, curvature_change, curvature, motion] = totals.each_ref().map(total);
        Products { steepness, curvature_change, curvature, motion }
    }
}
