//! Which fixed contacts the string is near.
//!
//! Between two grid points the string lies no lower than the lower of them by more than an eighth of its largest
//! second difference v: cubic interpolation at a fraction p is the straight line less
//! p(1 − p)/6·((2 − p)vⱼ + (1 + p)vⱼ₊₁), and the factors come to 1/8 at most. So the grid points are held against a skyline, the
//! highest contact beside each, in one pass; contacts are looked at one by one only where that is near.

use std::ops::Range;

use crate::grid::{Grid, LANES, NUT, Reading};
use crate::model::Contact;

/// How much lower than its points the string may lie between them, as a part of its largest second difference.
pub(crate) const SAG: f64 = 0.125;

/// The contacts beside each group of grid points.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Blocks(Vec<Range<u32>>);

impl Blocks {
    /// Of contacts in order of place.
    pub fn new(grid: &Grid, contacts: &[Contact]) -> Self {
        if contacts.is_empty() {
            return Blocks::default();
        }
        let mut blocks = vec![u32::MAX..0; grid.unknowns().div_ceil(LANES)];
        for (index, contact) in (0..).zip(contacts) {
            let beside = beside(&contact.reading, grid).0;
            for block in &mut blocks[(beside.start - NUT - 1) / LANES..=(beside.end - NUT - 2) / LANES] {
                *block = block.start.min(index)..index + 1;
            }
        }
        Blocks(blocks)
    }

    /// The contacts beside a group of grid points, and others between them.
    #[inline(always)]
    pub fn of(&self, group: u32) -> Range<u32> {
        self.0[group as usize].clone()
    }
}

/// Array indices of the unknowns beside a contact, and whether it must always be looked at: at the ends the string
/// is continued to points that are not there.
fn beside(reading: &Reading, grid: &Grid) -> (Range<usize>, bool) {
    let (start, end) = reading.span();
    if end - start == 1 {
        return (start..end, false);
    }
    let at_an_end = reading.first == NUT || reading.first + 3 >= NUT + grid.intervals;
    (reading.first + 1..reading.first + 3, at_an_end)
}

/// Puts the height of the highest contact beside each grid point into `skyline`.
pub(crate) fn draw(grid: &Grid, contacts: &[Contact], heights: &[f64], skyline: &mut [f64]) {
    skyline.fill(f64::NEG_INFINITY);
    for (contact, &height) in contacts.iter().zip(heights) {
        let (beside, always) = beside(&contact.reading, grid);
        let height = if always { f64::INFINITY } else { height };
        for top in &mut skyline[beside] {
            *top = top.max(height);
        }
    }
}

/// The lowest of a group of grid points and those beside it, m.
#[inline(always)]
pub(crate) fn lowest(displacement: &[f64], group: u32) -> f64 {
    let start = NUT + group as usize * LANES;
    displacement[start..start + LANES + 2].iter().fold(f64::INFINITY, |low, &u| low.min(u))
}
