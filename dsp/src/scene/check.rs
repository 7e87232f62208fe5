//! What scenes may say: every value in its range, named as in the file.

use super::{FingerSpec, FretboardSpec, ListeningPoint, Scene, SolverSettings, StringSpec};
use crate::contact::ContactLaw;
use crate::curve::{Along, CountOrList, Curve, MOST_COUNTED, MOST_FRETS, OneOrEach};
use crate::error::{Error, on_string, ranged, within};
use crate::gesture::{FASTEST, MOST_CLEARANCE, MOST_FORCE};
use crate::model::{Barrier, Model, StringParameters};

/// The most strings, plucks or fingers of a scene, a limit against descriptions that fill the memory.
const MOST_THINGS: usize = 1000;

/// The most fingers on one string: all that touch each other are solved together, in memory that grows
/// with their square.
pub(crate) const MOST_FINGERS: usize = 100;

impl Scene {
    /// Refuses every value outside its range, naming it as in the file.
    ///
    /// # Errors
    /// At the first of them.
    pub fn check(&self) -> Result<(), Error> {
        within("sample_rate", self.sample_rate, *Model::RATES.start(), *Model::RATES.end(), "Hz")?;
        within("duration", self.duration, 0.0, 1e5, "s")?;
        self.solver.check()?;
        if self.string.is_empty() || self.string.len() > MOST_THINGS {
            let accepted = format!("there must be 1 to {MOST_THINGS} strings");
            return Err(Error::range("[[string]]", self.string.len(), accepted));
        }
        for (name, count) in [("[[pluck]]", self.pluck.len()), ("[[finger]]", self.finger.len())] {
            if count > MOST_THINGS {
                return Err(Error::range(name, count, format!("there must be at most {MOST_THINGS}")));
            }
        }
        for (i, string) in self.string.iter().enumerate() {
            string.check(&format!("string[{}]", i + 1))?;
        }
        if let Some(fretboard) = &self.fretboard {
            fretboard.check()?;
        }
        if let Some(body) = &self.body {
            body.check()?;
        }
        for (i, pluck) in self.pluck.iter().enumerate() {
            let name = format!("pluck[{}]", i + 1);
            let length = self.length_of(&name, pluck.string)?;
            within(&format!("{name}.start"), pluck.start, 0.0, 1e9, "s")?;
            within(&format!("{name}.duration"), pluck.duration, 0.0, 1e9, "s")?;
            within(&format!("{name}.release"), pluck.release, 0.0, 1e9, "s")?;
            within(&format!("{name}.force"), pluck.force, -MOST_FORCE, MOST_FORCE, "N")?;
            on_string(&format!("{name}.position"), pluck.position, length)?;
        }
        for (i, finger) in self.finger.iter().enumerate() {
            let name = format!("finger[{}]", i + 1);
            let length = self.length_of(&name, finger.string)?;
            finger.check(&name, length)?;
        }
        for number in 1..=self.string.len() {
            let count = self.finger.iter().filter(|finger| finger.string == number).count();
            if count > MOST_FINGERS {
                let accepted = format!("there must be at most {MOST_FINGERS}");
                return Err(Error::range(format!("number of fingers on string[{number}]"), count, accepted));
            }
        }
        match self.output.position {
            ListeningPoint::Bridge => Ok(()),
            ListeningPoint::At(place) => self
                .string
                .iter()
                .try_for_each(|string| on_string("output.position", place, string.length).map(drop)),
            ListeningPoint::Air if self.body.is_some() => Ok(()),
            ListeningPoint::Air => {
                let accepted = "only a [body] is heard in the air, and there is none";
                Err(Error::range("output.position", "\"air\"", accepted))
            }
        }
    }

    fn length_of(&self, name: &str, string: usize) -> Result<f64, Error> {
        let spec = string.checked_sub(1).and_then(|i| self.string.get(i));
        spec.map(|s| s.length).ok_or_else(|| {
            Error::range(format!("{name}.string"), string, format!("it must be 1 to {}", self.string.len()))
        })
    }
}

