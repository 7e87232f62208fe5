//! The two passes over the grid in every sample. They take rows of a [`Field`] one after another, as many lanes at once as the
//! instruction set has; sums run down each lane and are added up in a fixed order, so that every instruction set gives the same
//! bits. There is no fused multiply-add.

mod advance;
mod moving;
mod sweep;
mod weights;

use crate::field::{Ends, Field};
use crate::instructions::{Pass, Vectors};
use crate::model::Model;
use crate::scene::Stencil;
use advance::LastPass;
pub(crate) use advance::{Advance, Moved, STILL};
use moving::Moving;
use sweep::Predict;
pub(crate) use weights::Weights;

/// What a string's stretching depends on, of a prediction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretching {
    /// vᵀ(u + w), v the undivided second difference of u; of a string with stretching only.
    pub along: f64,
    /// 1/(1 + G vᵀv): how far the string gives way to what stretches it.
    pub yielding: f64,
}

/// How a string is bent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Shape {
    /// |δu|², the sum of squared differences between neighbours; of a string without stretching only.
    pub steepness: f64,
    /// vᵀv; of one with stretching only.
    pub curvature: f64,
}

/// What a prediction goes from, and where it writes.
pub(crate) struct Prediction<'a> {
    pub weights: &'a Weights,
    /// G, the strength of tension modulation.
    pub stretch: f64,
    /// u and d.
    pub from: (&'a Field, &'a Field),
    /// v, and w.
    pub to: (&'a mut Field, &'a mut Field),
    pub shape: &'a mut Shape,
}

