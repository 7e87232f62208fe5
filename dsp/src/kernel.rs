//! The three passes over the grid in every sample. Every loop runs in groups of [`LANES`] with sums in
//! a fixed order, so that every instruction set gives the same bits; `pulp` picks the widest at run
//! time. There is no fused multiply-add.

use pulp::{Arch, Simd, WithSimd};

use crate::grid::{LANES, NUT};
use crate::model::{Model, Stiffness};
use crate::scene::Stencil;

/// Array index of the first unknown.
const FIRST: usize = NUT + 1;

/// The inner products of a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Products {
    /// |δu|², the sum of squared differences between neighbours, = −vᵀu.
    pub steepness: f64,
    /// vᵀ(w − d), v the undivided second difference of u.
    pub curvature_change: f64,
    /// vᵀv.
    pub curvature: f64,
    /// dᵀd.
    pub motion: f64,
}

/// Coefficients of one prediction in undivided differences, all times 1/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    /// Of the motion at a point itself.
    motion: f64,
    /// Of v, by distance.
    near: [f64; 3],
    /// Of the motion on either side.
    beside: f64,
}

impl Weights {
    /// The weights of a model at a stiffness.
    pub fn new(model: &Model, stiffness: &Stiffness) -> Self {
        let (k, h2) = (model.grid.time_step, model.grid.spacing * model.grid.spacing);
        let k2 = k * k * model.inverse_s;
        let second = k2 * stiffness.tension / (model.string.linear_density * h2);
        let fourth = k2 * stiffness.kappa_2 / (h2 * h2);
        let sixth = k2 * stiffness.kappa_6 / (h2 * h2 * h2);
        let loss = 2.0 * model.string.loss_1 * k * model.inverse_s / h2;
        // A multiple of 2⁻⁵² as `decay` is, so that their difference is exact: a string that moves as a whole
        // decays by `decay` and no rounding.
        let beside = (1.0 + loss) - 1.0;
        // second·v − fourth·δ²v + sixth·δ⁴v, gathered by neighbour; decay·d + loss·δ²d likewise.
        Weights {
            motion: model.decay - 2.0 * beside,
            near: [second + 2.0 * fourth + 6.0 * sixth, -fourth - 4.0 * sixth, sixth],
            beside,
        }
    }
}

/// What the vector instructions of a pass take at a time: [`LANES`] numbers side by side.
type Group = [f64; LANES];

/// So many groups of an array from an index on. (Loops over slices of one length need no checks.)
#[inline(always)]
fn groups(array: &[f64], at: usize, count: usize) -> &[Group] {
    &array[at..].as_chunks().0[..count]
}

/// The same to write to.
#[inline(always)]
fn groups_mut(array: &mut [f64], at: usize, count: usize) -> &mut [Group] {
    &mut array[at..].as_chunks_mut().0[..count]
}

/// A group as vectors of an instruction set's width.
#[inline(always)]
fn split<S: Simd>(group: &Group) -> &[S::f64s] {
    S::as_simd_f64s(group).0
}

