//! Which fixed contacts the string is near.
//!
//! Between two grid points the string lies no lower than the lower of them by more than an eighth of its largest
//! second difference v: cubic interpolation at a fraction p is the straight line less
//! p(1 − p)/6·((2 − p)vⱼ + (1 + p)vⱼ₊₁), and the factors come to 1/8 at most. So the grid points are held against a skyline, the
//! highest contact beside each, in one pass; contacts are looked at one by one only where that is near.

use std::ops::Range;

use crate::field::{BEFORE, Field, LANES, row_count};
use crate::grid::Grid;
use crate::model::Contact;

/// Neighbouring grid points that are held against the skyline as one.
pub(crate) const CLEARED: usize = 8;

/// What is known of [`CLEARED`] neighbouring points in each lane of a field.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Clearance {
    /// How far the one nearest to the skyline is over it, m.
    pub over: [f64; LANES],
    /// The lowest displacement, m.
    pub lowest: [f64; LANES],
}

/// Groups of neighbouring points in each lane of a field.
pub(crate) fn groups(grid: &Grid) -> usize {
    row_count(grid.intervals).div_ceil(CLEARED)
}

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
        let (rows, groups) = (row_count(grid.intervals), groups(grid));
        let group = |node: usize| (BEFORE + node) / rows * groups + (BEFORE + node) % rows / CLEARED;
        let mut ranges = vec![nothing; LANES * groups];
        for (index, contact) in contacts.iter().enumerate() {
            let beside = beside(contact, grid).0;
            for range in &mut ranges[group(beside.start)..=group(beside.end - 1)] {
                *range = range.start.min(index)..index + 1;
            }
        }
        Blocks(ranges)
    }

    /// Looks at the contacts, each once and in order, at which a string can lie no more than `margin`, m, over what is
    /// beside it.
    #[inline(always)]
    pub fn look(&self, margin: f64, clearances: &[Clearance], heights: &[f64], mut found: impl FnMut(usize)) {
        let mut least = [f64::INFINITY; LANES];
        for clearance in clearances {
            for (least, over) in least.iter_mut().zip(&clearance.over) {
                *least = if *over < *least { *over } else { *least };
            }
        }
        let mut next = 0;
        for (lane, ranges) in self.0.chunks_exact(clearances.len().max(1)).enumerate() {
            if least[lane] > margin {
                continue;
            }
            for (group, (range, clearance)) in ranges.iter().zip(clearances).enumerate() {
                if clearance.over[lane] > margin || range.end <= next {
                    continue;
                }
                // A contact between two groups may be nearer to the other.
                let floor = clearance.lowest[lane].min(beside_group(clearances, lane, group)) - margin;
                let start = range.start.max(next);
                for (index, &height) in (start..).zip(&heights[start..range.end]) {
                    let below = height < floor;
                    if !below {
                        found(index);
                    }
                }
                next = range.end;
            }
        }
    }
}

/// The lowest displacement in the groups before and after one, m.
#[inline(always)]
fn beside_group(clearances: &[Clearance], lane: usize, group: usize) -> f64 {
    let last = clearances.len() - 1;
    let before = match (lane, group) {
        (0, 0) => f64::INFINITY,
        (_, 0) => clearances[last].lowest[lane - 1],
        _ => clearances[group - 1].lowest[lane],
    };
    let after = match clearances.get(group + 1) {
        Some(next) => next.lowest[lane],
        None if lane + 1 < LANES => clearances[0].lowest[lane + 1],
        None => f64::INFINITY,
    };
    before.min(after)
}

/// The unknown nodes beside a contact, and whether it must always be looked at: there the string goes on to
/// an end, which is no unknown.
fn beside(contact: &Contact, grid: &Grid) -> (Range<usize>, bool) {
    // (Within the first or last spacing a straight reading has one weight, too, and the end of the string for the other.)
    if contact.reading.weights.contains(&1.0) {
        let (start, end) = contact.reading.span();
        return (start..end, false);
    }
    let cell = grid.interval(contact.place / grid.spacing);
    let (first, last) = (cell.max(1), (cell + 1).min(grid.intervals - 1));
    (first..last + 1, cell == 0 || cell + 1 == grid.intervals)
}

