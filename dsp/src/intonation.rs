//! Intonation: strings that play in tune on their own grid, by geometry and tension alone.
//!
//! Pressing a string behind a fret stretches it, the stretch raises its tension, and the note comes
//! out sharp; a coarse grid adds errors of its own. A luthier moves nut and saddle; here the place of
//! every fret under every string is solved for, as on fingerboards with curved frets, and the tension
//! for the open string. Nothing is corrected while a note sounds: a finger between frets, a slide and
//! a bent note find the same neck.
//!
//! A note's pitch is found without playing it: the string's rest under the finger (`equilibrium`),
//! then the frequency of the lowest oscillation about it (`mode`), both with the very matrices the
//! scheme steps through.

mod equilibrium;
mod finger;
mod laid;
mod mode;
mod placing;
mod sounding;

use crate::curve::Curve;
use crate::digits::plain;
use crate::error::Error;
use crate::grid::Reading;
use crate::model::{Model, StringParameters};
use crate::neck::Neck;
use crate::scene::{SolverSettings, Stencil};
use crate::setup::{Fretting, Intonation, Setup, SetupString, frequency};
use equilibrium::Equilibrium;
pub use finger::{Behind, finger_place, finger_position};
pub use laid::Laid;
use mode::{Resting, open_frequency, stopped_frequency};
pub use sounding::{Pressed, Sounding};

/// A string ready to be modelled.
#[derive(Debug, Clone, PartialEq)]
pub struct Intonated {
    /// The string with its tension, and the tension it may be bent to.
    pub string: StringParameters,
    /// Places of the frets under this string, m from the nut, fret 1 first.
    pub frets: Vec<f64>,
}

/// One string over a neck on a grid of a stencil and a sample rate.
struct Bench<'a> {
    setup: &'a Setup,
    neck: &'a Neck,
    fretting: &'a Fretting,
    settings: SolverSettings,
    sample_rate: f64,
}

/// Steps of a search for one number; each gains several digits.
const MOST_STEPS: usize = 30;

/// Pitch is met to this fraction, 0.002 cents, below what tension modulation does to any audible note.
const PITCH_TOLERANCE: f64 = 1e-6;

/// Tunes one string of a set-up on its grid and, if the set-up asks for it, places its frets.
///
/// Where the grid is too coarse to tell a fret from its neighbours (high strings below 22 kHz) the best
/// place found is kept.
///
/// # Errors
/// When the string is too short for its grid, its density asks for too much or too little tension, it is too stiff to sound so low,
/// or a contact is too stiff for the sample rate.
pub fn intonate(
    setup: &Setup,
    string: &SetupString,
    stencil: Stencil,
    sample_rate: f64,
) -> Result<Intonated, Error> {
    let bench = Bench::new(setup, stencil, sample_rate);
    let target = std::f64::consts::TAU * frequency(string.pitch + setup.tuning);
    let tuned = bench.tuned(string, setup.tension_room(), target)?;
    let mut frets = setup.neck.equal_places();
    match (setup.intonation, setup.neck.fretless) {
        (Intonation::Physical, _) => {}
        (Intonation::Compensated, false) => bench.place_frets(&tuned, target, &mut frets)?,
        (Intonation::Compensated, true) => bench.place_fingers(&tuned, target, &mut frets)?,
    }
    Ok(Intonated { string: tuned, frets })
}

/// The frequencies at which a string of a set-up sounds where its finger stops the frets, Hz, fret 1 first: those of equal
/// temperament as far as its frets are placed for that, and else as sharp as pressing makes them.
///
/// # Errors
/// As [`intonate`].
pub fn stopped_frequencies(
    setup: &Setup,
    string: &SetupString,
    placed: &Intonated,
    stencil: Stencil,
    sample_rate: f64,
) -> Result<Vec<f64>, Error> {
    let sounding = Sounding::new(setup, string, placed, stencil, sample_rate);
    let pressed = Pressed { force: setup.player.fretting.force, tension_ratio: 1.0 };
    (1..=placed.frets.len()).map(|fret| sounding.frequency(fret, pressed)).collect()
}

/// The tension, N, that would tune a string of a set-up if it were flexible.
pub fn flexible_tension(setup: &Setup, string: &SetupString) -> f64 {
    let angular = std::f64::consts::TAU * frequency(string.pitch + setup.tuning);
    let wave_speed = setup.neck.scale_length * angular / std::f64::consts::PI;
    wave_speed * wave_speed * string.linear_density
}

/// A string of a set-up with the tension that would tune it if it were flexible.
pub(crate) fn flexible(setup: &Setup, string: &SetupString) -> StringParameters {
    let tension = flexible_tension(setup, string);
    StringParameters {
        length: setup.neck.scale_length,
        linear_density: string.linear_density,
        tension,
        tension_limit: tension * setup.tension_room(),
        youngs_modulus: string.youngs_modulus,
        core_radius: string.core_radius,
        loss_0: string.loss_0,
        loss_1: string.loss_1,
        tension_modulation: setup.tension_modulation,
    }
}

/// Refuses a string that its pitch takes too much or too little tension, by the number that set-ups have for it: at one pitch
/// tension grows nearly as the density, and the limit beyond which it is lies on the safe side.
fn bearable(string: &SetupString, tension: f64) -> Result<(), Error> {
    let density = string.linear_density;
    let [least, most] = StringParameters::TENSION.map(|limit| density * (limit / tension));
    if (least..=most).contains(&density) {
        return Ok(());
    }
    let accepted = format!(
        "at this pitch and neck.scale_length it must lie between {:.2e} and {:.2e} kg/m, for a tension of {} to {} N",
        // Half a percent is as much as three digits can be off by.
        1.005 * least,
        0.995 * most,
        plain(StringParameters::TENSION[0]),
        plain(StringParameters::TENSION[1]),
    );
    Err(Error::range("linear_density", plain(density), accepted))
}

