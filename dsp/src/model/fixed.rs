//! Places where the string can touch something fixed.

use super::StringParameters;
use crate::close::Pressed;
use crate::contact::{Before, ContactLaw};
use crate::flexibility::Flexibility;
use crate::grid::{Grid, Reading};

/// A place where the string can touch something fixed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Where it is, m from the nut.
    pub place: f64,
    /// The point of the string.
    pub reading: Reading,
    /// The contact law.
    pub law: ContactLaw,
    /// Hunt–Crossley damping, s/m.
    pub damping: f64,
    /// Height of the barrier, m, when the model is made.
    pub height: f64,
    /// What waves too short for the grid take away from a contact that has just been made, N s/m; 0 for all but frets
    /// between grid points round which the string bends.
    pub radiation: f64,
    /// What it is.
    pub kind: ContactKind,
}

impl Contact {
    /// Whether it takes energy from what moves into it.
    #[inline(always)]
    pub(crate) fn resists(&self) -> bool {
        self.damping > 0.0 || self.radiation > 0.0
    }

    /// How much of a penetration, m, the contact itself is pressed in by: the rest, if any, is how far a string gives way round
    /// a kinked fret.
    pub fn pressed_in(&self, penetration: f64) -> f64 {
        if self.radiation > 0.0 { self.law.own_penetration(penetration) } else { penetration }
    }

    /// The force, N, of what the contact itself is pressed in at a penetration, m, on which its damping acts: where the string
    /// gives way round a kinked fret, no more than that of the knee.
    #[inline(always)]
    pub fn own_force(&self, penetration: f64) -> f64 {
        self.pressed(penetration).own_force
    }

    /// How deep it is in the string at a penetration, m.
    #[inline(always)]
    pub(crate) fn pressed(&self, penetration: f64) -> Pressed {
        if penetration <= 0.0 {
            return Pressed { depth: Before::apart(penetration), own_force: 0.0 };
        }
        let (depth, force) = Before::with_force(&self.law, penetration);
        Pressed {
            depth,
            own_force: if self.radiation > 0.0 { self.law.own_part(penetration, force) } else { force },
        }
    }

    /// For how many steps a contact that has just been made sends off waves that are too short for the grid, less and less:
    /// they are about as long as it takes to cross two or three spacings.
    pub const RADIATING: u64 = 5;

    /// The resistance, N s/m, of a contact that will radiate for so many steps more.
    #[inline(always)]
    pub fn radiating(&self, left: u64) -> f64 {
        left as f64 / Self::RADIATING as f64 * self.radiation
    }

    /// Lets the string bend round a fret as it does within a spacing of the grid: what makes it give way there is a spring
    /// between the two, and what the waves that are too short for the grid take away a resistance, while they do.
    pub(super) fn bend_round(&mut self, string: &StringParameters, grid: &Grid, flexibility: &Flexibility) {
        if !matches!(self.kind, ContactKind::Fret { .. }) {
            return;
        }
        let reading = grid.straight_reading(self.place);
        let residual = flexibility.residual(self.place, &reading);
        if residual > LACKING * grid.spacing / string.tension {
            self.reading = reading;
            self.law = self.law.giving_way(residual);
            self.radiation = 2.0 * (string.tension * string.linear_density).sqrt();
        }
    }
}

/// What a grid lacks is made up for where it is more than this part of h/T, the depth of the largest chord under a kink being
/// a quarter. So small a part lets a hundredth of the losses behind a fret remain, and less of it makes a spring too stiff for
/// the resistance beside it to keep a string from rattling.
const LACKING: f64 = 0.1;

/// What a fixed contact is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactKind {
    /// The board at a grid point.
    Board {
        /// Which grid point.
        node: usize,
    },
    /// A fret.
    Fret {
        /// Which fret, 0 for the first of the barrier's list.
        index: usize,
    },
}
