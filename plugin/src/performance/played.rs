//! What a player knows of a string before touching it.

use low_action_dsp::intonation::Laid;
use low_action_dsp::setup::{Pickup, Setup, frequency};
use low_action_dsp::{Instrument, StringGeometry};

use super::technique::{BAR, BAR_SHARE, BAR_WEIGHT, HOLDING};

/// What the player knows of one string.
#[derive(Debug, Clone, PartialEq)]
pub struct PlayedString {
    /// Its pitch, its length and its frets.
    pub geometry: StringGeometry,
    /// Its tension at rest, N.
    pub tension: f64,
    /// How far a finger has to press it down until it touches the fret, m, fret 1 first.
    pub depths: Vec<f64>,
    /// Force of a fretting finger from which on the string lies on a fret, N, fret 1 first.
    pub stopping_forces: Vec<f64>,
    /// Where a bar lies over a fret for its note to be in tune, m from the nut, fret 1 first.
    pub bar_places: Vec<f64>,
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
        let tension = geometry.wave_impedance * geometry.wave_impedance / setup.string[index].linear_density;
        // The string hangs from nut and saddle in two straight lines that meet under the finger, so deep that it just touches
        // the crown.
        let depth = |(fret, &crown): (usize, &f64)| {
            let beyond = geometry.length - geometry.finger_position(fret + 1);
            -setup.neck.crown_height(crown) * beyond / (geometry.length - crown)
        };
        let depths: Vec<f64> = geometry.frets.iter().enumerate().map(depth).collect();
        // Beyond the finger it goes straight to the saddle. In front of it, straight to what it hangs from there: the nut, or a
        // fret, mostly the one behind the finger, over which it is bent the more the nearer that is. (Not on a bare board, where the
        // finger itself ends it.)
        let stopping = |(fret, &depth): (usize, &f64)| {
            let place = geometry.finger_position(fret + 1);
            let before = |&crown: &f64| (depth + setup.neck.crown_height(crown)) / (place - crown);
            let behind = &geometry.frets[..if setup.neck.fretless { 0 } else { fret }];
            let steepest = behind.iter().map(before).fold(depth / place, f64::max);
            tension * (steepest + depth / (geometry.length - place)).max(0.0)
        };
        let stopping_forces = depths.iter().enumerate().map(stopping).collect();
        let coil = match setup.pickup {
            Pickup::Magnetic { position, .. } if setup.blend < 0.5 => Some(position),
            _ => None,
        };
        let (fretless, barred) = (setup.neck.fretless, setup.wants_bar());
        let mut string = Self {
            geometry,
            tension,
            depths,
            stopping_forces,
            bar_places: Vec::new(),
            fretless,
            barred,
            coil,
        };
        let laid = Laid::new(instrument.model(index));
        let open = string.geometry.open_pitch + setup.tuning;
        let bar_place = |fret: usize| laid.place(&BAR, string.bar_force(fret), frequency(open + fret as f64));
        string.bar_places = (1..=string.geometry.frets.len()).map(bar_place).collect();
        string
    }

    /// How far a finger has to press the string down until it touches a fret, m; 0 for the open string.
    pub fn depth(&self, fret: usize) -> f64 {
        of_fret(&self.depths, fret)
    }

    /// Force of a fretting finger from which on the string lies on a fret, N, while other frets carry it behind the finger; 0 for
    /// the open string.
    pub fn stopping_force(&self, fret: usize) -> f64 {
        of_fret(&self.stopping_forces, fret)
    }

    /// Force of a fretting finger under which the string leaves a fret, N, if it hangs from nothing but nut and saddle; 0 for the
    /// open string.
    pub fn leaving_force(&self, fret: usize) -> f64 {
        let depth = self.depth(fret);
        if depth > 0.0 { self.pull(depth, 0, fret) } else { 0.0 }
    }

    /// What a finger's or a capo's force, N, becomes at a fret of a string that is pulled to so many times its own tension, or to less:
    /// more if it would leave the fret, but no more than keeps up with the tension, so that a string too lightly held still is.
    pub fn held_pulled(&self, force: f64, fret: usize, tightened: f64) -> f64 {
        let tightened = tightened.max(1.0);
        (HOLDING * tightened * self.stopping_force(fret)).clamp(force, force * tightened)
    }

    /// Where a bar lies over a fret, m from the nut; 0 for the open string.
    pub fn bar_place(&self, fret: usize) -> f64 {
        of_fret(&self.bar_places, fret)
    }

    /// What a bar presses the string with over a fret, N: its weight, or less where the string would touch the fret.
    pub fn bar_force(&self, fret: usize) -> f64 {
        (BAR_SHARE * self.leaving_force(fret)).min(BAR_WEIGHT)
    }

    /// What pulls a finger back that has pressed the string down behind one fret by so much, m, while another (0 for the nut)
    /// stops it, N.
    pub(crate) fn pull(&self, depth: f64, stopped: usize, fret: usize) -> f64 {
        let place = self.geometry.finger_position(fret);
        let near = place - self.geometry.finger_position(stopped);
        self.stiffness(near, self.geometry.length - place) * depth
    }

    /// How stiff the string is at a place with so much of it on either side, m, in N/m.
    pub(crate) fn stiffness(&self, near: f64, beyond: f64) -> f64 {
        self.tension * (1.0 / near + 1.0 / beyond)
    }
}

/// What is known of a fret, fret 1 first; 0 for the open string.
fn of_fret(values: &[f64], fret: usize) -> f64 {
    fret.checked_sub(1).and_then(|index| values.get(index)).copied().unwrap_or(0.0)
}
