//! The last pass of a step.

use pulp::{Simd, WithSimd};

use super::lanes::{add_product, part_of, rows, rows_mut, vectors};
use crate::field::{Ends, Field, LANES, total};

/// Motion below this, m, is none: what runs ahead of a wave on a silent string would otherwise become a
/// subnormal number, slow on most machines and flushed to zero on some, and the bits would depend on the
/// host. The square of such a motion's last digit is still a normal number.
pub(crate) const STILL: f64 = 1e-120;

/// What the last pass goes from, and where it writes.
pub(crate) struct Advance<'a> {
    /// ψ.
    pub pull: f64,
    /// w, v and u.
    pub from: (&'a Field, &'a Field, &'a Field),
    /// d⁺ and u⁺.
    pub to: (&'a mut Field, &'a mut Field),
}

/// What the last pass has moved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Moved {
    /// The largest |d⁺|, m.
    pub largest: f64,
    /// d⁺ᵀd⁺, m².
    pub squares: f64,
}

/// The last pass: d⁺ = w − ψv and u⁺ = u + d⁺, oddly continued beyond both ends.
///
/// What the next sweep reads first, rows at both ends of the pieces and what lies beyond the ends of the string, is written first:
/// a vector that is read soon after parts of it were written waits until all of them are in memory.
pub(super) struct LastPass<'a, 'b, const STRETCH: bool> {
    pub pass: Advance<'b>,
    pub ends: &'a Ends,
}

impl<const STRETCH: bool> WithSimd for LastPass<'_, '_, STRETCH> {
    type Output = Moved;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Moved {
        let LastPass { pass: Advance { pull, from: (w, v, u), to: (d_next, u_next) }, ends } = self;
        let (w, v, u, d_next) = (rows(w), rows(v), rows(u), rows_mut(d_next));
        let count = w.len();
        let (v, u, d_next) = (&v[..count], &u[..count], &mut d_next[..count]);
        let (pull, still) = (simd.splat_f64s(pull), simd.splat_f64s(STILL));
        let (mut sizes, mut squares) = ([0.0; LANES], [0.0; LANES]);
        let (first, last) = ends.rows(count);
        for (turn, range) in [0..first, last..count, first..last].into_iter().enumerate() {
            let after = &mut rows_mut(u_next)[..count];
            for part in 0..vectors::<S>() {
                let mut largest = part_of::<S>(&sizes, part);
                let mut sum = part_of::<S>(&squares, part);
                for at in range.clone() {
                    let d = part_of::<S>(&w[at], part);
                    let v = part_of::<S>(&v[at], part);
                    let d = if STRETCH { simd.sub_f64s(d, simd.mul_f64s(pull, v)) } else { d };
                    let size = simd.abs_f64s(d);
                    let d = simd.select_f64s(simd.less_than_f64s(size, still), simd.splat_f64s(0.0), d);
                    S::as_mut_simd_f64s(&mut d_next[at]).0[part] = d;
                    S::as_mut_simd_f64s(&mut after[at]).0[part] =
                        simd.add_f64s(part_of::<S>(&u[at], part), d);
                    largest = simd.max_f64s(size, largest);
                    add_product(simd, &mut sum, d, d);
                }
                S::as_mut_simd_f64s(&mut sizes).0[part] = largest;
                S::as_mut_simd_f64s(&mut squares).0[part] = sum;
            }
            if turn == 1 {
                u_next.close_ends(ends);
            }
        }
        let largest = sizes.iter().fold(0.0, |most, &size| if size > most { size } else { most });
        Moved { largest, squares: total(&squares) }
    }
}
