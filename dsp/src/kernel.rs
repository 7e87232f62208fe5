//! The three passes over the grid in every sample. Every loop runs in groups of [`LANES`] with sums in
//! a fixed order, so that every instruction set gives the same bits; `pulp` picks the widest at run
//! time. There is no fused multiply-add.

use pulp::{Arch, Simd, WithSimd};

use crate::grid::{LANES, NUT};
use crate::model::{Model, Stiffness};

/// Array index of the first unknown.
const FIRST: usize = NUT + 1;

/// The inner products of a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Products {
    /// |δu|², the sum of squared differences between neighbours, = −vᵀu.
    pub steepness: f64,
    /// vᵀw, v the undivided second difference of u.
    pub curvature_prediction: f64,
    /// vᵀd.
    pub curvature_motion: f64,
    /// vᵀv.
    pub curvature: f64,
    /// dᵀd.
    pub motion: f64,
}

/// Coefficients of one prediction in undivided differences, all times 1/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    decay: f64,
    near: [f64; 3],
    loss_1: f64,
}

impl Weights {
    /// The weights of a model at a stiffness.
    pub fn new(model: &Model, stiffness: &Stiffness) -> Self {
        let (k, h2) = (model.grid.time_step, model.grid.spacing * model.grid.spacing);
        let k2 = k * k * model.inverse_s;
        let second = k2 * stiffness.tension / (model.string.linear_density * h2);
        let fourth = k2 * stiffness.kappa_2 / (h2 * h2);
        let sixth = k2 * stiffness.kappa_6 / (h2 * h2 * h2);
        // second·v − fourth·δ²v + sixth·δ⁴v, gathered by neighbour.
        Weights {
            decay: model.decay,
            near: [second + 2.0 * fourth + 6.0 * sixth, -fourth - 4.0 * sixth, sixth],
            loss_1: 2.0 * model.string.loss_1 * k * model.inverse_s / h2,
        }
    }
}

/// An array from an index on, as vectors of an instruction set's width.
#[inline(always)]
fn from<S: Simd>(array: &[f64], at: usize) -> &[S::f64s] {
    S::as_simd_f64s(&array[at..]).0
}

/// The same to write to.
#[inline(always)]
fn from_mut<S: Simd>(array: &mut [f64], at: usize) -> &mut [S::f64s] {
    S::as_mut_simd_f64s(&mut array[at..]).0
}

/// Vectors in a group of lanes.
#[inline(always)]
fn vectors<S: Simd>() -> usize {
    LANES / S::F64_LANES
}

/// Sums in [`LANES`] lanes, so that every width adds the same numbers in the same order. An instruction
/// set uses as many of the vectors as it needs.
#[derive(Clone, Copy)]
struct Sum<S: Simd>([S::f64s; LANES]);

impl<S: Simd> Sum<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        Sum([simd.splat_f64s(0.0); LANES])
    }

    #[inline(always)]
    fn add_product(&mut self, simd: S, part: usize, a: S::f64s, b: S::f64s) {
        self.0[part] = simd.add_f64s(self.0[part], simd.mul_f64s(a, b));
    }

    /// The lanes in their order.
    #[inline(always)]
    fn lanes(&self) -> [f64; LANES] {
        let mut lanes = [0.0; LANES];
        lanes.copy_from_slice(&pulp::bytemuck::cast_slice(&self.0[..vectors::<S>()])[..LANES]);
        lanes
    }

    /// The sum over lanes in a fixed order.
    #[inline(always)]
    fn total(&self) -> f64 {
        let l = self.lanes();
        ((l[0] + l[4]) + (l[1] + l[5])) + ((l[2] + l[6]) + (l[3] + l[7]))
    }
}

/// 1 for the unknowns of the last group of lanes and 0 beyond.
#[inline(always)]
fn mask(count: usize) -> [f64; LANES] {
    std::array::from_fn(|lane| if lane < count { 1.0 } else { 0.0 })
}

/// Runs a pass over all groups of lanes: whole ones, then the last with a mask, if any is left.
macro_rules! over_groups {
    ($simd:expr, $unknowns:expr, $group:ident $(::<$($generic:ident),*>)?, $($argument:expr),*) => {{
        let parts = vectors::<S>();
        let whole = $unknowns / LANES;
        let one = $simd.splat_f64s(1.0);
        for group in 0..whole {
            for part in 0..parts {
                $group::<S, $($($generic,)*)? false>($simd, group * parts + part, part, one, $($argument),*);
            }
        }
        let rest = $unknowns % LANES;
        if rest > 0 {
            let keep = mask(rest);
            let keep = S::as_simd_f64s(&keep).0;
            for part in 0..parts {
                let at = whole * parts + part;
                $group::<S, $($($generic,)*)? true>($simd, at, part, keep[part], $($argument),*);
            }
        }
    }};
}

