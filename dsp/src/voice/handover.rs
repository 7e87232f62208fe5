//! A string that takes over from another one.

use super::Voice;
use crate::body::End;
use crate::handover::Side;
use crate::model::Model;
use crate::ramp::Ramp;
use crate::roomy::Roomy;

/// Frets and board on their way to where the model has them.
#[derive(Debug, Clone)]
pub(super) struct Settling {
    /// Heights from which they started, m, in the model's order.
    from: Roomy<f64>,
    /// How far they have come, 0 to 1.
    pub part: Ramp,
}

impl Settling {
    /// All is where the model has it.
    pub fn none(model: &Model) -> Self {
        Settling { from: Roomy::with_capacity(model.contacts.len()), part: Ramp::at(1.0) }
    }
}

/// The time frets and board take from where the string of another model left them to their own place, s:
/// a millimetre at the speed of a slow finger.
const SETTLING: f64 = 0.04;

impl Voice {
    /// Moves frets and board by a sample's share of their way.
    #[cold]
    pub(super) fn settle(&mut self) {
        let part = self.settling.part.step();
        let way = self.settling.from.iter().zip(&self.model.contacts);
        self.drive.heights.clear();
        if part < 1.0 {
            self.drive.heights.extend(way.map(|(from, contact)| from + (contact.height - from) * part));
        } else {
            // The last move ends exactly there; afterwards the barrier rests.
            self.drive.heights.extend(way.map(|(_, contact)| contact.height));
        }
    }

    /// Takes over from another string of the same host's rate: its motion, the fingers on it, the
    /// plucks under way, and its ledger, for which it leaves its own. The bridge of that one is `lift` m up. Nothing is allocated or
    /// given back, but by ledgers.
    pub fn take_over(&mut self, old: &mut Voice, lift: f64) {
        if old.ledger.is_some() {
            std::mem::swap(&mut self.ledger, &mut old.ledger);
            old.rebook();
        }
        self.asleep = old.asleep;
        self.hands.take_over(&old.hands, &self.model, &old.model);
        self.listener.take_over(&old.listener);
        self.decimator.take_over(&old.decimator);
        if self.asleep {
            // Nobody heard the old tension, and no ramp runs while nothing moves.
            self.hands.arrive();
        } else {
            self.take_motion(old, lift);
            self.hands.keep_only(&self.state);
        }
        if let Some(body) = &mut self.body {
            body.take_over(old.body.as_ref(), &self.model, self.hands.tension());
        }
        if self.asleep {
            return self.rebook();
        }
        self.settling.from.clear();
        self.settling.from.extend_from_slice(self.state.heights());
        self.settling.part = Ramp::at(0.0);
        self.settling.part.go(1.0, (SETTLING / self.model.grid.time_step).round() as u64);
        self.rebook();
    }

    /// Takes over the motion, and the tension that there is.
    fn take_motion(&mut self, old: &mut Voice, lift: f64) {
        let had = old.hands.tension();
        let (hands, model) = (&self.hands, &self.model);
        let begins_at = |asked: f64, own: f64| hands.begins_at(model, asked, had, own);
        let mut new = Side { model, deflection: &mut self.deflection };
        let mut before = Side { model: &old.model, deflection: &mut old.deflection };
        new.deflection.clear();
        before.deflection.clear();
        for (pluck, old_pluck) in hands.plucks.iter().zip(&old.hands.plucks) {
            new.deflection.push(&pluck.push(hands.sample_rate));
            before.deflection.push(&old_pluck.push(old.hands.sample_rate));
        }
        if let (Some(body), Some(old_body)) = (&self.body, &old.body)
            && body.goes_on_from(old_body)
        {
            new.deflection.push(&End::new(model, begins_at(had, 0.0)).push(lift));
            before.deflection.push(&old_body.end().push(lift));
        }
        let tension = self.state.take_over(&mut new, &old.state, &mut before, had, begins_at);
        self.hands.tune_from(tension);
    }

    /// Shares steps with the host's samples as another string of the same rate does.
    pub fn follow(&mut self, other: &Voice) {
        self.decimator.follow(&other.decimator);
    }
}
