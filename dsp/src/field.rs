//! Numbers over the grid of a string, in the order in which vectors take them.
//!
//! The string is cut into [`LANES`] pieces of the same length, which lie side by side: the first row holds the first
//! point of each piece, the next row the second, and so on. The neighbours of a row's points are then the rows before and
//! after it, whole and aligned, so that a stencil of any width reads each number once. Only where pieces join does a row
//! continue in another lane.

use std::ops::{Deref, DerefMut};

use aligned_vec::{AVec, ConstAlign};

use crate::grid::Grid;

/// Lanes of the widest vector the kernels are written for.
pub const LANES: usize = 8;

/// A number in each lane, side by side: a row of a field, [`LANES`] numbers anywhere in it, or as many modes of a body.
pub(crate) type Row = [f64; LANES];

/// Points before the nut: the two odd ghosts that the widest stencil reads, and one that nobody needs, so that the
/// first row never asks for a point before the first.
pub(crate) const BEFORE: usize = 3;

/// Points after the bridge: two odd ghosts.
pub(crate) const AFTER: usize = 2;

/// The rows in which the two points beside the nut are that those beyond it are the negative of, and all rows before these.
pub(crate) const BESIDE_NUT: usize = BEFORE + 3;

/// The fewest rows: those, among which are as many as the widest stencil reads on one side of the first one, and that itself.
const LEAST_ROWS: usize = BESIDE_NUT;

/// Bytes in a row.
const ALIGNMENT: usize = 8 * LANES;

/// The sum over lanes in a fixed order.
#[inline(always)]
pub(crate) fn total([a, b, c, d, e, f, g, h]: &Row) -> f64 {
    ((a + e) + (b + f)) + ((c + g) + (d + h))
}

/// Whether any number of a row is no more than `most`. (All are asked, so that no branch has to be guessed.)
#[inline(always)]
pub(crate) fn any_at_most(row: &Row, most: f64) -> bool {
    row.iter().fold(false, |found, &number| found | (number <= most))
}

/// How many rows a field has over a grid of so many intervals.
#[inline(always)]
pub(crate) fn row_count(intervals: usize) -> usize {
    (BEFORE + intervals + 1 + AFTER).div_ceil(LANES).max(LEAST_ROWS)
}

/// Where the `point`-th number in order of place stands, [`BEFORE`] for the nut, on a grid of so many intervals.
#[inline(always)]
pub(crate) fn cell(intervals: usize, point: usize) -> usize {
    let rows = row_count(intervals);
    LANES * (point % rows) + point / rows
}

/// One number for each point of a grid, its ends and ghosts included, by [`Grid::cell`].
#[derive(Debug, Clone, PartialEq)]
pub struct Field(AVec<f64, ConstAlign<ALIGNMENT>>);

impl Field {
    /// The same number everywhere.
    pub fn filled(grid: &Grid, value: f64) -> Field {
        let numbers = std::iter::repeat_n(value, LANES * row_count(grid.intervals));
        Field(AVec::from_iter(ALIGNMENT, numbers))
    }

    /// Zero everywhere.
    pub fn new(grid: &Grid) -> Field {
        Self::filled(grid, 0.0)
    }

    /// The numbers at the points from the nut (node 0) on, in order of place: ends, ghosts and padding after the
    /// bridge come last.
    pub fn from_nut(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        let pieces = (0..LANES).flat_map(|lane| self.iter().skip(lane).step_by(LANES));
        pieces.skip(BEFORE).copied()
    }

    /// Puts the numbers at the nodes 0 to `intervals` in order of place into `out`, in the place of what it holds.
    pub(crate) fn unfold(&self, intervals: usize, out: &mut Vec<f64>) {
        out.clear();
        for lane in 0..LANES {
            out.extend(self.chunks_exact(LANES).map(|row| row[lane]));
        }
        out.drain(..BEFORE);
        out.truncate(intervals + 1);
    }
}

impl Deref for Field {
    type Target = [f64];
    #[inline(always)]
    fn deref(&self) -> &[f64] {
        &self.0
    }
}

impl DerefMut for Field {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.0
    }
}

/// The ends of a string on its grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ends {
    /// The ghosts beyond both ends, each with the point whose negative it is; that beside the bridge comes first.
    ghosts: [(usize, usize); 4],
    /// The row from which on all is that lies beyond the bridge, and what that is the negative of, but for what is in the rows
    /// [beside the nut](BESIDE_NUT); and the last three, which the pieces beside them continue.
    pub beside_bridge: usize,
}

impl Ends {
    /// Of a grid.
    pub fn new(grid: &Grid) -> Self {
        let cell = |point: usize| cell(grid.intervals, point);
        let (nut, bridge) = (BEFORE, BEFORE + grid.intervals);
        let mirror = |end: usize, away: usize| (cell(end - away), cell(end + away));
        let (near, far) = (mirror(bridge, 1), mirror(bridge, 2));
        let row = (near.0 / LANES).min(far.0 / LANES).min(row_count(grid.intervals) - 3);
        Ends {
            ghosts: [(near.1, near.0), (far.1, far.0), mirror(nut, 1), mirror(nut, 2)],
            beside_bridge: row.max(BESIDE_NUT),
        }
    }

    /// Has the displacements beyond both ends continue those of the string oddly.
    #[inline(always)]
    pub fn close(&self, displacement: &mut [f64]) {
        for (ghost, point) in self.ghosts {
            displacement[ghost] = -displacement[point];
        }
    }

    /// Whether these displacements are closed so.
    #[cfg(test)]
    pub fn have_closed(&self, displacement: &[f64]) -> bool {
        self.ghosts.iter().all(|&(ghost, point)| displacement[ghost] == -displacement[point])
    }

    /// The last point that moves.
    pub fn last(&self) -> usize {
        self.ghosts[0].1
    }
}
