//! One step of a string that may touch something: find the contacts, solve for their forces, advance, and look
//! whether the string was driven into others.

use crate::active::Active;
use crate::drive::Drive;
use crate::field::Field;
use crate::instructions::Vectors;
use crate::kernel::{Moved, Stretching};
use crate::model::{Coasting, Model};
use crate::solver::{Convergence, EnergyScale};
use crate::state::State;
use crate::string::Scratch;

/// Where rounding of the forces moves the string so much that the energy is off by more than this part of the
/// largest, the string as it came out is solved for again.
const ROUNDING: f64 = 1e-15;

/// How often that is repeated at most.
const REFINEMENTS: usize = 3;

/// Inexact solutions may put in at most this part of the largest energy, all together.
const CREATED_AT_MOST: f64 = 1e-12;

impl State {
    /// The part of a step that follows the prediction.
    #[inline(always)]
    pub(crate) fn contact_step<V: Vectors>(
        &mut self,
        simd: V,
        model: &Model,
        drive: &Drive,
        predicted: Stretching,
        scratch: &mut Scratch,
    ) -> Convergence {
        let mut convergence = Convergence::default();
        let free = self.would_stretch(&predicted);
        let free_pull = scratch.pull(free);
        self.touch(model, free_pull, scratch);
        let mut created = 0.0;
        for attempt in 0.. {
            let mut moved = Moved::default();
            scratch.tried = 0.0;
            if scratch.active.is_empty() {
                moved = self.advance::<V, true>(simd, free, scratch);
            } else {
                // M's rank-one term: mobility·G/(1 + G vᵀv) z zᵀ.
                let Coasting { mobility, stretch, .. } = scratch.coasting;
                let factor = mobility * stretch * predicted.yielding;
                let scale = self.energy_scale(scratch);
                let mut predicted = predicted;
                let mut stretching = 0.0;
                for round in 0.. {
                    created = scratch.solver.solve(
                        scratch.instructions,
                        &mut scratch.active,
                        factor,
                        &model.settings,
                        scale,
                        &mut convergence,
                    );
                    let spread = spread(mobility, &mut scratch.active, &mut scratch.motion);
                    predicted.along += spread.along;
                    scratch.tried += spread.sum;
                    let more = self.would_stretch(&predicted);
                    stretching += more;
                    moved = self.advance::<V, true>(simd, more, scratch);
                    // (It knows of what is added in this round.)
                    scratch.stretching = stretching;
                    let rounding = f64::EPSILON * mobility * spread.sum * spread.sum;
                    let exact = rounding <= ROUNDING * self.energy_scale && created <= scale.credit;
                    if exact || round == REFINEMENTS {
                        break;
                    }
                    // What q̄ still lacks: half of q − vᵀu⁺, less what it is already.
                    predicted.along = self.recentre(scratch) + 2.0 * stretching;
                }
            }
            if !self.find_missed(simd, model, &moved, attempt > 0, scratch) {
                break;
            }
            // Something was driven into a contact that was not in the solution: take the forces back
            // and solve again with it.
            convergence.repeats += 1;
            self.look_back(model);
            self.predict(simd, drive, scratch);
            self.begin_again(model, free_pull, scratch);
        }
        convergence.active = scratch.active.len() as u32;
        self.solver_balance = (self.solver_balance + created).max(0.0);
        self.finish(model, scratch);
        convergence
    }

    /// Makes the string as the solution has left it the new starting point, from which only corrections to the forces are solved
    /// for. The forces found so far and the pull of the stretched string may each have moved it much farther than both together, and
    /// what rounding lost in that difference is so left behind: only the corrections are rounded from here on. Returns vᵀu⁺ of the
    /// new starting point.
    #[cold]
    fn recentre(&self, scratch: &mut Scratch) -> f64 {
        for active in scratch.active.iter_mut() {
            active.base = active.force;
            let moved = active.sign * active.reading.of(&scratch.motion);
            active.centre = -(moved + active.rest + active.own_mobility * active.base);
        }
        self.curvature.iter().zip(&*scratch.displacement).map(|(v, u)| v * u).sum()
    }

    /// Starts from no forces again, with the contacts that were missed.
    #[cold]
    fn begin_again(&mut self, model: &Model, free_pull: f64, scratch: &mut Scratch) {
        for active in scratch.active.iter_mut() {
            active.base = 0.0;
        }
        self.show(free_pull, scratch);
        self.add_missed(model, free_pull, scratch);
    }

    /// The energy against which this sample's errors are judged: of the string as a linear one, of the
    /// contacts, of the fingers.
    #[inline(always)]
    fn energy_scale(&mut self, scratch: &Scratch) -> EnergyScale {
        let contacts: f64 = scratch.active.iter().map(|active| active.before.energy).sum();
        let present = scratch.string_energy() + contacts + scratch.finger_energy;
        self.energy_scale = self.energy_scale.max(present);
        let credit = CREATED_AT_MOST * self.energy_scale - self.solver_balance;
        EnergyScale { present, credit }
    }

    /// Moves fingers by their forces, and keeps heights for the next step.
    #[inline(always)]
    fn finish(&mut self, model: &Model, scratch: &mut Scratch) {
        scratch.solver.aside.clear();
        let contacts = model.contacts.len();
        for active in scratch.active.iter() {
            if let Some(slot) = active.slot.checked_sub(contacts)
                && let (Some(finger), Some(old)) = (&mut self.fingers[slot], &scratch.fingers[slot])
            {
                finger.motion += active.own_mobility * active.force;
                finger.height = old.height + finger.motion;
            }
        }
        if self.heights_rest_in > 0 {
            self.heights_rest_in -= 1;
            self.heights_before.copy_from_slice(&self.heights);
            self.heights.copy_from_slice(&self.heights_next);
        }
    }
}

/// What forces beyond the base do to the string.
struct Spread {
    /// What they add to vᵀw, m².
    along: f64,
    /// Sum of their sizes, N.
    sum: f64,
}

/// Adds the forces beyond the base to a prediction.
#[inline(always)]
fn spread(mobility: f64, contacts: &mut [Active], prediction: &mut Field) -> Spread {
    let mut done = Spread { along: 0.0, sum: 0.0 };
    for contact in contacts {
        let force = contact.force - contact.base;
        contact.reading.spread(prediction, mobility * contact.sign * force);
        done.along += mobility * force * contact.pull;
        done.sum += force.abs();
    }
    done
}
