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
pub(crate) struct Blocks(Vec<Range<usize>>);

impl Blocks {
    /// Of contacts in order of place.
    pub fn new(grid: &Grid, contacts: &[Contact]) -> Self {
        if contacts.is_empty() {
            return Blocks::default();
        }
        let nothing = Range { start: usize::MAX, end: 0 };
        let mut blocks = vec![nothing; grid.unknowns().div_ceil(LANES)];
        for (index, contact) in contacts.iter().enumerate() {
            let beside = beside(&contact.reading, grid).0;
            for block in &mut blocks[(beside.start - NUT - 1) / LANES..=(beside.end - NUT - 2) / LANES] {
                *block = block.start.min(index)..index + 1;
            }
        }
        Blocks(blocks)
    }

    /// The contacts beside a group of grid points, and others between them.
    #[inline(always)]
    pub fn of(&self, group: usize) -> Range<usize> {
        self.0[group].clone()
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
pub(crate) fn lowest(displacement: &[f64], group: usize) -> f64 {
    let start = NUT + group * LANES;
    displacement[start..start + LANES + 2].iter().fold(f64::INFINITY, |low, &u| low.min(u))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactLaw;
    use crate::model::ContactKind;

    /// Numbers from −1 to 1 that look random (the constants of Knuth's MMIX generator).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Contacts anywhere, on grid points and within the first and last spacing too, in order of place.
    fn contacts(grid: &Grid, seed: &mut u64) -> Vec<Contact> {
        let mut contacts: Vec<_> = (0..30)
            .map(|index| {
                let place = 0.5 * (1.0 + random(seed));
                let node = ((place * grid.intervals as f64) as usize).clamp(1, grid.intervals - 1);
                let reading = if index % 3 == 0 { Reading::at_node(grid, node) } else { grid.reading(place) };
                let law = ContactLaw::known(1e10, 1.5);
                let kind = ContactKind::Fret { index };
                Contact { reading, law, height: 0.5 * random(seed), kind }
            })
            .collect();
        contacts.sort_by(|a, b| a.reading.centre().total_cmp(&b.reading.centre()));
        contacts
    }

    #[test]
    fn every_contact_that_is_near_is_found() {
        let mut seed = 1;
        let mut found = 0;
        for run in 0..3000 {
            let grid = Grid::new(1.0, 4 + run % 40, 1e-5);
            let contacts = contacts(&grid, &mut seed);
            let heights: Vec<f64> = contacts.iter().map(|contact| contact.height).collect();
            let blocks = Blocks::new(&grid, &contacts);
            let mut skyline = vec![0.0; grid.padded_len()];
            draw(&grid, &contacts, &heights, &mut skyline);
            // From smooth to as rough as can be.
            let roughness = 0.5 * (1.0 + random(&mut seed));
            let mut u = vec![0.0; grid.padded_len()];
            for node in 1..grid.intervals {
                let smooth = (6.0 * grid.place(node)).sin();
                u[NUT + node] = (1.0 - roughness) * smooth + roughness * random(&mut seed);
            }
            let bends = (1..grid.intervals).map(|node| {
                let at = NUT + node;
                ((u[at + 1] - u[at]) - (u[at] - u[at - 1])).abs()
            });
            let margin = 0.1 + SAG * bends.fold(0.0, f64::max);
            let groups = (0..grid.unknowns().div_ceil(LANES)).filter(|&group| {
                let first = NUT + 1 + group * LANES;
                (first..first + LANES).any(|at| u[at] - skyline[at] <= margin)
            });
            let looked_at: Vec<usize> = groups
                .flat_map(|group| {
                    let floor = lowest(&u, group) - margin;
                    blocks.of(group).filter(|&index| heights[index] >= floor).collect::<Vec<_>>()
                })
                .collect();
            for (index, contact) in contacts.iter().enumerate() {
                if contact.reading.of(&u) - contact.height <= 0.1 {
                    found += 1;
                    assert!(looked_at.contains(&index), "run {run}: {contact:?}");
                }
            }
        }
        assert!(found > 10_000);
    }
}
