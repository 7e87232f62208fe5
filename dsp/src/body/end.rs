//! The end of a string on a bridge that gives way: what one does to the other.

use super::coefficients::Coefficients;
use crate::drive::Push;
use crate::grid::Reading;
use crate::model::{Model, Stiffness};
use crate::state::State;

/// How much more tension grids bear than hands and tuning ask for, as a part of it, where there is a body.
pub(super) const ROOM: f64 = 0.02;

/// How the string pulls at the bridge at a tension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct End {
    /// N.
    pub tension: f64,
    /// Reads the string where the bridge's motion is felt.
    pub reading: Reading,
    /// Newtons on the bridge for 1 m there.
    pub pull: f64,
    /// Newtons on the bridge for 1 m of its own, downwards: while the string is held, and while it goes along in a straight line.
    pub back: f64,
    pub line: f64,
}

impl End {
    pub fn new(model: &Model, tension: f64) -> Self {
        let (grid, h) = (&model.grid, model.grid.spacing);
        let Stiffness { kappa_squared, kappa_6, .. } = model.stiffness(tension);
        let (h3, density) = (h * h * h, model.string.linear_density);
        let (bending, sixth) = (density * kappa_squared / h3, density * kappa_6 / (h3 * h * h));
        // The operator's weights of neighbours one, two and three points away, N/m.
        let (first, second, third) =
            (tension / h + 4.0 * bending + 15.0 * sixth, -bending - 6.0 * sixth, sixth);
        // The straight line from the nut to the bridge, 1 m up, goes on beyond it, where a string with fixed ends turns oddly:
        // 1 m at the bridge and 2 m farther out.
        let near = [third, second + 2.0 * third, first + 2.0 * second + 2.0 * third];
        let pull = near[2];
        let reading = Reading::before_bridge(grid, near.map(|force| force / pull));
        let line = [3.0, 2.0, 1.0].map(|away| 1.0 - away / grid.intervals as f64);
        let held: f64 = near.iter().zip(line).map(|(force, line)| force * line).sum();
        let line = tension / grid.length;
        End { tension, reading, pull, back: held + line, line }
    }

    /// Pulls as at another tension, N, from now on.
    #[inline]
    pub fn pull_at(&mut self, model: &Model, tension: f64) {
        if tension != self.tension {
            *self = End::new(model, tension);
        }
    }

    /// What a bridge that is `lift` m up does to the string.
    #[inline]
    pub fn push(&self, lift: f64) -> Push {
        Push { reading: self.reading, force: self.pull * lift }
    }

    /// What the string does to a bridge that is `lift` m up, N.
    #[inline]
    pub fn force(&self, state: &State, lift: f64) -> f64 {
        self.pull * self.reading.of(&state.displacement) - self.back * lift
    }

    /// What string and bridge have in common between two samples, J, by what is read of the string at both and how far the bridge
    /// is up then, m: less where the bridge goes along with the string.
    pub fn common(&self, string: [f64; 2], lift: [f64; 2]) -> f64 {
        0.5 * self.back * lift[0] * lift[1] - 0.5 * self.pull * (lift[1] * string[0] + lift[0] * string[1])
    }

    /// The same if nothing cancelled.
    pub fn common_size(&self, string: [f64; 2], lift: [f64; 2]) -> f64 {
        let [string, lift] = [string.map(f64::abs), lift.map(f64::abs)];
        0.5 * self.back * lift[0] * lift[1]
            + 0.5 * self.pull.abs() * (lift[1] * string[0] + lift[0] * string[1])
    }

    /// How much a body takes of what the grid of a string has left where it is tautest, at `most` N: the scheme is stable up to 1.
    ///
    /// Both together are where 4/k² − K is not negative, K what drives string and body back, by masses of 1 kg. The string's
    /// own part of that is r·4/k² at least, r what is left. By what couples both, b = φ·pull·weights/√(ρh), the body then needs
    /// 4/k² − ω² − φφᵀ(back + |pull·weights|²/(ρh r 4/k²)) not to be negative for all its modes, which it is not while
    /// (back + …) Σφ²/(4/k² − ω²) ≤ 1. Of several strings over one body the brackets add up.
    pub fn taken(model: &Model, most: f64, modes: &[Coefficients]) -> f64 {
        let End { reading, pull, back, .. } = End::new(model, most);
        let (k, density) = (model.grid.time_step, model.string.linear_density);
        let highest = 4.0 / (k * k);
        let left = 1.0 - model.stiffness(most).stability(density, model.string.loss_1, &model.grid);
        if left <= 0.0 {
            return f64::INFINITY;
        }
        let weights: f64 = reading.weights.iter().map(|weight| weight * weight).sum();
        let coupled = pull * pull * weights / (density * model.grid.spacing * left * highest);
        (back + coupled) * Coefficients::sum(modes, |own| 1.0 / (highest - own))
    }
}
