//! How the active contacts answer forces: r = −c − M f.
//!
//! M = D + S − ω z zᵀ, where D is the fingers' own mobility, S the mobility of the string at places that
//! share grid points, and the last term the pull of tension modulation. Contacts fall into blocks that
//! share no grid points, so S and D are dense only within blocks, and z couples them all. Of a few
//! contacts the whole matrix is kept.

mod elimination;
mod few;
#[cfg(test)]
mod tests;

use crate::roomy::Roomy;
use crate::solver::Answer;
use elimination::{springs_of_any, springs_of_few, springs_of_several};
pub(crate) use few::Few;
use few::product_of_few;

/// Points of the string that a finger may touch at once, by cubic interpolation.
const FINGER_POINTS: usize = 4;

/// A run of contacts that share grid points.
#[derive(Debug, Clone, Copy)]
struct Block {
    start: usize,
    len: usize,
    /// Where the block's entries begin.
    offset: usize,
}

/// The answer matrix M of many contacts, and room to solve with it.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    blocks: Roomy<Block>,
    /// Room to find the blocks.
    starts: Roomy<usize>,
    entries: Roomy<f64>,
    /// z and its factor ω ≥ 0.
    pull: Roomy<f64>,
    pull_factor: f64,
    /// Room for one block's matrix and roots, and for what springs make of z.
    matrix: Roomy<f64>,
    roots: Roomy<f64>,
    pulled: Roomy<f64>,
}

/// Splits contacts in [order](crate::grid::Reading::order) into the shortest runs that share no grid points. A wide contact may
/// begin before a narrow one that stands before it, so a run ends only where all that follows begins later.
fn split(
    starts: &mut Vec<usize>,
    count: usize,
    span: impl Fn(usize) -> (usize, usize),
    mut found: impl FnMut(usize, usize),
) {
    starts.clear();
    starts.extend((0..count).map(|i| span(i).0));
    for i in (1..count).rev() {
        starts[i - 1] = starts[i - 1].min(starts[i]);
    }
    let (mut start, mut reach) = (0, 0);
    for (i, &next) in starts.iter().enumerate() {
        if i > start && next >= reach {
            found(start, i);
            start = i;
        }
        reach = reach.max(span(i).1);
    }
    if start < count {
        found(start, count);
    }
}

/// What the response needs to know of a contact.
pub(crate) trait Coupled {
    /// Interval of grid indices it touches, end not included.
    fn span(&self) -> (usize, usize);
    /// Product with another contact: mobility of the string between them, signs included, m/N.
    fn coupling(&self, other: &Self) -> f64;
    /// The same with itself.
    fn own_coupling(&self) -> f64 {
        self.coupling(self)
    }
    /// The contact's own mobility besides the string's (a finger's), m/N.
    fn own_mobility(&self) -> f64;
    /// Its share z of the tension pull.
    fn pull(&self) -> f64;
}

/// What the answer of many contacts needs room for.
pub(crate) struct Needs {
    /// Entries of all blocks.
    entries: usize,
    /// Contacts in the largest block.
    largest: usize,
    /// Cubes of the numbers of contacts in the blocks, all together.
    cubes: f64,
}

impl Needs {
    /// Of fixed contacts, whose spans are given in their order, and so many fingers anywhere.
    fn of(spans: &[(usize, usize)], fingers: usize) -> Self {
        let mut blocks = Vec::new();
        let mut starts = Vec::new();
        split(
            &mut starts,
            spans.len(),
            |i| spans[i],
            |start, end| {
                let first = spans[start..end].iter().map(|span| span.0).min();
                let last = spans[start..end].iter().map(|span| span.1).max();
                blocks.push((end - start, first.unwrap_or(0), last.unwrap_or(0)));
            },
        );
        // The most contacts whose blocks a finger's four points can touch: from the last point of one
        // block on, the blocks that begin within the next three.
        let touched = (0..blocks.len()).map(|i| {
            let reach = blocks[i].2 + FINGER_POINTS - 1;
            blocks[i..].iter().take_while(|block| block.1 < reach).map(|block| block.0).sum::<usize>()
        });
        // Fingers join what they touch; at worst all of it becomes one block.
        let all = spans.len() + fingers;
        let touched = touched.max().unwrap_or(0);
        let joined = fingers.saturating_mul(touched + 1).min(all);
        let largest = blocks.iter().map(|block| block.0).max().unwrap_or(0).max(joined);
        let square = |contacts: usize| contacts.saturating_mul(contacts);
        let fixed = blocks.iter().fold(0usize, |sum, block| sum.saturating_add(square(block.0)));
        let cube = |contacts: usize| {
            let side = contacts as f64;
            side * side * side
        };
        // Each with what it touches, or all of them at one place.
        let with_fingers = fingers as f64 * cube(touched + 1) + cube(fingers);
        let cubes = blocks.iter().fold(with_fingers, |sum, block| sum + cube(block.0)).min(cube(all));
        Needs { entries: fixed.saturating_add(square(joined)).min(square(all)), largest, cubes }
    }

    /// How many numbers a [`Response`] to fixed contacts with these spans and so many fingers keeps.
    pub fn numbers(spans: &[(usize, usize)], fingers: usize) -> usize {
        let Needs { entries, largest, .. } = Needs::of(spans, fingers);
        entries.saturating_add(largest.saturating_mul(largest))
    }

    /// How many steps it may take to gather them and to solve with them once, a third of the cube of each block: at worst, where
    /// all contacts are active and fingers join as many as they can.
    pub fn work(spans: &[(usize, usize)], fingers: usize) -> f64 {
        Self::numbers(spans, fingers) as f64 + Needs::of(spans, fingers).cubes / 3.0
    }
}

