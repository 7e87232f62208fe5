//! Strings over a body as tests have them.

mod balance;
mod motion;
mod refusals;
mod scenes;

use std::slice::from_mut;

use super::*;
use crate::drive::Drive;
use crate::energy::Ledger;
use crate::field::Row;
use crate::model::StringParameters;
use crate::scene::{SolverSettings, Stencil};
use crate::string::Scratch;

const GUITAR: Description = Description::GUITAR;

/// The low E of nylon, without losses of its own; with room for a body.
fn low_string(stencil: Stencil) -> Model {
    low_string_at(stencil, 48_000.0)
}

fn low_string_at(stencil: Stencil, rate: f64) -> Model {
    let string = StringParameters {
        length: 0.65,
        linear_density: 6.24e-3,
        tension: 71.6,
        tension_limit: 71.6 * 1.06 * room(true),
        youngs_modulus: 2.234e10,
        core_radius: 2.387e-4,
        loss_0: 0.0,
        loss_1: 0.0,
        tension_modulation: true,
    };
    let settings = SolverSettings { stencil, ..SolverSettings::default() };
    Model::new(string, None, 0, settings, rate).expect("it can be")
}

/// A string over a body, its ledger, and what moves with both.
struct Pair {
    model: Model,
    state: State,
    scratch: Scratch,
    drive: Drive,
    ledger: Ledger,
    body: Body,
    heard: Heard,
}

impl Pair {
    fn new(model: Model, description: &Description) -> Self {
        check(description, &[&model]).expect("it is heavy enough");
        let body = Body::new(description, &model);
        let state = State::new(&model);
        let (scratch, drive) = (Scratch::new(&model), Drive::new(&model));
        let ledger = Ledger::new(&model, &state, model.string.tension);
        Pair { model, state, scratch, drive, ledger, body, heard: Heard::default() }
    }

    /// One step, and what string and body hold together half a step before its end, J.
    fn step(&mut self) -> f64 {
        step(from_mut(self))
    }
}

/// One step of strings over one body, and what all hold together half a step before its end, J.
fn step(strings: &mut [Pair]) -> f64 {
    let lift = |strings: &[Pair]| strings.iter().map(|pair| pair.body.lift()).sum::<f64>();
    let before = lift(strings);
    let (mut energy, mut coupling) = (0.0, Vec::new());
    for Pair { model, state, scratch, drive, ledger, body, heard } in &mut *strings {
        let string_before = body.end.reading.of(&state.displacement);
        let (push, of_body) = body.step(model, state, drive.tension, before);
        *heard = of_body;
        drive.bridge = Some(push);
        state.step(model, drive, scratch);
        energy += ledger.record(model, state, scratch, drive).energies.total();
        coupling.push((body.end, [string_before, body.end.reading.of(&state.displacement)]));
    }
    let after = lift(strings);
    for (end, string) in coupling {
        energy += end.common(string, [before, after]);
    }
    // All that the strings have the modes do is one motion.
    let mut whole = strings[0].body.modes.clone();
    for Pair { body: Body { modes, .. }, .. } in &strings[1..] {
        let add = |to: &mut Vec<Row>, from: &[Row]| {
            to.iter_mut().flatten().zip(from.iter().flatten()).for_each(|(to, from)| *to += from);
        };
        add(&mut whole.place, &modes.place);
        add(&mut whole.motion, &modes.motion);
    }
    energy + whole.energy()
}
