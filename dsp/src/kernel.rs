//! The two passes over the grid in every sample, and the look at a skyline now and then. They take rows of a [`Field`] one
//! after another, as many lanes at once as the instruction set has; sums run down each lane and are added up in a
//! fixed order, so that every instruction set gives the same bits. There is no fused multiply-add.

mod advance;
mod clear;
mod lanes;
mod sweep;
mod weights;

use pulp::{Simd, WithSimd};

use crate::field::{Ends, Field};
use crate::grid::Grid;
use crate::model::Model;
use crate::scene::Stencil;
use crate::skyline::Clearance;
use advance::LastPass;
pub(crate) use advance::{Advance, STILL};
use clear::Clear;
pub(crate) use lanes::{part_of, vectors};
use sweep::Predict;
pub(crate) use weights::Weights;

/// The inner products of a prediction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Products {
    /// |δu|², the sum of squared differences between neighbours; of a string without stretching only.
    pub steepness: f64,
    /// vᵀ(u + w), v the undivided second difference of u; of one with stretching only, as the next.
    pub along: f64,
    /// vᵀv.
    pub curvature: f64,
    /// dᵀd.
    pub motion: f64,
}

/// The passes of one model.
#[derive(Debug, Clone)]
pub(crate) struct Kernel {
    /// Neighbours of v on either side that the string's operator reads: 0 without stiffness, 1, or 2.
    reach: usize,
    stretch: bool,
    loss: bool,
    ends: Ends,
    /// 1 at each point that moves, 0 elsewhere.
    keep: Field,
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
            reach,
            stretch: model.coasting.stretch > 0.0,
            loss: model.string.loss_1 > 0.0,
            ends: Ends::new(&model.grid),
            keep: moving(&model.grid),
        }
    }

    /// The prediction w from u, d and v a step ago, and v of this step in the place of that; with their products.
    #[inline(always)]
    pub fn predict<S: Simd>(
        &self,
        simd: S,
        weights: &Weights,
        from: (&Field, &Field),
        to: (&mut Field, &mut Field),
    ) -> Products {
        match self.reach {
            0 => self.predict_reaching::<S, 0>(simd, weights, from, to),
            1 => self.predict_reaching::<S, 1>(simd, weights, from, to),
            _ => self.predict_reaching::<S, 2>(simd, weights, from, to),
        }
    }

    #[inline(always)]
    fn predict_reaching<S: Simd, const REACH: usize>(
        &self,
        simd: S,
        weights: &Weights,
        from: (&Field, &Field),
        to: (&mut Field, &mut Field),
    ) -> Products {
        match (self.stretch, self.loss) {
            (false, false) => self.sweep::<S, REACH, false, false>(simd, weights, from, to),
            (false, true) => self.sweep::<S, REACH, false, true>(simd, weights, from, to),
            (true, false) => self.sweep::<S, REACH, true, false>(simd, weights, from, to),
            (true, true) => self.sweep::<S, REACH, true, true>(simd, weights, from, to),
        }
    }

    #[inline(always)]
    fn sweep<S: Simd, const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &self,
        simd: S,
        weights: &Weights,
        from: (&Field, &Field),
        to: (&mut Field, &mut Field),
    ) -> Products {
        // The last difference, to the bridge, belongs to no point that moves.
        let last = if STRETCH { 0.0 } else { from.0[self.ends.last()] };
        let sweep = Predict::<REACH, STRETCH, LOSS> { weights, from, to, keep: &self.keep };
        let products = simd.vectorize(sweep);
        Products { steepness: products.steepness + last * last, ..products }
    }

    /// The next motion and displacement; returns the largest motion of a point, m.
    #[inline(always)]
    pub fn advance<S: Simd>(&self, simd: S, mut pass: Advance) -> f64 {
        let largest = if self.stretch {
            LastPass::<true>(&mut pass).with_simd(simd)
        } else {
            LastPass::<false>(&mut pass).with_simd(simd)
        };
        pass.to.1.close_ends(&self.ends);
        largest
    }

    /// How far groups of points are over a skyline.
    #[inline(always)]
    pub fn clear<S: Simd>(
        &self,
        simd: S,
        displacement: &Field,
        skyline: &Field,
        clearances: &mut [Clearance],
    ) {
        simd.vectorize(Clear { displacement, skyline, clearances });
    }
}

