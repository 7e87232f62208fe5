//! Rows of a field.

use crate::field::{LANES, Row};

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

/// The rows that precede the first one, nearest last: the last rows, each lane moved to the next. (The first lane gets
/// a number from elsewhere, at a point that nothing depends on.)
#[inline(always)]
pub(super) fn rows_before<const COUNT: usize>(field: &[f64]) -> [&Row; COUNT] {
    std::array::from_fn(|index| row_from(field, field.len() - LANES * (COUNT - index) - 1))
}

/// The rows that follow the last one: the first rows, each lane moved to the one before.
#[inline(always)]
pub(super) fn rows_after<const COUNT: usize>(field: &[f64]) -> [&Row; COUNT] {
    std::array::from_fn(|index| row_from(field, LANES * index + 1))
}

#[inline(always)]
fn row_from(field: &[f64], start: usize) -> &Row {
    const NOTHING: &Row = &[0.0; LANES];
    // (A field has more rows than these are apart.)
    field[start..].first_chunk().unwrap_or(NOTHING)
}