/// The same to write to.
#[inline(always)]
fn split_mut<S: Simd>(group: &mut Group) -> &mut [S::f64s] {
    S::as_mut_simd_f64s(group).0
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

/// 1 for so many unknowns in the last group of lanes and 0 beyond.
const MASKS: [Group; LANES] = {
    let mut masks = [[0.0; LANES]; LANES];
    let mut count = 0;
    while count < LANES {
        let mut lane = 0;
        while lane < count {
            masks[count][lane] = 1.0;
            lane += 1;
        }
        count += 1;
    }
    masks
};

/// v = δ²u (undivided) on the unknowns, with odd ghosts beyond the ends, and |δu|².
///
/// The difference of differences is exact but for rounding of the differences themselves, so that the
/// force on a smooth string is good to its own last digits and not to those of u.
#[inline(always)]
fn curve<S: Simd>(simd: S, unknowns: usize, u: &[f64], v: &mut [f64]) -> f64 {
    let mut steepness = Sum::new(simd);
    let (whole, rest) = (unknowns / LANES, unknowns % LANES);
    let points = [0, 1, 2].map(|offset| groups(u, FIRST - 1 + offset, whole));
    let out = groups_mut(v, FIRST, whole);
    for at in 0..whole {
        let points = points.map(|points| &points[at]);
        curve_group::<S, false>(simd, &[1.0; LANES], points, &mut out[at], &mut steepness);
    }
    if rest > 0 {
        let points = [0, 1, 2].map(|offset| &groups(u, FIRST - 1 + offset, whole + 1)[whole]);
        let out = &mut groups_mut(v, FIRST, whole + 1)[whole];
        curve_group::<S, true>(simd, &MASKS[rest], points, out, &mut steepness);
    }
    let last = FIRST + unknowns - 1;
    v[FIRST - 2] = -v[FIRST];
    v[last + 2] = -v[last];
    steepness.total() + u[last] * u[last]
}

#[inline(always)]
fn curve_group<S: Simd, const TAIL: bool>(
    simd: S,
    keep: &Group,
    points: [&Group; 3],
    out: &mut Group,
    steepness: &mut Sum<S>,
) {
    let [left, here, right] = points.map(split::<S>);
    let (keep, out) = (split::<S>(keep), split_mut::<S>(out));
    for part in 0..vectors::<S>() {
        let before = simd.sub_f64s(here[part], left[part]);
        let after = simd.sub_f64s(right[part], here[part]);
        let value = simd.sub_f64s(after, before);
        out[part] = if TAIL { simd.mul_f64s(keep[part], value) } else { value };
        let kept = if TAIL { simd.mul_f64s(keep[part], before) } else { before };
        steepness.add_product(simd, part, kept, kept);
    }
}

/// What a prediction reads: v from two points left to two points right, d from one left to one right.
#[derive(Clone, Copy)]
struct Around<'a, T: ?Sized> {
    v: [&'a T; 5],
    d: [&'a T; 3],
}

impl<'a> Around<'a, [Group]> {
    #[inline(always)]
    fn new(v: &'a [f64], d: &'a [f64], count: usize) -> Self {
        Around {
            v: [0, 1, 2, 3, 4].map(|offset| groups(v, FIRST - 2 + offset, count)),
            d: [0, 1, 2].map(|offset| groups(d, FIRST - 1 + offset, count)),
        }
    }

    #[inline(always)]
    fn at(&self, at: usize) -> Around<'a, Group> {
        Around { v: self.v.map(|v| &v[at]), d: self.d.map(|d| &d[at]) }
    }
}

/// Weights in every lane.
struct Splat<S: Simd> {
    motion: S::f64s,
    near: [S::f64s; 3],
    beside: S::f64s,
}

/// Sums of a prediction: vᵀ(w − d), vᵀv, dᵀd.
struct Sums<S: Simd> {
    change: Sum<S>,
    curvature: Sum<S>,
    square: Sum<S>,
}

/// w: the motion in the next step were there no contact and no tension modulation; and its products.
#[inline(always)]
fn predict<S: Simd, const REACH: usize, const STRETCH: bool, const LOSS: bool>(
    simd: S,
    unknowns: usize,
    weights: &Weights,
    (v, d): (&[f64], &[f64]),
    w: &mut [f64],
) -> Products {
    let splat = Splat::<S> {
        motion: simd.splat_f64s(weights.motion),
        near: weights.near.map(|weight| simd.splat_f64s(weight)),
        beside: simd.splat_f64s(weights.beside),
    };
    let zero = Sum::new(simd);
    let mut sums = Sums { change: zero, curvature: zero, square: zero };
    let (whole, rest) = (unknowns / LANES, unknowns % LANES);
    let around = Around::new(v, d, whole);
    let out = groups_mut(w, FIRST, whole);
    for at in 0..whole {
        let (keep, around, out) = (&[1.0; LANES], around.at(at), &mut out[at]);
        predict_group::<S, REACH, STRETCH, LOSS, false>(simd, keep, &splat, around, out, &mut sums);
    }
    if rest > 0 {
        let around = Around::new(v, d, whole + 1).at(whole);
        let (keep, out) = (&MASKS[rest], &mut groups_mut(w, FIRST, whole + 1)[whole]);
        predict_group::<S, REACH, STRETCH, LOSS, true>(simd, keep, &splat, around, out, &mut sums);
    }
    Products {
        steepness: 0.0,
        curvature_change: sums.change.total(),
        curvature: sums.curvature.total(),
        motion: sums.square.total(),
    }
}

#[inline(always)]
fn predict_group<S: Simd, const REACH: usize, const STRETCH: bool, const LOSS: bool, const TAIL: bool>(
    simd: S,
    keep: &Group,
    weights: &Splat<S>,
    around: Around<Group>,
    out: &mut Group,
    sums: &mut Sums<S>,
) {
    let (v, d) = (around.v.map(split::<S>), around.d.map(split::<S>));
    let (keep, out) = (split::<S>(keep), split_mut::<S>(out));
    for part in 0..vectors::<S>() {
        let (v0, d0) = (v[2][part], d[1][part]);
        let mut value = simd.mul_f64s(weights.near[0], v0);
        if REACH > 0 {
            let beside = simd.add_f64s(v[1][part], v[3][part]);
            value = simd.add_f64s(value, simd.mul_f64s(weights.near[1], beside));
        }
        if REACH > 1 {
            let far = simd.add_f64s(v[0][part], v[4][part]);
            value = simd.add_f64s(value, simd.mul_f64s(weights.near[2], far));
        }
        if LOSS {
            let beside = simd.add_f64s(d[0][part], d[2][part]);
            value = simd.add_f64s(value, simd.mul_f64s(weights.beside, beside));
        }
        value = simd.add_f64s(value, simd.mul_f64s(weights.motion, d0));
        if TAIL {
            value = simd.mul_f64s(keep[part], value);
        }
        out[part] = value;
        sums.square.add_product(simd, part, d0, d0);
        if STRETCH {
            // In the last group one ghost of v may stand beyond the bridge.
            let v0 = if TAIL { simd.mul_f64s(keep[part], v0) } else { v0 };
            sums.change.add_product(simd, part, v0, simd.sub_f64s(value, d0));
            sums.curvature.add_product(simd, part, v0, v0);
        }
    }
}

/// Motion below this, m, is none: what runs ahead of a wave on a silent string would otherwise become a
/// subnormal number, slow on most machines and flushed to zero on some, and the bits would depend on the
/// host. The square of such a motion's last digit is still a normal number.
const STILL: f64 = 1e-120;

/// What the last pass goes from, and where it writes.
pub(crate) struct Advance<'a> {
    /// ψ.
    pub pull: f64,
    /// w, v and u.
    pub from: (&'a [f64], &'a [f64], &'a [f64]),
    /// d⁺ and u⁺.
    pub to: (&'a mut [f64], &'a mut [f64]),
    /// Heights that the points are held against.
    pub skyline: &'a [f64],
    /// How far the lowest point of each group is over its own.
    pub clearances: &'a mut [f64],
}

/// d⁺ = w − ψv and u⁺ = u + d⁺; returns the largest |d⁺|.
#[inline(always)]
fn advance<S: Simd, const STRETCH: bool, const SKYLINE: bool>(
    simd: S,
    unknowns: usize,
    Advance { pull, from: (w, v, u), to: (d_next, u_next), skyline, clearances }: Advance,
) -> f64 {
    // Beyond the unknowns w and v are 0, and so is what is written there.
    let count = unknowns.div_ceil(LANES);
    let pull = simd.splat_f64s(pull);
    let (zero, still) = (simd.splat_f64s(0.0), simd.splat_f64s(STILL));
    let mut largest = [zero; LANES];
    let (w, v, u) = (groups(w, FIRST, count), groups(v, FIRST, count), groups(u, FIRST, count));
    let (d_next, u_next) = (groups_mut(d_next, FIRST, count), groups_mut(u_next, FIRST, count));
    let skyline = if SKYLINE { groups(skyline, FIRST, count) } else { &[] };
    let clearances = if SKYLINE { &mut clearances[..count] } else { &mut [] };
    for at in 0..count {
        let [w, v, u] = [&w[at], &v[at], &u[at]].map(split::<S>);
        let (d_next, u_next) = (split_mut::<S>(&mut d_next[at]), split_mut::<S>(&mut u_next[at]));
        for part in 0..vectors::<S>() {
            let d = if STRETCH { simd.sub_f64s(w[part], simd.mul_f64s(pull, v[part])) } else { w[part] };
            let size = simd.abs_f64s(d);
            let d = simd.select_f64s(simd.less_than_f64s(size, still), zero, d);
            d_next[part] = d;
            u_next[part] = simd.add_f64s(u[part], d);
            largest[part] = simd.max_f64s(size, largest[part]);
        }
        if SKYLINE {
            let tops = split::<S>(&skyline[at]);
            let mut least = simd.sub_f64s(u_next[0], tops[0]);
            for part in 1..vectors::<S>() {
                least = simd.min_f64s(least, simd.sub_f64s(u_next[part], tops[part]));
            }
            clearances[at] = simd.reduce_min_f64s(least);
        }
    }
    let lanes: &[f64] = pulp::bytemuck::cast_slice(&largest[..vectors::<S>()]);
    lanes.iter().fold(0.0f64, |a, &b| a.max(b))
}

/// The passes of one model, on the widest instruction set of this machine.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kernel {
    arch: Arch,
    /// Neighbours of v on either side that the string's operator reads: 0 without stiffness, 1, or 2.
    reach: usize,
    stretch: bool,
    loss: bool,
    /// Whether points are held against a skyline.
    skyline: bool,
}

