//! The losses of a string of a scene: as they are, or by the times in which it decays at two frequencies.

use serde::Deserializer;
use serde::de::Error as _;

use super::StringSpec;
use crate::digits::{at_least, cleared, plain};
use crate::error::{Error, ranged};
use crate::model::StringParameters;

/// ln(1000): what 60 dB are, in the exponent.
const SIXTY_DECIBELS: f64 = 3.0 * std::f64::consts::LN_10;

/// The frequencies at which a decay may be told, Hz, limits against slips of the pen.
const FREQUENCY: [f64; 2] = [1e-3, 1e6];

/// How long a decay may take at the first of them, s: from 0.7 ms on, σ₀ is within [its range](StringParameters::LOSS_0).
const TIME: [f64; 2] = [1e-3, 1e9];

/// Reads a decay at two frequencies.
pub(super) fn at_two<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[[f64; 2]; 2]>, D::Error> {
    let points = crate::curve::pairs(deserializer)?.unwrap_or_default();
    let count = points.len();
    let expected = "two pairs [[frequency, time], [frequency, time]]";
    <[_; 2]>::try_from(points).map(Some).map_err(|_| D::Error::invalid_length(count, &expected))
}

/// What the decay of a string at two frequencies asks of it.
struct Decays {
    /// γ² at both frequencies, 1/m².
    squares: [f64; 2],
    /// σ₀ + σ₁γ² there, 1/s.
    rates: [f64; 2],
}

impl Decays {
    fn new(string: &StringParameters, t60: &[[f64; 2]; 2]) -> Decays {
        Decays {
            squares: t60.map(|[frequency, _]| string.wavenumber_squared(frequency)),
            rates: t60.map(|[_, time]| SIXTY_DECIBELS / time),
        }
    }

    /// σ₀, 1/s, and σ₁, m²/s: the line over γ² through both.
    fn losses(&self) -> [f64; 2] {
        let ([near, far], [slow, fast]) = (self.squares, self.rates);
        // Where nothing grows the frequencies may be as close as they like.
        let loss_1 = if fast == slow { 0.0 } else { (fast - slow) / (far - near) };
        // In the shortest second time that is accepted σ₀ is 0, but for rounding.
        [(slow - loss_1 * near).max(0.0), loss_1]
    }

    /// The shortest second time, s, with which σ₀ is not negative and σ₁ in its range, but for rounding: where it has few digits
    /// it has no more.
    fn shortest(&self) -> f64 {
        let ([near, far], [slow, _]) = (self.squares, self.rates);
        let [_, most] = StringParameters::LOSS_1;
        cleared(SIXTY_DECIBELS / (slow * (far / near)).min(slow + most * (far - near)))
    }
}

impl StringSpec {
    /// What the string loses, σ₀ in 1/s and σ₁ in m²/s: `loss_0` and `loss_1`, or what makes it decay as `t60` says
    /// (`docs/physics.md`, section 1).
    pub fn losses(&self) -> [f64; 2] {
        let string = StringParameters::from_spec(self);
        [string.loss_0, string.loss_1]
    }

    /// The same for a string of which everything else is known.
    pub(crate) fn losses_of(&self, string: &StringParameters) -> [f64; 2] {
        match &self.t60 {
            Some(t60) => Decays::new(string, t60).losses(),
            None => [self.loss_0, self.loss_1].map(Option::unwrap_or_default),
        }
    }

    /// Refuses losses out of their range, decays that no losses in theirs have, and both at once. Everything else is in its range.
    pub(super) fn check_losses(&self, name: &str) -> Result<(), Error> {
        let given = [
            ("loss_0", self.loss_0, StringParameters::LOSS_0, "1/s"),
            ("loss_1", self.loss_1, StringParameters::LOSS_1, "m²/s"),
        ];
        for (key, value, range, unit) in given {
            let Some(value) = value else { continue };
            let name = format!("{name}.{key}");
            if self.t60.is_some() {
                let accepted = "the string has a t60, from which both losses follow: give one or the other";
                return Err(Error::range(name, plain(value), accepted));
            }
            ranged(&name, value, range, unit)?;
        }
        self.t60.map_or(Ok(()), |t60| self.check_decay(&format!("{name}.t60"), t60))
    }

    fn check_decay(&self, name: &str, t60: [[f64; 2]; 2]) -> Result<(), Error> {
        let [[lower, longest], [upper, time]] = t60;
        ranged(&format!("frequency of point 1 of {name}"), lower, FREQUENCY, "Hz")?;
        let upper_name = format!("frequency of point 2 of {name}");
        ranged(&upper_name, upper, FREQUENCY, "Hz")?;
        if upper <= lower {
            let accepted = format!("it must be above that of the point before, {} Hz", plain(lower));
            return Err(Error::range(upper_name, plain(upper), accepted));
        }
        ranged(&format!("time of point 1 of {name}"), longest, TIME, "s")?;
        let shortest = Decays::new(&StringParameters::from_spec(self), &t60).shortest().min(longest);
        if time >= shortest && time <= longest {
            return Ok(());
        }
        let accepted = format!(
            "it must lie between {} and {} s, for loss_0 and loss_1 to be in their ranges",
            plain(at_least(shortest).min(longest)),
            plain(longest)
        );
        Err(Error::range(format!("time of point 2 of {name}"), plain(time), accepted))
    }
}

#[cfg(test)]
mod tests;
