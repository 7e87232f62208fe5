//! What an instrument is heard by.

use serde::{Deserialize, Serialize};

use super::on_scale;
use crate::digits::plain;
use crate::error::{Error, within};

/// What is heard of the strings.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Pickup {
    /// A coil over the strings: their velocity at a place, through the coil's own resonance.
    Magnetic {
        /// Middle of the coil, m from the saddle, strictly between the ends of the string.
        position: f64,
        /// Width of its field along the string, m, 0 for a point and up, and within the string.
        aperture: f64,
        /// Resonance of coil and cable, Hz, 100 to 1e6.
        resonance: f64,
        /// Height of that resonance over low frequencies, as a factor, 0.1 to 100.
        quality: f64,
    },
    /// The force of the strings on the bridge. (With braces, since
    /// keys that do not belong there are only looked for where there could be some.)
    Bridge {},
    /// The sound pressure 1 m in front of the [body](super::Setup::body), without a room.
    Microphone {},
}

impl Pickup {
    /// Refuses values outside their range on an instrument of such a scale, m, and a microphone where there is no body.
    pub(super) fn check(&self, scale: f64, has_body: bool) -> Result<(), Error> {
        match *self {
            Pickup::Microphone {} if !has_body => {
                Err(Error::range("pickup.kind", "\"microphone\"", "there must be a [body] to be heard"))
            }
            Pickup::Bridge {} | Pickup::Microphone {} => Ok(()),
            Pickup::Magnetic { position, aperture, resonance, quality } => {
                within("pickup.resonance", resonance, 100.0, 1e6, "Hz")?;
                within("pickup.quality", quality, 0.1, 100.0, "")?;
                within("pickup.aperture", aperture, 0.0, scale, "m")?;
                on_scale("pickup.position", position, scale)?;
                if aperture / 2.0 < position.min(scale - position) {
                    return Ok(());
                }
                let accepted = format!("half of it must stay on the string around {} m", plain(position));
                Err(Error::range("pickup.aperture", plain(aperture), accepted))
            }
        }
    }
}
