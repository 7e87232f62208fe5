//! What is seen of a scene while it is computed.

use low_action_dsp::Simulation;
use low_action_dsp::pickup::stretch_tension;

/// What was seen while computing.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Seen {
    /// The first sample whose output is no finite number.
    pub not_finite: Option<u64>,
    /// Whether a point of a string is not finite at the end, however finite the output.
    pub ends_not_finite: bool,
    /// Deepest penetration of board and frets, m.
    pub penetration: f64,
    /// Newton iterations in all, and the most in one sample of one string.
    pub iterations: u64,
    pub most_iterations: u32,
    /// The most contacts active at once in one string.
    pub contacts: u32,
    /// Where stretching left the least room: the tension there was and the one that the grid bears, N.
    pub stretched: Option<[f64; 2]>,
}

impl Seen {
    pub(super) fn look(&mut self, simulation: &Simulation, output: f64) {
        if self.not_finite.is_none() && !output.is_finite() {
            self.not_finite = Some(simulation.steps() - 1);
        }
        for string in simulation.strings() {
            if string.model.string.tension_modulation {
                let own = string.scratch.stiffness().tension;
                let now =
                    [own + stretch_tension(&string.model, &string.scratch), string.model.tension_borne(own)];
                if self.stretched.is_none_or(|[most, borne]| now[0] * borne > most * now[1]) {
                    self.stretched = Some(now);
                }
            }
            let convergence = &string.convergence;
            if convergence.active > 0 {
                self.penetration = self.penetration.max(string.penetration());
                self.iterations += u64::from(convergence.iterations);
                self.most_iterations = self.most_iterations.max(convergence.iterations);
                self.contacts = self.contacts.max(convergence.active);
            }
        }
    }
}
