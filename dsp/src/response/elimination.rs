//! Springs against what answers them: (1 + D M) x = D g solved for a few unknowns, and for any number.

use nalgebra::allocator::Allocator;
use nalgebra::linalg::Cholesky;
use nalgebra::{Const, DefaultAllocator, Dim, Dyn, OMatrix, VecStorage, VectorViewMut};

/// Up to so many unknowns rows are multiplied by the pivots.
const MULTIPLIED: usize = 4;

/// Solves (1 + D M) x = D g for each of several g by one elimination without pivots. In place: each g goes in, its x comes
/// out. No pivots are needed: where a slope is 0 its row is done, and the others are those of the positive D⁻¹ + M, scaled,
/// so that every pivot is at least 1. The last two unknowns are found together, and up to four rows are multiplied by the
/// pivot and not divided by it, so that only one division is waited for. (For so few unknowns what counts is how long each
/// operation waits for the one before. With more of them the products of steep slopes could pass the largest number.) The sides
/// follow when the matrix is done.
#[inline(always)]
#[expect(clippy::needless_range_loop, reason = "indices are how the formulas are written")]
pub(super) fn springs_of_few<const N: usize, const SIDES: usize>(
    entry: impl Fn(usize, usize) -> f64,
    slopes: &[f64],
    sides: [&mut [f64]; SIDES],
) {
    let mut a = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            a[i][j] = slopes[i] * entry(i, j);
        }
        a[i][i] += 1.0;
    }
    let Some(pair) = N.checked_sub(2) else {
        sides.into_iter().for_each(|x| x[0] = slopes[0] * x[0] / a[0][0]);
        return;
    };
    let mut inverses = [0.0; N];
    for j in 0..pair {
        inverses[j] = 1.0 / a[j][j];
        for i in j + 1..N {
            if N > MULTIPLIED {
                a[i][j] *= inverses[j];
            }
            let (pivot, share) = (pivot::<N>(a[j][j]), a[i][j]);
            for k in j + 1..N {
                a[i][k] = pivot * a[i][k] - share * a[j][k];
            }
        }
    }
    let last = pair + 1;
    let inverse = 1.0 / (a[pair][pair] * a[last][last] - a[pair][last] * a[last][pair]);
    for x in sides {
        for i in 0..N {
            x[i] *= slopes[i];
        }
        for j in 0..pair {
            for i in j + 1..N {
                x[i] = pivot::<N>(a[j][j]) * x[i] - a[i][j] * x[j];
            }
        }
        let found = [
            inverse * (a[last][last] * x[pair] - a[pair][last] * x[last]),
            inverse * (a[pair][pair] * x[last] - a[last][pair] * x[pair]),
        ];
        x[pair..N].copy_from_slice(&found);
        for j in (0..pair).rev() {
            for k in j + 1..N {
                x[j] -= a[j][k] * x[k];
            }
            x[j] *= inverses[j];
        }
    }
}

/// What rows of so many unknowns are multiplied by for a pivot.
#[inline(always)]
fn pivot<const N: usize>(pivot: f64) -> f64 {
    if N > MULTIPLIED { 1.0 } else { pivot }
}

/// The same for more: x = √D y with (1 + √D M √D) y = √D g, which is symmetric. Rare, and apart from the few.
#[inline(never)]
pub(super) fn springs_of_several<const N: usize, const SIDES: usize>(
    entries: &[f64],
    slopes: &[f64],
    sides: [&mut [f64]; SIDES],
) {
    let roots: [f64; N] = std::array::from_fn(|i| slopes[i].sqrt());
    let matrix = OMatrix::<f64, Const<N>, Const<N>>::from_fn(|i, j| scaled(entries, &roots, i, j));
    solve(matrix, &roots, sides);
}

/// The same for any number, the same bits for as many. Memory is lent to nalgebra and taken back, so nothing is allocated.
pub(super) fn springs_of_any<const SIDES: usize>(
    room: &mut Vec<f64>,
    roots: &mut Vec<f64>,
    entries: &[f64],
    slopes: &[f64],
    sides: [&mut [f64]; SIDES],
) {
    let n = slopes.len();
    roots.clear();
    roots.extend(slopes.iter().map(|slope| slope.sqrt()));
    let mut data = std::mem::take(room);
    data.clear();
    for j in 0..n {
        data.extend((0..n).map(|i| scaled(entries, roots, i, j)));
    }
    let matrix = OMatrix::<f64, Dyn, Dyn>::from_data(VecStorage::new(Dyn(n), Dyn(n), data));
    if let Some(factor) = solve(matrix, roots, sides) {
        *room = factor.unpack_dirty().data.into();
    }
}

/// 1 + √D M √D below its diagonal and on it, which is all that is looked at.
#[inline(always)]
fn scaled(entries: &[f64], roots: &[f64], i: usize, j: usize) -> f64 {
    if i < j {
        return 0.0;
    }
    let entry = roots[i] * entries[i * roots.len() + j] * roots[j];
    if i == j { 1.0 + entry } else { entry }
}

/// Solves for each side by one factorisation, which is given back for its memory.
#[inline(always)]
fn solve<D: Dim, const SIDES: usize>(
    matrix: OMatrix<f64, D, D>,
    roots: &[f64],
    sides: [&mut [f64]; SIDES],
) -> Option<Cholesky<f64, D>>
where
    DefaultAllocator: Allocator<D, D>,
{
    // No pivot is less than 1. Where the slopes are so steep that rounding has left nothing of one, it is taken for that: the
    // forces are poor then, which the caller's energy test sees, and the memory is not lost.
    let size = matrix.shape_generic().0;
    let factor = Cholesky::new_with_substitute(matrix, 1.0)?;
    for x in sides {
        x.iter_mut().zip(roots).for_each(|(x, root)| *x *= root);
        factor.solve_mut(&mut VectorViewMut::<f64, D>::from_slice_generic(x, size, Const));
        x.iter_mut().zip(roots).for_each(|(x, root)| *x *= root);
    }
    Some(factor)
}
