//! Which points of a grid move.

use crate::field::{Field, LANES, row_count};
use crate::grid::Grid;

/// All but the ends; in rows, all but padding after the last of them.
#[derive(Debug, Clone)]
pub(super) struct Moving {
    /// 1 at each point that moves, 0 elsewhere.
    pub keep: Field,
    /// From the first on, how many rows move in all lanes.
    pub whole: usize,
}

impl Moving {
    /// Of a grid.
    pub fn new(grid: &Grid) -> Self {
        let mut keep = Field::new(grid);
        for node in 1..grid.intervals {
            keep[grid.cell(node)] = 1.0;
        }
        let before_last_piece = (LANES - 1) * row_count(grid.intervals);
        Moving { keep, whole: grid.unknowns().saturating_sub(before_last_piece) }
    }
}
