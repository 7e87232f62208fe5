//! Which bodies there cannot be under strings, by their rate and their grids.

use super::coefficients::{Coefficients, fastest, is_slow};
use super::end::End;
use super::most_tension;
use crate::digits::{at_least, at_most, cleared, plain};
use crate::error::Error;
use crate::model::Model;
use crate::setup::Body as Description;

/// Refuses a body that strings, all of one rate, cannot stand on.
pub(crate) fn check(description: &Description, strings: &[&Model]) -> Result<(), Error> {
    check_rate(description, strings[0].grid.time_step)?;
    if taken(description, strings) > 1.0 { Err(too_light(description, strings)) } else { Ok(()) }
}

/// Refuses a body whose two lowest modes are too fast for a time step, s: without them the bridge would hardly give way, and nearly
/// nothing be heard. (Of the others those that are too fast may be missing.)
fn check_rate(description: &Description, time_step: f64) -> Result<(), Error> {
    let higher = |frequency: f64| Description { frequency, ..*description }.with_air()[1].frequency;
    let fits = |frequency: f64| is_slow(higher(frequency), time_step);
    if fits(description.frequency) {
        return Ok(());
    }
    let [mut low, mut high] = [Description::FREQUENCY[0], description.frequency];
    let least = plain(low);
    let why = format!(
        "at {} Hz a body's two lowest modes must lie below {} Hz",
        plain(cleared(1.0 / time_step)),
        plain(at_most(cleared(fastest(time_step))))
    );
    let accepted = if fits(low) {
        // It rises with the frequency of the soundboard by itself.
        while high - low > 1e-6 * low {
            let middle = 0.5 * (low + high);
            *if fits(middle) { &mut low } else { &mut high } = middle;
        }
        format!("{why}: it must lie between {least} and {} Hz", plain(at_most(low)))
    } else {
        format!(
            "{why}, and by the air in the box one is at {} Hz even with {least} Hz: body.mass or body.volume must be more, or \
             body.area or body.hole less",
            plain(at_most(higher(low)))
        )
    };
    Err(Error::range("body.frequency", plain(description.frequency), accepted))
}

/// How much a body takes of what the grids of strings leave for what all are together; they are stable up to 1.
pub(super) fn taken(description: &Description, strings: &[&Model]) -> f64 {
    let modes = Coefficients::of(description.modes(), strings[0].grid.time_step);
    strings.iter().map(|model| End::taken(model, most_tension(model, true), &modes)).sum()
}

/// The refusal of a body that is too light for its strings, with the mass that would do, if any would.
fn too_light(description: &Description, strings: &[&Model]) -> Error {
    let heaviest = Description::MASS[1];
    let mut heavier = *description;
    while heavier.mass < heaviest {
        // What is taken goes nearly with 1/mass.
        let more = taken(&heavier, strings).clamp(1.001, 1e3);
        heavier.mass = (heavier.mass * more).min(heaviest);
        if taken(&heavier, strings) <= 1.0 {
            let accepted = format!("it must be at least {} kg", plain(at_least(heavier.mass)));
            return Error::range("body.mass", plain(description.mass), accepted);
        }
    }
    let accepted = format!(
        "no mass up to {} kg will do: linear_density, youngs_modulus, core_radius or loss_1 of its strings must be less, or \
         body.spacing more",
        plain(heaviest)
    );
    Error::range("body.mass", plain(description.mass), accepted)
}
