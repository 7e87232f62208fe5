//! The body under all strings of a running scene: what they hear one another by.

use super::SceneString;
use crate::body::{End, Modes, check};
use crate::energy::BodyLedger;
use crate::entry::Entry;
use crate::error::Error;
use crate::model::Model;
use crate::setup::Body;

/// One bank of modes, and an end of each string on its bridge.
#[derive(Debug, Clone)]
pub(super) struct SceneBody {
    modes: Modes,
    ends: Vec<End>,
    /// How far the bridge was up at the sample that the last step led from, m.
    pub lift: f64,
    /// The sound pressure at that sample, Pa.
    pub pressure: f64,
}

impl SceneBody {
    /// At rest, under strings that are let go of as they are now.
    pub fn new(description: &Body, strings: &[SceneString]) -> Result<SceneBody, Error> {
        let models: Vec<&Model> = strings.iter().map(|string| &string.model).collect();
        check(description, &models)?;
        let mut body = SceneBody {
            modes: Modes::new(description, models[0].grid.time_step),
            ends: models.iter().map(|model| End::new(model, model.string.tension)).collect(),
            lift: 0.0,
            pressure: 0.0,
        };
        let forces = body.ends.iter().zip(strings).map(|(end, string)| end.force(&string.state, 0.0));
        let force = forces.fold(0.0, |sum, force| sum + force);
        body.modes.let_go(force);
        Ok(body)
    }

    /// How many modes it has.
    pub fn count(&self) -> usize {
        self.modes.count()
    }

    /// Takes the step that the strings are about to take, and has the bridge push each of them in it. To be asked before any moves.
    pub fn step(&mut self, strings: &mut [SceneString]) {
        self.lift = self.modes.lift();
        let mut force = 0.0;
        for (end, SceneString { model, state, scratch, drive, .. }) in self.ends.iter_mut().zip(strings) {
            end.pull_at(model, state.tension_under(drive, scratch));
            drive.bridge = Some(end.push(self.lift));
            force += end.force(state, self.lift);
        }
        self.pressure = self.modes.swing(force);
    }

    /// Opens its ledger.
    pub fn open_ledger(&self, strings: &[SceneString]) -> BodyLedger {
        let strings = strings.iter().map(|string| (&string.model, &string.state));
        BodyLedger::new(&self.modes, &self.ends, strings)
    }

    /// Books the step just taken, in which the bridge has put so much into all strings, W.
    pub fn book(&self, ledger: &mut BodyLedger, strings: &[SceneString], into_strings: f64) -> Entry {
        let strings = strings.iter().map(|string| (&string.state, &string.scratch));
        ledger.record(&self.modes, &self.ends, strings, into_strings)
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;
    use crate::simulation::Simulation;

    /// A body is let go of together with a string that is held in a shape: at rest at that moment, and not half a step before, so
    /// that it has come from where it goes.
    #[test]
    fn a_body_is_let_go_of_with_its_strings() {
        let text = "sample_rate = 48000\nduration = 1.0\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\ntension = 60.0\n\
                    shape = [[0.0, 0.0], [0.5, 0.003], [0.65, 0.0]]\n[body]\nfrequency = 170.0\nmass = 0.1\narea = 0.05\n\
                    quality = 20.0\nspacing = 50.0\nvolume = 0.0145\nhole = 0.0055\n";
        let mut simulation =
            Simulation::new(&Scene::from_toml(text).expect("it is legal")).expect("it can be built");
        let lifts = |simulation: &Simulation| {
            let modes = &simulation.body.as_ref().expect("there is one").modes;
            [modes.lift_before(), modes.lift()]
        };
        let [before, begins] = lifts(&simulation);
        simulation.step();
        let [_, after] = lifts(&simulation);
        assert_eq!(begins, 0.0);
        assert!(after > 1e-9 && (after / before - 1.0).abs() < 1e-12, "from {before} to {after} m");
    }
}
