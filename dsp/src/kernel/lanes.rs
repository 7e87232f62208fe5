//! Rows of a field, and parts of them as wide as an instruction set's vectors.

use pulp::Simd;

use crate::field::LANES;

/// A row of a field, or [`LANES`] numbers anywhere in it.
pub(crate) type Row = [f64; LANES];

/// The rows of a field.
#[inline(always)]
pub(super) fn rows(field: &[f64]) -> &[Row] {
    field.as_chunks().0
}

/// The same to write to.
#[inline(always)]
pub(super) fn rows_mut(field: &mut [f64]) -> &mut [Row] {
    field.as_chunks_mut().0
}

/// Some lanes of a row: the `part`-th vector of an instruction set in it.
#[inline(always)]
pub(crate) fn part_of<S: Simd>(row: &Row, part: usize) -> S::f64s {
    S::as_simd_f64s(row).0[part]
}

/// Vectors in a row.
#[inline(always)]
pub(crate) fn vectors<S: Simd>() -> usize {
    LANES / S::F64_LANES
}

/// The rows that precede the first one, nearest last: the last rows, each lane moved to the next. (The first lane gets
/// a number from elsewhere, at a point that nothing depends on.)
#[inline(always)]
pub(super) fn rows_before<const COUNT: usize>(field: &[f64]) -> [Row; COUNT] {
    std::array::from_fn(|index| row_from(field, field.len() - LANES * (COUNT - index) - 1))
}

/// The rows that follow the last one: the first rows, each lane moved to the one before.
#[inline(always)]
pub(super) fn rows_after<const COUNT: usize>(field: &[f64]) -> [Row; COUNT] {
    std::array::from_fn(|index| row_from(field, LANES * index + 1))
}

#[inline(always)]
fn row_from(field: &[f64], start: usize) -> Row {
    let mut row = [0.0; LANES];
    row.copy_from_slice(&field[start..start + LANES]);
    row
}

#[inline(always)]
pub(super) fn add_product<S: Simd>(simd: S, sum: &mut S::f64s, a: S::f64s, b: S::f64s) {
    *sum = simd.add_f64s(*sum, simd.mul_f64s(a, b));
}
