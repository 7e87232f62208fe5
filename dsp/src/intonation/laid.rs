//! Where something lies on a string that ends it by its weight alone, as a bar does, and presses it to nothing.

use std::f64::consts::PI;

use super::equilibrium::axial_spring;
use super::mode::{Resting, wavenumber};
use super::{MOST_STEPS, PITCH_TOLERANCE};
use crate::flexibility::Flexibility;
use crate::gesture::Touch;
use crate::grid::Grid;
use crate::model::Model;

/// A string that something is laid on (`docs/physics.md`, section 9).
pub struct Laid<'a> {
    model: &'a Model,
    flexibility: Flexibility,
}

impl<'a> Laid<'a> {
    /// The string of a model, at its own tension.
    pub fn new(model: &'a Model) -> Self {
        let own = model.stiffness(model.string.tension);
        Self { model, flexibility: Flexibility::new(&model.string, &own, &model.grid) }
    }

    /// Where a touch that rests with a force, N, 0 or more, lies for what is beyond it to sound at a frequency, Hz, if it touches
    /// nothing else and what is behind it is kept quiet, m from the nut. For what no place gives, as near as there is one.
    pub fn place(&self, touch: &Touch, force: f64, frequency: f64) -> f64 {
        let Grid { length, .. } = self.model.grid;
        let angular = std::f64::consts::TAU * frequency;
        let mut place = 0.5 * length;
        for _ in 0..MOST_STEPS {
            let tension = self.tension(force, place);
            let half_wave = PI / wavenumber(self.model, tension, angular);
            let beyond = half_wave + self.shortened(touch, force, tension, angular, place);
            let next = (length - beyond).clamp(0.0, length);
            let moved = (next - std::mem::replace(&mut place, next)).abs();
            if moved <= PITCH_TOLERANCE * (length - place) {
                break;
            }
        }
        place
    }

    /// The tension, N, of the string that a force, N, bends there: two straight lines, which are longer than one.
    fn tension(&self, force: f64, place: f64) -> f64 {
        let Model { grid, string, .. } = self.model;
        let bent = force / string.tension;
        let stretch = bent * bent * place * (grid.length - place) / grid.length;
        string.tension + 0.5 * axial_spring(self.model) * stretch
    }

    /// By how much shorter the string sounds than it is from there to the saddle, m: what it gives way less than a flexible one does
    /// under a force at that point, less what gives way under it.
    fn shortened(&self, touch: &Touch, force: f64, tension: f64, angular: f64, place: f64) -> f64 {
        let Model { grid, .. } = self.model;
        let at = grid.reading(place);
        let straight = place * (grid.length - place) / grid.length;
        let yields = self.model.finger_law_if(touch).map_or(0.0, |law| {
            let compliance = Resting { at, law, touch, force }.stiffness(angular, grid.time_step).inv().re;
            // What does not press has none.
            if compliance.is_finite() { compliance } else { 0.0 }
        });
        straight - self.model.string.tension * self.flexibility.of_grid(&at) - tension * yields
    }
}

#[cfg(test)]
mod tests {
    use super::Laid;
    use crate::gesture::Touch;
    use crate::model::{Model, StringParameters};
    use crate::scene::SolverSettings;

    /// The third string of an electric guitar, with so thick a core, on a fine grid, under what is heavy and hard: where it has to lie
    /// beyond the place from which a flexible string would sound at a frequency, m.
    fn farther(core_radius: f64, frequency: f64) -> f64 {
        let (length, tension, linear_density) = (0.6477, 73.7, 1.1433e-3);
        let string = StringParameters {
            length,
            linear_density,
            tension,
            tension_limit: tension,
            youngs_modulus: 2.07e11,
            core_radius,
            loss_0: 0.0,
            loss_1: 0.0,
            tension_modulation: false,
        };
        let model = Model::new(string, None, 1, SolverSettings::default(), 2e6).expect("it can be built");
        let bar = Touch { mass: 1e3, stiffness: 1e9, exponent: 1.0, damping: 0.0, hand_damping: 0.0 };
        let place = Laid::new(&model).place(&bar, 0.25, frequency);
        let half_wave = 0.5 * (tension / linear_density).sqrt() / frequency;
        (length - half_wave) - place
    }

    #[test]
    fn a_flexible_string_ends_where_it_lies() {
        for frequency in [250.0, 400.0, 600.0] {
            let off = farther(0.0, frequency);
            // A seventh of a spacing (0.13 mm) is what it is between points.
            assert!(off.abs() < 2e-5, "{frequency} Hz: {off} m");
        }
    }

    /// A stiff one bends round it, over √(EI/T) to either side, and sounds as if it ended half of that nearer to the saddle. Its stiffness
    /// raises it otherwise, too: of a half wave b by the part π²EI/(2Tb²).
    #[test]
    fn a_stiff_string_bends_round_it() {
        let core_radius: f64 = 2.159e-4;
        let bending = 2.07e11 * std::f64::consts::FRAC_PI_4 * core_radius.powi(4) / 73.7;
        for frequency in [250.0, 400.0, 600.0] {
            let half_wave = 0.5 * (73.7_f64 / 1.1433e-3).sqrt() / frequency;
            let raised = std::f64::consts::PI.powi(2) * bending / (2.0 * half_wave);
            let expected = 0.5 * bending.sqrt() + raised;
            let off = farther(core_radius, frequency);
            assert!((off - expected).abs() < 0.03 * expected, "{frequency} Hz: {off} m for {expected} m");
        }
    }
}