impl Kernel {
    /// The passes that a model needs; what it lacks is left out of the loops.
    pub fn new(model: &Model) -> Self {
        let reach = match model.settings.stencil {
            Stencil::Paper => usize::from(model.string.kappa_squared() > 0.0),
            Stencil::Corrected => 1,
            Stencil::Wide => 2,
        };
        Kernel {
            arch: Arch::new(),
            reach,
            stretch: model.stretch > 0.0,
            loss: model.string.loss_1 > 0.0,
            skyline: !model.contacts.is_empty(),
        }
    }

    /// The same passes with scalar instructions.
    pub fn without_vectors(self) -> Self {
        Kernel { arch: Arch::Scalar, ..self }
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
        match self.reach {
            0 => self.predict_reaching::<0>(unknowns, weights, u, d, v, w),
            1 => self.predict_reaching::<1>(unknowns, weights, u, d, v, w),
            _ => self.predict_reaching::<2>(unknowns, weights, u, d, v, w),
        }
    }

    fn predict_reaching<const REACH: usize>(
        &self,
        unknowns: usize,
        weights: &Weights,
        u: &[f64],
        d: &[f64],
        v: &mut [f64],
        w: &mut [f64],
    ) -> Products {
        match (self.stretch, self.loss) {
            (false, false) => self.run::<REACH, false, false>(unknowns, weights, u, d, v, w),
            (false, true) => self.run::<REACH, false, true>(unknowns, weights, u, d, v, w),
            (true, false) => self.run::<REACH, true, false>(unknowns, weights, u, d, v, w),
            (true, true) => self.run::<REACH, true, true>(unknowns, weights, u, d, v, w),
        }
    }

