//! A set-up: one instrument as a luthier and a player would describe it, read from a TOML file.
//!
//! It says nothing about grids or sample rates; [`intonate`](crate::intonation::intonate) and
//! [`Neck::barrier`] turn it into numbers for the model.

mod body;
mod bridge;
mod pickup;
mod player;
mod string;

use serde::{Deserialize, Serialize};

use crate::choice::choice;
use crate::curve::Curve;
use crate::digits::plain;
use crate::error::{Error, limited, ranged, within};
use crate::intonation::Behind;
use crate::model::{Barrier, StringParameters};
use crate::neck::Neck;
use crate::preset::names;
pub use body::Body;
pub(crate) use body::Mode;
pub use bridge::Bridge;
pub use pickup::Pickup;
pub use player::{Damper, Fretting, Player};
pub use string::SetupString;

/// A whole instrument.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Setup {
    /// Short name, not empty and not blank; nothing else is asked of it.
    pub name: String,
    /// What it is, one line.
    #[serde(default)]
    pub description: String,
    /// Whether it is made to play in tune.
    #[serde(default)]
    pub intonation: Intonation,
    /// Largest bend by tension, semitones, 0 to 12; the grids leave room for it, and for half a semitone in any case.
    pub max_bend: f64,
    /// Output per unit of pickup signal, 1e-9 to 1e9.
    pub gain: f64,
    /// How much higher everything sounds than written, semitones, −12 to 12: another concert pitch.
    #[serde(default)]
    pub tuning: f64,
    /// Whether stretching raises the tension of the strings.
    #[serde(default = "yes")]
    pub tension_modulation: bool,
    /// How much of the sound is heard by a pickup of the other kind, 0 to 1: the force on the bridge beside
    /// a coil, or a coil beside bridge or microphone.
    #[serde(default)]
    pub blend: f64,
    /// Frets and board.
    pub neck: Neck,
    /// A bridge over which the strings wrap; none means that they end at an edge.
    #[serde(default)]
    pub bridge: Option<Bridge>,
    /// What the bridge stands on, if it gives way; none, or `false` in a file, means that it does not.
    #[serde(default, deserialize_with = "body::or_none")]
    pub body: Option<Body>,
    /// The player's hands.
    pub player: Player,
    /// What is heard.
    pub pickup: Pickup,
    /// The strings, highest first.
    pub string: Vec<SetupString>,
}

/// Whether an instrument is made to play in tune.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Intonation {
    /// Tension and fret places are solved so that open and fretted strings are in tune.
    #[default]
    Compensated,
    /// Frets stand in equal temperament and only the open string is tuned: stopped notes are as sharp
    /// as pressing makes them.
    Physical,
}

impl<'de> Deserialize<'de> for Intonation {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        use Intonation::{Compensated, Physical};
        choice(deserializer, &[("compensated", Compensated), ("physical", Physical)])
    }
}

fn yes() -> bool {
    true
}

/// The built-in set-ups: name and file.
pub(crate) const FILES: [(&str, &str); 4] = [
    ("electric", include_str!("../instruments/electric.toml")),
    ("classical", include_str!("../instruments/classical.toml")),
    ("steel", include_str!("../instruments/steel.toml")),
    ("bass", include_str!("../instruments/bass.toml")),
];

/// No finger presses a string down to a fret that is farther below it, m: high actions of guitars and basses are 4 mm.
const OUT_OF_REACH: f64 = 6e-3;

/// The most strings an instrument may have.
pub const MOST_STRINGS: usize = 32;

/// What the numbers may be that a luthier can change on an instrument that is made: semitones, a part and a MIDI note number.
/// (Losses are as those of any [string](StringParameters::LOSS_0).)
const TUNING: [f64; 2] = [-12.0, 12.0];
const BLEND: [f64; 2] = [0.0, 1.0];
const PITCH: [f64; 2] = [0.0, 127.0];

