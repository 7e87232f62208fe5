//! A scene: everything there is to simulate, in SI units, as read from a TOML file.

mod board;
mod check;
mod decay;

pub use board::{BoardHeights, BoardSpec};
pub(crate) use check::MOST_FINGERS;

use serde::de::{Error as _, Unexpected};
use serde::{Deserialize, Deserializer};

use crate::choice::choice;
use crate::curve::{CountOrList, Curve, OneOrEach};
use crate::error::Error;
use crate::gesture::Touch;
use crate::setup::Body;
use crate::times::refuse_times;

/// A whole simulation: strings, what they may hit, what acts on them, what is listened to.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Internal sample rate, Hz, 1e3 to 1e7.
    pub sample_rate: f64,
    /// Length of the simulation, s, 0 to 1e5.
    pub duration: f64,
    /// How the scheme is solved.
    #[serde(default)]
    pub solver: SolverSettings,
    /// The strings, in order.
    pub string: Vec<StringSpec>,
    /// What the strings may hit; without it no contact is modelled.
    pub fretboard: Option<FretboardSpec>,
    /// What the bridge under all strings stands on, heavy enough for all of them; without it the bridge stands still, and strings
    /// do not hear each other.
    pub body: Option<Body>,
    /// Pushes on strings.
    #[serde(default)]
    pub pluck: Vec<PluckSpec>,
    /// Fingers above strings.
    #[serde(default)]
    pub finger: Vec<FingerSpec>,
    /// What is listened to.
    #[serde(default)]
    pub output: OutputSpec,
}

impl Scene {
    /// Reads and checks a scene.
    ///
    /// # Errors
    /// When the text is not TOML, has an unknown key, or a value is outside its range. What depends on
    /// the grid (a string too short for it, a stiffness too high for it) is refused when the scene is
    /// built.
    pub fn from_toml(text: &str) -> Result<Scene, Error> {
        if let Ok(table) = toml::from_str(text) {
            refuse_times(&table)?;
        }
        let scene: Scene = toml::from_str(text).map_err(|error| Error::syntax(&error, text))?;
        scene.check()?;
        Ok(scene)
    }

    /// Number of samples the scene lasts.
    pub fn samples(&self) -> u64 {
        (self.duration * self.sample_rate).round() as u64
    }
}

/// Speed against accuracy.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SolverSettings {
    /// Newton iterations at most in a solution, 0 to 1000; few samples need more than one solution. Passive at every cap, even 0.
    pub max_iterations: usize,
    /// Largest error of a penetration at which the iteration may stop, m, 0 to 1e-3.
    pub tolerance: f64,
    /// Difference operator of the string.
    pub stencil: Stencil,
}

impl SolverSettings {
    /// The most iterations that may be asked for.
    pub const MOST_ITERATIONS: usize = 1000;
    /// The widest tolerance, m.
    pub const WIDEST_TOLERANCE: f64 = 1e-3;
}

impl Default for SolverSettings {
    fn default() -> Self {
        SolverSettings { max_iterations: 50, tolerance: 1e-15, stencil: Stencil::Paper }
    }
}

/// Difference operators of the string; the same energy argument holds for all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stencil {
    /// Five points, as published: second-order accurate.
    Paper,
    /// Five points with the leading dispersion error taken out of the stiffness, at no cost.
    Corrected,
    /// Seven points with the two leading dispersion errors taken out.
    Wide,
}

impl Stencil {
    /// All of them, the published one first.
    pub const ALL: [Self; 3] = [Self::Paper, Self::Corrected, Self::Wide];

    /// Its name in a scene file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Corrected => "corrected",
            Self::Wide => "wide",
        }
    }
}

impl<'de> Deserialize<'de> for Stencil {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use Stencil::{Corrected, Paper, Wide};
        const NAMED: [(&str, Stencil); Stencil::ALL.len()] =
            [(Paper.name(), Paper), (Corrected.name(), Corrected), (Wide.name(), Wide)];
        choice(deserializer, &NAMED)
    }
}

