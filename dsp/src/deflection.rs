//! How far what presses a string deflects it, found in room that is there already: whoever plays may ask.

use crate::band::{Band, Factored, read, weights};
use crate::drive::Push;
use crate::grid::Reading;
use crate::model::{Model, Stiffness};

/// Forces on a string of one grid, and its deflection under them: K⁻¹ Σ w f, K its stiffness and w the weights of each.
#[derive(Debug, Clone)]
pub(crate) struct Deflection {
    stiffness: Factored<f64>,
    /// Forces at the unknowns, N.
    forces: Vec<f64>,
    /// Whether there is any.
    is_pressed: bool,
    /// The deflection that was found last, m.
    pub found: Vec<f64>,
    /// That which a shape of the string contains, m.
    pub contained: Vec<f64>,
}

impl Deflection {
    /// Room for a string of this model; allocates.
    pub fn new(model: &Model) -> Self {
        let Model { grid, string, .. } = model;
        let nothing = vec![0.0; grid.unknowns()];
        let stiffness = model.stiffness(string.tension);
        Deflection {
            stiffness: Band::of_string(grid, string.linear_density, &stiffness).factor(),
            forces: nothing.clone(),
            is_pressed: false,
            found: nothing.clone(),
            contained: nothing,
        }
    }

    /// Nothing presses.
    pub fn clear(&mut self) {
        self.forces.fill(0.0);
        self.found.fill(0.0);
        self.contained.fill(0.0);
        self.is_pressed = false;
    }

    /// A force presses besides, N, up is positive.
    pub fn press(&mut self, at: &Reading, force: f64) {
        if force == 0.0 {
            return;
        }
        weights(at).for_each(|(i, weight)| self.forces[i] += weight * force);
        self.is_pressed = true;
    }

    /// A push presses besides.
    pub fn push(&mut self, push: &Push) {
        self.press(&push.reading, push.force);
    }

    /// Finds the deflection at a tension, N, to which stretching adds so much more, N, 0 or more. Whether there is any: nothing
    /// deflects a string that nothing presses, and what is beyond all numbers is left out.
    pub fn find(&mut self, model: &Model, tension: f64, stretching: f64) -> bool {
        if !self.is_pressed {
            return false;
        }
        let own = model.stiffness(tension);
        let stiffness = Stiffness { tension: tension + stretching, ..own };
        self.stiffness.become_string(&model.grid, model.string.linear_density, &stiffness);
        self.found.copy_from_slice(&self.forces);
        self.stiffness.solve_in_place(&mut self.found);
        if !self.found.iter().all(|point| point.is_finite()) {
            self.found.fill(0.0);
        }
        true
    }

    /// The deflection at a point, m.
    pub fn at(&self, reading: &Reading) -> f64 {
        read(reading, &self.found)
    }

    /// By how much a shape of the string moves at an unknown where the deflection found takes the place of the one it contains, m.
    pub fn renew(&mut self, unknown: usize) -> f64 {
        let found = self.found[unknown];
        found - std::mem::replace(&mut self.contained[unknown], found)
    }
}
