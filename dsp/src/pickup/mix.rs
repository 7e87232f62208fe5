//! Which pickups are over a string, and how much of each is heard.

use crate::model::StringParameters;
use crate::setup::{Pickup, Setup};

/// The pickups of a set-up over one string, and how much of each is heard.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PickupMix {
    /// The set-up's own and the other kind, each with its share of the sound.
    pub(super) parts: [(Pickup, f64); 2],
    /// Where a wide bridge begins, m from the nut.
    pub(super) bridge: f64,
}

/// A coil over strings of any scale.
struct Coil {
    /// Its middle, m from the saddle, as a part of the scale.
    place: f64,
    /// Width of its field along the string, m.
    aperture: f64,
    /// Resonance, Hz.
    resonance: f64,
    /// Height of that over low frequencies, as a factor.
    quality: f64,
}

/// The coil that is mixed to the force on the bridge: a single coil a quarter of the string from the saddle,
/// where guitars have the neck pickup.
const COIL: Coil = Coil { place: 0.25, aperture: 0.02, resonance: 4500.0, quality: 2.0 };

impl PickupMix {
    /// The pickups over a string of a set-up. The velocity at a coil and the force on the bridge are
    /// brought to one scale by the string's wave impedance √(Tρ), the sound of a body by what it makes of a newton.
    pub fn of(setup: &Setup, string: &StringParameters) -> Self {
        let impedance = (string.tension * string.linear_density).sqrt();
        let Coil { place, aperture, resonance, quality } = COIL;
        let position = place * setup.neck.scale_length;
        let (other, scale) = match setup.pickup {
            Pickup::Magnetic { .. } => (Pickup::Bridge {}, 1.0 / impedance),
            Pickup::Bridge {} => (Pickup::Magnetic { position, aperture, resonance, quality }, impedance),
            Pickup::Microphone {} => {
                let pascals = setup.body.map_or(0.0, |body| body.pascals_per_newton());
                (Pickup::Magnetic { position, aperture, resonance, quality }, impedance * pascals)
            }
        };
        let wide = setup.bridge.as_ref().map_or(0.0, |bridge| bridge.length);
        let parts = [(setup.pickup, 1.0 - setup.blend), (other, setup.blend * scale)];
        PickupMix { parts, bridge: if wide > 0.0 { setup.neck.scale_length - wide } else { f64::INFINITY } }
    }
}
