//! What is tried: sample rates, stencils, caps, tolerances, exponents of the contact law.

use std::sync::LazyLock;

use low_action_dsp::neck::Neck;
use low_action_dsp::scene::FretPlacement;
use low_action_dsp::{EngineSettings, Quality, Setup, SolverSettings, Stencil};

use super::frets::placement_name;
use super::scenes::Kind;

/// One way to compute a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Sample rate, Hz.
    pub rate: f64,
    /// The widest grid of a string, m; one that is wider at the rate is computed at a multiple of it.
    pub widest: f64,
    /// Difference operator of the strings.
    pub stencil: Stencil,
    /// Newton iterations at most in a sample.
    pub cap: usize,
    /// Largest change of penetration at which the iteration may stop, m.
    pub tolerance: f64,
    /// Exponent of the frets' contact law; without it the instrument's own, 1.5.
    pub exponent: Option<f64>,
    /// Damping of frets and board, s/m; without it the instrument's own.
    pub damping: Option<f64>,
    /// Where frets act on the grid.
    pub frets: FretPlacement,
    /// How contacts are computed.
    pub law: Law,
}

/// How contacts are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// Their law is solved for, by Newton's method.
    Newton,
    /// Their energy is made a square and no equation is solved, as in [`super::rival`].
    Quadratised,
}

/// What settings are varied about: `live` with every string at 48 kHz, but solved so exactly that its tolerance is nothing beside what
/// is varied.
pub const BASE: Setting = Setting {
    rate: 48e3,
    widest: f64::INFINITY,
    stencil: Stencil::Wide,
    cap: 20,
    tolerance: 1e-12,
    exponent: None,
    damping: None,
    frets: FretPlacement::Kinked,
    law: Law::Newton,
};

/// What everything is held against.
pub const REFERENCE: Setting = Setting { rate: 768e3, cap: 200, tolerance: 1e-15, ..BASE };

/// The neck of the instrument whose strings buzz.
static OWN_NECK: LazyLock<Neck> = LazyLock::new(|| Setup::builtin("electric").expect("it is built in").neck);

/// The axis along which a setting departs from [`BASE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The qualities a player chooses between.
    Quality,
    /// Sample rate and stencil.
    Grid,
    /// Cap and tolerance.
    Solver,
    /// Exponent of the contact law, at several rates.
    Exponent,
    /// Newton's method or a quadratised law.
    Law,
    /// Rate alone, for one string after the other.
    String,
    /// Damping of frets, likewise.
    Loss,
    /// Where frets act and how wide grids are, likewise.
    Frets,
}

impl Axis {
    /// All of them.
    pub const ALL: [Axis; 8] = [
        Axis::Quality,
        Axis::Grid,
        Axis::Solver,
        Axis::Exponent,
        Axis::Law,
        Axis::String,
        Axis::Loss,
        Axis::Frets,
    ];
}

/// Host rates at which qualities are measured, Hz.
pub const HOSTS: [f64; 3] = [44.1e3, 48e3, 96e3];

/// The widest grids on which frets are looked at, m: as they come at one step a sample, those of `live`, and finer ones.
const SPACINGS: [f64; 3] = [f64::INFINITY, 9e-3, 6e-3];

/// A quality at a host rate.
pub fn quality(quality: Quality, rate: f64) -> Setting {
    let EngineSettings { sample_rate, widest_spacing, stencil, max_iterations, tolerance } =
        quality.settings(rate);
    Setting { rate: sample_rate, widest: widest_spacing, stencil, cap: max_iterations, tolerance, ..BASE }
}

