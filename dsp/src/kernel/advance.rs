//! The last pass of a step.

use crate::field::{BESIDE, Ends, Field, LANES, Row};
use crate::instructions::{Pass, Vectors};

/// Motion below this, m, is none: what runs ahead of a wave on a silent string would otherwise become a
/// subnormal number, slow on most machines and flushed to zero on some, and the bits would depend on the
/// host. The square of such a motion's last digit is still a normal number. (Points of a string are asked by their squares, which are
/// summed anyway: that of a smaller motion may be subnormal or flushed to zero, and is too small either way.)
pub(crate) const STILL: f64 = 1e-120;

/// What the last pass goes from, and where it writes.
pub(crate) struct Advance<'a> {
    /// ψ.
    pub pull: f64,
    /// w, then d⁺ in its place.
    pub motion: &'a mut Field,
    /// v and u.
    pub from: (&'a Field, &'a Field),
    /// u⁺.
    pub to: &'a mut Field,
    /// What u⁺ is held against, of a string that may touch something.
    pub skyline: &'a Field,
}

/// What the last pass has moved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Moved {
    /// d⁺ᵀd⁺, m².
    pub squares: f64,
    /// How far the lowest point of each lane is over the skyline, if the string is held against one, m.
    pub over: Row,
}

/// The last pass: d⁺ = w − ψv and u⁺ = u + d⁺, oddly continued beyond both ends; `OVER` a skyline if anything may be touched.
///
/// What the next sweep reads first, rows at both ends of the pieces and what lies beyond the ends of the string, is written first:
/// a vector that is read soon after parts of it were written waits until all of them are in memory.
pub(super) struct LastPass<'a, 'b, const STRETCH: bool, const OVER: bool> {
    pub pass: Advance<'b>,
    pub ends: &'a Ends,
}

impl<const STRETCH: bool, const OVER: bool> Pass for LastPass<'_, '_, STRETCH, OVER> {
    type Output = Moved;

    #[inline(always)]
    fn by<V: Vectors>(self, simd: V) -> Moved {
        let LastPass { pass: Advance { pull, motion, from: (v, u), to: u_next, skyline }, ends } = self;
        let motion = motion.rows_mut();
        // (As many of each: their lengths are compared once, and not where rows are taken.)
        let count = motion.len();
        let [v, u, skyline] = [v, u, skyline].map(|field| &field.rows()[..count]);
        let (pull, least_square) = (simd.splat(pull), simd.splat(STILL * STILL));
        let mut least_over = [f64::INFINITY; LANES];
        let mut squares = [0.0; LANES];
        // (In a loop, so that the code of the pass is there once: what a fretted step is made of hardly fits where a processor keeps
        // the instructions that it has read.)
        let last = ends.beside_bridge;
        for (range, closes) in [(0..BESIDE, false), (last..count, true), (BESIDE..last, false)] {
            let u_rows = &mut u_next.rows_mut()[..count];
            // (No range goes beyond the rows; told so, the compiler asks after none of them.)
            for at in range.start..range.end.min(count) {
                for part in 0..V::PARTS {
                    let d = simd.part(&motion[at], part);
                    let v = simd.part(&v[at], part);
                    let d = if STRETCH { simd.sub(d, simd.mul(pull, v)) } else { d };
                    let sum = simd.part(&squares, part);
                    let [d, sum] = simd.add_squares(sum, d, least_square);
                    let u = simd.add(simd.part(&u[at], part), d);
                    simd.put(&mut squares, part, sum);
                    simd.put(&mut motion[at], part, d);
                    simd.put(&mut u_rows[at], part, u);
                    if OVER {
                        let over = simd.sub(u, simd.part(&skyline[at], part));
                        let least = simd.min(over, simd.part(&least_over, part));
                        simd.put(&mut least_over, part, least);
                    }
                }
            }
            if closes {
                ends.close(u_next);
            }
        }
        Moved { squares: simd.total(&squares), over: least_over }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::instructions::Instructions;

    /// What moves less than [`STILL`] comes to rest, by every instruction set; what moves as much goes on, and what is no number
    /// stays none.
    #[test]
    fn what_hardly_moves_comes_to_rest() {
        let grid = Grid::new(0.65, 40, 1e-5);
        let ends = Ends::new(&grid);
        let moved = [0.0, 1e-150, 0.999 * STILL, STILL, -0.999 * STILL, -STILL, 1e-3, f64::NAN];
        for instructions in Instructions::all() {
            for (node, motion) in (1..).zip(moved) {
                let [mut moved, v, u, mut u_next, skyline] = [(); 5].map(|()| Field::new(&grid));
                let cell = grid.cell(node);
                moved[cell] = motion;
                let pass = Advance {
                    pull: 0.0,
                    motion: &mut moved,
                    from: (&v, &u),
                    to: &mut u_next,
                    skyline: &skyline,
                };
                let Moved { squares, .. } = instructions.run(LastPass::<true, true> { pass, ends: &ends });
                let expected = if motion.abs() < STILL { 0.0 } else { motion };
                let found = [moved[cell], u_next[cell], squares];
                for (found, expected) in found.into_iter().zip([expected, expected, expected * expected]) {
                    let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
                    assert!(same, "{found:e} and not {expected:e} of {motion:e} by {instructions:?}");
                }
            }
        }
    }
}