/// One string.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StringSpec {
    /// Length, m, 1e-3 to 1e3.
    pub length: f64,
    /// Mass per length, kg/m, 1e-7 to 1e2.
    pub linear_density: f64,
    /// Tension at rest, N, 1e-3 to 1e6, or its course in time `[[t, T], …]`.
    pub tension: Curve,
    /// Young's modulus of the core, Pa, 0 to 1e13; 0 for an ideal string.
    #[serde(default)]
    pub youngs_modulus: f64,
    /// Radius of the core, m, 0 to 0.1.
    #[serde(default)]
    pub core_radius: f64,
    /// Loss of all frequencies alike, 1/s, 0 to 1e4; 0 if neither this nor `t60` is given. (What the string has in the end is
    /// told by [`StringSpec::losses`].)
    pub loss_0: Option<f64>,
    /// Loss that grows with frequency, m²/s, 0 to 1e2; 0 if neither this nor `t60` is given.
    pub loss_1: Option<f64>,
    /// Instead of both losses, how long the string takes to fall by 60 dB at two frequencies, `[[Hz, s], [Hz, s]]`: frequencies of
    /// 1e-3 to 1e6 Hz, the second above the first; the first time 1e-3 to 1e9 s, the second no longer, and no shorter than
    /// losses in their ranges allow.
    #[serde(default, deserialize_with = "decay::at_two")]
    pub t60: Option<[[f64; 2]; 2]>,
    /// Whether stretching raises the tension.
    #[serde(default)]
    pub tension_modulation: bool,
    /// Initial displacement `[[x, u], …]`, m, −1 to 1, at places on the string; without it the string begins at 0.
    #[serde(default, deserialize_with = "crate::curve::pairs")]
    pub shape: Option<Vec<[f64; 2]>>,
    /// Initial velocity `[[x, v], …]`, m/s, −1e3 to 1e3, up is positive, at places on the string; without it the string begins at
    /// rest.
    #[serde(default, deserialize_with = "crate::curve::pairs")]
    pub velocity: Option<Vec<[f64; 2]>>,
}

/// Board and frets under all strings.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FretboardSpec {
    /// Contact stiffness of a point, N/m^exponent, 1e-3 to 1e30, and no more than can be told from rounding at the scene's rate.
    pub stiffness: f64,
    /// Exponent of the contact law, 1 to 5.
    pub exponent: f64,
    /// Hunt–Crossley damping, s/m, 0 to 1e5.
    #[serde(default)]
    pub damping: f64,
    /// Height of the board, m, −10 to 0, its profile `[[x, height], …]` (no board beyond its ends), or three heights that it is a
    /// parabola through; without it there is no back board.
    pub board: Option<BoardSpec>,
    /// Number of frets in equal temperament, 0 to 640, or their places, up to 1000, m from the nut, on every string.
    #[serde(default = "no_frets")]
    pub frets: CountOrList,
    /// Height of the crowns, m, −10 to 0, or one per fret; needed where there are frets.
    pub fret_top: Option<OneOrEach>,
    /// Where frets act on the grid.
    #[serde(default)]
    pub fret_placement: FretPlacement,
    /// Spacing for which `stiffness` holds, m, 1e-6 to 1e3: board points of another spacing h get stiffness·h/this.
    pub board_reference_spacing: Option<f64>,
}

fn no_frets() -> CountOrList {
    CountOrList::Count(0)
}

/// Where frets act on the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FretPlacement {
    /// At their places, by interpolation.
    #[default]
    Exact,
    /// At the nearest grid points.
    Nearest,
    /// At their places, and the string bends round them as it would if the grid had room for a kink: as exact on coarse
    /// grids as the others are on fine ones.
    Kinked,
}

impl<'de> Deserialize<'de> for FretPlacement {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use FretPlacement::{Exact, Kinked, Nearest};
        choice(deserializer, &[("exact", Exact), ("nearest", Nearest), ("kinked", Kinked)])
    }
}

