//! Hands that go over to another string.

use super::FADE;
use crate::gesture::FINGERS_PER_STRING;
use crate::hands::{Hands, Pluck};
use crate::model::Model;
use crate::ramp::Ramp;
use crate::state::State;

impl Hands {
    /// Takes over what the hands on another string are doing.
    pub(crate) fn take_over(&mut self, old: &Hands, model: &Model, old_model: &Model) {
        let scale = model.grid.length / old_model.grid.length;
        let factor = self.sample_rate / old.sample_rate;
        self.plucks.clear();
        for pluck in &old.plucks {
            let position = pluck.position * scale;
            let reading = model.grid.reading(position);
            self.plucks.push(Pluck { position, reading, ..pluck.resampled(factor) });
        }
        self.stilling = old.stilling.resampled(factor);
        self.carry(old);
        for (held, before) in self.fingers.iter_mut().zip(&old.fingers) {
            *held = before.map(|before| before.carried(scale, factor));
        }
        // The same bend of this string goes on in its own time.
        let (tension, most) = (model.string.tension, self.most_tension);
        let same_bend = |bent: f64| (tension * (bent / old_model.string.tension)).min(most);
        self.bent = old.bent.map(same_bend).resampled(factor);
    }

    /// Has the string's tension begin at so much, N: from there to its own tuning is a way beside its bends.
    pub(crate) fn tune_from(&mut self, tension: f64) {
        self.tuned = Ramp::at(tension / self.bent.value());
        if self.tuned.value() != 1.0 {
            self.tuned.go(1.0, self.samples(FADE));
        }
    }

    /// Has the tension at the end of its way.
    pub(crate) fn arrive(&mut self) {
        self.bent = Ramp::at(self.bent.goal());
        self.tuned = Ramp::at(1.0);
    }

    /// Lets go of fingers that the string's state has not.
    pub(crate) fn keep_only(&mut self, state: &State) {
        for slot in 0..FINGERS_PER_STRING {
            if state.fingers()[slot].is_none() {
                self.fingers[slot] = None;
            }
        }
    }
}
