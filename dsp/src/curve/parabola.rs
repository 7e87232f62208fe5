//! A quantity that follows a parabola through three of its values.

use super::Along;
use crate::digits::plain;
use crate::error::Error;

/// A parabola through three values, at 0, half way to its end and at its end. It goes on beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parabola {
    /// Where it has the last of its values, above 0.
    pub end: f64,
    /// Its values at 0, at half of the end and at the end.
    pub values: [f64; 3],
}

impl Parabola {
    /// The value at `place`.
    pub fn at(&self, place: f64) -> f64 {
        let [first, _, last] = self.values;
        let part = place / self.end;
        // The chord as points joined by straight lines have it, and what the arc is away from it: so three equal values are one
        // to the last bit, and three on a line the line.
        first + (last - first) * part + self.rise() * (4.0 * part * (1.0 - part))
    }

    /// The largest value between 0 and the end.
    pub fn largest(&self) -> f64 {
        let [first, _, last] = self.values;
        let rise = self.rise();
        let top = 0.5 + (last - first) / (8.0 * rise);
        let ends = first.max(last);
        if rise > 0.0 && top > 0.0 && top < 1.0 { ends.max(self.at(top * self.end)) } else { ends }
    }

    /// How far it is above its chord half way.
    fn rise(&self) -> f64 {
        let [first, middle, last] = self.values;
        middle - 0.5 * (first + last)
    }

    /// Refuses an end that is not above 0 or farther than `along` goes, and every value that `refused` refuses.
    pub(super) fn check(
        &self,
        name: &str,
        along: Along,
        refused: impl Fn(&str, f64) -> Result<f64, Error>,
    ) -> Result<(), Error> {
        let Along { unit, to, .. } = along;
        if !(self.end > 0.0 && self.end <= to) {
            let accepted = format!("it must be above 0 and at most {} {unit}", plain(to));
            return Err(Error::range(format!("end of {name}"), plain(self.end), accepted));
        }
        for (which, value) in ["first", "middle", "last"].into_iter().zip(self.values) {
            refused(&format!("{which} value of {name}"), value)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Curve;
    use super::*;

    const HEIGHTS: [f64; 3] = [-1e-3, -1.5e-3, -1.8e-3];

    /// By Lagrange, which is another way to write the same.
    fn through(values: [f64; 3], part: f64) -> f64 {
        let [first, middle, last] = values;
        first * (1.0 - part) * (1.0 - 2.0 * part)
            + middle * 4.0 * part * (1.0 - part)
            + last * part * (2.0 * part - 1.0)
    }

    #[test]
    fn it_goes_through_its_values_and_is_a_parabola() {
        let parabola = Parabola { end: 0.65, values: HEIGHTS };
        for step in 0..=1300 {
            let part = f64::from(step) / 1300.0;
            let off = parabola.at(0.65 * part) - through(HEIGHTS, part);
            assert!(off.abs() < 1e-18, "off by {off:e} at {part}");
        }
        for (place, value) in [(0.0, HEIGHTS[0]), (0.325, HEIGHTS[1]), (0.65, HEIGHTS[2])] {
            assert!((parabola.at(place) - value).abs() < 1e-18, "{} at {place}", parabola.at(place));
        }
    }

    #[test]
    fn its_mean_and_its_largest_value_are_those_of_all_its_values() {
        for values in [HEIGHTS, [0.0, 2.0, 1.0], [1.0, 1.1, 0.0], [3.0, 1.0, 2.0], [0.0, 0.5, 1.0], [7.0; 3]]
        {
            let parabola = Parabola { end: 2.0, values };
            let places: Vec<f64> = (0..20_000).map(|i| 1e-4 * (f64::from(i) + 0.5)).collect();
            let all = || places.iter().map(|&place| parabola.at(place));
            let mean = all().sum::<f64>() / places.len() as f64;
            let largest = all().chain([values[0], values[2]]).fold(f64::NEG_INFINITY, f64::max);
            // What is between the places: half a step squared times the curvature, which is at most 8.
            let curve = Curve::Parabola(parabola);
            assert!((curve.mean(0.0, 2.0) - mean).abs() < 1e-8, "{values:?}: {mean}");
            assert!((curve.largest() - largest).abs() < 4e-8, "{values:?}: {largest}");
        }
    }
}