/// The passes of one model.
#[derive(Debug, Clone)]
pub(crate) struct Kernel {
    /// Neighbours of v on either side that the string's operator reads: 0 without stiffness, 1, or 2.
    reach: usize,
    stretch: bool,
    loss: bool,
    ends: Ends,
    moving: Moving,
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
            moving: Moving::new(&model.grid),
        }
    }

    /// The prediction w from u, d and v a step ago, and v of this step in the place of that; how the string is bent, and what
    /// its stretching depends on.
    #[inline(always)]
    pub fn predict<V: Vectors>(&self, simd: V, prediction: Prediction) -> Stretching {
        match self.reach {
            0 => self.predict_reaching::<V, 0>(simd, prediction),
            1 => self.predict_reaching::<V, 1>(simd, prediction),
            _ => self.predict_reaching::<V, 2>(simd, prediction),
        }
    }

    #[inline(always)]
    fn predict_reaching<V: Vectors, const REACH: usize>(
        &self,
        simd: V,
        prediction: Prediction,
    ) -> Stretching {
        match (self.stretch, self.loss) {
            (false, false) => self.sweep::<V, REACH, false, false>(simd, prediction),
            (false, true) => self.sweep::<V, REACH, false, true>(simd, prediction),
            (true, false) => self.sweep::<V, REACH, true, false>(simd, prediction),
            (true, true) => self.sweep::<V, REACH, true, true>(simd, prediction),
        }
    }

    #[inline(always)]
    fn sweep<V: Vectors, const REACH: usize, const STRETCH: bool, const LOSS: bool>(
        &self,
        simd: V,
        Prediction { weights, stretch, from, to, shape }: Prediction,
    ) -> Stretching {
        // The last difference, to the bridge, belongs to no point that moves.
        let last = if STRETCH { 0.0 } else { from.0[self.ends.last()] };
        let moving = &self.moving;
        let sweep = Predict::<REACH, STRETCH, LOSS> { weights, stretch, from, to, shape, moving };
        let stretching = simd.run(sweep);
        if !STRETCH {
            shape.steepness += last * last;
        }
        stretching
    }

    /// The next motion and displacement; `OVER` a skyline, if anything may be touched.
    #[inline(always)]
    pub fn advance<V: Vectors, const OVER: bool>(&self, simd: V, pass: Advance) -> Moved {
        if self.stretch {
            LastPass::<true, OVER> { pass, ends: &self.ends }.by(simd)
        } else {
            LastPass::<false, OVER> { pass, ends: &self.ends }.by(simd)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::instructions::Instructions;

    /// G.
    const STRETCH: f64 = 0.5;

    /// Both passes by one instruction set, the last one held against a skyline and not.
    struct Passes<'a> {
        kernel: &'a Kernel,
        weights: &'a Weights,
        from: (&'a Field, &'a Field),
        to: [&'a mut Field; 4],
        skyline: &'a Field,
    }

    impl Pass for Passes<'_> {
        type Output = (Stretching, Shape, [Moved; 2]);

        #[inline(always)]
        fn by<V: Vectors>(self, simd: V) -> Self::Output {
            let Passes { kernel, weights, from: (u, d), to: [v, w, d_next, u_next], skyline } = self;
            let mut shape = Shape::default();
            let prediction =
                Prediction { weights, stretch: STRETCH, from: (u, d), to: (v, w), shape: &mut shape };
            let stretching = kernel.predict(simd, prediction);
            let mut pass = |over: bool| {
                // (What is closed before it is written may not be what was there anyway.)
                u_next.fill(0.0);
                d_next.copy_from_slice(w);
                let pass = Advance { pull: 1e-3, motion: d_next, from: (v, u), to: u_next, skyline };
                if over {
                    kernel.advance::<V, true>(simd, pass)
                } else {
                    kernel.advance::<V, false>(simd, pass)
                }
            };
            let moved = [pass(false), pass(true)];
            (stretching, shape, moved)
        }
    }

    /// Every instruction set gives the same bits in every pass there is, for every number of points in the last rows.
    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        if cfg!(target_arch = "x86_64") && Instructions::all().len() == 2 {
            println!("passed over: this machine has no instructions but those of two lanes");
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
        ends.close(&mut u);
        let weights = Weights { motion: 0.97, near: [0.7, -0.03, 0.001], before: 0.01, energy: [0.0; 2] };
        let run = |instructions: Instructions| {
            let kernel = Kernel { reach, stretch, loss, ends, moving: Moving::new(&grid) };
            let empty = || Field::new(&grid);
            let (mut v, mut w, mut d_next, mut u_next) = (before.clone(), empty(), empty(), empty());
            let products = instructions.run(Passes {
                kernel: &kernel,
                weights: &weights,
                from: (&u, &d),
                to: [&mut v, &mut w, &mut d_next, &mut u_next],
                skyline: &before,
            });
            for (node, value) in (1..).zip(u_next.from_nut()) {
                let mirrored = node > intervals && node <= intervals + 2;
                assert!(value == 0.0 || mirrored || node < intervals, "node {node} of {intervals} moves");
            }
            assert!(ends.have_closed(&u_next), "{intervals} intervals");
            let bits: Vec<u64> = w.iter().chain(&*d_next).chain(&*u_next).map(|x| x.to_bits()).collect();
            (format!("{products:?}"), bits)
        };
        let expected = run(Instructions::Any);
        for instructions in Instructions::all() {
            assert_eq!(
                run(instructions),
                expected,
                "{intervals} intervals, reach {reach}, stretch {stretch}, loss {loss}, {instructions:?}"
            );
        }
    }

    /// How far the lowest point of all is over the skyline, m.
    fn least_over(moved: &Moved) -> f64 {
        moved.over.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The sweep gives what the formulas say point by point, oddly continued at both ends.
    #[test]
    fn rows_are_the_string_in_order() {
        for (intervals, stretch) in (4..=60).flat_map(|intervals| [(intervals, true), (intervals, false)]) {
            let grid = Grid::new(0.65, intervals, 1e-5);
            let ends = Ends::new(&grid);
            // Multiples of small powers of two, so that no order of adding rounds.
            let at = |node: i64| {
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
                u[grid.cell(node)] = at(node as i64);
                d[grid.cell(node)] = 0.5 * at(node as i64);
                v[grid.cell(node)] = 3.0 * at(node as i64) - 8.0;
            }
            ends.close(&mut u);
            let weights = Weights { motion: 0.75, near: [0.5, -0.25, 0.125], before: 0.25, energy: [0.0; 2] };
            let mut skyline = Field::filled(&grid, f64::NEG_INFINITY);
            (1..intervals).for_each(|node| skyline[grid.cell(node)] = 0.25 * at(node as i64));
            let kernel = Kernel { reach: 2, stretch, loss: true, ends, moving: Moving::new(&grid) };
            let (found, shape, moved) = Instructions::best().run(Passes {
                kernel: &kernel,
                weights: &weights,
                from: (&u, &d),
                to: [&mut v, &mut w, &mut d_next, &mut u_next],
                skyline: &skyline,
            });
            let bend = |node: i64| at(node + 1) - 2.0 * at(node) + at(node - 1);
            let last = at(intervals as i64 - 1);
            let mut steepness = last * last;
            let (mut along, mut curvature, mut squares) = (0.0, 0.0, 0.0);
            for node in 1..intervals as i64 {
                let beside = |away: i64| bend(node - away) + bend(node + away);
                let past = 0.5 * 0.75 * at(node) - 0.25 * (3.0 * at(node) - 8.0);
                let value = 0.5 * bend(node) - 0.25 * beside(1) + 0.125 * beside(2) + past;
                let cell = grid.cell(node as usize);
                assert_eq!((v[cell], w[cell]), (bend(node), value), "node {node} of {intervals}");
                let step = at(node) - at(node - 1);
                steepness += step * step;
                let motion = if stretch { value - 1e-3 * bend(node) } else { value };
                squares += motion * motion;
                curvature += bend(node) * bend(node);
                along += bend(node) * (value + at(node));
            }
            let expected = if stretch {
                (along, 1.0 / (1.0 + STRETCH * curvature), Shape { curvature, steepness: 0.0 })
            } else {
                (0.0, 1.0, Shape { curvature: 0.0, steepness })
            };
            assert_eq!((found.along, found.yielding, shape), expected, "{intervals} intervals");
            // (Motions by a pull of 1e-3 round, and their squares.)
            let [free, held] = moved;
            assert!((free.squares / squares - 1.0).abs() < 1e-14, "{intervals} intervals");
            // Whether or not it is held against a skyline makes no other motion; and its lowest point is told.
            assert_eq!(
                (free.squares, least_over(&free)),
                (held.squares, f64::INFINITY),
                "{intervals} intervals"
            );
            let over = (1..intervals).map(|node| {
                let cell = grid.cell(node);
                u_next[cell] - skyline[cell]
            });
            assert_eq!(least_over(&held), over.fold(f64::INFINITY, f64::min), "{intervals} intervals");
        }
    }
}
