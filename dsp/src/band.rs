//! Symmetric matrices of seven diagonals, real or complex, and linear systems with them.

use std::ops::{Add, Div, Mul, Sub};

use crate::grid::{Grid, Reading};
use crate::model::Stiffness;

/// What the entries may be: real, or complex with plain (not conjugate) symmetry.
pub(crate) trait Number:
    Copy + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
}

impl Number for f64 {}
impl Number for nalgebra::Complex<f64> {}

/// Diagonals kept: the main one and three above.
const DIAGONALS: usize = 4;

/// Undivided −δ², δ⁴ and −δ⁶ as coefficients of the neighbours at distance 0 to 3.
const DIFFERENCES: [[f64; DIAGONALS]; 3] =
    [[2.0, -1.0, 0.0, 0.0], [6.0, -4.0, 1.0, 0.0], [20.0, -15.0, 6.0, -1.0]];

/// A symmetric matrix over the unknowns of a grid; row i holds entries (i, i) to (i, i + 3).
#[derive(Debug, Clone)]
pub(crate) struct Band<T> {
    rows: Vec<[T; DIAGONALS]>,
}

impl<T: Number> Band<T> {
    /// The stiffness of a string on a grid, N/m: force at a grid point per displacement of another.
    /// The string goes on oddly beyond its fixed ends.
    pub fn of_string(grid: &Grid, linear_density: f64, stiffness: &Stiffness) -> Self {
        let mut matrix = Band { rows: vec![[T::from(0.0); DIAGONALS]; grid.unknowns()] };
        matrix.become_string(grid, linear_density, stiffness);
        matrix
    }

    /// Becomes that, in the room that is there.
    fn become_string(&mut self, grid: &Grid, linear_density: f64, stiffness: &Stiffness) {
        let h = grid.spacing;
        let parts = [
            stiffness.tension / h,
            linear_density * stiffness.kappa_squared / (h * h * h),
            linear_density * stiffness.kappa_6 / (h * h * h * h * h),
        ];
        let near: [f64; DIAGONALS] =
            std::array::from_fn(|d| (0..3).map(|part| parts[part] * DIFFERENCES[part][d]).sum());
        let (last, count) = (grid.intervals as isize, DIAGONALS as isize);
        for row in 1..last {
            if (count..=last - count).contains(&row) {
                // Far from the ends all rows are the same.
                self.rows[row as usize - 1] = near.map(T::from);
                continue;
            }
            self.rows[row as usize - 1] = [T::from(0.0); DIAGONALS];
            for offset in 1 - count..count {
                let (column, sign) = match row + offset {
                    column if column < 0 => (-column, -1.0),
                    column if column > last => (2 * last - column, -1.0),
                    column => (column, 1.0),
                };
                // The lower half is not stored, the ends do not move.
                if column >= row && column < last {
                    let entry = &mut self.rows[row as usize - 1][(column - row) as usize];
                    *entry = *entry + T::from(sign * near[offset.unsigned_abs()]);
                }
            }
        }
    }

    /// Adds `amount` times the product of a point's weights with themselves: a spring at that point.
    pub fn add_spring(&mut self, at: &Reading, amount: T) {
        for i in 0..4 {
            for j in i..4 {
                let weight = at.weights[i] * at.weights[j];
                if weight != 0.0 {
                    let entry = &mut self.rows[at.first + i - 1][j - i];
                    *entry = *entry + T::from(weight) * amount;
                }
            }
        }
    }

    /// Adds `amount` to the main diagonal from a row on.
    pub fn shift_from(&mut self, first: usize, amount: T) {
        for row in &mut self.rows[first..] {
            row[0] = row[0] + amount;
        }
    }

    /// The product with a vector.
    pub fn times(&self, v: &[T]) -> Vec<T> {
        let mut product = vec![T::from(0.0); v.len()];
        for (i, row) in self.rows.iter().enumerate() {
            product[i] = product[i] + row[0] * v[i];
            for (d, &entry) in row.iter().enumerate().skip(1) {
                if i + d < v.len() {
                    product[i] = product[i] + entry * v[i + d];
                    product[i + d] = product[i + d] + entry * v[i];
                }
            }
        }
        product
    }

    /// LDLᵀ in place of the matrix: D on the main diagonal, L beside it.
    pub fn factor(mut self) -> Factored<T> {
        self.eliminate();
        Factored(self)
    }

    /// Becomes its own factors.
    fn eliminate(&mut self) {
        let count = self.rows.len();
        for i in 0..count {
            let row = self.rows[i];
            for d in 1..DIAGONALS.min(count - i) {
                let ratio = row[d] / row[0];
                for (entry, &above) in self.rows[i + d].iter_mut().zip(&row[d..]) {
                    *entry = *entry - ratio * above;
                }
                self.rows[i][d] = ratio;
            }
        }
    }
}

/// A factored [`Band`].
#[derive(Debug, Clone)]
pub(crate) struct Factored<T>(Band<T>);

impl<T: Number> Factored<T> {
    /// Becomes the factors of another string's stiffness on the same grid, in the room that is there.
    pub fn become_string(&mut self, grid: &Grid, linear_density: f64, stiffness: &Stiffness) {
        self.0.become_string(grid, linear_density, stiffness);
        self.0.eliminate();
    }

    /// Solves for the right-hand side `b`.
    pub fn solve(&self, b: &[T]) -> Vec<T> {
        let mut x = b.to_vec();
        self.solve_in_place(&mut x);
        x
    }

