//! What is heard of a string.

use crate::filter::Biquad;
use crate::grid::NUT;
use crate::model::Model;
use crate::setup::Pickup;
use crate::state::State;
use crate::string::Scratch;

/// Transverse force of the string on the bridge at the sample n from which the last step led, N, up is
/// positive: −T ∂ₓu + EI ∂ₓₓₓu at x = L, with the stencil's own bending term and the tension raised by
/// stretching.
pub fn bridge_force(model: &Model, scratch: &Scratch) -> f64 {
    let h = model.grid.spacing;
    // After a step the scratch holds uⁿ.
    let u = &scratch.displacement;
    let end = NUT + model.grid.intervals;
    let slope = (u[end] - u[end - 1]) / h;
    let last_curvature = ((u[end] - u[end - 1]) - (u[end - 1] - u[end - 2])) / (h * h);
    let stiffness = scratch.stiffness();
    // ∂ₓₓu vanishes at the bridge, so ∂ₓₓₓu there is minus the last curvature over h.
    -(stiffness.tension + stretch_tension(model, scratch)) * slope
        - model.string.linear_density * stiffness.kappa_2 * last_curvature / h
}

/// Tension added by stretching at n, EA/(2L)·∫(∂ₓu)² dx, N; 0 where the string has no tension modulation.
pub fn stretch_tension(model: &Model, scratch: &Scratch) -> f64 {
    if model.stretch == 0.0 {
        return 0.0;
    }
    let string = &model.string;
    string.axial_stiffness() / (2.0 * string.length * model.grid.spacing) * scratch.steepness()
}

/// What a pickup hears of one string.
#[derive(Debug, Clone)]
pub(crate) struct Listener {
    source: Source,
    coil: Biquad,
    block: Biquad,
}

#[derive(Debug, Clone)]
enum Source {
    /// Velocity averaged over the coil's field: weights from a grid index on, 1/s each.
    Field {
        first: usize,
        weights: Vec<f64>,
    },
    Bridge,
}

/// Points at which the field of a coil is sampled, a Gauss–Legendre rule of five: exact for all that a
/// string can do within 2 cm.
const FIELD: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// Below this nothing is music, and the force of a pressed string on the bridge has a constant part, Hz.
const LOWEST: f64 = 18.0;

impl Listener {
    /// The pickup of a set-up over one string.
    pub fn new(pickup: &Pickup, model: &Model, sample_rate: f64) -> Self {
        let block = Biquad::high_pass(LOWEST, sample_rate);
        match *pickup {
            Pickup::Bridge => Listener { source: Source::Bridge, coil: Biquad::through(), block },
            Pickup::Magnetic { position, aperture, resonance, quality } => {
                let end = model.grid.length;
                let middle = end - position;
                let mut sum = vec![0.0; model.grid.padded_len()];
                for (offset, weight) in FIELD {
                    let place = (middle + 0.5 * aperture * offset).clamp(1e-6 * end, (1.0 - 1e-6) * end);
                    let share = 0.5 * weight / model.grid.time_step;
                    model.grid.reading(place).spread(&mut sum, share);
                }
                let first = sum.iter().position(|w| *w != 0.0).unwrap_or(0);
                let last = sum.iter().rposition(|w| *w != 0.0).unwrap_or(0);
                let weights = sum[first..=last].to_vec();
                let coil = Biquad::resonance(resonance, quality, sample_rate);
                Listener { source: Source::Field { first, weights }, coil, block }
            }
        }
    }

    /// The signal after a step: volts of an arbitrary coil, or newtons.
    #[inline]
    pub fn hear(&mut self, model: &Model, state: &State, scratch: &Scratch) -> f64 {
        let signal = match &self.source {
            Source::Bridge => bridge_force(model, scratch),
            Source::Field { first, weights } => {
                let motion = &state.motion[*first..*first + weights.len()];
                motion.iter().zip(weights).map(|(d, w)| d * w).sum()
            }
        };
        self.block.next(self.coil.next(signal))
    }

    /// The signal of a string at rest.
    #[inline]
    pub fn hear_nothing(&mut self) -> f64 {
        if self.coil.is_still() && self.block.is_still() {
            return 0.0;
        }
        self.block.next(self.coil.next(0.0))
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        self.coil.reset();
        self.block.reset();
    }
}