impl Setup {
    /// Names of the built-in set-ups; the first is the default.
    pub const BUILTIN: [&'static str; FILES.len()] = names(&[&FILES]);

    /// A built-in set-up by its name.
    pub fn builtin(name: &str) -> Option<Setup> {
        let (_, text) = FILES.iter().find(|(known, _)| *known == name)?;
        Some(Setup::from_toml(text).expect("the files in instruments/ are read by the tests"))
    }

    /// Reads and checks a set-up.
    ///
    /// # Errors
    /// When the text is not TOML, has an unknown key, lacks one, names a set-up to be based on that is not
    /// built in, or a value is outside its range. What
    /// depends on the grid is refused when the instrument is built.
    pub fn from_toml(text: &str) -> Result<Setup, Error> {
        let base = |name: &str| {
            let found = FILES.iter().find(|(known, _)| *known == name);
            found.map(|(_, text)| *text).ok_or_else(|| {
                let [others @ .., last] = Self::BUILTIN;
                let accepted = format!("a set-up can only be based on {} or {last}", others.join(", "));
                Error::text("based_on", name, accepted)
            })
        };
        let setup: Setup = crate::preset::read(text, base)?;
        setup.check()?;
        Ok(setup)
    }

    /// The text of a set-up file that says all of this; [`Setup::from_toml`] reads the same numbers out of it.
    ///
    /// # Errors
    /// When a number is none that TOML has.
    pub fn to_toml(&self) -> Result<String, Error> {
        toml::to_string(self).map_err(|error| Error::Syntax(error.to_string()))
    }

    /// Brings what a luthier can change on an instrument that is made (heights and relief of the neck, losses, tuning, and
    /// what is heard of the other pickup), but for the place of the coil, back to what a set-up may have.
    pub fn limit(&mut self) {
        self.neck.limit();
        let idle = (&mut self.player.idle_loss, player::IDLE_LOSS);
        let alike = [(&mut self.tuning, TUNING), (&mut self.blend, BLEND), idle];
        let of_strings = self.string.iter_mut().flat_map(|SetupString { pitch, loss_0, loss_1, .. }| {
            [(pitch, PITCH), (loss_0, StringParameters::LOSS_0), (loss_1, StringParameters::LOSS_1)]
        });
        for (value, range) in alike.into_iter().chain(of_strings) {
            *value = limited(*value, range);
        }
    }

    /// Refuses every value outside its range, naming it as in the file.
    ///
    /// # Errors
    /// At the first of them.
    pub fn check(&self) -> Result<(), Error> {
        if self.name.trim().is_empty() {
            return Err(Error::range("name", format!("{:?}", self.name), "it must not be blank"));
        }
        within("max_bend", self.max_bend, 0.0, 12.0, "semitones")?;
        within("gain", self.gain, 1e-9, 1e9, "")?;
        ranged("tuning", self.tuning, TUNING, "semitones")?;
        ranged("blend", self.blend, BLEND, "")?;
        self.neck.check()?;
        if let Some(bridge) = self.bridge {
            bridge.check(&self.neck)?;
        }
        if let Some(body) = self.body {
            body.check()?;
            if self.bridge.is_some() {
                return Err(Error::range(
                    "body",
                    "a table",
                    "there must be none beside a wide [bridge], which stands still",
                ));
            }
        }
        self.player.check(self.neck.scale_length)?;
        self.pickup.check(self.neck.scale_length, self.body.is_some())?;
        if self.string.is_empty() || self.string.len() > MOST_STRINGS {
            let accepted = format!("there must be 1 to {MOST_STRINGS} strings");
            return Err(Error::range("[[string]]", self.string.len(), accepted));
        }
        for (i, string) in self.string.iter().enumerate() {
            string.check(&format!("string[{}]", i + 1))?;
        }
        Ok(())
    }

    /// Whether something hard may touch strings elsewhere than at frets: a wide bridge, or a bar where the frets of the middle are
    /// out of reach. (Those near the nut may be within it, so that a bar is laid there only where it is asked for.)
    pub(crate) fn is_touched_between_frets(&self) -> bool {
        self.bridge.is_some() || self.neck.action > OUT_OF_REACH
    }

    /// Whether its nut lifts the strings out of the reach of fingers, all along the neck: such an instrument is played with a bar.
    pub fn wants_bar(&self) -> bool {
        !self.neck.fretless && self.neck.nut_clearance > OUT_OF_REACH
    }

    /// The barrier under a string whose frets stand at `frets` (m from the nut): frets, board and bridge.
    ///
    /// # Errors
    /// When the contact law is out of range.
    pub fn barrier(&self, frets: &[f64]) -> Result<Barrier, Error> {
        let mut barrier = self.neck.barrier(frets)?;
        if let (Some(bridge), Some(Curve::Points(board))) = (&self.bridge, &mut barrier.board) {
            board.extend(bridge.outline(&self.neck));
        }
        Ok(barrier)
    }

    /// How far behind its fret a finger presses: not at all where there are no frets.
    pub fn behind(&self) -> Behind {
        if self.neck.fretless {
            return Behind { part: 0.0, nearest: 0.0 };
        }
        Behind { part: self.player.fretting.behind, nearest: self.player.fretting.nearest }
    }

    /// The largest factor by which a bend may raise the tension of a string.
    pub fn highest_tension_ratio(&self) -> f64 {
        tension_ratio(self.max_bend)
    }

    /// How fast a partial (1 for the lowest, or between two) of an open string dies away, 1/s: by [its own
    /// losses](SetupString::decay) and by what the body takes up, 2f₁Z Re Y to first order, Z = √(Tρ) = 2Lf₁ρ its wave impedance;
    /// 0 without either.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn decay(&self, string: usize, partial: f64) -> f64 {
        let (spec, length) = (&self.string[string], self.neck.scale_length);
        let fundamental = frequency(spec.pitch + self.tuning);
        let taken = self.body.map_or(0.0, |body| body.takes_up(partial * fundamental));
        spec.decay(length, partial) + 4.0 * length * spec.linear_density * fundamental * fundamental * taken
    }

    /// The factor up to which the grid of a string bears a higher tension: bends, and in any case what fingers and plucks stretch.
    pub(crate) fn tension_room(&self) -> f64 {
        // (A body takes a part of its own.)
        tension_ratio(self.max_bend.max(LEAST_ROOM)) * crate::body::room(self.body.is_some())
    }
}

/// What a grid has room for where strings may not be bent so far, semitones.
const LEAST_ROOM: f64 = 0.5;

/// The factor of tension that raises a string by so many semitones: pitch goes with its root.
pub fn tension_ratio(semitones: f64) -> f64 {
    libm::exp2(semitones / 6.0)
}

/// The frequency of a MIDI note number, Hz: 69 is 440 Hz.
pub fn frequency(pitch: f64) -> f64 {
    440.0 * libm::exp2((pitch - 69.0) / 12.0)
}

/// Refuses a place, m from the saddle, that is not strictly between the ends of the scale.
fn on_scale(name: &str, place: f64, scale: f64) -> Result<(), Error> {
    if place.is_finite() && place > 0.0 && place < scale {
        return Ok(());
    }
    let accepted = format!("it must lie above 0 and below {} m from the saddle", plain(scale));
    Err(Error::range(name, plain(place), accepted))
}