    fn run<const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &self,
        unknowns: usize,
        weights: &Weights,
        u: &[f64],
        d: &[f64],
        v: &mut [f64],
        w: &mut [f64],
    ) -> Products {
        self.arch.dispatch(Predict::<REACH, STRETCH, LOSS> { unknowns, weights, u, d, v, w })
    }

    /// The next motion and displacement, and if there is a skyline how far they are from it; returns the largest motion
    /// of a point, m.
    pub fn advance(&self, unknowns: usize, arrays: Advance) -> f64 {
        match (self.stretch, self.skyline) {
            (false, false) => self.arch.dispatch(LastPass::<false, false> { unknowns, arrays }),
            (false, true) => self.arch.dispatch(LastPass::<false, true> { unknowns, arrays }),
            (true, false) => self.arch.dispatch(LastPass::<true, false> { unknowns, arrays }),
            (true, true) => self.arch.dispatch(LastPass::<true, true> { unknowns, arrays }),
        }
    }
}

/// The passes of a prediction, to be compiled for each instruction set.
struct Predict<'a, const REACH: usize, const STRETCH: bool, const LOSS: bool> {
    unknowns: usize,
    weights: &'a Weights,
    u: &'a [f64],
    d: &'a [f64],
    v: &'a mut [f64],
    w: &'a mut [f64],
}

