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

/// Rows before the first one and after the last one that a field has besides: as many as the widest stencil reads there. In them the
/// string goes on in every lane: the neighbours of a piece's first and last points, or an end and two odd ghosts.
pub(crate) const BESIDE: usize = 3;

/// The fewest rows: those beside the one end of a piece are not those beside the other.
const LEAST_ROWS: usize = 2 * BESIDE;

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

/// How many rows the points that move take over a grid of so many intervals.
#[inline(always)]
pub(crate) fn row_count(intervals: usize) -> usize {
    (intervals - 1).div_ceil(LANES).max(LEAST_ROWS)
}

/// How many numbers a field has over a grid of so many intervals.
pub(crate) fn cell_count(intervals: usize) -> usize {
    LANES * (row_count(intervals) + 2 * BESIDE)
}

/// Where the number stands that is `ahead` of the farthest ghost before the nut, in order of place: the nut's is [`NUT`] ahead.
#[inline(always)]
fn cell(intervals: usize, ahead: usize) -> usize {
    let rows = row_count(intervals);
    let piece = (ahead.saturating_sub(BESIDE) / rows).min(LANES - 1);
    LANES * (ahead - piece * rows) + piece
}

/// How far ahead of the farthest ghost the nut is.
const NUT: usize = BESIDE - 1;

/// Where the number of grid point `node` stands, 0 for the nut, on a grid of so many intervals.
#[inline(always)]
pub(crate) fn cell_of(intervals: usize, node: usize) -> usize {
    cell(intervals, NUT + node)
}

/// One number for each point of a grid, its ends and ghosts included, by [`Grid::cell`].
#[derive(Debug, Clone, PartialEq)]
pub struct Field(AVec<f64, ConstAlign<ALIGNMENT>>);

impl Field {
    /// The same number everywhere.
    pub fn filled(grid: &Grid, value: f64) -> Field {
        Field(AVec::from_iter(ALIGNMENT, std::iter::repeat_n(value, cell_count(grid.intervals))))
    }

    /// Zero everywhere.
    pub fn new(grid: &Grid) -> Field {
        Self::filled(grid, 0.0)
    }

    /// All rows, those beside the others, too.
    #[inline(always)]
    pub(crate) fn all_rows(&self) -> &[Row] {
        self.as_chunks().0
    }

    /// The rows of the points that move, padding after the last of them.
    #[inline(always)]
    pub(crate) fn rows(&self) -> &[Row] {
        let rows = self.all_rows();
        &rows[BESIDE..rows.len() - BESIDE]
    }

    /// The same to write to.
    #[inline(always)]
    pub(crate) fn rows_mut(&mut self) -> &mut [Row] {
        let rows = self.as_chunks_mut().0;
        let after = rows.len() - BESIDE;
        &mut rows[BESIDE..after]
    }

    /// The numbers at the points from the one beside the nut on, in order of place: the bridge, ghosts and
    /// padding come last.
    pub fn from_nut(&self) -> impl Iterator<Item = f64> + Clone + '_ {
        (0..LANES).flat_map(|lane| self.rows().iter().map(move |row| row[lane]))
    }

    /// Puts the numbers at the nodes 0 to `intervals` in order of place into `out`, in the place of what it holds.
    pub(crate) fn unfold(&self, intervals: usize, out: &mut Vec<f64>) {
        out.clear();
        out.push(0.0);
        for lane in 0..LANES {
            out.extend(self.rows().iter().map(|row| row[lane]));
        }
        out.truncate(intervals);
        out.push(0.0);
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
    /// The row from which on there are the two points beside the bridge, if they are not among the first rows, and the last
    /// [rows](BESIDE), which the pieces beside them continue.
    pub beside_bridge: usize,
}

impl Ends {
    /// Of a grid.
    pub fn new(grid: &Grid) -> Self {
        let cell = |ahead: usize| cell(grid.intervals, ahead);
        let (nut, bridge) = (NUT, NUT + grid.intervals);
        let mirror = |end: usize, away: usize| (cell(end - away), cell(end + away));
        let (near, far) = (mirror(bridge, 1), mirror(bridge, 2));
        let row = near.0.min(far.0) / LANES - BESIDE;
        Ends {
            ghosts: [(near.1, near.0), (far.1, far.0), mirror(nut, 1), mirror(nut, 2)],
            beside_bridge: row.min(row_count(grid.intervals) - BESIDE).max(BESIDE),
        }
    }

    /// Has the displacements beyond both ends continue those of the string oddly, and those beside each piece the piece.
    #[inline(always)]
    pub fn close(&self, displacement: &mut [f64]) {
        for (ghost, point) in self.ghosts {
            displacement[ghost] = -displacement[point];
        }
        let rows = displacement.as_chunks_mut::<LANES>().0;
        if let Some((before, rows)) = rows.split_first_chunk_mut::<BESIDE>()
            && let Some((rows, after)) = rows.split_last_chunk_mut::<BESIDE>()
            && let (Some(first), Some(last)) = (rows.first_chunk::<BESIDE>(), rows.last_chunk::<BESIDE>())
        {
            for row in 0..BESIDE {
                before[row][1..].copy_from_slice(&last[row][..LANES - 1]);
                after[row][..LANES - 1].copy_from_slice(&first[row][1..]);
            }
        }
    }

    /// Whether these displacements are closed so.
    #[cfg(test)]
    pub fn have_closed(&self, displacement: &[f64]) -> bool {
        let odd = self.ghosts.iter().all(|&(ghost, point)| displacement[ghost] == -displacement[point]);
        let rows = displacement.as_chunks::<LANES>().0;
        let count = rows.len() - 2 * BESIDE;
        let continued = (0..BESIDE).all(|row| {
            let [before, first] = [rows[row], rows[BESIDE + row]];
            let [last, after] = [rows[count + row], rows[BESIDE + count + row]];
            before[1..] == last[..LANES - 1] && after[..LANES - 1] == first[1..]
        });
        odd && continued
    }

    /// The last point that moves.
    pub fn last(&self) -> usize {
        self.ghosts[0].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of ends, ghosts and all between each stands in a cell of its own; what moves stands in the rows, in order, and no more of them
    /// are there than it fills, but for the fewest; and what lies beyond it is in padding, or in the outermost lanes beside.
    #[test]
    fn every_point_has_its_cell() {
        for intervals in 4..=200 {
            let grid = Grid::new(0.65, intervals, 1e-5);
            let mut field = Field::filled(&grid, f64::NAN);
            for ahead in 0..=intervals + 2 * NUT {
                let cell = &mut field[cell(intervals, ahead)];
                assert!(cell.is_nan(), "{ahead} of {intervals} has the cell of another");
                *cell = ahead as f64;
            }
            let first = (NUT + 1) as f64;
            let moving: Vec<f64> = field.from_nut().take(intervals - 1).collect();
            let expected: Vec<f64> = (0..intervals - 1).map(|point| first + point as f64).collect();
            assert_eq!(moving, expected, "{intervals} intervals");
            let rows = field.rows().len();
            assert!(rows == LEAST_ROWS || LANES * (rows - 1) < intervals - 1, "{rows} rows of {intervals}");
            let (before, after) = (&field[..LANES * BESIDE], &field[LANES * (BESIDE + rows)..]);
            let others = |row: &[f64], lane: usize| {
                row.iter().enumerate().all(|(index, number)| index % LANES == lane || number.is_nan())
            };
            assert!(others(before, 0) && others(after, LANES - 1), "{intervals} intervals");
        }
    }
}
