//! The sweep of a prediction: rows one after another, with what is needed of their neighbours in registers.

use pulp::{Simd, WithSimd};

use super::lanes::{Row, add_product, part_of, rows, rows_after, rows_before, rows_mut, vectors};
use super::{Shape, Stretching, Weights};
use crate::field::{Field, LANES, total};

/// Sums of a sweep in each lane.
#[derive(Clone, Copy)]
struct Sums<S: Simd> {
    /// |δu|².
    steepness: S::f64s,
    /// vᵀ(u + w).
    along: S::f64s,
    /// vᵀv.
    curvature: S::f64s,
}

impl<S: Simd> Sums<S> {
    /// Adds the differences of a row to the one before, where it moves.
    #[inline(always)]
    fn add_slope(&mut self, simd: S, keep: S::f64s, slope: S::f64s) {
        let slope = simd.mul_f64s(keep, slope);
        add_product(simd, &mut self.steepness, slope, slope);
    }
}

/// Weights in every lane.
struct Splat<S: Simd> {
    motion: S::f64s,
    near: [S::f64s; 3],
    before: S::f64s,
}

/// What a prediction reads in its own row.
struct Here<S: Simd> {
    u: S::f64s,
    d: S::f64s,
    /// v a step ago.
    v_before: S::f64s,
    /// 1 where it moves, 0 elsewhere.
    keep: S::f64s,
}

/// What a sweep knows of the rows around the present one.
struct Around<S: Simd> {
    /// u two rows ahead.
    ahead: S::f64s,
    /// Its difference to the row before.
    slope: S::f64s,
    /// v from two rows before to one ahead.
    v: [S::f64s; 4],
}

impl<S: Simd> Around<S> {
    /// Around the first row, of the three rows of u before it and the three from it on, and where the first three move.
    /// Adds up their slopes, which say how a string is stretched that does not pull itself tight.
    #[inline(always)]
    fn first<const STRETCH: bool>(simd: S, u: [S::f64s; 6], keep: [S::f64s; 3], sums: &mut Sums<S>) -> Self {
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
        if !STRETCH {
            sums.add_slope(simd, keep[0], slopes[2]);
            sums.add_slope(simd, keep[1], slopes[3]);
            sums.add_slope(simd, keep[2], slopes[4]);
        }
        Around { ahead: u[5], slope: slopes[4], v }
    }

    /// v and w of the present row, given u three rows ahead, where that moves if it is not one of the first again, and u,
    /// d and v a step ago in this row; goes on to the next.
    ///
    /// The difference of differences is exact but for rounding of the differences themselves, so that the
    /// force on a smooth string is good to its own last digits and not to those of u.
    #[inline(always)]
    fn step<const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &mut self,
        simd: S,
        weights: &Splat<S>,
        (ahead, moving): (S::f64s, Option<S::f64s>),
        Here { u, d, v_before, keep }: Here<S>,
        sums: &mut Sums<S>,
    ) -> [S::f64s; 2] {
        let slope = simd.sub_f64s(ahead, self.ahead);
        let v = [self.v[0], self.v[1], self.v[2], self.v[3], simd.sub_f64s(slope, self.slope)];
        if !STRETCH && let Some(moving) = moving {
            sums.add_slope(simd, moving, slope);
        }
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
            value = simd.sub_f64s(value, simd.mul_f64s(weights.before, v_before));
        }
        value = simd.add_f64s(value, simd.mul_f64s(weights.motion, d));
        let w = simd.mul_f64s(keep, value);
        let curvature = simd.mul_f64s(keep, v[2]);
        if STRETCH {
            add_product(simd, &mut sums.along, curvature, simd.add_f64s(u, w));
            add_product(simd, &mut sums.curvature, curvature, curvature);
        }
        *self = Around { ahead, slope, v: [v[1], v[2], v[3], v[4]] };
        [curvature, w]
    }
}

/// Some lanes of all rows, on the way through them.
struct Lanes<'a, S: Simd> {
    simd: S,
    part: usize,
    weights: &'a Splat<S>,
    keep: &'a [Row],
    /// u and d.
    from: [&'a [Row]; 2],
    around: Around<S>,
    sums: Sums<S>,
    /// Where the sweep has not yet been, v a step ago.
    v: &'a mut [Row],
    w: &'a mut [Row],
}