/// A push that grows as a raised cosine (`docs/physics.md`, section 1), and lets go at once or as it grew.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PluckSpec {
    /// Which string, 1 for the first, up to the number of strings.
    #[serde(default = "first", deserialize_with = "number")]
    pub string: usize,
    /// When it begins, s, 0 to 1e9.
    #[serde(default)]
    pub start: f64,
    /// How long it grows, s, 0 to 1e9.
    pub duration: f64,
    /// How long it takes to let go after that, s, 0 to 1e9; 0 is at once.
    #[serde(default)]
    pub release: f64,
    /// Where, m from the nut, strictly between the ends of the string.
    pub position: f64,
    /// Largest force, N, −1e6 to 1e6, up is positive.
    pub force: f64,
}

fn first() -> usize {
    1
}

/// Reads what is counted from 1. (How far it may go, and that it is not 0, is for who knows how many there are.)
fn number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
    let number = i64::deserialize(deserializer)?;
    let counted = "a whole number, 1 or more";
    usize::try_from(number).map_err(|_| D::Error::invalid_value(Unexpected::Signed(number), &counted))
}

/// A finger above a string.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FingerSpec {
    /// Which string, 1 for the first, up to the number of strings.
    #[serde(default = "first", deserialize_with = "number")]
    pub string: usize,
    /// Mass, kg, 1e-7 to 1e3.
    pub mass: f64,
    /// Stiffness of the pad, N/m^exponent, 1e-3 to 1e30, and no more than can be told from rounding at the scene's rate.
    pub stiffness: f64,
    /// Exponent of the pad's law, 1 to 5.
    pub exponent: f64,
    /// Hunt–Crossley damping, s/m, 0 to 1e5.
    #[serde(default)]
    pub damping: f64,
    /// The hand's own damping, N s/m, 0 to 1e5.
    #[serde(default)]
    pub hand_damping: f64,
    /// Place, m from the nut, strictly between the ends of the string, or its course in time.
    pub position: Curve,
    /// Initial height of the pad, m, −10 to 10.
    #[serde(default)]
    pub height: f64,
    /// Initial velocity, m/s, −1e3 to 1e3, up is positive.
    #[serde(default)]
    pub velocity: f64,
    /// Force, N downward, −1e6 to 1e6, or its course in time.
    #[serde(default = "no_force")]
    pub force: Curve,
}

impl FingerSpec {
    /// The finger as a mass on a lossy spring.
    pub fn touch(&self) -> Touch {
        Touch {
            mass: self.mass,
            stiffness: self.stiffness,
            exponent: self.exponent,
            damping: self.damping,
            hand_damping: self.hand_damping,
        }
    }
}

fn no_force() -> Curve {
    Curve::Constant(0.0)
}

/// What is listened to.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputSpec {
    /// A point whose velocity is heard, m from the nut, `"bridge"` for the force on the bridge, or `"air"` for the sound before the
    /// body, which there must be then.
    #[serde(default)]
    pub position: ListeningPoint,
}

/// A point of the string, the bridge, or the air.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ListeningPoint {
    /// The transverse force of the string on the bridge, N.
    #[default]
    Bridge,
    /// The velocity of the string at a place, m from the nut, in m/s.
    At(f64),
    /// The sound pressure 1 m in front of the body, Pa.
    Air,
}

impl<'de> Deserialize<'de> for ListeningPoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct PointVisitor;
        impl serde::de::Visitor<'_> for PointVisitor {
            type Value = ListeningPoint;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a place in m from the nut, \"bridge\" or \"air\"")
            }
            fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<ListeningPoint, E> {
                Ok(ListeningPoint::At(value))
            }
            fn visit_i64<E: serde::de::Error>(self, value: i64) -> Result<ListeningPoint, E> {
                Ok(ListeningPoint::At(value as f64))
            }
            fn visit_str<E: serde::de::Error>(self, value: &str) -> Result<ListeningPoint, E> {
                match value {
                    "bridge" => Ok(ListeningPoint::Bridge),
                    "air" => Ok(ListeningPoint::Air),
                    _ => Err(E::invalid_value(serde::de::Unexpected::Str(value), &self)),
                }
            }
        }
        deserializer.deserialize_any(PointVisitor)
    }
}