impl Response {
    /// Room for fixed contacts, whose spans are given in their order, and so many fingers anywhere: for
    /// all that can be active at once, but for no square of a long board.
    pub fn with_capacity(spans: &[(usize, usize)], fingers: usize) -> Self {
        let all = spans.len() + fingers;
        let Needs { entries, largest, .. } = Needs::of(spans, fingers);
        Response {
            blocks: Roomy::with_capacity(all),
            starts: Roomy::with_capacity(all),
            entries: Roomy::with_capacity(entries),
            pull: Roomy::with_capacity(all),
            pull_factor: 0.0,
            matrix: Roomy::with_capacity(largest * largest),
            roots: Roomy::with_capacity(largest),
            pulled: Roomy::with_capacity(all),
        }
    }

    /// Gathers M for contacts in their order.
    pub fn gather<C: Coupled>(&mut self, contacts: &[C], pull_factor: f64) {
        self.blocks.clear();
        self.entries.clear();
        self.pull.clear();
        self.pull.extend(contacts.iter().map(Coupled::pull));
        self.pull_factor = pull_factor;
        let Response { blocks, starts, entries, .. } = self;
        let add_block = |start: usize, end: usize| {
            let (len, offset) = (end - start, entries.len());
            blocks.push(Block { start, len, offset });
            entries.resize(offset + len * len, 0.0);
            let (contacts, entries) = (&contacts[start..end], &mut entries[offset..]);
            for i in 0..len {
                for j in 0..i {
                    let coupling = contacts[i].coupling(&contacts[j]);
                    (entries[i * len + j], entries[j * len + i]) = (coupling, coupling);
                }
                entries[i * len + i] = contacts[i].own_coupling() + contacts[i].own_mobility();
            }
        };
        split(starts, contacts.len(), |i| contacts[i].span(), add_block);
    }
}

impl Answer for Response {
    #[inline(always)]
    fn product(&self, x: &[f64], out: &mut [f64]) {
        for block in &self.blocks {
            // Most contacts stand alone.
            if block.len == 1 {
                out[block.start] = self.entries[block.offset] * x[block.start];
                continue;
            }
            let entries = &self.entries[block.offset..][..block.len * block.len];
            let range = block.start..block.start + block.len;
            let (x, out) = (&x[range.clone()], &mut out[range]);
            // One loop for all sizes would take the worst sample of a chord that buzzes 6 % more instructions.
            match block.len {
                2 => product_of_few::<2>(entries.as_chunks().0, x, out),
                3 => product_of_few::<3>(entries.as_chunks().0, x, out),
                4 => product_of_few::<4>(entries.as_chunks().0, x, out),
                5 => product_of_few::<5>(entries.as_chunks().0, x, out),
                6 => product_of_few::<6>(entries.as_chunks().0, x, out),
                count => {
                    out.fill(0.0);
                    for (column, x) in entries.chunks_exact(count).zip(x) {
                        for (out, m) in out.iter_mut().zip(column) {
                            *out += m * x;
                        }
                    }
                }
            }
        }
        if self.pull_factor > 0.0 {
            let along: f64 = self.pull.iter().zip(x).map(|(z, x)| z * x).sum();
            for (out, z) in out.iter_mut().zip(&self.pull) {
                *out -= self.pull_factor * along * z;
            }
        }
    }

    #[inline(always)]
    fn springs(&mut self, slopes: &[f64], x: &mut [f64]) {
        if self.pull_factor > 0.0 {
            // Sherman–Morrison on 1 + D(S + own) − ω D z zᵀ.
            let mut pulled = std::mem::take(&mut *self.pulled);
            pulled.clone_from(&self.pull);
            self.springs_without_pull(slopes, [&mut *x, &mut pulled]);
            let along = dot(&self.pull, x);
            let factor = self.pull_factor * along / (1.0 - self.pull_factor * dot(&self.pull, &pulled));
            for (x, pulled) in x.iter_mut().zip(&pulled) {
                *x += factor * pulled;
            }
            *self.pulled = pulled;
        } else {
            self.springs_without_pull(slopes, [x]);
        }
    }
}

impl Response {
    /// The forces of springs under several sets of penetrations, each in place, were there no pull.
    #[inline(always)]
    fn springs_without_pull<const SIDES: usize>(&mut self, slopes: &[f64], mut sides: [&mut [f64]; SIDES]) {
        let Response { blocks, entries, matrix, roots, .. } = self;
        for block in &*blocks {
            let range = block.start..block.start + block.len;
            let slopes = &slopes[range.clone()];
            let sides = sides.each_mut().map(|x| &mut x[range.clone()]);
            let entries = &entries[block.offset..][..block.len * block.len];
            match block.len {
                1 => springs_of_few::<1, SIDES>(|_, _| entries[0], slopes, sides),
                2 => springs_of_few::<2, SIDES>(|i, j| entries[2 * i + j], slopes, sides),
                3 => springs_of_few::<3, SIDES>(|i, j| entries[3 * i + j], slopes, sides),
                4 => springs_of_few::<4, SIDES>(|i, j| entries[4 * i + j], slopes, sides),
                5 => springs_of_few::<5, SIDES>(|i, j| entries[5 * i + j], slopes, sides),
                6 => springs_of_few::<6, SIDES>(|i, j| entries[6 * i + j], slopes, sides),
                7 => springs_of_several::<7, SIDES>(entries, slopes, sides),
                8 => springs_of_several::<8, SIDES>(entries, slopes, sides),
                9 => springs_of_several::<9, SIDES>(entries, slopes, sides),
                10 => springs_of_several::<10, SIDES>(entries, slopes, sides),
                _ => springs_of_any(matrix, roots, entries, slopes, sides),
            }
        }
    }
}

/// aᵀb.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