/// v = δ²u (undivided) on the unknowns, with odd ghosts beyond the ends, and |δu|².
///
/// The difference of differences is exact but for rounding of the differences themselves, so that the
/// force on a smooth string is good to its own last digits and not to those of u.
#[inline(always)]
fn curve<S: Simd>(simd: S, unknowns: usize, u: &[f64], v: &mut [f64]) -> f64 {
    let mut steepness = Sum::new(simd);
    let points = [from::<S>(u, FIRST - 1), from::<S>(u, FIRST), from::<S>(u, FIRST + 1)];
    let out = from_mut::<S>(v, FIRST);
    over_groups!(simd, unknowns, curve_group, &points, out, &mut steepness);
    let last = FIRST + unknowns - 1;
    v[FIRST - 2] = -v[FIRST];
    v[last + 2] = -v[last];
    steepness.total() + u[last] * u[last]
}

#[inline(always)]
fn curve_group<S: Simd, const TAIL: bool>(
    simd: S,
    at: usize,
    part: usize,
    keep: S::f64s,
    [left, here, right]: &[&[S::f64s]; 3],
    out: &mut [S::f64s],
    steepness: &mut Sum<S>,
) {
    let before = simd.sub_f64s(here[at], left[at]);
    let after = simd.sub_f64s(right[at], here[at]);
    let value = simd.sub_f64s(after, before);
    out[at] = if TAIL { simd.mul_f64s(keep, value) } else { value };
    let kept = if TAIL { simd.mul_f64s(keep, before) } else { before };
    steepness.add_product(simd, part, kept, kept);
}

/// What a prediction reads: v from two points left to two points right, d from one left to one right.
struct Around<'a, S: Simd> {
    v: [&'a [S::f64s]; 5],
    d: [&'a [S::f64s]; 3],
}

/// Weights in every lane.
struct Splat<S: Simd> {
    decay: S::f64s,
    near: [S::f64s; 3],
    loss_1: S::f64s,
}

/// Sums of a prediction: vᵀw, vᵀd, vᵀv, dᵀd.
struct Sums<S: Simd> {
    prediction: Sum<S>,
    motion: Sum<S>,
    curvature: Sum<S>,
    square: Sum<S>,
}

/// w: the motion in the next step were there no contact and no tension modulation; and its products.
#[inline(always)]
fn predict<S: Simd, const WIDE: bool, const STRETCH: bool, const LOSS: bool>(
    simd: S,
    unknowns: usize,
    weights: &Weights,
    (v, d): (&[f64], &[f64]),
    w: &mut [f64],
) -> Products {
    let splat = Splat::<S> {
        decay: simd.splat_f64s(weights.decay),
        near: weights.near.map(|weight| simd.splat_f64s(weight)),
        loss_1: simd.splat_f64s(weights.loss_1),
    };
    let around = Around::<S> {
        v: [0, 1, 2, 3, 4].map(|offset| from::<S>(v, FIRST - 2 + offset)),
        d: [0, 1, 2].map(|offset| from::<S>(d, FIRST - 1 + offset)),
    };
    let zero = Sum::new(simd);
    let mut sums = Sums { prediction: zero, motion: zero, curvature: zero, square: zero };
    let out = from_mut::<S>(w, FIRST);
    over_groups!(simd, unknowns, predict_group::<WIDE, STRETCH, LOSS>, &splat, &around, out, &mut sums);
    Products {
        steepness: 0.0,
        curvature_prediction: sums.prediction.total(),
        curvature_motion: sums.motion.total(),
        curvature: sums.curvature.total(),
        motion: sums.square.total(),
    }
}

#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn predict_group<S: Simd, const WIDE: bool, const STRETCH: bool, const LOSS: bool, const TAIL: bool>(
    simd: S,
    at: usize,
    part: usize,
    keep: S::f64s,
    weights: &Splat<S>,
    around: &Around<S>,
    out: &mut [S::f64s],
    sums: &mut Sums<S>,
) {
    let (v0, d0) = (around.v[2][at], around.d[1][at]);
    let beside = simd.add_f64s(around.v[1][at], around.v[3][at]);
    let mut value = simd.add_f64s(simd.mul_f64s(weights.near[0], v0), simd.mul_f64s(weights.near[1], beside));
    if WIDE {
        let far = simd.add_f64s(around.v[0][at], around.v[4][at]);
        value = simd.add_f64s(value, simd.mul_f64s(weights.near[2], far));
    }
    if LOSS {
        let after = simd.sub_f64s(around.d[2][at], d0);
        let before = simd.sub_f64s(d0, around.d[0][at]);
        value = simd.add_f64s(value, simd.mul_f64s(weights.loss_1, simd.sub_f64s(after, before)));
    }
    value = simd.add_f64s(value, simd.mul_f64s(weights.decay, d0));
    if TAIL {
        value = simd.mul_f64s(keep, value);
    }
    out[at] = value;
    sums.square.add_product(simd, part, d0, d0);
    if STRETCH {
        // In the last group one ghost of v may stand beyond the bridge.
        let v0 = if TAIL { simd.mul_f64s(keep, v0) } else { v0 };
        sums.prediction.add_product(simd, part, v0, value);
        sums.motion.add_product(simd, part, v0, d0);
        sums.curvature.add_product(simd, part, v0, v0);
    }
}

