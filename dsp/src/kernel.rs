//! The three passes over the grid in every sample. Every loop runs in groups of [`LANES`] with sums in
//! a fixed order, so that every instruction set gives the same bits; `pulp` picks the widest at run
//! time. There is no fused multiply-add.

use pulp::Arch;

use crate::grid::{LANES, NUT};
use crate::model::{Model, Stiffness};

type Lanes = [f64; LANES];

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

#[inline(always)]
fn load(array: &[f64], at: usize) -> &Lanes {
    let (lanes, _) = array[at..].split_first_chunk::<LANES>().expect("arrays are padded");
    lanes
}

#[inline(always)]
fn store(array: &mut [f64], at: usize) -> &mut Lanes {
    let (lanes, _) = array[at..].split_first_chunk_mut::<LANES>().expect("arrays are padded");
    lanes
}

/// A sum over lanes in a fixed order.
#[inline(always)]
fn total(lanes: &Lanes) -> f64 {
    ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) + ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]))
}

/// 1 for the unknowns of the last group of lanes and 0 beyond.
#[inline(always)]
fn mask(count: usize) -> Lanes {
    std::array::from_fn(|lane| if lane < count { 1.0 } else { 0.0 })
}

/// v = δ²u (undivided) on the unknowns, with odd ghosts beyond the ends, and |δu|².
///
/// The difference of differences is exact but for rounding of the differences themselves, so that the
/// force on a smooth string is good to its own last digits and not to those of u.
#[inline(always)]
fn curve(unknowns: usize, u: &[f64], v: &mut [f64]) -> f64 {
    let mut steepness = [0.0; LANES];
    let mut group = |at: usize, keep: Option<&Lanes>| {
        let (left, here, right) = (load(u, at - 1), load(u, at), load(u, at + 1));
        let out = store(v, at);
        for l in 0..LANES {
            let before = here[l] - left[l];
            let value = (right[l] - here[l]) - before;
            let square = before * before;
            let keep = keep.map(|keep| keep[l]);
            out[l] = keep.map_or(value, |keep| keep * value);
            steepness[l] += keep.map_or(square, |keep| keep * square);
        }
    };
    let whole = unknowns / LANES;
    for index in 0..whole {
        group(FIRST + index * LANES, None);
    }
    if !unknowns.is_multiple_of(LANES) {
        group(FIRST + whole * LANES, Some(&mask(unknowns % LANES)));
    }
    let last = FIRST + unknowns - 1;
    v[FIRST - 2] = -v[FIRST];
    v[last + 2] = -v[last];
    total(&steepness) + u[last] * u[last]
}

/// w: the motion in the next step were there no contact and no tension modulation; and its products.
#[inline(always)]
fn predict<const WIDE: bool, const STRETCH: bool, const LOSS: bool>(
    unknowns: usize,
    weights: &Weights,
    v: &[f64],
    d: &[f64],
    w: &mut [f64],
) -> Products {
    let mut sums = [[0.0; LANES]; 4];
    let mut group = |at: usize, keep: Option<&Lanes>| {
        let (v0, d0) = (load(v, at), load(d, at));
        let mut value = [0.0; LANES];
        let (left, right) = (load(v, at - 1), load(v, at + 1));
        for l in 0..LANES {
            value[l] = weights.near[0] * v0[l] + weights.near[1] * (left[l] + right[l]);
        }
        if WIDE {
            let (left, right) = (load(v, at - 2), load(v, at + 2));
            for l in 0..LANES {
                value[l] += weights.near[2] * (left[l] + right[l]);
            }
        }
        if LOSS {
            let (left, right) = (load(d, at - 1), load(d, at + 1));
            for l in 0..LANES {
                value[l] += weights.loss_1 * ((right[l] - d0[l]) - (d0[l] - left[l]));
            }
        }
        let out = store(w, at);
        for l in 0..LANES {
            value[l] += weights.decay * d0[l];
            if let Some(keep) = keep {
                value[l] *= keep[l];
            }
            out[l] = value[l];
            sums[3][l] += d0[l] * d0[l];
        }
        if STRETCH {
            for l in 0..LANES {
                let v0 = keep.map_or(v0[l], |keep| keep[l] * v0[l]);
                sums[0][l] += v0 * value[l];
                sums[1][l] += v0 * d0[l];
                sums[2][l] += v0 * v0;
            }
        }
    };
    let whole = unknowns / LANES;
    for index in 0..whole {
        group(FIRST + index * LANES, None);
    }
    if !unknowns.is_multiple_of(LANES) {
        group(FIRST + whole * LANES, Some(&mask(unknowns % LANES)));
    }
    Products {
        steepness: 0.0,
        curvature_prediction: total(&sums[0]),
        curvature_motion: total(&sums[1]),
        curvature: total(&sums[2]),
        motion: total(&sums[3]),
    }
}

/// d⁺ = w − ψv and u⁺ = u + d⁺; returns the largest |d⁺|.
#[inline(always)]
fn advance<const STRETCH: bool>(
    unknowns: usize,
    pull: f64,
    (w, v, u): (&[f64], &[f64], &[f64]),
    d_next: &mut [f64],
    u_next: &mut [f64],
) -> f64 {
    let mut largest = [0.0f64; LANES];
    // Beyond the unknowns w and v are 0 (but for one ghost of v), and so is what is written there.
    for index in 0..unknowns.div_ceil(LANES) {
        let at = FIRST + index * LANES;
        let (w, v, u) = (load(w, at), load(v, at), load(u, at));
        let d_out = store(d_next, at);
        for l in 0..LANES {
            let d = if STRETCH { w[l] - pull * v[l] } else { w[l] };
            d_out[l] = d;
            largest[l] = if d.abs() > largest[l] { d.abs() } else { largest[l] };
        }
        let u_out = store(u_next, at);
        for l in 0..LANES {
            u_out[l] = u[l] + d_out[l];
        }
    }
    largest.iter().fold(0.0f64, |a, &b| a.max(b))
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
        self.arch.dispatch(
            #[inline(always)]
            || {
                let steepness = curve(unknowns, u, v);
                let products = predict::<WIDE, STRETCH, LOSS>(unknowns, weights, v, d, w);
                // The ghost beyond the bridge lies where `advance` writes.
                v[FIRST + unknowns + 1] = 0.0;
                Products { steepness, ..products }
            },
        )
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
        self.arch.dispatch(
            #[inline(always)]
            || {
                if self.stretch {
                    advance::<true>(unknowns, pull, from, d_next, u_next)
                } else {
                    advance::<false>(unknowns, pull, from, d_next, u_next)
                }
            },
        )
    }
}
