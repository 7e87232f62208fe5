//! The last pass of a step.

use std::ops::Range;

use pulp::{Simd, WithSimd};

use super::lanes::{Row, add_product, part_of, rows, rows_mut, vectors};
use crate::field::{BESIDE_NUT, Ends, Field, LANES, total};

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
        let (count, last) = (rows(w).len(), ends.beside_bridge);
        let mut rows = Rows::<STRETCH> {
            pull,
            from: [w, v, u].map(|field| rows(field)),
            sizes: [0.0; LANES],
            squares: [0.0; LANES],
        };
        rows.advance(simd, 0..BESIDE_NUT, (d_next, u_next));
        rows.advance(simd, last..count, (d_next, u_next));
        u_next.close_ends(ends);
        rows.advance(simd, BESIDE_NUT..last, (d_next, u_next));
        let largest = rows.sizes.iter().fold(0.0, |most, &size| if size > most { size } else { most });
        Moved { largest, squares: total(&rows.squares) }
    }
}

/// The rows of a last pass.
struct Rows<'a, const STRETCH: bool> {
    pull: f64,
    /// w, v and u.
    from: [&'a [Row]; 3],
    /// The largest |d⁺| so far in each lane.
    sizes: Row,
    /// Σ(d⁺)² so far in each lane.
    squares: Row,
}

impl<const STRETCH: bool> Rows<'_, STRETCH> {
    /// Moves some of them.
    #[inline(always)]
    fn advance<S: Simd>(&mut self, simd: S, range: Range<usize>, (d_next, u_next): (&mut Field, &mut Field)) {
        let [w, v, u] = self.from.map(|rows| &rows[range.clone()]);
        let count = w.len();
        let (v, u) = (&v[..count], &u[..count]);
        let [d_next, u_next] = [d_next, u_next].map(|field| &mut rows_mut(field)[range.clone()][..count]);
        let (pull, still) = (simd.splat_f64s(self.pull), simd.splat_f64s(STILL));
        for part in 0..vectors::<S>() {
            let mut largest = part_of::<S>(&self.sizes, part);
            let mut squares = part_of::<S>(&self.squares, part);
            for at in 0..count {
                let d = part_of::<S>(&w[at], part);
                let v = part_of::<S>(&v[at], part);
                let d = if STRETCH { simd.sub_f64s(d, simd.mul_f64s(pull, v)) } else { d };
                let size = simd.abs_f64s(d);
                let d = simd.select_f64s(simd.less_than_f64s(size, still), simd.splat_f64s(0.0), d);
                S::as_mut_simd_f64s(&mut d_next[at]).0[part] = d;
                S::as_mut_simd_f64s(&mut u_next[at]).0[part] = simd.add_f64s(part_of::<S>(&u[at], part), d);
                largest = simd.max_f64s(size, largest);
                add_product(simd, &mut squares, d, d);
            }
            S::as_mut_simd_f64s(&mut self.sizes).0[part] = largest;
            S::as_mut_simd_f64s(&mut self.squares).0[part] = squares;
        }
    }
}
