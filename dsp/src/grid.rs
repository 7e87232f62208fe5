//! The grid of one string, and how a point between grid points is read and driven.

use std::cmp::Ordering;

use crate::error::{Error, on_string};
use crate::field::{Field, cell_of};

/// A string of `intervals` equal spacings in space and a step in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Number of intervals N; the unknowns are the N − 1 interior points.
    pub intervals: usize,
    /// Length of the string, m.
    pub length: f64,
    /// Spacing h = L/N, m.
    pub spacing: f64,
    /// Time step k, s.
    pub time_step: f64,
}

impl Grid {
    /// A grid of the given number of intervals, 4 or more, on a string of so many m with steps of so many s.
    pub(crate) fn new(length: f64, intervals: usize, time_step: f64) -> Self {
        Grid { intervals, length, spacing: length / intervals as f64, time_step }
    }

    /// Number of unknowns, N − 1.
    pub fn unknowns(&self) -> usize {
        self.intervals - 1
    }

    /// Where the number of grid point `node`, 0 to `intervals`, stands in a [`Field`].
    #[inline(always)]
    pub fn cell(&self, node: usize) -> usize {
        cell_of(self.intervals, node)
    }

    /// The place of grid point `node`, m from the nut.
    pub fn place(&self, node: usize) -> f64 {
        self.length * node as f64 / self.intervals as f64
    }

    /// The interval that a point so many spacings from the nut lies in, 0 for the first.
    #[inline]
    pub(crate) fn interval(&self, spacings: f64) -> usize {
        (spacings.floor() as usize).min(self.intervals - 1)
    }

    /// The reading of the point `position` (m from the nut), which must lie on the string.
    pub fn reading(&self, position: f64) -> Reading {
        Reading::new(self, position)
    }

    /// The reading of the point `position` by the straight line between the two grid points beside it.
    pub fn straight_reading(&self, position: f64) -> Reading {
        Reading::straight(self, position)
    }

    /// Refuses a point that is not strictly between the ends of the string; `name` says whose it is.
    ///
    /// # Errors
    /// When it is one of the ends, beyond them or no number.
    pub fn check_place(&self, name: &str, position: f64) -> Result<f64, Error> {
        on_string(name, position, self.length)
    }
}

/// Interpolation by four points, cubic (Lagrange) or straight: `weights` is hg on the nodes `first` to `first + 3`.
///
/// The same weights read a value, hgᵀu, and spread a force, g f = weights·f/h, so that the power given
/// to the string is exactly force times the velocity that is read. Beyond the ends the string
/// continues oddly (u₋₁ = −u₁), which is folded into the weights; the fixed end points weigh nothing.
/// At a grid point all but one weight vanish.
///
/// (Aligned so that it is copied in whole vectors: one that overlaps two others waits until they are in memory.)
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(32))]
pub struct Reading {
    /// The first of the four nodes.
    pub first: usize,
    /// hg on the four nodes.
    pub weights: [f64; 4],
    /// Where they stand in a field.
    cells: [u32; 4],
    /// The overlap with itself.
    own_overlap: f64,
}

/// Closer to a node than this fraction of the spacing is at the node.
pub(crate) const AT_NODE: f64 = 1e-9;

impl Reading {
    /// Reads nothing.
    pub(crate) const NOTHING: Reading =
        Reading { first: 0, weights: [0.0; 4], cells: [0; 4], own_overlap: 0.0 };

    fn new(grid: &Grid, position: f64) -> Self {
        // Cubic Lagrange weights of the nodes cell − 1 … cell + 2 at fraction p of the cell.
        let lagrange = |p: f64| {
            [
                -p * (p - 1.0) * (p - 2.0) / 6.0,
                (p + 1.0) * (p - 1.0) * (p - 2.0) / 2.0,
                -(p + 1.0) * p * (p - 2.0) / 2.0,
                (p + 1.0) * p * (p - 1.0) / 6.0,
            ]
        };
        Reading::between(grid, position, lagrange)
    }

    fn straight(grid: &Grid, position: f64) -> Self {
        Reading::between(grid, position, |p| [0.0, 1.0 - p, p, 0.0])
    }

    /// The reading of a point by weights of the nodes cell − 1 … cell + 2 that depend on where it lies in its cell.
    fn between(grid: &Grid, position: f64, weights_at: impl Fn(f64) -> [f64; 4]) -> Self {
        let nodes = grid.intervals;
        let place = (position / grid.spacing).clamp(0.0, nodes as f64);
        let nearest = place.round();
        if (place - nearest).abs() < AT_NODE {
            return Reading::at_node(grid, nearest as usize);
        }
        let cell = grid.interval(place);
        // The window of four nodes, kept inside 0 … N where the grid is long enough for that.
        let window = cell.saturating_sub(1).min((nodes + 1).saturating_sub(4)) as isize;
        let mut weights = [0.0; 4];
        for (offset, weight) in weights_at(place - cell as f64).into_iter().enumerate() {
            let node = cell as isize - 1 + offset as isize;
            let (node, sign) = match node {
                n if n < 0 => (-n, -1.0),
                n if n > nodes as isize => (2 * nodes as isize - n, -1.0),
                n => (n, 1.0),
            };
            if node != 0 && node != nodes as isize {
                weights[(node - window) as usize] += sign * weight;
            }
        }
        Reading::over(grid, window as usize, weights)
    }

