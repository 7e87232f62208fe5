//! The sweep of a prediction: rows one after another, with what is needed of their neighbours in registers.

use super::rows::{rows, rows_after, rows_before, rows_mut};
use super::{Shape, Stretching, Weights};
use crate::field::{Field, LANES, Row};
use crate::instructions::{Pass, Vectors};

/// Sums of a sweep in each lane.
#[derive(Clone, Copy)]
struct Sums<V: Vectors> {
    /// |δu|².
    steepness: V::Vector,
    /// vᵀ(u + w).
    along: V::Vector,
    /// vᵀv.
    curvature: V::Vector,
}

impl<V: Vectors> Sums<V> {
    /// Adds the differences of a row to the one before, where it moves.
    #[inline(always)]
    fn add_slope(&mut self, simd: V, keep: V::Vector, slope: V::Vector) {
        let slope = simd.mul(keep, slope);
        self.steepness = simd.add_product(self.steepness, slope, slope);
    }
}

/// Weights in every lane.
struct Splat<V: Vectors> {
    motion: V::Vector,
    near: [V::Vector; 3],
    before: V::Vector,
}

/// What a prediction reads in its own row.
struct Here<V: Vectors> {
    u: V::Vector,
    d: V::Vector,
    /// v a step ago.
    v_before: V::Vector,
    /// 1 where it moves, 0 elsewhere.
    keep: V::Vector,
}

/// What a sweep knows of the rows around the present one.
struct Around<V: Vectors> {
    /// u two rows ahead.
    ahead: V::Vector,
    /// Its difference to the row before.
    slope: V::Vector,
    /// v from two rows before to one ahead.
    v: [V::Vector; 4],
}

impl<V: Vectors> Around<V> {
    /// Around the first row, of the three rows of u before it and the three from it on, and where the first three move.
    /// Adds up their slopes, which say how a string is stretched that does not pull itself tight.
    #[inline(always)]
    fn first<const STRETCH: bool>(
        simd: V,
        u: [V::Vector; 6],
        keep: [V::Vector; 3],
        sums: &mut Sums<V>,
    ) -> Self {
        let slopes = [
            simd.sub(u[1], u[0]),
            simd.sub(u[2], u[1]),
            simd.sub(u[3], u[2]),
            simd.sub(u[4], u[3]),
            simd.sub(u[5], u[4]),
        ];
        let v = [
            simd.sub(slopes[1], slopes[0]),
            simd.sub(slopes[2], slopes[1]),
            simd.sub(slopes[3], slopes[2]),
            simd.sub(slopes[4], slopes[3]),
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
        simd: V,
        weights: &Splat<V>,
        (ahead, moving): (V::Vector, Option<V::Vector>),
        Here { u, d, v_before, keep }: Here<V>,
        sums: &mut Sums<V>,
    ) -> [V::Vector; 2] {
        let slope = simd.sub(ahead, self.ahead);
        let v = [self.v[0], self.v[1], self.v[2], self.v[3], simd.sub(slope, self.slope)];
        if !STRETCH && let Some(moving) = moving {
            sums.add_slope(simd, moving, slope);
        }
        let mut value = simd.mul(weights.near[0], v[2]);
        if REACH > 0 {
            let beside = simd.add(v[1], v[3]);
            value = simd.add(value, simd.mul(weights.near[1], beside));
        }
        if REACH > 1 {
            let far = simd.add(v[0], v[4]);
            value = simd.add(value, simd.mul(weights.near[2], far));
        }
        if LOSS {
            value = simd.sub(value, simd.mul(weights.before, v_before));
        }
        value = simd.add(value, simd.mul(weights.motion, d));
        let w = simd.mul(keep, value);
        let curvature = simd.mul(keep, v[2]);
        if STRETCH {
            sums.along = simd.add_product(sums.along, curvature, simd.add(u, w));
            sums.curvature = simd.add_product(sums.curvature, curvature, curvature);
        }
        *self = Around { ahead, slope, v: [v[1], v[2], v[3], v[4]] };
        [curvature, w]
    }
}

/// Some lanes of all rows, on the way through them.
struct Lanes<'a, V: Vectors> {
    simd: V,
    part: usize,
    weights: &'a Splat<V>,
    around: Around<V>,
    sums: Sums<V>,
}

/// A row as it is predicted.
struct At<'a> {
    u: &'a Row,
    d: &'a Row,
    keep: &'a Row,
    /// v a step ago, then in this one.
    v: &'a mut Row,
    w: &'a mut Row,
}