/// Motion below this, m, is none: what runs ahead of a wave on a silent string would otherwise become a
/// subnormal number, slow on most machines and flushed to zero on some, and the bits would depend on the
/// host. The square of such a motion's last digit is still a normal number.
const STILL: f64 = 1e-120;

/// d⁺ = w − ψv and u⁺ = u + d⁺; returns the largest |d⁺|.
#[inline(always)]
fn advance<S: Simd, const STRETCH: bool>(
    simd: S,
    unknowns: usize,
    pull: f64,
    (w, v, u): (&[f64], &[f64], &[f64]),
    d_next: &mut [f64],
    u_next: &mut [f64],
) -> f64 {
    // Beyond the unknowns w and v are 0, and so is what is written there.
    let count = unknowns.div_ceil(LANES) * vectors::<S>();
    let pull = simd.splat_f64s(pull);
    let (zero, still) = (simd.splat_f64s(0.0), simd.splat_f64s(STILL));
    let mut largest = [simd.splat_f64s(0.0); 2];
    let (w, v, u) =
        (&from::<S>(w, FIRST)[..count], &from::<S>(v, FIRST)[..count], &from::<S>(u, FIRST)[..count]);
    let d_next = &mut from_mut::<S>(d_next, FIRST)[..count];
    let u_next = &mut from_mut::<S>(u_next, FIRST)[..count];
    for at in 0..count {
        let d = if STRETCH { simd.sub_f64s(w[at], simd.mul_f64s(pull, v[at])) } else { w[at] };
        let size = simd.abs_f64s(d);
        let d = simd.select_f64s(simd.less_than_f64s(size, still), zero, d);
        d_next[at] = d;
        u_next[at] = simd.add_f64s(u[at], d);
        largest[at % 2] = simd.max_f64s(size, largest[at % 2]);
    }
    let lanes: &[f64] = pulp::bytemuck::cast_slice(&largest);
    lanes.iter().fold(0.0f64, |a, &b| a.max(b))
}

/// The passes of one model, on the widest instruction set of this machine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kernel {
    arch: Arch,
    wide: bool,
    stretch: bool,
    loss: bool,
}

impl Kernel {
    /// The passes that a model needs; what it lacks is left out of the loops.
    pub fn new(model: &Model) -> Self {
        Kernel {
            arch: Arch::new(),
            wide: model.settings.stencil == crate::scene::Stencil::Wide,
            stretch: model.stretch > 0.0,
            loss: model.string.loss_1 > 0.0,
        }
    }

    /// Second differences v and the prediction w, with their products.
    pub fn predict(
        &self,
        unknowns: usize,
        weights: &Weights,
        (u, d): (&[f64], &[f64]),
        v: &mut [f64],
        w: &mut [f64],
    ) -> Products {
        match (self.wide, self.stretch, self.loss) {
            (false, false, false) => self.run::<false, false, false>(unknowns, weights, u, d, v, w),
            (false, false, true) => self.run::<false, false, true>(unknowns, weights, u, d, v, w),
            (false, true, false) => self.run::<false, true, false>(unknowns, weights, u, d, v, w),
            (false, true, true) => self.run::<false, true, true>(unknowns, weights, u, d, v, w),
            (true, false, false) => self.run::<true, false, false>(unknowns, weights, u, d, v, w),
            (true, false, true) => self.run::<true, false, true>(unknowns, weights, u, d, v, w),
            (true, true, false) => self.run::<true, true, false>(unknowns, weights, u, d, v, w),
            (true, true, true) => self.run::<true, true, true>(unknowns, weights, u, d, v, w),
        }
    }

