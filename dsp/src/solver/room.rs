//! Room for one solution.

/// The arrays of one solution, each with a number for each contact.
pub(super) struct Room<'a> {
    pub residual: &'a mut [f64],
    pub step: &'a mut [f64],
    pub motion: &'a mut [f64],
    pub slopes: &'a mut [f64],
    pub unknown: &'a mut [f64],
    pub start: &'a mut [f64],
    /// Forces beyond the base.
    pub forces: &'a mut [f64],
}

/// Arrays of a [`Room`].
pub(super) const ARRAYS: usize = 7;

impl<'a> Room<'a> {
    #[inline(always)]
    pub fn new(numbers: &'a mut [f64], count: usize) -> Self {
        let (residual, rest) = numbers.split_at_mut(count);
        let (step, rest) = rest.split_at_mut(count);
        let (motion, rest) = rest.split_at_mut(count);
        let (slopes, rest) = rest.split_at_mut(count);
        let (unknown, rest) = rest.split_at_mut(count);
        let (start, rest) = rest.split_at_mut(count);
        let (forces, _) = rest.split_at_mut(count);
        Room { residual, step, motion, slopes, unknown, start, forces }
    }
}