/// Rows one after another.
#[inline(always)]
fn at_each<'a>(
    (u, d, keep): (&'a [Row], &'a [Row], &'a [Row]),
    (v, w): (&'a mut [Row], &'a mut [Row]),
) -> impl Iterator<Item = At<'a>> {
    u.iter().zip(d).zip(keep).zip(v).zip(w).map(|((((u, d), keep), v), w)| At { u, d, keep, v, w })
}

impl<V: Vectors> Lanes<'_, V> {
    /// Predicts a row, given u three rows ahead.
    #[inline(always)]
    fn predict<const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &mut self,
        At { u, d, keep, v, w }: At,
        (ahead, moving): (&Row, Option<&Row>),
    ) {
        let (simd, part) = (self.simd, self.part);
        let moving = moving.map(|moving| simd.part(moving, part));
        let ahead = simd.part(ahead, part);
        let here = Here {
            u: simd.part(u, part),
            d: simd.part(d, part),
            v_before: simd.part(v, part),
            keep: simd.part(keep, part),
        };
        let sums = &mut self.sums;
        let [curvature, motion] =
            self.around.step::<REACH, STRETCH, LOSS>(simd, self.weights, (ahead, moving), here, sums);
        simd.put(v, part, curvature);
        simd.put(w, part, motion);
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

impl<const REACH: usize, const STRETCH: bool, const LOSS: bool> Pass for Predict<'_, REACH, STRETCH, LOSS> {
    /// (All else waits for these two: they are handed on in registers.)
    type Output = Stretching;

    #[inline(always)]
    fn by<V: Vectors>(self, simd: V) -> Stretching {
        let Predict { weights, stretch, from: (u, d), to: (v, w), shape, keep } = self;
        let splat = Splat::<V> {
            motion: simd.splat(weights.motion),
            near: weights.near.map(|weight| simd.splat(weight)),
            before: simd.splat(weights.before),
        };
        let (before, after) = (rows_before::<3>(u), rows_after::<3>(u));
        let (u, v, w) = (rows(u), rows_mut(v), rows_mut(w));
        // (As many of each: their lengths are compared once, and not where rows are taken together.)
        let count = u.len();
        let [d, keep] = [d, keep].map(|field| &rows(field)[..count]);
        let (v, w) = (&mut v[..count], &mut w[..count]);
        // The last three rows are followed by the first ones of the pieces beside.
        let inner = count - 3;
        let (u_inner, u_last) = u.split_at(inner);
        let (d_inner, d_last) = d.split_at(inner);
        let (keep_inner, keep_last) = keep.split_at(inner);
        let (v_inner, v_last) = v.split_at_mut(inner);
        let (w_inner, w_last) = w.split_at_mut(inner);
        let mut totals = [[0.0; LANES]; 3];
        for part in 0..V::PARTS {
            let zero = simd.splat(0.0);
            let mut sums = Sums { steepness: zero, along: zero, curvature: zero };
            let first = [
                simd.part(before[0], part),
                simd.part(before[1], part),
                simd.part(before[2], part),
                simd.part(&u[0], part),
                simd.part(&u[1], part),
                simd.part(&u[2], part),
            ];
            let moving = [simd.part(&keep[0], part), simd.part(&keep[1], part), simd.part(&keep[2], part)];
            let around = Around::first::<STRETCH>(simd, first, moving, &mut sums);
            let mut lanes = Lanes { simd, part, weights: &splat, around, sums };
            let mut inner = at_each((u_inner, d_inner, keep_inner), (v_inner, w_inner))
                .zip(u[3..].iter().zip(&keep[3..]));
            // Two in each round, so that less of what is handed on has to change registers.
            while let Some((at, (ahead, moving))) = inner.next() {
                lanes.predict::<REACH, STRETCH, LOSS>(at, (ahead, Some(moving)));
                let Some((at, (ahead, moving))) = inner.next() else { break };
                lanes.predict::<REACH, STRETCH, LOSS>(at, (ahead, Some(moving)));
            }
            let last = at_each((u_last, d_last, keep_last), (v_last, w_last));
            for (at, ahead) in last.zip(after) {
                lanes.predict::<REACH, STRETCH, LOSS>(at, (ahead, None));
            }
            let Sums { steepness, along, curvature } = lanes.sums;
            for (total, sum) in totals.iter_mut().zip([steepness, along, curvature]) {
                simd.put(total, part, sum);
            }
        }
        if !STRETCH {
            shape.steepness = simd.total(&totals[0]);
            return Stretching { along: 0.0, yielding: 1.0 };
        }
        // The sum that is there first is divided by while the other is still added up.
        shape.curvature = simd.total(&totals[2]);
        let yielding = 1.0 / (1.0 + stretch * shape.curvature);
        Stretching { along: simd.total(&totals[1]), yielding }
    }
}
