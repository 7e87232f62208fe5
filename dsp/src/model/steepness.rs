//! How stiff a contact may be: stiffer ones cannot be told from rounding.

use crate::contact::ContactLaw;
use crate::digits::plain;
use crate::error::Error;

/// A contact is refused if M φ′ is above this at 1 cm of motion in one step.
const CONDITIONING: f64 = 1e10;

/// Beyond this M φ′ a contact grows no steeper: it then yields 1e-8 of what the point would move without it,
/// and the last digit of a motion still is 1e-8 of the force.
pub(super) const STEEPEST: f64 = 1e8;

/// The stiffest contact of an exponent, N/m^exponent, that is accepted where one newton moves a point by
/// `mobility`, m/N, in a step: Mα K^(1/α) F^(1−1/α) ≤ 1e10 with F = 1 cm/M, M the mobility.
pub fn stiffest(exponent: f64, mobility: f64) -> f64 {
    let force = 0.01 / mobility;
    let conditioning = mobility * exponent * libm::pow(force, 1.0 - 1.0 / exponent);
    libm::pow(CONDITIONING / conditioning, exponent)
}

/// Refuses a contact that is stiffer than that: of a stiffness, N/m^exponent, that is a part or a multiple of the one
/// that its description gives it, which is the one named.
pub(super) fn check_stiffness(
    name: &str,
    given: &ContactLaw,
    stiffness: f64,
    mobility: f64,
) -> Result<(), Error> {
    if stiffness <= stiffest(given.exponent(), mobility) {
        Ok(())
    } else {
        Err(too_stiff(name, given, stiffness, mobility))
    }
}

/// Why it is refused.
pub(super) fn too_stiff(name: &str, given: &ContactLaw, stiffness: f64, mobility: f64) -> Error {
    let limit = stiffest(given.exponent(), mobility);
    // Half a percent is as much as three digits can be too high by.
    let accepted = format!(
        "at this sample rate it must be at most {:.2e} N/m^exponent",
        0.995 * limit * (given.stiffness() / stiffness)
    );
    Error::range(name, plain(given.stiffness()), accepted)
}
