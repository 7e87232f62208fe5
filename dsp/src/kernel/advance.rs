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

impl Moved {
    /// How far the lowest point of all is over the skyline, m.
    #[inline(always)]
    pub fn least_over(&self) -> f64 {
        self.over.iter().fold(f64::INFINITY, |least, &over| if over < least { over } else { least })
    }
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
        let LastPass { pass: Advance { pull, from: (w, v, u), to: (d_next, u_next), skyline }, ends } = self;
        let (count, last) = (rows(w).len(), ends.beside_bridge);
        let mut moving = Moving::<STRETCH, OVER> {
            pull,
            from: [w, v, u, skyline].map(|field| rows(field)),
            over: [f64::INFINITY; LANES],
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
        Moved { squares: total(&moving.squares), over: moving.over }
    }
}

/// Rows on their way through a last pass.
struct Moving<'a, const STRETCH: bool, const OVER: bool> {
    pull: f64,
    /// w, v and u, and the skyline.
    from: [&'a [Row]; 4],
    /// The least of u⁺ over the skyline so far in each lane.
    over: Row,
    /// Σ(d⁺)² so far in each lane.
    squares: Row,
}

impl<const STRETCH: bool, const OVER: bool> Moving<'_, STRETCH, OVER> {
    /// Moves some of them.
    #[inline(always)]
    fn advance<V: Vectors>(
        &mut self,
        simd: V,
        range: Range<usize>,
        (d_next, u_next): (&mut Field, &mut Field),
    ) {
        let [w, v, u, top] = self.from.map(|rows| &rows[range.clone()]);
        let count = w.len();
        let (v, u, top) = (&v[..count], &u[..count], &top[..count]);
        let [d_next, u_next] = [d_next, u_next].map(|field| &mut rows_mut(field)[range.clone()][..count]);
        let (pull, still) = (simd.splat(self.pull), simd.splat(STILL));
        for at in 0..count {
            for part in 0..V::PARTS {
                let d = simd.part(&w[at], part);
                let v = simd.part(&v[at], part);
                let d = if STRETCH { simd.sub(d, simd.mul(pull, v)) } else { d };
                let size = simd.abs(d);
                let d = simd.clear_below(d, size, still);
                let u = simd.add(simd.part(&u[at], part), d);
                simd.put(&mut d_next[at], part, d);
                simd.put(&mut u_next[at], part, u);
                if OVER {
                    let over = simd.sub(u, simd.part(&top[at], part));
                    let over = simd.min(over, simd.part(&self.over, part));
                    simd.put(&mut self.over, part, over);
                }
                let squares = simd.add_product(simd.part(&self.squares, part), d, d);
                simd.put(&mut self.squares, part, squares);
            }
        }
    }
}
