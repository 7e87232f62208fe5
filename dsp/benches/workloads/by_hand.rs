//! What a free string does, in the shortest way that it can be written by hand: stiff and lossy, linear or stretching, but with nothing
//! known of its energy, of what it might touch, or of when it rests.

use std::hint::black_box;

use pulp::{Arch, Simd, WithSimd};

use super::points::{FIRST, Points, points};
use super::{OneString, SAMPLES};

/// A string in order of place.
#[derive(Clone)]
pub struct ByHand {
    arch: Arch,
    /// u, d = u − u⁻, v = δ²u and w, the motion that is predicted, m; v is that of a step ago before a step.
    u: Points,
    d: Points,
    v: Points,
    w: Points,
    /// (δu)ᵀδu⁻, m².
    stretched: f64,
    weights: Weights,
    unknowns: usize,
}

/// Coefficients of the motion.
#[derive(Clone, Copy)]
struct Weights {
    /// Of d.
    motion: f64,
    /// Of u, by distance.
    near: [f64; 4],
    /// Of v a step ago, taken away.
    before: f64,
    /// G, the strength of tension modulation.
    stretch: f64,
}

impl ByHand {
    /// Where a free string is, and under way as it is.
    pub fn new(free: &OneString) -> Self {
        let (displacement, motion) = (free.displacement(), free.motion());
        let before: Vec<f64> = displacement.iter().zip(&motion).map(|(u, d)| u - d).collect();
        let (u, u_before) = (points(&displacement), points(&before));
        let slopes = |u: &Points| -> Vec<f64> {
            (FIRST..=FIRST + before.len()).map(|point| u[point] - u[point - 1]).collect()
        };
        let [slope, slope_before] = [&u, &u_before].map(slopes);
        let bends: Vec<f64> = slope_before.windows(2).map(|pair| pair[1] - pair[0]).collect();
        ByHand {
            arch: Arch::new(),
            d: points(&motion),
            v: points(&bends),
            w: u.clone(),
            u,
            stretched: slope.iter().zip(&slope_before).map(|(now, before)| now * before).sum(),
            weights: Weights::new(free),
            unknowns: before.len(),
        }
    }

    /// [`SAMPLES`] samples.
    pub fn run(&mut self) -> f64 {
        self.steps::<true>()
    }

    /// The same of a string that does not pull itself tight: a linear one.
    pub fn run_linear(&mut self) -> f64 {
        self.steps::<false>()
    }

    fn steps<const STRETCHES: bool>(&mut self) -> f64 {
        for _ in 0..SAMPLES {
            let ByHand { arch, u, d, v, w, stretched, weights, unknowns } = self;
            // Beyond the ends the string goes on oddly.
            let past = FIRST + *unknowns;
            (u[FIRST - 2], u[FIRST - 3]) = (-u[FIRST], -u[FIRST + 1]);
            (u[past + 1], u[past + 2]) = (-u[past - 1], -u[past - 2]);
            let unknowns = *unknowns;
            arch.dispatch(Step::<STRETCHES> { u, d, v, w, stretched, weights, unknowns });
            // What the last vectors wrote beyond the end.
            for written in [u, d, v] {
                written[past..].fill(0.0);
            }
        }
        black_box(self.u.iter().sum())
    }

    /// Where its moving points are, m.
    pub fn displacement(&self) -> &[f64] {
        &self.u[FIRST..FIRST + self.unknowns]
    }
}

impl Weights {
    /// Those of docs/physics.md.
    fn new(free: &OneString) -> Self {
        let (string, grid) = (&free.model.string, &free.model.grid);
        let stiffness = free.model.stiffness(string.tension);
        let (k, h) = (grid.time_step, grid.spacing);
        let (k2, h2) = (k * k, h * h);
        let s = 1.0 + string.loss_0 * k;
        let second = k2 * stiffness.tension / (string.linear_density * h2 * s);
        let fourth = k2 * stiffness.kappa_squared / (h2 * h2 * s);
        let sixth = k2 * stiffness.kappa_6 / (h2 * h2 * h2 * s);
        let before = 2.0 * string.loss_1 * k / (h2 * s);
        // Of v, by distance; each v is a second difference of u.
        let [v0, v1, v2] = [second + 2.0 * fourth + 6.0 * sixth + before, -fourth - 4.0 * sixth, sixth];
        Weights {
            motion: (1.0 - string.loss_0 * k) / s,
            near: [2.0 * (v1 - v0), v0 - 2.0 * v1 + v2, v1 - 2.0 * v2, v2],
            before,
            stretch: k2 * string.axial_stiffness()
                / (4.0 * string.linear_density * string.length * h2 * h * s),
        }
    }
}

struct Step<'a, const STRETCHES: bool> {
    u: &'a mut [f64],
    d: &'a mut [f64],
    v: &'a mut [f64],
    w: &'a mut [f64],
    stretched: &'a mut f64,
    weights: &'a Weights,
    unknowns: usize,
}

impl<const STRETCHES: bool> WithSimd for Step<'_, STRETCHES> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Step { u, d, v, w, stretched, weights, unknowns } = self;
        let count = unknowns.div_ceil(S::F64_LANES);
        let last_lanes = simd.mask_between_m64s(0, (unknowns - (count - 1) * S::F64_LANES) as u64).mask();
        let [motion, before] = [weights.motion, weights.before].map(|weight| simd.splat_f64s(weight));
        let near = weights.near.map(|weight| simd.splat_f64s(weight));
        let none = simd.splat_f64s(0.0);
        let points: [_; 7] =
            std::array::from_fn(|shift| &S::as_simd_f64s(&u[FIRST + shift - 3..]).0[..count]);
        let [v, w, d] = [v, w, d].map(|field| &mut S::as_mut_simd_f64s(&mut field[FIRST..]).0[..count]);
        let (mut along, mut curvature) = (none, none);
        for at in 0..count {
            let here = points[3][at];
            let beside: [_; 3] =
                std::array::from_fn(|away| simd.add_f64s(points[2 - away][at], points[4 + away][at]));
            let bend = simd.sub_f64s(beside[0], simd.add_f64s(here, here));
            let mut value = simd.mul_f64s(near[0], here);
            for (near, beside) in near[1..].iter().zip(beside) {
                value = simd.add_f64s(value, simd.mul_f64s(*near, beside));
            }
            value = simd.sub_f64s(value, simd.mul_f64s(before, v[at]));
            value = simd.add_f64s(value, simd.mul_f64s(motion, d[at]));
            if !STRETCHES {
                (v[at], d[at]) = (bend, value);
                continue;
            }
            let bend = if at + 1 < count { bend } else { simd.select_f64s(last_lanes, bend, none) };
            along = simd.add_f64s(along, simd.mul_f64s(bend, simd.add_f64s(here, value)));
            curvature = simd.add_f64s(curvature, simd.mul_f64s(bend, bend));
            (v[at], w[at]) = (bend, value);
        }
        let yielding = 1.0 / (1.0 + weights.stretch * simd.reduce_sum_f64s(curvature));
        let stretching = 0.5 * yielding * (*stretched - simd.reduce_sum_f64s(along));
        *stretched = 2.0 * stretching - *stretched;
        let pull = simd.splat_f64s(-2.0 * weights.stretch * stretching);
        let u = &mut S::as_mut_simd_f64s(&mut u[FIRST..]).0[..count];
        for at in 0..count {
            if STRETCHES {
                d[at] = simd.sub_f64s(w[at], simd.mul_f64s(pull, v[at]));
            }
            u[at] = simd.add_f64s(u[at], d[at]);
        }
    }
}
