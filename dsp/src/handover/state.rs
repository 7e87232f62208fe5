//! A string's motion that goes over to another model.
//!
//! A string that is pressed has kinks, at fingers, frets and where it is plucked, and no reading between grid points finds those: what
//! it misses of one is a force there, as large as a part of what presses, that lets go at that moment. So what presses is taken off
//! before: its [static deflection](Deflection) on the old grid. What is left, K⁻¹ times the forces of inertia, is smooth, and is read.
//! The deflection on the new grid under the same forces is put back. Then all that pulled the string before pulls it now: a string
//! at rest is at rest on any grid.

use crate::deflection::Deflection;
use crate::model::Model;
use crate::state::State;

/// A string that takes over, or from which it does, with what presses both.
pub(crate) struct Side<'a> {
    pub model: &'a Model,
    pub deflection: &'a mut Deflection,
}

/// How the new string differs from the old one.
#[derive(Clone, Copy)]
pub(super) struct Change {
    /// Whether it has the same grid.
    pub same_grid: bool,
    /// The part of the forces of its contacts that presses it.
    pub force: f64,
}

/// What stretching adds to the tension and the deflection depend on each other: they are found in turn, so often at most. Each gains
/// the digits that it has of the difference between two grids, which is small.
const MOST_TURNS: usize = 3;

/// And until the tension is known so well, as a part of itself.
const SAME_TENSION: f64 = 1e-9;

impl State {
    /// Takes over the motion of a string on another model, and the fingers on it; one whose pad is too
    /// stiff for this model is left out. What moved in a step of the old model moves its share of that in
    /// a step of this one. What else presses both strings than contacts and fingers, if anything does, is in their deflections.
    ///
    /// The old string had a tension, N, and `begins_at` says with how much of one that is asked for the new one can begin, where
    /// stretching adds so much to it. Gives back with how much it does: with what leaves all that pulls it, that of stretching
    /// included, as it was.
    pub(crate) fn take_over(
        &mut self,
        new: &mut Side,
        old: &State,
        before: &mut Side,
        tension: f64,
        begins_at: impl Fn(f64, f64) -> f64,
    ) -> f64 {
        let [stretching, own] =
            [before.model, new.model].map(|model| old.stretch_tension(before.model, model));
        let pulls = |own: f64| begins_at(tension + (stretching - own), own);
        let (asked, begins) = (tension + (stretching - own), pulls(own));
        // Under so much of the forces it has the same shape at that tension.
        let part = if begins == asked { 1.0 } else { (begins + own) / (asked + own) };
        let change = Change {
            same_grid: new.model.grid == before.model.grid,
            force: if part.is_finite() { part } else { 1.0 },
        };
        self.finger_changes = old.finger_changes;
        self.steps = old.steps;
        self.solver_balance = old.solver_balance;
        self.energy_scale = old.energy_scale;
        self.take_contacts(new, old, before, change);
        self.take_fingers(new, old, before, change);
        before.deflection.find(before.model, tension, stretching);
        self.read(new, old, before, change.same_grid);
        let tension = self.deflect(new, pulls);
        self.close_shape(new.model);
        if change.same_grid {
            // (Steps sum it in another order: the last digit of it goes on, too.)
            self.squares = old.squares;
        }
        self.carry_fingers(new.model, old, before.model, change);
        self.raise_contacts(new.model);
        self.look_at_all(new.model);
        tension
    }

    /// Reads displacement and motion, and what of the displacement is deflection.
    fn read(&mut self, new: &mut Side, old: &State, before: &Side, same_grid: bool) {
        if same_grid {
            self.displacement.copy_from_slice(&old.displacement);
            self.motion.copy_from_slice(&old.motion);
            new.deflection.contained.copy_from_slice(&before.deflection.found);
            return;
        }
        let (grid, old_grid) = (&new.model.grid, &before.model.grid);
        let scale = grid.length / old_grid.length;
        let share = grid.time_step / old_grid.time_step;
        self.displacement.fill(0.0);
        self.motion.fill(0.0);
        for node in 1..grid.intervals {
            let reading = old_grid.reading(grid.place(node) / scale);
            self.displacement[grid.cell(node)] = reading.of(&old.displacement);
            self.motion[grid.cell(node)] = share * reading.of(&old.motion);
            new.deflection.contained[node - 1] = before.deflection.at(&reading);
        }
    }

    /// Puts this string's own deflection in the place of the one that is contained in its displacement. Gives back the tension, N,
    /// that it has where stretching adds so much to it, by `pulls`.
    fn deflect(&mut self, new: &mut Side, pulls: impl Fn(f64) -> f64) -> f64 {
        let Side { model, deflection } = new;
        self.look_back(model);
        let mut stretching = self.stretch_tension(model, model);
        for _ in 0..MOST_TURNS {
            let tension = pulls(stretching);
            if !deflection.find(model, tension, stretching) {
                break;
            }
            for node in 1..model.grid.intervals {
                self.displacement[model.grid.cell(node)] += deflection.renew(node - 1);
            }
            let before = stretching;
            self.look_back(model);
            stretching = self.stretch_tension(model, model);
            if (stretching - before).abs() <= SAME_TENSION * tension {
                break;
            }
        }
        pulls(stretching)
    }

    /// What its stretching between the last two samples, on the grid of one model, adds to the tension under another, N. (A motion
    /// of a wave's height in a step could make that negative, which no string that rests has.)
    fn stretch_tension(&self, on: &Model, under: &Model) -> f64 {
        under.string.stretch_tension(self.stretch(on).max(0.0), on.grid.spacing)
    }
}
