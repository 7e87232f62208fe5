//! The cheapest way to give several notes a string each.

use super::LEAVE_OUT;

/// Nodes of the search for one place of the hand. Six notes on six strings take a few hundred
/// after pruning; the bound is for instruments with very many strings.
const SEARCH_LIMIT: usize = 2_000;

/// Depth-first search for the cheapest assignment, pruned by the least the rest can cost.
pub(super) struct Search<'a> {
    pub strings: usize,
    pub costs: &'a [f64],
    pub bounds: &'a [f64],
    pub taken: &'a mut [bool],
    pub path: &'a mut [Option<usize>],
    pub best_path: &'a mut [Option<usize>],
    pub best_cost: f64,
    pub visits: usize,
}

impl Search<'_> {
    /// Tries every string for the note in this row and those after it, given the cost of those before.
    pub(super) fn descend(&mut self, row: usize, cost: f64) {
        self.visits += 1;
        if cost + self.bounds[row] >= self.best_cost || self.visits > SEARCH_LIMIT {
            return;
        }
        if row == self.path.len() {
            self.best_cost = cost;
            self.best_path.copy_from_slice(self.path);
            return;
        }
        for string in 0..self.strings {
            let step = self.costs[row * self.strings + string];
            if !self.taken[string] && step < LEAVE_OUT {
                self.taken[string] = true;
                self.path[row] = Some(string);
                self.descend(row + 1, cost + step);
                self.taken[string] = false;
            }
        }
        self.path[row] = None;
        self.descend(row + 1, cost + LEAVE_OUT);
    }
}
