//! What is tried: sample rates, stencils, caps, tolerances, exponents of the contact law.

use low_action_dsp::{SolverSettings, Stencil};

/// One way to compute a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Internal sample rate, Hz.
    pub rate: f64,
    /// Difference operator of the strings.
    pub stencil: Stencil,
    /// Newton iterations at most in a sample.
    pub cap: usize,
    /// Largest change of penetration at which the iteration may stop, m.
    pub tolerance: f64,
    /// Exponent of the frets' contact law; without it the instrument's own, 1.5.
    pub exponent: Option<f64>,
}

/// What plugins compute with at a host rate of 48 kHz.
pub const LIVE: Setting =
    Setting { rate: 48e3, stencil: Stencil::Wide, cap: 20, tolerance: 1e-12, exponent: None };

/// What everything is held against.
pub const REFERENCE: Setting =
    Setting { rate: 768e3, stencil: Stencil::Wide, cap: 200, tolerance: 1e-15, exponent: None };

/// The axis along which a setting departs from [`LIVE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Sample rate and stencil.
    Grid,
    /// Cap and tolerance.
    Solver,
    /// Exponent of the contact law, at several rates.
    Exponent,
}

/// All settings of an axis, in the order of its table.
pub fn settings(axis: Axis) -> Vec<Setting> {
    use Stencil::{Corrected, Paper, Wide};
    let grid = |rate: f64, stencil: Stencil| Setting { rate, stencil, ..LIVE };
    match axis {
        Axis::Grid => {
            let mut all = vec![grid(44.1e3, Wide)];
            for rate in [48e3, 96e3, 192e3] {
                all.extend([Paper, Corrected, Wide].map(|stencil| grid(rate, stencil)));
            }
            all.push(grid(384e3, Wide));
            all
        }
        Axis::Solver => {
            let mut all = Vec::new();
            for rate in [48e3, 96e3] {
                let caps = [1, 2, 4, 8, 20, 50].map(|cap| Setting { rate, cap, ..LIVE });
                let tolerances = [1e-6, 1e-9, 1e-15].map(|tolerance| Setting { rate, tolerance, ..LIVE });
                all.extend(caps.into_iter().filter(|setting| rate == 48e3 || [2, 8].contains(&setting.cap)));
                all.extend(tolerances.into_iter().filter(|one| rate == 48e3 || one.tolerance == 1e-9));
            }
            all
        }
        Axis::Exponent => {
            let exponents = [1.0, 2.0, 2.5];
            let of = |exponent| [48e3, 96e3].map(|rate| Setting { rate, exponent: Some(exponent), ..LIVE });
            exponents.into_iter().flat_map(of).collect()
        }
    }
}

/// Those that are quick to compute and compared in `--quick`.
pub fn quick() -> Vec<Setting> {
    settings(Axis::Grid).into_iter().filter(|setting| setting.rate == 48e3).collect()
}

impl Setting {
    /// As a scene says it.
    pub fn solver(&self) -> SolverSettings {
        SolverSettings { max_iterations: self.cap, tolerance: self.tolerance, stencil: self.stencil }
    }

    /// The reference for this setting.
    pub fn reference(&self) -> Setting {
        Setting { exponent: self.exponent, ..REFERENCE }
    }

    /// Its name in the table of an axis.
    pub fn name(&self, axis: Axis) -> String {
        let rate = format!("{} kHz", self.rate / 1e3);
        match axis {
            Axis::Grid => format!("{rate}, {}", stencil_name(self.stencil)),
            Axis::Solver => format!("{rate}, cap {}, {:e} m", self.cap, self.tolerance),
            Axis::Exponent => format!("{rate}, exponent {}", self.exponent.unwrap_or(1.5)),
        }
    }
}

/// How files and tables write a stencil.
pub fn stencil_name(stencil: Stencil) -> &'static str {
    match stencil {
        Stencil::Paper => "paper",
        Stencil::Corrected => "corrected",
        Stencil::Wide => "wide",
    }
}