impl<S: Simd> Lanes<'_, S> {
    /// Predicts a row, given u three rows ahead.
    #[inline(always)]
    fn predict<const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &mut self,
        at: usize,
        (ahead, moving): (&Row, Option<&Row>),
    ) {
        let part = self.part;
        let moving = moving.map(|moving| part_of::<S>(moving, part));
        let ahead = part_of::<S>(ahead, part);
        let here = Here {
            u: part_of::<S>(&self.from[0][at], part),
            d: part_of::<S>(&self.from[1][at], part),
            v_before: part_of::<S>(&self.v[at], part),
            keep: part_of::<S>(&self.keep[at], part),
        };
        let sums = &mut self.sums;
        let [v, w] =
            self.around.step::<REACH, STRETCH, LOSS>(self.simd, self.weights, (ahead, moving), here, sums);
        S::as_mut_simd_f64s(&mut self.v[at]).0[part] = v;
        S::as_mut_simd_f64s(&mut self.w[at]).0[part] = w;
    }
}

/// The sweep of a prediction: v, the undivided second difference of u, and w, the motion in the next step were there no
/// contact and no tension modulation, both 0 where nothing moves; and their products.
pub(super) struct Predict<'a, const REACH: usize, const STRETCH: bool, const LOSS: bool> {
    pub weights: &'a Weights,
    /// G, the strength of tension modulation.
    pub stretch: f64,
    /// u and d.
    pub from: (&'a Field, &'a Field),
    /// v, a step ago until the sweep has passed, and w.
    pub to: (&'a mut Field, &'a mut Field),
    pub shape: &'a mut Shape,
    /// 1 at each point that moves, 0 elsewhere.
    pub keep: &'a Field,
}

impl<const REACH: usize, const STRETCH: bool, const LOSS: bool> WithSimd
    for Predict<'_, REACH, STRETCH, LOSS>
{
    /// (All else waits for these two: they are handed on in registers.)
    type Output = Stretching;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Stretching {
        let Predict { weights, stretch, from: (u, d), to: (v, w), shape, keep } = self;
        let splat = Splat::<S> {
            motion: simd.splat_f64s(weights.motion),
            near: weights.near.map(|weight| simd.splat_f64s(weight)),
            before: simd.splat_f64s(weights.before),
        };
        let (before, after) = (rows_before::<3>(u), rows_after::<3>(u));
        let (u, d, keep, v, w) = (rows(u), rows(d), rows(keep), rows_mut(v), rows_mut(w));
        let count = u.len();
        let (d, keep, v, w) = (&d[..count], &keep[..count], &mut v[..count], &mut w[..count]);
        let mut totals = [[0.0; LANES]; 3];
        for part in 0..vectors::<S>() {
            let zero = simd.splat_f64s(0.0);
            let mut sums = Sums { steepness: zero, along: zero, curvature: zero };
            let first = [
                part_of::<S>(&before[0], part),
                part_of::<S>(&before[1], part),
                part_of::<S>(&before[2], part),
                part_of::<S>(&u[0], part),
                part_of::<S>(&u[1], part),
                part_of::<S>(&u[2], part),
            ];
            let moving =
                [part_of::<S>(&keep[0], part), part_of::<S>(&keep[1], part), part_of::<S>(&keep[2], part)];
            let around = Around::first::<STRETCH>(simd, first, moving, &mut sums);
            let from = [u, d];
            let mut lanes = Lanes { simd, part, weights: &splat, keep, from, around, sums, v, w };
            for at in 0..count - 3 {
                lanes.predict::<REACH, STRETCH, LOSS>(at, (&u[at + 3], Some(&keep[at + 3])));
            }
            lanes.predict::<REACH, STRETCH, LOSS>(count - 3, (&after[0], None));
            lanes.predict::<REACH, STRETCH, LOSS>(count - 2, (&after[1], None));
            lanes.predict::<REACH, STRETCH, LOSS>(count - 1, (&after[2], None));
            let Sums { steepness, along, curvature } = lanes.sums;
            for (total, sum) in totals.iter_mut().zip([steepness, along, curvature]) {
                S::as_mut_simd_f64s(total).0[part] = sum;
            }
        }
        if !STRETCH {
            shape.steepness = total(&totals[0]);
            return Stretching { along: 0.0, yielding: 1.0 };
        }
        // The sum that is there first is divided by while the other is still added up.
        shape.curvature = total(&totals[2]);
        let yielding = 1.0 / (1.0 + stretch * shape.curvature);
        Stretching { along: total(&totals[1]), yielding }
    }
}