    /// The reading of a grid point; the ends of the string read nothing.
    pub fn at_node(grid: &Grid, node: usize) -> Self {
        let mut weights = [0.0; 4];
        // Node 0 or N is fixed; every other node is the last of its window or, near the nut, earlier.
        let window = node.saturating_sub(3);
        if node != 0 && node != grid.intervals {
            weights[node - window] = 1.0;
        }
        Reading::over(grid, window, weights)
    }

    /// The reading of the three grid points before the bridge, nearest last, by weights of whoever asks.
    pub(crate) fn before_bridge(grid: &Grid, [third, second, first]: [f64; 3]) -> Self {
        Reading::over(grid, grid.intervals - 4, [0.0, third, second, first])
    }

    fn over(grid: &Grid, first: usize, weights: [f64; 4]) -> Self {
        let cells = [0, 1, 2, 3].map(|offset| grid.cell(first + offset) as u32);
        let reading = Reading { first, weights, cells, own_overlap: 0.0 };
        Reading { own_overlap: reading.overlap(&reading), ..reading }
    }

    /// The place read, in nodes from the nut, exact but in the last two spacings of the string.
    fn centre(&self) -> f64 {
        let w = &self.weights;
        self.first as f64 + (w[1] + 2.0 * w[2] + 3.0 * w[3])
    }

    /// The order in which many contacts are solved: by place, but for those within the last two spacings of the string,
    /// whose weights lack the fixed end.
    pub(crate) fn order(&self, other: &Reading) -> Ordering {
        self.centre().total_cmp(&other.centre())
    }

    /// The interval of nodes whose weights matter, end not included.
    #[inline]
    pub(crate) fn span(&self) -> (usize, usize) {
        let weighs = |weight: &f64| *weight != 0.0;
        let start = self.weights.iter().position(weighs).unwrap_or(0);
        let end = self.weights.iter().rposition(weighs).map_or(0, |last| last + 1);
        (self.first + start, self.first + end)
    }

    /// The value hgᵀv of a field.
    #[inline(always)]
    pub fn of(&self, v: &Field) -> f64 {
        let (w, v) = (&self.weights, self.cells.map(|cell| v[cell as usize]));
        (w[0] * v[0] + w[1] * v[1]) + (w[2] * v[2] + w[3] * v[3])
    }

    /// The value of a field of which nothing cancels.
    pub(crate) fn size(&self, v: &Field) -> f64 {
        self.cells.iter().zip(self.weights).map(|(cell, weight)| (weight * v[*cell as usize]).abs()).sum()
    }

    /// The values of several fields of the same grid. (Their lengths are compared once, and where a number stands once for
    /// all of them.)
    #[inline(always)]
    pub(crate) fn of_each<const COUNT: usize>(&self, fields: [&Field; COUNT]) -> [f64; COUNT] {
        let length = fields[0].len();
        let fields = fields.map(|field| &field[..length]);
        let w = &self.weights;
        let at = self.cells.map(|cell| fields.map(|field| field[cell as usize]));
        std::array::from_fn(|i| (w[0] * at[0][i] + w[1] * at[1][i]) + (w[2] * at[2][i] + w[3] * at[3][i]))
    }

    /// Adds `amount` times the weights to a field.
    #[inline(always)]
    pub fn spread(&self, v: &mut Field, amount: f64) {
        for (cell, weight) in self.cells.iter().zip(self.weights) {
            v[*cell as usize] += weight * amount;
        }
    }

    /// Whether it is a curve that is read, neither a point nor a straight line between two.
    pub(crate) fn is_curved(&self) -> bool {
        self.weights.iter().filter(|weight| **weight != 0.0).count() > 2
    }

    /// Σ over nodes of the squares of the weights: the [`overlap`](Reading::overlap) with itself.
    #[inline(always)]
    pub(crate) fn own_overlap(&self) -> f64 {
        self.own_overlap
    }

    /// Σ over nodes of the product of two readings' weights, h²gᵀg′: how strongly they couple.
    #[inline]
    pub fn overlap(&self, other: &Reading) -> f64 {
        let (near, far) = if self.first <= other.first { (self, other) } else { (other, self) };
        let (a, b) = (&near.weights, &far.weights);
        match far.first - near.first {
            0 => (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]),
            1 => (a[1] * b[0] + a[2] * b[1]) + a[3] * b[2],
            2 => a[2] * b[0] + a[3] * b[1],
            3 => a[3] * b[0],
            _ => 0.0,
        }
    }
}
