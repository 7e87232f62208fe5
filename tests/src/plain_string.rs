//! A string without contacts, for which formulas on paper say what it does.

use std::f64::consts::PI;
use std::fmt::Debug;

use low_action_dsp::{Scene, Simulation};

/// The stencils' names in a scene.
pub const STENCILS: [&str; 3] = ["paper", "corrected", "wide"];

/// A string without contacts.
pub struct PlainString {
    /// Hz.
    pub sample_rate: f64,
    /// m.
    pub length: f64,
    /// kg/m.
    pub linear_density: f64,
    /// N.
    pub tension: f64,
    /// Pa.
    pub youngs_modulus: f64,
    /// m.
    pub core_radius: f64,
    /// 1/s.
    pub loss_0: f64,
    /// m²/s.
    pub loss_1: f64,
}

/// Low E of a light electric set: 38.216e-5 lb/in (D'Addario NW046) tuned to 82.407 Hz on 25.5 in, its core
/// of steel 0.018 in thick; losses that let it ring for some seconds.
pub const LOW_E: PlainString = PlainString {
    sample_rate: 48_000.0,
    length: 0.6477,
    linear_density: 6.825e-3,
    tension: 77.77,
    youngs_modulus: 2.07e11,
    core_radius: 0.2286e-3,
    loss_0: 0.5,
    loss_1: 1e-4,
};

/// A `[[string]]` of a scene, of a length (m) and density (kg/m), under a tension (N) or a course of it, with Young's modulus
/// (Pa) and radius (m) of its core and both losses (1/s and m²/s).
pub fn string_table(
    [length, linear_density]: [f64; 2],
    tension: &impl Debug,
    [youngs_modulus, core_radius]: [f64; 2],
    [loss_0, loss_1]: [f64; 2],
) -> String {
    format!(
        "[[string]]
        length = {length:?}
        linear_density = {linear_density:?}
        tension = {tension:?}
        youngs_modulus = {youngs_modulus:?}
        core_radius = {core_radius:?}
        loss_0 = {loss_0:?}
        loss_1 = {loss_1:?}"
    )
}

impl PlainString {
    fn scene(&self, stencil: &str, shape: &[[f64; 2]], more: &str) -> Scene {
        let text = format!(
            "sample_rate = {:?}
            duration = 10.0
            [solver]
            stencil = {stencil:?}
            {}
            shape = {shape:?}
            {more}",
            self.sample_rate,
            string_table(
                [self.length, self.linear_density],
                &self.tension,
                [self.youngs_modulus, self.core_radius],
                [self.loss_0, self.loss_1],
            ),
        );
        Scene::from_toml(&text).expect("the scene is valid")
    }

    /// The string released from the height `shape` has at each grid point.
    pub fn released(&self, stencil: &str, shape: impl Fn(f64) -> f64, more: &str) -> Simulation {
        let flat = self.scene(stencil, &[[0.0, 0.0], [self.length, 0.0]], more);
        let places: Vec<f64> =
            Simulation::new(&flat).expect("the scene can be built").string(0).places().collect();
        let inner = places.iter().map(|&x| [x, shape(x)]);
        let points: Vec<_> = [[0.0, 0.0]].into_iter().chain(inner).chain([[self.length, 0.0]]).collect();
        Simulation::new(&self.scene(stencil, &points, more)).expect("the scene can be built")
    }

    /// c² = T/ρ, m²/s².
    pub fn c_squared(&self) -> f64 {
        self.tension / self.linear_density
    }

    /// κ² = EI/ρ with I = πr⁴/4, m⁴/s².
    pub fn kappa_squared(&self) -> f64 {
        self.youngs_modulus * PI * self.core_radius.powi(4) / 4.0 / self.linear_density
    }

    /// Undamped angular frequency at wave number β, by the differential equation.
    pub fn frequency(&self, beta: f64) -> f64 {
        (self.c_squared() * beta.powi(2) + self.kappa_squared() * beta.powi(4)).sqrt()
    }
}