/// 1 at each point of a grid that moves, 0 elsewhere.
fn moving(grid: &Grid) -> Field {
    let mut keep = Field::new(grid);
    for node in 1..grid.intervals {
        keep[grid.cell(node)] = 1.0;
    }
    keep
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instructions::Instructions;
    use crate::skyline::groups;

    /// Both passes, and the look at a skyline, by one instruction set.
    struct Passes<'a> {
        kernel: &'a Kernel,
        weights: &'a Weights,
        from: (&'a Field, &'a Field),
        to: [&'a mut Field; 4],
        clearances: &'a mut [Clearance],
    }

    impl WithSimd for Passes<'_> {
        type Output = (Products, f64);

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let Passes { kernel, weights, from: (u, d), to: [v, w, d_next, u_next], clearances } = self;
            let products = kernel.predict(simd, weights, (u, d), (v, w));
            let pass = Advance { pull: 1e-3, from: (w, v, u), to: (d_next, u_next) };
            let largest = kernel.advance(simd, pass);
            kernel.clear(simd, u_next, d, clearances);
            (products, largest)
        }
    }

    /// Every instruction set gives the same bits in every pass there is, for every number of points in the last rows.
    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        if Instructions::all().into_iter().all(Instructions::is_any) {
            println!("passed over: this machine has no instructions but those of any processor");
        }
        let passes = [0, 1, 2].into_iter().flat_map(|reach| {
            [(false, false), (false, true), (true, false), (true, true)]
                .map(|(stretch, loss)| (reach, stretch, loss))
        });
        for (reach, stretch, loss) in passes {
            (4..=60).for_each(|intervals| assert_same_bits(intervals, (reach, stretch, loss)));
        }
    }

    fn assert_same_bits(intervals: usize, (reach, stretch, loss): (usize, bool, bool)) {
        let grid = Grid::new(0.65, intervals, 1e-5);
        let mut seed = intervals as u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let ends = Ends::new(&grid);
        let mut field = || {
            let mut values = Field::new(&grid);
            (1..intervals).for_each(|node| values[grid.cell(node)] = random());
            values
        };
        let (mut u, d, before) = (field(), field(), field());
        u.close_ends(&ends);
        let weights = Weights { motion: 0.97, near: [0.7, -0.03, 0.001], before: 0.01 };
        let run = |instructions: Instructions| {
            let keep = moving(&grid);
            let kernel = Kernel { reach, stretch, loss, ends, keep };
            let empty = || Field::new(&grid);
            let (mut v, mut w, mut d_next, mut u_next) = (before.clone(), empty(), empty(), empty());
            let mut clearances = vec![Clearance::default(); groups(&grid)];
            let (products, largest) = instructions.run(Passes {
                kernel: &kernel,
                weights: &weights,
                from: (&u, &d),
                to: [&mut v, &mut w, &mut d_next, &mut u_next],
                clearances: &mut clearances,
            });
            for (node, value) in u_next.from_nut().enumerate() {
                let mirrored = node > intervals && node <= intervals + 2;
                let moves = node > 0 && node < intervals;
                assert!(value == 0.0 || mirrored || moves, "node {node} of {intervals} moves");
            }
            let bits: Vec<u64> = w.iter().chain(&*d_next).chain(&*u_next).map(|x| x.to_bits()).collect();
            (format!("{products:?} {clearances:?}"), largest.to_bits(), bits)
        };
        let expected = run(Instructions::any());
        for instructions in Instructions::all() {
            assert_eq!(
                run(instructions),
                expected,
                "{intervals} intervals, reach {reach}, stretch {stretch}, loss {loss}, {instructions:?}"
            );
        }
    }

    /// The sweep gives what the formulas say point by point, oddly continued at both ends.
    #[test]
    fn rows_are_the_string_in_order() {
        for (intervals, stretch) in (4..=60).flat_map(|intervals| [(intervals, true), (intervals, false)]) {
            let grid = Grid::new(0.65, intervals, 1e-5);
            let ends = Ends::new(&grid);
            // Multiples of small powers of two, so that no order of adding rounds.
            let shape = |node: i64| {
                let n = intervals as i64;
                let inside = |node: i64| if node % n == 0 { 0.0 } else { ((node * node * 7) % 16) as f64 };
                match node {
                    node if node < 0 => -inside(-node),
                    node if node > n => -inside(2 * n - node),
                    node => inside(node),
                }
            };
            let [mut u, mut d, mut v, mut w, mut d_next, mut u_next] = [(); 6].map(|()| Field::new(&grid));
            for node in 1..intervals {
                u[grid.cell(node)] = shape(node as i64);
                d[grid.cell(node)] = 0.5 * shape(node as i64);
                v[grid.cell(node)] = 3.0 * shape(node as i64) - 8.0;
            }
            u.close_ends(&ends);
            let weights = Weights { motion: 0.75, near: [0.5, -0.25, 0.125], before: 0.25 };
            let keep = moving(&grid);
            let kernel = Kernel { reach: 2, stretch, loss: true, ends, keep };
            let (products, _) = Instructions::best().run(Passes {
                kernel: &kernel,
                weights: &weights,
                from: (&u, &d),
                to: [&mut v, &mut w, &mut d_next, &mut u_next],
                clearances: &mut vec![Clearance::default(); groups(&grid)],
            });
            let bend = |node: i64| shape(node + 1) - 2.0 * shape(node) + shape(node - 1);
            let last = shape(intervals as i64 - 1);
            let mut steepness = last * last;
            let mut expected = Products::default();
            for node in 1..intervals as i64 {
                let beside = |away: i64| bend(node - away) + bend(node + away);
                let past = 0.5 * 0.75 * shape(node) - 0.25 * (3.0 * shape(node) - 8.0);
                let value = 0.5 * bend(node) - 0.25 * beside(1) + 0.125 * beside(2) + past;
                let cell = grid.cell(node as usize);
                assert_eq!((v[cell], w[cell]), (bend(node), value), "node {node} of {intervals}");
                let step = shape(node) - shape(node - 1);
                steepness += step * step;
                expected.motion += 0.25 * shape(node) * shape(node);
                if stretch {
                    expected.curvature += bend(node) * bend(node);
                    expected.along += bend(node) * (value + shape(node));
                }
            }
            if !stretch {
                expected.steepness = steepness;
            }
            assert_eq!(products, expected, "{intervals} intervals");
        }
    }
}
