//! Which fixed contacts the string is near.
//!
//! A contact that is asleep stands under a piece of the skyline: a line between the two grid points beside it that passes
//! through its top. As long as both points are over that line, so is the straight line between them over the contact, and
//! the string is no lower than that but for what it [sags](Sag).
//!
//! Each piece is as steep as the string was when its contact fell asleep, so that a string that is bent there, or runs at a slant
//! over it, is as far over the piece as over the contact.

use std::ops::Range;

use crate::field::{Field, cell_count};
use crate::grid::Grid;
use crate::model::Contact;

/// Which contacts are beside which points of a grid.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Beside {
    /// The contacts beside each point, by its cell of a field.
    contacts: Vec<Range<u32>>,
    places: Vec<Place>,
    /// How much lower than the straight line the string may lie at any contact that may sleep.
    pub sag: Sag,
}

/// How much lower than the straight line between two points the string may lie: cubic interpolation at a fraction p is that line less
/// p(1 − p)/6·((2 − p)vⱼ + (1 + p)vⱼ₊₁), v the second differences. Each sum of products is no larger than the product of the roots of
/// both sums of squares.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Sag {
    /// As a part of √(vᵀv) of the string.
    pub bend: f64,
    /// As a part of √|δu|², of its differences.
    pub slope: f64,
    /// As a part of √(dᵀd), of how far its points move.
    pub motion: f64,
}

/// Where a contact is on the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    /// The cells of the points beside it, twice the same where it is at one.
    cells: [u32; 2],
    /// How far from the first to the second it is, from 0 to 1.
    part: f64,
    /// Whether the string goes on to an end there, which is no point that moves.
    at_end: bool,
}

/// The straight line of a string between the points beside a contact.
pub(crate) struct Line {
    /// Its height over the contact's place, m.
    pub displacement: f64,
    /// How much higher the second point is than the first, m.
    pub rise: f64,
}

impl Beside {
    /// Of contacts in order of place.
    pub fn new(grid: &Grid, contacts: &[Contact]) -> Self {
        let mut beside = Beside {
            contacts: vec![0..0; cell_count(grid.intervals)],
            places: contacts.iter().map(|contact| Place::new(contact, grid)).collect(),
            sag: Sag::default(),
        };
        for (index, (place, contact)) in (0..).zip(beside.places.iter().zip(contacts)) {
            for cell in place.cells {
                let range = &mut beside.contacts[cell as usize];
                let start = if range.start == range.end { index } else { range.start };
                *range = start..index + 1;
            }
            if contact.reading.is_curved() && !place.at_end {
                beside.sag = beside.sag.max(&Sag::at(place.part));
            }
        }
        beside
    }

    /// The contacts beside a point.
    pub fn contacts(&self, cell: usize) -> Range<usize> {
        let Range { start, end } = self.contacts[cell];
        start as usize..end as usize
    }

    /// The points beside a contact.
    pub fn cells(&self, index: usize) -> [usize; 2] {
        self.places[index].cells.map(|cell| cell as usize)
    }

    /// Whether a contact may fall asleep: not where the string goes on to an end, of which the skyline knows nothing.
    pub fn may_sleep(&self, index: usize) -> bool {
        !self.places[index].at_end
    }

    /// The straight line of a string at a contact.
    pub fn line(&self, index: usize, u: &Field) -> Line {
        let [first, second] = self.cells(index).map(|cell| u[cell]);
        let rise = second - first;
        Line { displacement: first + self.places[index].part * rise, rise }
    }

    /// How high the piece of a contact of a height is at a point beside it, m, if it rises so much.
    pub fn piece(&self, index: usize, cell: usize, height: f64, rise: f64) -> f64 {
        let Place { cells, part, .. } = self.places[index];
        let away = if cell == cells[0] as usize { -part } else { 1.0 - part };
        height + away * rise
    }

    /// Puts the highest piece at a point into a skyline, of contacts at these heights; `asleep` says how much the piece of each that
    /// is asleep rises.
    pub fn draw(&self, cell: usize, heights: &[f64], asleep: &[Option<f64>], skyline: &mut Field) {
        let tops = self
            .contacts(cell)
            .filter_map(|index| asleep[index].map(|rise| self.piece(index, cell, heights[index], rise)));
        skyline[cell] = tops.fold(f64::NEG_INFINITY, f64::max);
    }

    /// The same at every point.
    pub fn draw_all(&self, heights: &[f64], asleep: &[Option<f64>], skyline: &mut Field) {
        for cell in 0..self.contacts.len() {
            self.draw(cell, heights, asleep, skyline);
        }
    }
}

impl Sag {
    /// At a fraction of a spacing.
    pub fn at(part: f64) -> Self {
        let (a, b) = (2.0 - part, 1.0 + part);
        let norm = |weights: &[f64]| weights.iter().map(|weight| weight * weight).sum::<f64>().sqrt();
        let share = part * (1.0 - part) / 6.0;
        Sag {
            bend: share * norm(&[a, b]),
            slope: share * norm(&[a, b - a, b]),
            motion: share * norm(&[a, b - 2.0 * a, a - 2.0 * b, b]),
        }
    }

    /// The most of each.
    fn max(&self, other: &Self) -> Self {
        Sag {
            bend: self.bend.max(other.bend),
            slope: self.slope.max(other.slope),
            motion: self.motion.max(other.motion),
        }
    }
}

impl Place {
    fn new(contact: &Contact, grid: &Grid) -> Self {
        let place = |nodes: [usize; 2], part, at_end| Place {
            cells: nodes.map(|node| grid.cell(node) as u32),
            part,
            at_end,
        };
        // (Within the first or last spacing a straight reading has one weight, too, and the end of the string for the other.)
        if contact.reading.weights.contains(&1.0) {
            return place([contact.reading.span().0; 2], 0.0, false);
        }
        let spacings = contact.place / grid.spacing;
        let cell = grid.interval(spacings);
        let at_end = cell == 0 || cell + 1 == grid.intervals;
        place([cell.max(1), (cell + 1).min(grid.intervals - 1)], spacings - cell as f64, at_end)
    }
}

#[cfg(test)]
mod tests;
