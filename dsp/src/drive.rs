//! What acts on one string in one sample.

use crate::field::Field;
use crate::grid::Reading;
use crate::model::Model;
use crate::roomy::Roomy;

/// How many plucks may push a string of an instrument at once.
pub const PUSHES: usize = 8;

/// A force on a point of the string.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Push {
    /// The point.
    pub reading: Reading,
    /// Force at n, N, up is positive.
    pub force: f64,
}

impl Push {
    /// What it puts into the string, W, by the string's motions before and after n, m, of so long a step, s.
    pub(crate) fn power(&self, before: &Field, after: &Field, time_step: f64) -> f64 {
        let motion = self.reading.of(after) + self.reading.of(before);
        self.force * motion / (2.0 * time_step)
    }
}

/// What a hand does to one finger in one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Hand {
    /// Place at n + 1, m from the nut.
    pub position: f64,
    /// Force at n, N, positive towards the board.
    pub force: f64,
}

/// Everything that acts on one string in step n, which leads from n to n + 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Tension at n, N, above 0 and no more than the model's `tension_limit`: beyond it the scheme is not stable.
    pub tension: f64,
    /// What a hand laid along the whole string adds to its loss σ₀ at n, 1/s: 0 or more, up to 1/k.
    pub loss: f64,
    /// Forces on points of the string.
    pub pushes: Roomy<Push>,
    /// The force of a bridge that gives way, where there is one. (What stands on the bridge gets what it takes from the string:
    /// the ledger books it apart from the pushes.)
    pub bridge: Option<Push>,
    /// What the hand does to the finger in each slot; ignored where there is no finger. A finger goes where its hand is in a
    /// single step.
    pub hands: Vec<Hand>,
    /// Heights of the fixed contacts at n + 1, m, in the model's order; empty while they rest.
    pub heights: Roomy<f64>,
}

impl Drive {
    /// Nothing acts; room for [`PUSHES`] pushes, and for moving every contact. Hands are at the nut, without force: whoever
    /// places a finger puts its hand over the same place.
    pub fn new(model: &Model) -> Drive {
        Drive {
            tension: model.string.tension,
            loss: 0.0,
            pushes: Roomy::with_capacity(PUSHES),
            bridge: None,
            hands: vec![Hand::default(); model.finger_slots],
            heights: Roomy::with_capacity(model.contacts.len()),
        }
    }
}
