//! How the active contacts answer forces: r = −c − M f.
//!
//! M = D + S − ω z zᵀ, where D is the fingers' own mobility, S the mobility of the string at places that
//! share grid points, and the last term the pull of tension modulation. Contacts fall into blocks that
//! share no grid points, so S and D are dense only within blocks, and z couples them all. A few
//! contacts make one block that holds everything.

use nalgebra::linalg::Cholesky;
use nalgebra::{DVectorViewMut, Dyn, OMatrix, SMatrix, SVector, VecStorage};

use crate::solver::Answer;

/// Up to this many contacts are one block, with the rank-one term inside.
const ONE_BLOCK: usize = 6;

/// A run of contacts that share grid points.
#[derive(Debug, Clone, Copy)]
struct Block {
    start: usize,
    len: usize,
    /// Where the block's entries begin.
    offset: usize,
}

/// The answer matrix M of the active contacts, and room to solve with it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Response {
    blocks: Vec<Block>,
    entries: Vec<f64>,
    /// z and its factor ω ≥ 0; 0 when it is inside the only block.
    pull: Vec<f64>,
    pull_factor: f64,
    /// Room for one block's matrix, and for z scaled.
    matrix: Vec<f64>,
    scaled_pull: Vec<f64>,
}

/// What the response needs to know of a contact.
pub(crate) trait Row {
    /// Interval of grid indices it touches, end not included.
    fn span(&self) -> (usize, usize);
    /// Product with another contact: mobility of the string between them, signs included, m/N.
    fn coupling(&self, other: &Self) -> f64;
    /// The contact's own mobility besides the string's (a finger's), m/N.
    fn own_mobility(&self) -> f64;
    /// Its share z of the tension pull.
    fn pull(&self) -> f64;
}

impl Response {
    /// Room for so many contacts.
    pub fn with_capacity(contacts: usize) -> Self {
        // Frets can be denser than the grid, and then all couple with all.
        let square = contacts * contacts;
        Response {
            blocks: Vec::with_capacity(contacts),
            entries: Vec::with_capacity(square),
            pull: Vec::with_capacity(contacts),
            pull_factor: 0.0,
            matrix: Vec::with_capacity(square),
            scaled_pull: Vec::with_capacity(contacts),
        }
    }

    /// Gathers M for contacts in order of place.
    pub fn gather<R: Row>(&mut self, rows: &[R], pull_factor: f64) {
        let count = rows.len();
        self.blocks.clear();
        self.entries.clear();
        self.pull.clear();
        self.pull.extend(rows.iter().map(Row::pull));
        let inside = count <= ONE_BLOCK;
        self.pull_factor = if inside { 0.0 } else { pull_factor };
        let mut start = 0;
        while start < count {
            let mut end = start + 1;
            let mut reach = rows[start].span().1;
            while end < count && (inside || rows[end].span().0 < reach) {
                reach = reach.max(rows[end].span().1);
                end += 1;
            }
            self.blocks.push(Block { start, len: end - start, offset: self.entries.len() });
            for i in start..end {
                for j in start..end {
                    let mut entry = rows[i].coupling(&rows[j]);
                    if inside {
                        entry -= pull_factor * (self.pull[i] * self.pull[j]);
                    }
                    if i == j {
                        entry += rows[i].own_mobility();
                    }
                    self.entries.push(entry);
                }
            }
            start = end;
        }
    }
}

impl Answer for Response {
    #[inline]
    fn product(&self, x: &[f64], out: &mut [f64]) {
        for block in &self.blocks {
            let x = &x[block.start..block.start + block.len];
            for i in 0..block.len {
                let row = &self.entries[block.offset + i * block.len..][..block.len];
                out[block.start + i] = row.iter().zip(x).map(|(m, x)| m * x).sum();
            }
        }
        if self.pull_factor > 0.0 {
            let along: f64 = self.pull.iter().zip(x).map(|(z, x)| z * x).sum();
            for (out, z) in out.iter_mut().zip(&self.pull) {
                *out -= self.pull_factor * along * z;
            }
        }
    }