impl<const REACH: usize, const STRETCH: bool, const LOSS: bool> WithSimd
    for Predict<'_, REACH, STRETCH, LOSS>
{
    type Output = Products;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Products {
        let Predict { unknowns, weights, u, d, v, w } = self;
        let steepness = curve(simd, unknowns, u, v);
        let products = predict::<S, REACH, STRETCH, LOSS>(simd, unknowns, weights, (v, d), w);
        // The ghost beyond the bridge lies where `advance` writes.
        v[FIRST + unknowns + 1] = 0.0;
        Products { steepness, ..products }
    }
}

/// The last pass, likewise.
struct LastPass<'a, const STRETCH: bool, const SKYLINE: bool> {
    unknowns: usize,
    arrays: Advance<'a>,
}

impl<const STRETCH: bool, const SKYLINE: bool> WithSimd for LastPass<'_, STRETCH, SKYLINE> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        advance::<S, STRETCH, SKYLINE>(simd, self.unknowns, self.arrays)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

    /// All that this machine has.
    fn instruction_sets() -> Vec<Arch> {
        let mut all = vec![Arch::new()];
        #[cfg(target_arch = "x86_64")]
        all.extend(pulp::x86::V3::try_new().map(Arch::V3));
        all
    }

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
            let weights = Weights { motion: 0.97, near: [0.7, -0.03, 0.001], beside: 0.01 };
            let run = |arch: Arch| {
                let kernel = Kernel { arch, reach: 2, stretch: true, loss: true, skyline: true };
                let empty = || vec![0.0; grid.padded_len()];
                let (mut v, mut w, mut d_next, mut u_next) = (empty(), empty(), empty(), empty());
                let products = kernel.predict(unknowns, &weights, (&u, &d), &mut v, &mut w);
                let mut clearances = vec![0.0; unknowns.div_ceil(LANES)];
                let arrays = Advance {
                    pull: 1e-3,
                    from: (&w, &v, &u),
                    to: (&mut d_next, &mut u_next),
                    skyline: &d,
                    clearances: &mut clearances,
                };
                let largest = kernel.advance(unknowns, arrays);
                assert!(u_next[FIRST + unknowns..].iter().all(|value| *value == 0.0), "ends move");
                let bits: Vec<u64> = w.iter().chain(&d_next).chain(&u_next).map(|x| x.to_bits()).collect();
                (format!("{products:?} {clearances:?}"), largest.to_bits(), bits)
            };
            for arch in instruction_sets() {
                assert_eq!(run(arch), run(Arch::Scalar), "{intervals} intervals, {arch:?}");
            }
        }
    }
}
