//! How a string goes on by itself for a step, and how easily it is moved: all that depends on its loss σ₀.

use super::StringParameters;
use crate::grid::Grid;

/// The coefficients of a step that depend on the loss of all frequencies alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Coasting {
    /// The loss σ₀ that is realised, 1/s, which differs from the one asked for in the last digit.
    pub loss_0: f64,
    /// (1 − σ₀k)/(1 + σ₀k), how much of the motion is left after a step.
    pub decay: f64,
    /// 1/s = 1/(1 + σ₀k) = (1 + decay)/2, exactly.
    pub inverse_s: f64,
    /// k²/(ρhs): displacement in one step per newton at a grid point, m/N.
    pub mobility: f64,
    /// k²EA/(4ρLh³s), the strength of tension modulation in units of undivided second differences.
    pub stretch: f64,
}

impl Coasting {
    /// Of a string on its grid at a loss σ₀, 1/s.
    pub fn new(string: &StringParameters, grid: &Grid, loss_0: f64) -> Self {
        let (k, h) = (grid.time_step, grid.spacing);
        // (1 + x) − 1 rounds `decay` to a multiple of 2⁻⁵², so that 1 + decay is exact: an inverse that
        // is off by half an ulp would drift the energy by 1e-16 in every sample.
        let decay = (1.0 + (1.0 - loss_0 * k) / (1.0 + loss_0 * k)) - 1.0;
        let inverse_s = 0.5 * (1.0 + decay);
        let k2 = k * k;
        let stretch = if string.tension_modulation {
            k2 * string.axial_stiffness() * inverse_s
                / (4.0 * string.linear_density * string.length * h * h * h)
        } else {
            0.0
        };
        Coasting {
            loss_0: (1.0 - decay) / (1.0 + decay) / k,
            decay,
            inverse_s,
            mobility: k2 * inverse_s / (string.linear_density * h),
            stretch,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{Model, StringParameters};
    use crate::scene::SolverSettings;

    /// However little a hand adds, by itself less than the last digit of what the string loses anyway, it takes and never gives: no
    /// loss below the string's own. What it adds is as exact as that of a string can be: 1 and what is left of a motion are to 2⁻⁵².
    #[test]
    fn a_soft_hand_never_gives() {
        let hands: Vec<f64> = [0.0, f64::MIN_POSITIVE]
            .into_iter()
            .chain((-30..7).map(|power| libm::exp10(f64::from(power))))
            .collect();
        let (mut nothing, mut something) = (0, 0);
        for own in (0..200).map(|number| 0.013 * f64::from(number * number)) {
            let string = StringParameters {
                length: 0.65,
                linear_density: 6.24e-3,
                tension: 71.6,
                tension_limit: 80.0,
                youngs_modulus: 0.0,
                core_radius: 0.0,
                loss_0: own,
                loss_1: 0.0,
                tension_modulation: false,
            };
            for rate in [8_000.0, 48_000.0, 88_200.0] {
                let model = Model::new(string, None, 0, SolverSettings::default(), rate).expect("it can be");
                let known = 4.0 * f64::EPSILON * rate;
                for &hand in &hands {
                    let adds = model.coasting_under(hand).loss_0 - model.string.loss_0;
                    assert!(adds >= 0.0, "{hand:e} 1/s add {adds:e} to {own} at {rate} Hz");
                    if hand < 0.01 * rate {
                        assert!((adds - hand).abs() < known + 1e-12 * hand, "{hand:e} and not {adds:e} 1/s");
                    }
                    *if adds == 0.0 { &mut nothing } else { &mut something } += 1;
                }
            }
        }
        assert!(nothing > 1_000 && something > 1_000, "{nothing} add nothing, {something} do");
    }
}