/// All settings of an axis, in the order of its table.
pub fn settings(axis: Axis) -> Vec<Setting> {
    use Stencil::{Corrected, Paper, Wide};
    let grid = |rate: f64, stencil: Stencil| Setting { rate, stencil, ..BASE };
    match axis {
        Axis::Quality => {
            let at = |rate: f64| Quality::ALL.map(|one| quality(one, rate));
            HOSTS.into_iter().flat_map(at).collect()
        }
        Axis::Law => {
            let of = |law: Law| [48e3, 96e3, 192e3].map(|rate| Setting { rate, law, ..BASE });
            [Law::Newton, Law::Quadratised].into_iter().flat_map(of).collect()
        }
        Axis::String => [48e3, 96e3, 144e3, 192e3].map(|rate| grid(rate, Wide)).to_vec(),
        Axis::Loss => {
            // The instrument's own is not said, so that what is known of it is not measured again.
            let others = [Some(0.0), Some(0.1), None, Some(1.0), Some(3.0)];
            let at = |rate: f64| others.map(|damping| Setting { rate, damping, ..BASE });
            [&at(BASE.rate)[..], &at(REFERENCE.rate)[1..]].concat()
        }
        Axis::Frets => {
            let of = |frets: FretPlacement| SPACINGS.map(|widest| Setting { frets, widest, ..BASE });
            let lossless = Setting { frets: FretPlacement::Exact, damping: Some(0.0), ..BASE };
            [&[lossless], &of(FretPlacement::Exact)[..], &of(FretPlacement::Kinked)].concat()
        }
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
                let caps = [1, 2, 4, 8, 20, 50].map(|cap| Setting { rate, cap, ..BASE });
                let tolerances = [1e-6, 1e-9, 1e-15].map(|tolerance| Setting { rate, tolerance, ..BASE });
                all.extend(caps.into_iter().filter(|setting| rate == 48e3 || [2, 8].contains(&setting.cap)));
                all.extend(tolerances.into_iter().filter(|one| rate == 48e3 || one.tolerance == 1e-9));
            }
            all
        }
        Axis::Exponent => {
            let exponents = [1.0, 2.0, 2.5];
            let of = |exponent| [48e3, 96e3].map(|rate| Setting { rate, exponent: Some(exponent), ..BASE });
            exponents.into_iter().flat_map(of).collect()
        }
    }
}

/// All settings, each once.
pub fn all() -> Vec<Setting> {
    let mut all: Vec<Setting> = Vec::new();
    for setting in Axis::ALL.into_iter().flat_map(settings) {
        if !all.contains(&setting) {
            all.push(setting);
        }
    }
    all
}

/// Those of an axis that are quick to compute and compared in `--quick`.
pub fn quick(axis: Axis) -> Vec<Setting> {
    settings(axis).into_iter().filter(|setting| setting.rate == 48e3 && setting.widest > 4e-3).collect()
}

impl Setting {
    /// Whether it is measured in scenes of a kind.
    pub fn plays(&self, kind: Kind) -> bool {
        let among = |axis: Axis| settings(axis).contains(self);
        match kind {
            Kind::EachOpen => self.rate < 96e3 && among(Axis::Quality),
            Kind::EachBuzzing | Kind::High => {
                among(Axis::String)
                    || self.rate == 48e3 && among(Axis::Quality)
                    || kind == Kind::EachBuzzing && among(Axis::Loss)
                    || among(Axis::Frets) && (kind == Kind::EachBuzzing || self.damping.is_none())
            }
            _ => Axis::ALL
                .into_iter()
                .any(|axis| !matches!(axis, Axis::String | Axis::Loss | Axis::Frets) && among(axis)),
        }
    }

    /// As an instrument takes it.
    pub fn engine(&self) -> EngineSettings {
        EngineSettings {
            sample_rate: self.rate,
            widest_spacing: self.widest,
            stencil: self.stencil,
            max_iterations: self.cap,
            tolerance: self.tolerance,
        }
    }

    /// As a scene says it.
    pub fn solver(&self) -> SolverSettings {
        SolverSettings { max_iterations: self.cap, tolerance: self.tolerance, stencil: self.stencil }
    }

    /// The reference for this setting. At the rate of the reference only damping differs, and is held against none.
    pub fn reference(&self) -> Setting {
        let damping = if self.rate == REFERENCE.rate { Some(0.0) } else { self.damping };
        Setting { exponent: self.exponent, damping, ..REFERENCE }
    }

    /// Its name in the table of an axis.
    pub fn name(&self, axis: Axis) -> String {
        let rate = format!("{} kHz", self.rate / 1e3);
        match axis {
            Axis::Quality => {
                let found = Quality::ALL.into_iter().find(|one| quality(*one, self.rate) == *self);
                format!("`{}`, {rate}", found.map_or("other", Quality::name))
            }
            Axis::Law => {
                format!("{rate}, {}", if self.law == Law::Newton { "Newton" } else { "quadratised" })
            }
            Axis::String => rate,
            Axis::Loss => format!("{} s/m, {rate}", self.damping.unwrap_or(OWN_NECK.damping)),
            Axis::Frets => {
                let loss = if self.damping == Some(0.0) { ", lossless" } else { "" };
                let spacing =
                    if self.widest.is_finite() { format!("{} mm", 1e3 * self.widest) } else { rate };
                format!("{}{loss}, {spacing}", placement_name(self.frets))
            }
            Axis::Grid => format!("{rate}, {}", self.stencil.name()),
            Axis::Solver => format!("{rate}, cap {}, {:e} m", self.cap, self.tolerance),
            Axis::Exponent => format!("{rate}, exponent {}", self.exponent.unwrap_or(OWN_NECK.exponent)),
        }
    }
}