    /// Solves for the right-hand side in `x`, and leaves the solution there.
    pub fn solve_in_place(&self, x: &mut [T]) {
        let count = x.len();
        let rows = &self.0.rows;
        for (i, row) in rows.iter().enumerate() {
            for d in 1..DIAGONALS.min(count - i) {
                x[i + d] = x[i + d] - row[d] * x[i];
            }
        }
        for (i, row) in rows.iter().enumerate().rev() {
            x[i] = x[i] / row[0];
            for d in 1..DIAGONALS.min(count - i) {
                x[i] = x[i] - row[d] * x[i + d];
            }
        }
    }
}

/// aᵀb, without conjugation.
pub(crate) fn dot<T: Number>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::from(0.0), |sum, (&x, &y)| sum + x * y)
}

/// A factored matrix plus `strength`·v vᵀ.
#[derive(Debug, Clone)]
pub(crate) struct RankOne<T> {
    base: Factored<T>,
    vector: Vec<T>,
    solved: Vec<T>,
    /// strength/(1 + strength·vᵀA⁻¹v).
    gain: T,
}

impl<T: Number> RankOne<T> {
    /// Sherman and Morrison's update of a factored matrix.
    pub fn new(base: Factored<T>, vector: Vec<T>, strength: T) -> Self {
        let solved = base.solve(&vector);
        let gain = strength / (T::from(1.0) + strength * dot(&vector, &solved));
        RankOne { base, vector, solved, gain }
    }

    /// Solves for the right-hand side `b`.
    pub fn solve(&self, b: &[T]) -> Vec<T> {
        let mut x = self.base.solve(b);
        let amount = self.gain * dot(&self.vector, &x);
        for (value, &solved) in x.iter_mut().zip(&self.solved) {
            *value = *value - amount * solved;
        }
        x
    }
}

/// The value of a point of the string, from the unknowns.
pub(crate) fn read(at: &Reading, v: &[f64]) -> f64 {
    weights(at).map(|(i, weight)| weight * v[i]).sum()
}

/// The weights of a point that are not zero, with the unknowns they belong to.
pub(crate) fn weights(at: &Reading) -> impl Iterator<Item = (usize, f64)> + '_ {
    let present = at.weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
    present.map(|(i, &weight)| (at.first + i - 1, weight))
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: [f64; 3] = [0.65, 12.0, 1.0 / 48_000.0];
    const STIFFNESS: Stiffness = Stiffness { tension: 70.0, kappa_squared: 0.6, kappa_6: 3e-5 };
    const LINEAR_DENSITY: f64 = 1e-3;

    fn grid() -> Grid {
        Grid::new(GRID[0], GRID[1] as usize, GRID[2])
    }

    /// Sines are the modes of a string with free-turning ends, exactly so on a grid too.
    #[test]
    fn sines_are_eigenvectors() {
        let grid = grid();
        let matrix: Band<f64> = Band::of_string(&grid, LINEAR_DENSITY, &STIFFNESS);
        for partial in 1..grid.intervals {
            let angle = std::f64::consts::PI * partial as f64 / grid.intervals as f64;
            let mode: Vec<f64> = (1..grid.intervals).map(|node| (angle * node as f64).sin()).collect();
            let s = (2.0 * (0.5 * angle).sin() / grid.spacing).powi(2);
            let bending = LINEAR_DENSITY * s * s * (STIFFNESS.kappa_squared + s * STIFFNESS.kappa_6);
            let expected = grid.spacing * (STIFFNESS.tension * s + bending);
            for (found, u) in matrix.times(&mode).iter().zip(&mode) {
                assert!((found - expected * u).abs() < 1e-12 * expected, "partial {partial}");
            }
        }
    }

    /// Solving undoes multiplying, with springs and a rank-one part, real and complex.
    #[test]
    fn solutions_satisfy_their_system() {
        use nalgebra::Complex;
        let grid = grid();
        let mut matrix: Band<Complex<f64>> = Band::of_string(&grid, LINEAR_DENSITY, &STIFFNESS);
        matrix.add_spring(&grid.reading(0.02), Complex::from(1e6));
        matrix.add_spring(&grid.reading(0.31), Complex::new(2e3, 5e2));
        matrix.shift_from(0, Complex::from(-40.0));
        let vector: Vec<_> = (0..grid.unknowns()).map(|i| Complex::from(1.0 / (1.0 + i as f64))).collect();
        let right: Vec<_> = (0..grid.unknowns()).map(|i| Complex::new(i as f64, 1.0)).collect();
        let strength = Complex::from(300.0);
        let x = RankOne::new(matrix.clone().factor(), vector.clone(), strength).solve(&right);
        let along = strength * dot(&vector, &x);
        for ((product, v), b) in matrix.times(&x).iter().zip(&vector).zip(&right) {
            assert!((product + along * v - b).norm() < 1e-9);
        }
    }

    /// A spring at a point answers the point's displacement and nothing else.
    #[test]
    fn springs_act_where_they_are() {
        let grid = grid();
        let at = grid.reading(0.123);
        let u: Vec<f64> = (0..grid.unknowns()).map(|i| (i as f64).cos()).collect();
        let plain: Band<f64> = Band::of_string(&grid, LINEAR_DENSITY, &STIFFNESS);
        let mut sprung = plain.clone();
        sprung.add_spring(&at, 7.0);
        let force = 7.0 * read(&at, &u);
        let mut difference = sprung.times(&u);
        difference.iter_mut().zip(plain.times(&u)).for_each(|(a, b)| *a -= b);
        for (i, weight) in weights(&at) {
            difference[i] -= weight * force;
        }
        assert!(difference.iter().all(|left| left.abs() < 1e-9));
    }
}