impl<'a> Bench<'a> {
    fn new(setup: &'a Setup, stencil: Stencil, sample_rate: f64) -> Self {
        Self {
            setup,
            neck: &setup.neck,
            fretting: &setup.player.fretting,
            settings: SolverSettings { stencil, ..SolverSettings::default() },
            sample_rate,
        }
    }

    fn model(&self, string: &StringParameters, frets: &[f64]) -> Result<Model, Error> {
        let barrier = self.setup.barrier(frets)?;
        Model::new(*string, Some(&barrier), 1, self.settings, self.sample_rate).map_err(Error::of_setup)
    }

    /// The string with the tension that puts its first partial at `target` (1/s) on its own grid.
    fn tuned(&self, string: &SetupString, ratio: f64, target: f64) -> Result<StringParameters, Error> {
        let mut tuned = flexible(self.setup, string);
        let mut tension = tuned.tension;
        for _ in 0..MOST_STEPS {
            // What a bare board refuses, its frets refuse by the lower of both limits.
            let strictly = |error| self.model(&tuned, &self.neck.equal_places()).err().unwrap_or(error);
            let model = self.model(&tuned, &[]).map_err(strictly)?;
            let off = open_frequency(&model, 1) / target;
            tension /= off * off;
            // Less than any number: slack beyond all measure.
            if tension == 0.0 {
                break;
            }
            tuned = StringParameters { tension, tension_limit: tension * ratio, ..tuned };
            if (off - 1.0).abs() < PITCH_TOLERANCE {
                return bearable(string, tension).map(|()| tuned);
            }
        }
        // However slack it is, it is too stiff to sound as low as that.
        let tuning = match self.setup.tuning {
            0.0 => String::new(),
            tuning => format!(", and tuning = {},", plain(tuning)),
        };
        let accepted =
            format!("with its core_radius and youngs_modulus{tuning} the string cannot sound so low");
        Err(Error::range("pitch", plain(string.pitch), accepted))
    }

    /// Angular frequency (1/s) of the string stopped at a fret, near `target`, and its shape at rest.
    fn stopped(
        &self,
        string: &StringParameters,
        frets: &[f64],
        fret: usize,
        target: f64,
        guess: Option<Vec<f64>>,
    ) -> Result<(f64, Vec<f64>), Error> {
        let model = self.model(string, frets)?;
        let force = self.fretting.force;
        let rest = self.rest(&model, frets, fret, force, guess);
        let sound = self.sound(&model, &rest, frets, fret, force, target)?;
        Ok((sound, rest.displacement))
    }

    /// The string of a model at rest, stopped at a fret by a finger that presses with such a force, N.
    fn rest(
        &self,
        model: &Model,
        frets: &[f64],
        fret: usize,
        force: f64,
        guess: Option<Vec<f64>>,
    ) -> Equilibrium {
        let place = finger_place(frets, fret, self.setup.behind());
        let guess = guess.unwrap_or_else(|| self.folded(model, force, place, frets[fret]));
        Equilibrium::new(model, &model.grid.reading(place), force, guess)
    }

    /// The angular frequency (1/s), near `target`, at which it sounds about that.
    fn sound(
        &self,
        model: &Model,
        rest: &Equilibrium,
        frets: &[f64],
        fret: usize,
        force: f64,
        target: f64,
    ) -> Result<f64, Error> {
        let Fretting { ref touch, .. } = *self.fretting;
        let law = model.finger_law(touch).map_err(|error| error.under("player.fretting"))?;
        let at: Reading = model.grid.reading(finger_place(frets, fret, self.setup.behind()));
        let finger = Resting { at, law, touch, force };
        // Behind a fret a finger lies between both parts of the string, and swallows what the one behind does. On a bare board it
        // does not: at semitones 12, 19 and 24, where that has a partial of the same pitch, it would be found as well.
        let still_to = if self.neck.fretless { frets[fret] } else { 0.0 };
        Ok(stopped_frequency(model, rest, &finger, frets[fret], target, still_to))
    }

    /// The string as straight pieces from nut to finger, crown and saddle, bent as far under the
    /// finger as tension and board let it: nearly its shape at rest.
    fn folded(&self, model: &Model, force: f64, finger: f64, crown: f64) -> Vec<f64> {
        let (length, height) = (model.string.length, self.neck.crown_height(crown));
        if self.neck.fretless {
            let board = self.neck.board_height(finger).unwrap_or(height);
            let corners = Curve::Points(vec![[0.0, 0.0], [finger, board], [length, 0.0]]);
            return (1..model.grid.intervals).map(|node| corners.at(model.grid.place(node))).collect();
        }
        let behind = crown - finger;
        // T(y/finger + (y − height)/behind) = −force.
        let free = (height / behind - force / model.string.tension) / (1.0 / finger + 1.0 / behind);
        let pressed = free.max(self.neck.board_height(finger).unwrap_or(free));
        let corners = Curve::Points(vec![[0.0, 0.0], [finger, pressed], [crown, height], [length, 0.0]]);
        (1..model.grid.intervals).map(|node| corners.at(model.grid.place(node))).collect()
    }
}
