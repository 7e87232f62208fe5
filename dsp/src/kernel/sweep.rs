//! The sweep of a prediction: rows one after another, with what is needed of their neighbours in registers.

use super::moving::Moving;
use super::{Shape, Stretching, Weights};
use crate::field::{BESIDE, Field, LANES, Row};
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
    fn add_slope(&mut self, simd: V, keep: Option<V::Vector>, slope: V::Vector) {
        let slope = keep.map_or(slope, |keep| simd.mul(keep, slope));
        self.steepness = simd.add_product(self.steepness, slope, slope);
    }
}

/// Weights in every lane.
struct Splat<V: Vectors> {
    motion: V::Vector,
    near: [V::Vector; 3],
    before: V::Vector,
}

/// What a prediction reads.
struct Here<V: Vectors> {
    u: V::Vector,
    d: V::Vector,
    /// v a step ago.
    v_before: V::Vector,
    /// u three rows ahead.
    ahead: V::Vector,
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
            sums.add_slope(simd, Some(keep[0]), slopes[2]);
            sums.add_slope(simd, Some(keep[1]), slopes[3]);
            sums.add_slope(simd, Some(keep[2]), slopes[4]);
        }
        Around { ahead: u[5], slope: slopes[4], v }
    }

    /// v and w of the present row, all of which moves, and the one three rows ahead, if `keep` does not say where they do;
    /// goes on to the next.
    ///
    /// The difference of differences is exact but for rounding of the differences themselves, so that the
    /// force on a smooth string is good to its own last digits and not to those of u.
    #[inline(always)]
    fn step<const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &mut self,
        simd: V,
        weights: &Splat<V>,
        Here { u, d, v_before, ahead }: Here<V>,
        keep: Option<[V::Vector; 2]>,
        sums: &mut Sums<V>,
    ) -> [V::Vector; 2] {
        let slope = simd.sub(ahead, self.ahead);
        let v = [self.v[0], self.v[1], self.v[2], self.v[3], simd.sub(slope, self.slope)];
        if !STRETCH {
            sums.add_slope(simd, keep.map(|[_, ahead]| ahead), slope);
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
        let [w, curvature] =
            [value, v[2]].map(|number| keep.map_or(number, |[here, _]| simd.mul(here, number)));
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
    /// v a step ago, then in this one.
    v: &'a mut Row,
    w: &'a mut Row,
    /// u three rows ahead.
    ahead: &'a Row,
}

/// 1 where a row moves and where the one three rows ahead does, 0 elsewhere.
struct Keep<'a> {
    here: &'a Row,
    ahead: &'a Row,
}

impl<V: Vectors> Lanes<'_, V> {
    /// Predicts a row, all of which moves, and the one three rows ahead, if it is not told where they do.
    #[inline(always)]
    fn predict<const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &mut self,
        At { u, d, v, w, ahead }: At,
        keep: Option<Keep>,
    ) {
        let (simd, part) = (self.simd, self.part);
        let here = Here {
            u: simd.part(u, part),
            d: simd.part(d, part),
            v_before: simd.part(v, part),
            ahead: simd.part(ahead, part),
        };
        let keep = keep.map(|Keep { here, ahead }| [here, ahead].map(|row| simd.part(row, part)));
        let [curvature, motion] =
            self.around.step::<REACH, STRETCH, LOSS>(simd, self.weights, here, keep, &mut self.sums);
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
    pub moving: &'a Moving,
}

impl<const REACH: usize, const STRETCH: bool, const LOSS: bool> Pass for Predict<'_, REACH, STRETCH, LOSS> {
    /// (All else waits for these two: they are handed on in registers.)
    type Output = Stretching;

    #[inline(always)]
    fn by<V: Vectors>(self, simd: V) -> Stretching {
        let Predict { weights, stretch, from: (u, d), to: (v, w), shape, moving } = self;
        let splat = Splat::<V> {
            motion: simd.splat(weights.motion),
            near: weights.near.map(|weight| simd.splat(weight)),
            before: simd.splat(weights.before),
        };
        let (u_all, keep_all) = (u.all_rows(), moving.keep.all_rows());
        let (u, d, v, w) = (u.rows(), d.rows(), v.rows_mut(), w.rows_mut());
        // (As many of each: their lengths are compared once, and not where rows are taken.)
        let count = u.len();
        let (d, v, w, keep) = (&d[..count], &mut v[..count], &mut w[..count], &moving.keep.rows()[..count]);
        let [u_ahead, keep_ahead] = [u_all, keep_all].map(|rows| &rows[2 * BESIDE..][..count]);
        // Two in each round, so that less of what is handed on has to change registers; in twos, since the compiler does not see that
        // twice a number of pairs is a number of rows. (Without stretching it is asked where the row three ahead moves, too.)
        let whole = if STRETCH { moving.whole } else { moving.whole.saturating_sub(BESIDE) };
        let pairs = (whole / 2).min(count / 2);
        let mut totals = [[0.0; LANES]; 3];
        for part in 0..V::PARTS {
            let zero = simd.splat(0.0);
            let mut sums = Sums { steepness: zero, along: zero, curvature: zero };
            let first = [0, 1, 2, 3, 4, 5].map(|row| simd.part(&u_all[row], part));
            let moves = [0, 1, 2].map(|row| simd.part(&keep[row], part));
            let around = Around::first::<STRETCH>(simd, first, moves, &mut sums);
            let mut lanes = Lanes { simd, part, weights: &splat, around, sums };
            for pair in 0..pairs {
                let [u, d, ahead] = [u, d, u_ahead].map(|rows| &rows.as_chunks::<2>().0[pair]);
                let [v, w] = [&mut *v, &mut *w].map(|rows| &mut rows.as_chunks_mut::<2>().0[pair]);
                for row in 0..2 {
                    let at =
                        At { u: &u[row], d: &d[row], v: &mut v[row], w: &mut w[row], ahead: &ahead[row] };
                    lanes.predict::<REACH, STRETCH, LOSS>(at, None);
                }
            }
            for row in 2 * pairs..count {
                let at = At { u: &u[row], d: &d[row], v: &mut v[row], w: &mut w[row], ahead: &u_ahead[row] };
                let keep = Keep { here: &keep[row], ahead: &keep_ahead[row] };
                lanes.predict::<REACH, STRETCH, LOSS>(at, Some(keep));
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
