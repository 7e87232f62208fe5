//! What a player knows of a string before touching it.

use low_action_dsp::setup::{Pickup, Setup};
use low_action_dsp::{Instrument, StringGeometry};

/// What the player knows of one string.
#[derive(Debug, Clone, PartialEq)]
pub struct PlayedString {
    /// Its pitch, its length and its frets.
    pub geometry: StringGeometry,
    /// Force of a fretting finger under which the string leaves the fret, N, fret 1 first.
    pub leaving_forces: Vec<f64>,
    /// Whether fingers stop it on a bare board.
    pub fretless: bool,
    /// Whether it is so high that it is stopped by a bar unless something else is asked for.
    pub barred: bool,
    /// Where a coil hears it, m from the saddle, if that is what hears it.
    pub coil: Option<f64>,
}

impl PlayedString {
    /// What there is to know of string `index` of an instrument built from a set-up.
    pub fn new(setup: &Setup, instrument: &Instrument, index: usize) -> Self {
        let geometry = instrument.geometry(index).clone();
        // Z² = Tρ.
        let tension = geometry.wave_impedance.powi(2) / setup.string[index].linear_density;
        let leaving_force = |(fret, &crown): (usize, &f64)| {
            // The string hangs from nut and saddle in two straight lines that meet under the finger,
            // so deep that it just touches the crown.
            let finger = geometry.finger_position(fret + 1);
            let beyond = geometry.length - finger;
            let depth = -setup.neck.crown_height(crown) * beyond / (geometry.length - crown);
            tension * depth * (1.0 / finger + 1.0 / beyond)
        };
        let leaving_forces = geometry.frets.iter().enumerate().map(leaving_force).collect();
        let coil = match setup.pickup {
            Pickup::Magnetic { position, .. } if setup.blend < 0.5 => Some(position),
            _ => None,
        };
        let (fretless, barred) = (setup.neck.fretless, setup.wants_bar());
        Self { geometry, leaving_forces, fretless, barred, coil }
    }
}
