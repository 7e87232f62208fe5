//! The last pass of a step.

use std::ops::Range;

use super::rows::{rows, rows_mut};
use crate::field::{BESIDE_NUT, Ends, Field, LANES, Row, total};
use crate::instructions::{Pass, Vectors};

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

impl<const STRETCH: bool> Pass for LastPass<'_, '_, STRETCH> {
    type Output = Moved;

    #[inline(always)]
    fn by<V: Vectors>(self, simd: V) -> Moved {
        let LastPass { pass: Advance { pull, from: (w, v, u), to: (d_next, u_next) }, ends } = self;
        let (count, last) = (rows(w).len(), ends.beside_bridge);
        let mut moving = Moving::<STRETCH> {
            pull,
            from: [w, v, u].map(|field| rows(field)),
            sizes: [0.0; LANES],
            squares: [0.0; LANES],
        };
        // (In a loop, so that the code of the pass is there once: what a fretted step is made of hardly fits where a processor keeps
        // the instructions that it has read.)
        for (range, closes) in [(0..BESIDE_NUT, false), (last..count, true), (BESIDE_NUT..last, false)] {
            moving.advance(simd, range, (d_next, u_next));
            if closes {
                u_next.close_ends(ends);
            }
        }
        let largest = moving.sizes.iter().fold(0.0, |most, &size| if size > most { size } else { most });
        Moved { largest, squares: total(&moving.squares) }
    }
}

/// Rows on their way through a last pass.
struct Moving<'a, const STRETCH: bool> {
    pull: f64,
    /// w, v and u.
    from: [&'a [Row]; 3],
    /// The largest |d⁺| so far in each lane.
    sizes: Row,
    /// Σ(d⁺)² so far in each lane.
    squares: Row,
}

impl<const STRETCH: bool> Moving<'_, STRETCH> {
    /// Moves some of them.
    #[inline(always)]
    fn advance<V: Vectors>(
        &mut self,
        simd: V,
        range: Range<usize>,
        (d_next, u_next): (&mut Field, &mut Field),
    ) {
        let [w, v, u] = self.from.map(|rows| &rows[range.clone()]);
        let count = w.len();
        let (v, u) = (&v[..count], &u[..count]);
        let [d_next, u_next] = [d_next, u_next].map(|field| &mut rows_mut(field)[range.clone()][..count]);
        let (pull, still) = (simd.splat(self.pull), simd.splat(STILL));
        for at in 0..count {
            for part in 0..V::PARTS {
                let d = simd.part(&w[at], part);
                let v = simd.part(&v[at], part);
                let d = if STRETCH { simd.sub(d, simd.mul(pull, v)) } else { d };
                let size = simd.abs(d);
                let d = simd.clear_below(d, size, still);
                simd.put(&mut d_next[at], part, d);
                simd.put(&mut u_next[at], part, simd.add(simd.part(&u[at], part), d));
                let largest = simd.max(size, simd.part(&self.sizes, part));
                simd.put(&mut self.sizes, part, largest);
                let squares = simd.add_product(simd.part(&self.squares, part), d, d);
                simd.put(&mut self.squares, part, squares);
            }
        }
    }
}