    fn run<const WIDE: bool, const STRETCH: bool, const LOSS: bool>(
        &self,
        unknowns: usize,
        weights: &Weights,
        u: &[f64],
        d: &[f64],
        v: &mut [f64],
        w: &mut [f64],
    ) -> Products {
        self.arch.dispatch(Predict::<WIDE, STRETCH, LOSS> { unknowns, weights, u, d, v, w })
    }

    /// The next motion and displacement; returns the largest motion of a point, m.
    pub fn advance(
        &self,
        unknowns: usize,
        pull: f64,
        from: (&[f64], &[f64], &[f64]),
        d_next: &mut [f64],
        u_next: &mut [f64],
    ) -> f64 {
        if self.stretch {
            self.arch.dispatch(Advance::<true> { unknowns, pull, from, d_next, u_next })
        } else {
            self.arch.dispatch(Advance::<false> { unknowns, pull, from, d_next, u_next })
        }
    }
}

/// The passes of a prediction, to be compiled for each instruction set.
struct Predict<'a, const WIDE: bool, const STRETCH: bool, const LOSS: bool> {
    unknowns: usize,
    weights: &'a Weights,
    u: &'a [f64],
    d: &'a [f64],
    v: &'a mut [f64],
    w: &'a mut [f64],
}

impl<const WIDE: bool, const STRETCH: bool, const LOSS: bool> WithSimd for Predict<'_, WIDE, STRETCH, LOSS> {
    type Output = Products;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Products {
        let Predict { unknowns, weights, u, d, v, w } = self;
        let steepness = curve(simd, unknowns, u, v);
        let products = predict::<S, WIDE, STRETCH, LOSS>(simd, unknowns, weights, (v, d), w);
        // The ghost beyond the bridge lies where `advance` writes.
        v[FIRST + unknowns + 1] = 0.0;
        Products { steepness, ..products }
    }
}

/// The last pass, likewise.
struct Advance<'a, const STRETCH: bool> {
    unknowns: usize,
    pull: f64,
    from: (&'a [f64], &'a [f64], &'a [f64]),
    d_next: &'a mut [f64],
    u_next: &'a mut [f64],
}

impl<const STRETCH: bool> WithSimd for Advance<'_, STRETCH> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        advance::<S, STRETCH>(simd, self.unknowns, self.pull, self.from, self.d_next, self.u_next)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

    /// Every instruction set gives the same bits, for every number of points in the last group.
    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        for intervals in 9..=26 {
            let grid = Grid::new(0.65, intervals, 1e-5);
            let unknowns = grid.unknowns();
            let mut seed = intervals as u64;
            let mut random = || {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
            };
            let mut array = || {
                let mut values = vec![0.0; grid.padded_len()];
                values[FIRST..FIRST + unknowns].fill_with(&mut random);
                values
            };
            let (u, d) = (array(), array());
            let weights = Weights { decay: 0.99, near: [0.7, -0.03, 0.001], loss_1: 0.01 };
            let run = |arch: Arch| {
                let kernel = Kernel { arch, wide: true, stretch: true, loss: true };
                let empty = || vec![0.0; grid.padded_len()];
                let (mut v, mut w, mut d_next, mut u_next) = (empty(), empty(), empty(), empty());
                let products = kernel.predict(unknowns, &weights, (&u, &d), &mut v, &mut w);
                let largest = kernel.advance(unknowns, 1e-3, (&w, &v, &u), &mut d_next, &mut u_next);
                assert!(u_next[FIRST + unknowns..].iter().all(|value| *value == 0.0), "ends move");
                let bits: Vec<u64> = w.iter().chain(&d_next).chain(&u_next).map(|x| x.to_bits()).collect();
                (format!("{products:?}"), largest.to_bits(), bits)
            };
            assert_eq!(run(Arch::new()), run(Arch::Scalar), "{intervals} intervals");
        }
    }
}