    fn solve(&mut self, roots: &[f64], y: &mut [f64]) {
        for index in 0..self.blocks.len() {
            self.solve_block(self.blocks[index], roots, y);
        }
        if self.pull_factor > 0.0 {
            // Sherman–Morrison on 1 + √D(S + D)√D − ω t tᵀ with t = √D z.
            let mut t = std::mem::take(&mut self.scaled_pull);
            t.clear();
            t.extend(self.pull.iter().zip(roots).map(|(z, root)| z * root));
            let along: f64 = t.iter().zip(y.iter()).map(|(t, y)| t * y).sum();
            for index in 0..self.blocks.len() {
                self.solve_block(self.blocks[index], roots, &mut t);
            }
            let against: f64 = t.iter().zip(&self.pull).zip(roots).map(|((t, z), root)| t * (z * root)).sum();
            let factor = self.pull_factor * along / (1.0 - self.pull_factor * against);
            for (y, t) in y.iter_mut().zip(&t) {
                *y += factor * t;
            }
            self.scaled_pull = t;
        }
    }
}

impl Response {
    fn solve_block(&mut self, block: Block, roots: &[f64], y: &mut [f64]) {
        let range = block.start..block.start + block.len;
        let (roots, y) = (&roots[range.clone()], &mut y[range]);
        let entries = &self.entries[block.offset..][..block.len * block.len];
        match block.len {
            1 => y[0] /= 1.0 + roots[0] * entries[0] * roots[0],
            2 => solve_fixed::<2>(entries, roots, y),
            3 => solve_fixed::<3>(entries, roots, y),
            4 => solve_fixed::<4>(entries, roots, y),
            _ => solve_any(&mut self.matrix, entries, roots, y),
        }
    }
}

/// The answer matrix of a few contacts, whole.
pub(crate) struct Few<const N: usize> {
    entries: [[f64; N]; N],
}

impl<const N: usize> Few<N> {
    /// Gathers M.
    #[inline(always)]
    pub fn gather<R: Row>(rows: &[R; N], pull_factor: f64) -> Self {
        let mut entries = [[0.0; N]; N];
        for i in 0..N {
            for j in 0..=i {
                let string = rows[i].coupling(&rows[j]);
                entries[i][j] = string - pull_factor * (rows[i].pull() * rows[j].pull());
                entries[j][i] = entries[i][j];
            }
            entries[i][i] += rows[i].own_mobility();
        }
        Few { entries }
    }
}

impl<const N: usize> Answer for Few<N> {
    #[inline(always)]
    fn product(&self, x: &[f64], out: &mut [f64]) {
        for (out, row) in out.iter_mut().zip(&self.entries) {
            *out = row.iter().zip(x).map(|(m, x)| m * x).sum();
        }
    }

    #[inline(always)]
    fn solve(&mut self, roots: &[f64], y: &mut [f64]) {
        if N == 1 {
            y[0] /= 1.0 + roots[0] * self.entries[0][0] * roots[0];
        } else {
            solve_fixed::<N>(self.entries.as_flattened(), roots, y);
        }
    }
}

/// 1 + √D M √D at (i, j).
#[inline(always)]
fn scaled(entries: &[f64], roots: &[f64], i: usize, j: usize) -> f64 {
    let entry = roots[i] * entries[i * roots.len() + j] * roots[j];
    if i == j { 1.0 + entry } else { entry }
}

#[inline(always)]
fn solve_fixed<const N: usize>(entries: &[f64], roots: &[f64], y: &mut [f64]) {
    let matrix = SMatrix::<f64, N, N>::from_fn(|i, j| scaled(entries, roots, i, j));
    // Eigenvalues are at least 1: only overflow can make the factorisation fail.
    if let Some(factor) = matrix.cholesky() {
        let solution = factor.solve(&SVector::<f64, N>::from_column_slice(y));
        y.copy_from_slice(solution.as_slice());
    }
}

/// The same for any size, in memory that is lent to nalgebra and taken back, so nothing is allocated.
fn solve_any(room: &mut Vec<f64>, entries: &[f64], roots: &[f64], y: &mut [f64]) {
    let n = roots.len();
    let mut data = std::mem::take(room);
    data.clear();
    for j in 0..n {
        data.extend((0..n).map(|i| scaled(entries, roots, i, j)));
    }
    let storage = VecStorage::new(Dyn(n), Dyn(n), data);
    let matrix = OMatrix::<f64, Dyn, Dyn>::from_data(storage);
    match Cholesky::new(matrix) {
        Some(factor) => {
            factor.solve_mut(&mut DVectorViewMut::from_slice(y, n));
            *room = factor.unpack_dirty().data.into();
        }
        // Overflow only; the caller's energy test then falls back on a stiffer secant.
        None => *room = Vec::new(),
    }
}
