//! The answer of a few contacts, whole.

use super::Coupled;
use super::elimination::springs_of_few;
use crate::solver::Answer;

/// The answer matrix of a few contacts, whole, in any order.
#[derive(Clone, Copy)]
pub(crate) struct Few<const N: usize> {
    entries: [[f64; N]; N],
}

impl<const N: usize> Few<N> {
    /// Gathers M.
    #[inline(always)]
    pub fn gather<C: Coupled>(contacts: &[C; N], pull_factor: f64) -> Self {
        let mut entries = [[0.0; N]; N];
        for i in 0..N {
            for j in 0..=i {
                let string =
                    if i == j { contacts[i].own_coupling() } else { contacts[i].coupling(&contacts[j]) };
                entries[i][j] = string - pull_factor * (contacts[i].pull() * contacts[j].pull());
                entries[j][i] = entries[i][j];
            }
            entries[i][i] += contacts[i].own_mobility();
        }
        Few { entries }
    }
}

impl<const N: usize> Answer for Few<N> {
    #[inline(always)]
    fn product(&self, x: &[f64], out: &mut [f64]) {
        product_of_few(&self.entries, x, out);
    }

    #[inline(always)]
    fn springs(&mut self, slopes: &[f64], x: &mut [f64]) {
        springs_of_few::<N, 1>(|i, j| self.entries[i][j], slopes, [x]);
    }
}

/// M x of a symmetric matrix, by columns, which are the rows: the sums are those of the rows in order, side by side.
#[inline(always)]
pub(super) fn product_of_few<const N: usize>(entries: &[[f64; N]], x: &[f64], out: &mut [f64]) {
    let mut sums = [0.0; N];
    for (column, x) in entries.iter().zip(x) {
        for (sum, m) in sums.iter_mut().zip(column) {
            *sum += m * x;
        }
    }
    out[..N].copy_from_slice(&sums);
}
