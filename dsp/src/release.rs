//! How a string that was held, and fingers that were, begin to move.

use crate::drive::Drive;
use crate::model::Model;
use crate::state::State;
use crate::string::Scratch;

impl State {
    /// Lets go of a string held in its shape or thrown at a velocity, and of its fingers, at the moment of this sample: from
    /// what it is told acts on them, finds where they would have been a sample before.
    ///
    /// The velocity v at a sample is the mean of the motions that lead to it and from it. Were the string simply kv away from
    /// where it is a sample before, it would be released half a sample too early, and all that follows would be off by as much.
    /// A step d⁺ = decay·d + e from d = kv shows e, and d⁺ + d = 2kv makes d = (2kv − e)/(1 + decay), but for the part of it
    /// that `loss_1` damps in that step; likewise for a finger (`docs/physics.md`, section 6). Allocates.
    ///
    /// # Panics
    /// As [`State::step`].
    pub fn let_go(&mut self, model: &Model, drive: &Drive) {
        let thrown = self.motion.iter().any(|&motion| motion != 0.0);
        if thrown {
            self.come_from_outside(model);
            // How deep each contact was goes by where it was.
            self.look_at_all(model);
        }
        let mut after = self.clone();
        let mut scratch = Scratch::new(model);
        after.step(model, drive, &mut scratch);
        for node in 1..model.grid.intervals {
            let cell = model.grid.cell(node);
            self.motion[cell] = begun(self.motion[cell], after.motion[cell], scratch.coasting.decay);
        }
        for (finger, after) in self.fingers.iter_mut().zip(&after.fingers) {
            if let (Some(finger), Some(after)) = (finger, after) {
                finger.motion = begun(finger.motion, after.motion, finger.inertia.persistence);
            }
        }
        self.close_shape(model);
        if thrown {
            self.come_from_outside(model);
        }
        self.look_at_all(model);
    }

    /// A string that is thrown off board or frets was not inside them a sample before: they were as much lower then, and do not
    /// throw it once more.
    fn come_from_outside(&mut self, model: &Model) {
        for (index, contact) in model.contacts.iter().enumerate() {
            let now = contact.reading.of(&self.displacement);
            let past = now - contact.reading.of(&self.motion);
            let (height, overlap) = (self.heights[index], (self.heights[index] - now).max(0.0));
            self.heights_before[index] = height.min(past + overlap);
        }
        // Until the end of the next step.
        self.heights_rest_in = 1;
    }
}

/// The motion d with which what is `thrown`, m per step, begins: a step from there has led to the motion `after`, of which so
/// much is what `persists` of d that d⁺ = persists·d + e, and the mean of d and d⁺ is to be what it is thrown with.
fn begun(thrown: f64, after: f64, persists: f64) -> f64 {
    let e = after - persists * thrown;
    (2.0 * thrown - e) / (1.0 + persists)
}
