//! The ledger of a body under strings: what it holds by itself and together with them, what it loses, and what they give it.

use std::ops::Deref;

use super::account::Account;
use crate::body::{End, Modes};
use crate::entry::{Energies, Entry, Inputs, Losses};
use crate::field::{Field, Row};
use crate::model::Model;
use crate::state::State;
use crate::string::Scratch;

/// The running ledger of the body under the strings of a scene.
///
/// Where the bridge has gone along with a string both have less between them than each by itself: that is counted here, and may
/// make its energy one below 0. What it is given is what strings' ledgers have the bridge take from them.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyLedger {
    account: Account,
    ends: Vec<End>,
    /// The motion to the last sample, m√kg.
    motion: Vec<Row>,
    /// How far the bridge was up at the last two samples, the later last, m.
    lift: [f64; 2],
    time_step: f64,
}

impl Deref for BodyLedger {
    type Target = Account;
    fn deref(&self) -> &Account {
        &self.account
    }
}

impl BodyLedger {
    /// Opens the ledger of a body in its present state under strings, each with its end on the bridge; all have one rate.
    pub(crate) fn new<'a>(
        modes: &Modes,
        ends: &[End],
        strings: impl Iterator<Item = (&'a Model, &'a State)>,
    ) -> BodyLedger {
        let lift = [modes.lift_before(), modes.lift()];
        let (mut body, mut time_step) = (modes.energy(), 0.0);
        for (end, (model, state)) in ends.iter().zip(strings) {
            time_step = model.grid.time_step;
            body += end.common(past_and_now(end, &state.displacement, &state.motion), lift);
        }
        BodyLedger {
            account: Account::new(Energies { body, ..Energies::default() }),
            ends: ends.to_vec(),
            motion: modes.motion().to_vec(),
            lift,
            time_step,
        }
    }

    /// Books the step that body and strings have just taken, in which the bridge has put so much into all strings, W.
    pub(crate) fn record<'a>(
        &mut self,
        modes: &Modes,
        ends: &[End],
        strings: impl Iterator<Item = (&'a State, &'a Scratch)>,
        into_strings: f64,
    ) -> Entry {
        let k = self.time_step;
        let [past, now] = self.lift;
        let next = modes.lift();
        let [moving, far] = modes.gross(&self.motion);
        let (mut body, mut retuned, mut gross) = (modes.energy(), 0.0, moving);
        let mut size = body;
        for ((end, old), (state, scratch)) in ends.iter().zip(&mut self.ends).zip(strings) {
            let is = end.reading.of(&scratch.displacement);
            let string = [is, end.reading.of(&state.displacement)];
            body += end.common(string, [now, next]);
            size += end.common_size(string, [now, next]);
            if end.tension != old.tension {
                let between = |end: &End| {
                    end.common(past_and_now(end, &scratch.displacement, &scratch.motion), [past, now])
                };
                retuned += between(end) - between(old);
                *old = *end;
            }
            // The bridge is a sum over all modes, and what pulls at it one over some points.
            let pulled = end.pull.abs()
                * (end.reading.size(&scratch.displacement) + end.reading.size(&state.displacement));
            gross += modes.sums() * far * (pulled + end.back * far);
        }
        let losses = Losses { body: modes.lost(&self.motion) / k, ..Losses::default() };
        let inputs = Inputs { bridge: -into_strings, tension: retuned / k, ..Inputs::default() };
        let put_in = inputs.bridge + inputs.tension;
        let energies = Energies { body, ..Energies::default() };
        let residual = body - self.account.energies.body + k * (losses.body - put_in);
        self.account.rounding += f64::EPSILON * gross;
        self.account.book(energies, size, k * put_in, residual);
        self.motion.copy_from_slice(modes.motion());
        self.lift = [now, next];
        Entry {
            energies,
            power_loss: losses.body,
            losses,
            power_in: inputs.tension,
            inputs,
            residual,
            ..Entry::default()
        }
    }
}

/// What an end reads of a string that is at a displacement after a motion: before that, and now.
fn past_and_now(end: &End, displacement: &Field, motion: &Field) -> [f64; 2] {
    let now = end.reading.of(displacement);
    [now - end.reading.of(motion), now]
}
