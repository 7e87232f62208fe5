//! How a string that was held, and fingers that were, begin to move.

use crate::drive::Drive;
use crate::model::Model;
use crate::state::State;
use crate::string::Scratch;

impl State {
    /// Lets go of a string held at rest in its shape, and of its fingers, at the moment of this sample: from what it is told
    /// acts on them, finds where they would have been a sample before.
    ///
    /// The velocity at a sample is the mean of the motions that lead to it and from it. Were the string simply where it is a
    /// sample before, it would be released half a sample too early, and all that follows would be off by as much. A step
    /// d⁺ = decay·d + q from d = 0 shows q, and d⁺ + d = 0 makes d = −q/(1 + decay), but for the part of it that `loss_1` damps in that step; likewise for a finger that comes at a
    /// velocity. Allocates.
    ///
    /// # Panics
    /// As [`State::step`].
    pub fn let_go(&mut self, model: &Model, drive: &Drive) {
        let mut after = self.clone();
        let mut scratch = Scratch::new(model);
        after.step(model, drive, &mut scratch);
        for node in 1..model.grid.intervals {
            let cell = model.grid.cell(node);
            self.motion[cell] = -after.motion[cell] / (1.0 + scratch.coasting.decay);
        }
        for (finger, after) in self.fingers.iter_mut().zip(&after.fingers) {
            if let (Some(finger), Some(after)) = (finger, after) {
                let (persistence, thrown) = (finger.inertia.persistence, finger.motion);
                // d⁺ = persistence·d + q as well, and the mean of both is what it is thrown with.
                let q = after.motion - persistence * thrown;
                finger.motion = (2.0 * thrown - q) / (1.0 + persistence);
            }
        }
        self.close_shape(model);
        self.look_at_all(model);
    }
}
