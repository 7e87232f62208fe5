//! The player's part of a set-up: how the hands of this instrument act.

use serde::{Deserialize, Serialize};

use super::on_scale;
use crate::error::{Error, limited, ranged, within};
use crate::gesture::Touch;

/// How the hands act.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Player {
    /// Where strings are plucked, m from the saddle, strictly between the ends of the string.
    pub pluck_position: f64,
    /// How long a pluck pushes, s, 1e-4 to 0.1.
    pub pluck_duration: f64,
    /// How long it takes to let go after that at velocity 127, s, 0 to 0.1, and up to four times as long the softer; 0 is at once.
    #[serde(default)]
    pub pluck_release: f64,
    /// Largest force of a pluck at velocity 127, N, 1e-3 to 1e3.
    pub pluck_force: f64,
    /// What hands that lie on strings nobody plays add to their loss, 1/s, 0 to 1000, where strings hear each other through a body: 0
    /// leaves them free to sing along. At a bridge that stands still such strings are silent, and nothing is done to them.
    #[serde(default = "usual_idle_loss")]
    pub idle_loss: f64,
    /// The finger that stops a string.
    pub fretting: Fretting,
    /// The finger or palm that silences a string.
    pub damper: Damper,
}

/// A finger that presses a string behind a fret.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize)]
#[serde(from = "FrettingFile", into = "FrettingFile")]
pub struct Fretting {
    /// The finger.
    pub touch: Touch,
    /// Force at rest on the string, N, 0.1 to 100.
    pub force: f64,
    /// Height above the string from which it comes, m, 0 to 0.1.
    pub hover: f64,
    /// Time over which its force rises, s, 0 to 1.
    pub landing: f64,
    /// Where it presses: this fraction of the fret's own space behind the crown, 0.05 to 0.95.
    pub behind: f64,
    /// It presses at least so far behind the crown, m, 0 to 0.03, where there is room for that.
    pub nearest: f64,
}

/// A finger or palm that rests on a string to silence it.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize)]
#[serde(from = "DamperFile", into = "DamperFile")]
pub struct Damper {
    /// The finger or palm.
    pub touch: Touch,
    /// Force at rest on the string, N, 1e-3 to 100.
    pub force: f64,
    /// Time over which its force rises, s, 0 to 1.
    pub landing: f64,
    /// The place farthest from the saddle that it touches, m from the saddle, strictly between the ends of the string.
    pub position: f64,
}

/// What the numbers may be that a player can also change while playing: s, s, N, N and m.
const PLUCK_DURATION: [f64; 2] = [1e-4, 0.1];
const PLUCK_RELEASE: [f64; 2] = [0.0, 0.1];
const PLUCK_FORCE: [f64; 2] = [1e-3, 1e3];
const FRETTING_FORCE: [f64; 2] = [0.1, 100.0];
const HOVER: [f64; 2] = [0.0, 0.1];

/// What hands may take of strings that nobody plays, 1/s.
pub(super) const IDLE_LOSS: [f64; 2] = [0.0, 1000.0];

/// What they take where nothing else is said, 1/s: what such strings hear of others fades by 20 dB in 0.4 s.
fn usual_idle_loss() -> f64 {
    6.0
}

impl Player {
    /// Brings what a player can change while playing, but for the place of the pluck, back to what a set-up may have.
    pub fn limit(&mut self) {
        let Fretting { touch, force, hover, .. } = &mut self.fretting;
        for (value, range) in [
            (&mut self.pluck_duration, PLUCK_DURATION),
            (&mut self.pluck_release, PLUCK_RELEASE),
            (&mut self.pluck_force, PLUCK_FORCE),
            (force, FRETTING_FORCE),
            (hover, HOVER),
        ] {
            *value = limited(*value, range);
        }
        touch.limit();
    }

    pub(super) fn check(&self, scale: f64) -> Result<(), Error> {
        on_scale("player.pluck_position", self.pluck_position, scale)?;
        ranged("player.pluck_duration", self.pluck_duration, PLUCK_DURATION, "s")?;
        ranged("player.pluck_release", self.pluck_release, PLUCK_RELEASE, "s")?;
        ranged("player.pluck_force", self.pluck_force, PLUCK_FORCE, "N")?;
        ranged("player.idle_loss", self.idle_loss, IDLE_LOSS, "1/s")?;
        let Fretting { touch, force, hover, landing, behind, nearest } = &self.fretting;
        touch.check("player.fretting")?;
        ranged("player.fretting.force", *force, FRETTING_FORCE, "N")?;
        ranged("player.fretting.hover", *hover, HOVER, "m")?;
        within("player.fretting.landing", *landing, 0.0, 1.0, "s")?;
        within("player.fretting.behind", *behind, 0.05, 0.95, "of the fret's space")?;
        within("player.fretting.nearest", *nearest, 0.0, 0.03, "m")?;
        let Damper { touch, force, landing, position } = &self.damper;
        touch.check("player.damper")?;
        within("player.damper.force", *force, 1e-3, 100.0, "N")?;
        within("player.damper.landing", *landing, 0.0, 1.0, "s")?;
        on_scale("player.damper.position", *position, scale)
    }
}

// Both fingers have the keys of a touch beside their own. Serde can lay one table into another only where unknown
// keys are let pass, so both lists are written out.

/// `[player.fretting]` as it stands in the file.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct FrettingFile {
    mass: f64,
    stiffness: f64,
    exponent: f64,
    damping: f64,
    hand_damping: f64,
    force: f64,
    hover: f64,
    landing: f64,
    behind: f64,
    #[serde(default)]
    nearest: f64,
}

impl From<FrettingFile> for Fretting {
    fn from(file: FrettingFile) -> Self {
        let FrettingFile { mass, stiffness, exponent, damping, hand_damping, .. } = file;
        Fretting {
            touch: Touch { mass, stiffness, exponent, damping, hand_damping },
            force: file.force,
            hover: file.hover,
            landing: file.landing,
            behind: file.behind,
            nearest: file.nearest,
        }
    }
}

impl From<Fretting> for FrettingFile {
    fn from(fretting: Fretting) -> Self {
        let Fretting { touch, force, hover, landing, behind, nearest } = fretting;
        let Touch { mass, stiffness, exponent, damping, hand_damping } = touch;
        Self { mass, stiffness, exponent, damping, hand_damping, force, hover, landing, behind, nearest }
    }
}

/// `[player.damper]` as it stands in the file.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct DamperFile {
    mass: f64,
    stiffness: f64,
    exponent: f64,
    damping: f64,
    hand_damping: f64,
    force: f64,
    landing: f64,
    position: f64,
}

impl From<DamperFile> for Damper {
    fn from(file: DamperFile) -> Self {
        let DamperFile { mass, stiffness, exponent, damping, hand_damping, .. } = file;
        Damper {
            touch: Touch { mass, stiffness, exponent, damping, hand_damping },
            force: file.force,
            landing: file.landing,
            position: file.position,
        }
    }
}

impl From<Damper> for DamperFile {
    fn from(damper: Damper) -> Self {
        let Damper { touch, force, landing, position } = damper;
        let Touch { mass, stiffness, exponent, damping, hand_damping } = touch;
        Self { mass, stiffness, exponent, damping, hand_damping, force, landing, position }
    }
}