impl SolverSettings {
    /// Refuses values outside their range.
    ///
    /// # Errors
    /// At the first of them.
    pub fn check(&self) -> Result<(), Error> {
        let most = Self::MOST_ITERATIONS as f64;
        within("solver.max_iterations", self.max_iterations as f64, 0.0, most, "")?;
        within("solver.tolerance", self.tolerance, 0.0, Self::WIDEST_TOLERANCE, "m").map(drop)
    }
}

impl StringSpec {
    /// Refuses values outside their range; `name` says which string this is.
    ///
    /// # Errors
    /// At the first of them.
    pub fn check(&self, name: &str) -> Result<(), Error> {
        within(&format!("{name}.length"), self.length, 1e-3, 1e3, "m")?;
        let number =
            |key: &str, value, range, unit| ranged(&format!("{name}.{key}"), value, range, unit).map(drop);
        number("linear_density", self.linear_density, StringParameters::LINEAR_DENSITY, "kg/m")?;
        let [least, most] = StringParameters::TENSION;
        self.tension.check(&format!("{name}.tension"), Along::TIME, least, most, "N")?;
        number("youngs_modulus", self.youngs_modulus, StringParameters::YOUNGS_MODULUS, "Pa")?;
        number("core_radius", self.core_radius, StringParameters::CORE_RADIUS, "m")?;
        self.check_losses(name)?;
        for (key, points, most, unit) in
            [("shape", &self.shape, 1.0, "m"), ("velocity", &self.velocity, FASTEST, "m/s")]
        {
            let Some(points) = points else { continue };
            let name = format!("{name}.{key}");
            Curve::Points(points.clone()).check(&name, Along::string(self.length), -most, most, unit)?;
        }
        Ok(())
    }
}

impl FretboardSpec {
    /// Refuses values outside their range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        ContactLaw::new("fretboard", self.stiffness, self.exponent)?;
        ranged("fretboard.damping", self.damping, Barrier::DAMPING, "s/m")?;
        if let Some(board) = &self.board {
            board.check()?;
        }
        if let Some(spacing) = self.board_reference_spacing {
            ranged("fretboard.board_reference_spacing", spacing, Barrier::REFERENCE_SPACING, "m")?;
        }
        let count = match &self.frets {
            CountOrList::Count(count) => {
                within("fretboard.frets", *count as f64, 0.0, MOST_COUNTED as f64, "")?;
                *count
            }
            CountOrList::List(places) => {
                within("number of fretboard.frets", places.len() as f64, 0.0, MOST_FRETS as f64, "")?;
                for (i, &place) in places.iter().enumerate() {
                    within(&format!("fretboard.frets[{}]", i + 1), place, 0.0, 1e3, "m")?;
                }
                places.len()
            }
        };
        match &self.fret_top {
            None if count > 0 => Err(Error::Syntax(format!(
                "missing key `fret_top` of [fretboard]: frets need the height of their crowns, {} to 0 m",
                -Barrier::FARTHEST
            ))),
            None => Ok(()),
            Some(OneOrEach::One(height)) => {
                within("fretboard.fret_top", *height, -Barrier::FARTHEST, 0.0, "m").map(drop)
            }
            Some(OneOrEach::Each(heights)) if heights.len() != count => Err(Error::range(
                "fretboard.fret_top",
                format!("{} heights", heights.len()),
                format!("it must be one height, or one for each of the {count} frets"),
            )),
            Some(OneOrEach::Each(heights)) => {
                for (i, &height) in heights.iter().enumerate() {
                    within(&format!("fretboard.fret_top[{}]", i + 1), height, -Barrier::FARTHEST, 0.0, "m")?;
                }
                Ok(())
            }
        }
    }
}

impl FingerSpec {
    fn check(&self, name: &str, length: f64) -> Result<(), Error> {
        self.touch().check(name)?;
        within(&format!("{name}.height"), self.height, -MOST_CLEARANCE, MOST_CLEARANCE, "m")?;
        within(&format!("{name}.velocity"), self.velocity, -FASTEST, FASTEST, "m/s")?;
        self.force.check(&format!("{name}.force"), Along::TIME, -MOST_FORCE, MOST_FORCE, "N")?;
        let on_string = |name: &str, place| on_string(name, place, length);
        self.position.check_each(&format!("{name}.position"), Along::TIME, on_string)
    }
}
