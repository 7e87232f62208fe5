//! What has happened to a string since somebody last looked: for pictures, which are drawn far less often than
//! strings are stepped. While nobody looks nothing is kept, and looking never alters what is looked at.

use crate::gesture::Gesture;
use crate::model::Model;
use crate::solver::Convergence;
use crate::state::State;
use crate::string::Scratch;

/// A pluck that was begun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plucked {
    /// Where it was asked for, m from the nut.
    pub position: f64,
    /// Its largest force, N, up is positive.
    pub force: f64,
}

/// What has happened to one string since somebody last looked.
#[derive(Debug, Clone)]
pub struct Observed {
    looking: bool,
    /// Lowest displacement of the interior points, m, seen some thousand times a second.
    pub lowest: Vec<f64>,
    /// Highest displacement of the interior points, m.
    pub highest: Vec<f64>,
    /// Largest force of each contact, N: in the model's order, then of the fingers by slot.
    pub forces: Vec<f64>,
    /// Steps taken.
    pub steps: u64,
    /// Newton iterations in all of them.
    pub iterations: u64,
    /// The last pluck begun.
    pub pluck: Option<Plucked>,
}

impl Observed {
    /// Room for a model's points and contacts; nobody looks yet.
    pub(crate) fn new(model: &Model) -> Self {
        let points = model.grid.unknowns();
        Observed {
            looking: false,
            lowest: vec![0.0; points],
            highest: vec![0.0; points],
            forces: vec![0.0; model.contacts.len() + model.finger_slots],
            steps: 0,
            iterations: 0,
            pluck: None,
        }
    }

    /// Somebody looks from now on, or nobody does.
    pub(crate) fn look(&mut self, looking: bool, state: &State) {
        if looking && !self.looking {
            self.begin_anew(state);
        }
        self.looking = looking;
    }

    /// Whether somebody looks.
    pub(crate) fn is_looking(&self) -> bool {
        self.looking
    }

    /// Forgets what has been looked at.
    pub(crate) fn begin_anew(&mut self, state: &State) {
        for ((lowest, highest), now) in
            self.lowest.iter_mut().zip(&mut self.highest).zip(state.displacement())
        {
            (*lowest, *highest) = (now, now);
        }
        self.forces.fill(0.0);
        (self.steps, self.iterations, self.pluck) = (0, 0, None);
    }

    /// A gesture has begun.
    pub(crate) fn see_gesture(&mut self, gesture: &Gesture) {
        if let Gesture::Pluck { position, force, .. } = *gesture
            && self.looking
        {
            self.pluck = Some(Plucked { position, force });
        }
    }

    /// A step was taken.
    #[inline]
    pub(crate) fn see_step(&mut self, convergence: &Convergence, scratch: &Scratch) {
        if !self.looking {
            return;
        }
        self.steps += 1;
        self.iterations += u64::from(convergence.iterations);
        for (index, force) in scratch.forces() {
            self.forces[index] = self.forces[index].max(force);
        }
    }

    /// The string has moved on for a while.
    pub(crate) fn see_shape(&mut self, state: &State) {
        if !self.looking {
            return;
        }
        for ((lowest, highest), now) in
            self.lowest.iter_mut().zip(&mut self.highest).zip(state.displacement())
        {
            *lowest = lowest.min(now);
            *highest = highest.max(now);
        }
    }
}