/// Puts the height of the highest contact beside each grid point into `skyline`.
pub(crate) fn draw(grid: &Grid, contacts: &[Contact], heights: &[f64], skyline: &mut Field) {
    skyline.fill(f64::NEG_INFINITY);
    for (contact, &height) in contacts.iter().zip(heights) {
        let (beside, always) = beside(contact, grid);
        let height = if always { f64::INFINITY } else { height };
        for node in beside {
            let top = &mut skyline[grid.cell(node)];
            *top = top.max(height);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactLaw;
    use crate::grid::Reading;
    use crate::model::ContactKind;

    /// Numbers from −1 to 1 that look random (the constants of Knuth's MMIX generator).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Contacts anywhere, on grid points and within the first and last spacing too, read by curves and by straight lines, in
    /// order of place.
    fn contacts(grid: &Grid, seed: &mut u64) -> Vec<Contact> {
        let mut contacts: Vec<_> = (0..30)
            .map(|index| {
                let place = 0.5 * (1.0 + random(seed));
                let node = ((place * grid.intervals as f64) as usize).clamp(1, grid.intervals - 1);
                let reading = match index % 3 {
                    0 => Reading::at_node(grid, node),
                    1 => grid.reading(place),
                    _ => grid.straight_reading(place),
                };
                let law = ContactLaw::known(1e10, 1.5);
                let kind = ContactKind::Fret { index };
                Contact {
                    place,
                    reading,
                    law,
                    damping: 0.0,
                    radiation: 0.0,
                    height: 0.5 * random(seed),
                    kind,
                }
            })
            .collect();
        contacts.sort_by(|a, b| a.place.total_cmp(&b.place));
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
            let mut skyline = Field::new(&grid);
            draw(&grid, &contacts, &heights, &mut skyline);
            // From smooth to as rough as can be.
            let roughness = 0.5 * (1.0 + random(&mut seed));
            let mut u = Field::new(&grid);
            for node in 1..grid.intervals {
                let smooth = (6.0 * grid.place(node)).sin();
                u[grid.cell(node)] = (1.0 - roughness) * smooth + roughness * random(&mut seed);
            }
            let point = |node: usize| u[grid.cell(node)];
            let bends = (1..grid.intervals)
                .map(|node| ((point(node + 1) - point(node)) - (point(node) - point(node - 1))).abs());
            let margin = 0.1 + SAG * bends.fold(0.0, f64::max);
            let over: Vec<f64> = u.iter().zip(&*skyline).map(|(u, top)| u - top).collect();
            let least = |field: &[f64], group: usize, lane: usize| {
                let rows = field.chunks(LANES).skip(group * CLEARED).take(CLEARED);
                rows.map(|row| row[lane]).fold(f64::INFINITY, f64::min)
            };
            let clearances: Vec<Clearance> = (0..groups(&grid))
                .map(|group| Clearance {
                    over: std::array::from_fn(|lane| least(&over, group, lane)),
                    lowest: std::array::from_fn(|lane| least(&u, group, lane)),
                })
                .collect();
            let mut looked_at = Vec::new();
            blocks.look(margin, &clearances, &heights, |index| looked_at.push(index));
            assert!(looked_at.is_sorted_by(|a, b| a < b), "run {run}: {looked_at:?}");
            for (index, contact) in contacts.iter().enumerate() {
                if contact.reading.of(&u) - contact.height <= 0.1 {
                    found += 1;
                    assert!(looked_at.contains(&index), "run {run}: {contact:?}");
                }
            }
        }
        // Clearances are drawn evenly, so that many contacts are that near: it is not a test of nothing.
        assert!(found > 10_000);
    }
}
