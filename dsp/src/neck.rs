//! The neck: where frets and board lie under a string, as height below the string at rest.

use serde::{Deserialize, Serialize};

use crate::contact::ContactLaw;
use crate::curve::Curve;
use crate::digits::{at_most, plain};
use crate::error::{Error, limited, ranged, within};
use crate::model::{Barrier, equal_place};
use crate::scene::FretPlacement;

/// Frets and board, the same under every string but for the exact fret places.
#[derive(Debug, Clone, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Neck {
    /// Length from nut to saddle, m, 0.1 to 5; fret m of equal temperament leaves 2^(−m/12) of it.
    pub scale_length: f64,
    /// Number of frets, 0 to [`Neck::MOST_FRETS`].
    pub frets: usize,
    /// Whether the fretted notes are stopped by fingers on the bare board; the number of frets is then how
    /// many semitones can be stopped.
    #[serde(default)]
    pub fretless: bool,
    /// Worn frets: which one, counted from 1, each once, and how much lower than made its crown is, m, 0 to 0.02.
    #[serde(default)]
    pub worn: Vec<(usize, f64)>,
    /// Crown of fret 1 below the string at rest, m, 1e-5 to 0.02.
    pub nut_clearance: f64,
    /// Crown of fret 12 (or where it would be) below the string at rest, m, from the nut clearance to 0.05.
    pub action: f64,
    /// How far the middle of the fretted board dips below the line from fret 1 to the last fret, m, 0 to 0.01, and no more than
    /// [`Neck::most_relief`].
    pub relief: f64,
    /// Height of the crowns above the board, m, 0 to 0.02.
    pub fret_height: f64,
    /// Contact stiffness of a fret, N/m^exponent, 1e-3 to 1e30, and no more than can be told from rounding at the strings' rates.
    pub stiffness: f64,
    /// Exponent of the contact law, 1 to 5.
    pub exponent: f64,
    /// Hunt–Crossley damping of frets and board, s/m, 0 to 1e5.
    #[serde(default)]
    pub damping: f64,
    /// Spacing of points for which the stiffness holds for the board too, m, 1e-6 to 1: grids of other spacings
    /// share it out, so that the board is the same at every sample rate.
    pub board_reference_spacing: f64,
}

/// The least that a crown is below the string, m.
const LEAST_CLEARANCE: f64 = 1e-5;

/// The most relief there is, m, however high the strings are.
const MOST_RELIEF: f64 = 0.01;

/// What the numbers may be that a luthier can change on a neck that is made, m.
const NUT_CLEARANCE: [f64; 2] = [LEAST_CLEARANCE, 0.02];
const FRET_HEIGHT: [f64; 2] = [0.0, 0.02];

/// How far the board goes on beyond the last fret, m.
const OVERHANG: f64 = 0.008;

/// Pieces of the polyline that stands for the board's curve; relief of 0.3 mm over 0.5 m is then met
/// to within 0.1 µm.
const PIECES: usize = 64;

impl Neck {
    /// The most frets.
    pub const MOST_FRETS: usize = 36;

    /// The highest action, m.
    pub const HIGHEST_ACTION: f64 = 0.05;

    /// Brings heights and relief, which a luthier can change on a neck that is made, back to what a set-up may have.
    pub(crate) fn limit(&mut self) {
        self.nut_clearance = limited(self.nut_clearance, NUT_CLEARANCE);
        self.action = limited(self.action, [self.nut_clearance, Self::HIGHEST_ACTION]);
        self.relief = limited(self.relief, [0.0, self.most_relief()]);
        self.fret_height = limited(self.fret_height, FRET_HEIGHT);
    }

    /// Refuses values outside their range.
    pub(crate) fn check(&self) -> Result<(), Error> {
        within("neck.scale_length", self.scale_length, 0.1, 5.0, "m")?;
        within("neck.frets", self.frets as f64, 0.0, Self::MOST_FRETS as f64, "")?;
        ranged("neck.nut_clearance", self.nut_clearance, NUT_CLEARANCE, "m")?;
        if !(self.nut_clearance..=Self::HIGHEST_ACTION).contains(&self.action) {
            // Either may be what is wrong.
            let (least, most) = (plain(self.nut_clearance), plain(Self::HIGHEST_ACTION));
            let accepted = format!("it must lie between neck.nut_clearance, {least}, and {most} m");
            return Err(Error::range("neck.action", plain(self.action), accepted));
        }
        ranged("neck.fret_height", self.fret_height, FRET_HEIGHT, "m")?;
        for (i, (fret, wear)) in self.worn.iter().enumerate() {
            let [fret_name, depth_name] =
                ["fret", "depth"].map(|what| format!("{what} of neck.worn[{}]", i + 1));
            if self.frets == 0 {
                return Err(Error::range(fret_name, fret, "there are no frets, neck.frets is 0"));
            }
            within(&fret_name, *fret as f64, 1.0, self.frets as f64, "")?;
            // Both together might be worn farther down than any.
            if self.worn[..i].iter().any(|(other, _)| other == fret) {
                return Err(Error::range(
                    fret_name,
                    fret,
                    "that fret is there already, and may be named once",
                ));
            }
            within(&depth_name, *wear, 0.0, 0.02, "m")?;
        }
        self.check_relief()?;
        ContactLaw::new("neck", self.stiffness, self.exponent)?;
        ranged("neck.damping", self.damping, Barrier::DAMPING, "s/m")?;
        within("neck.board_reference_spacing", self.board_reference_spacing, 1e-6, 1.0, "m").map(drop)
    }

    fn check_relief(&self) -> Result<(), Error> {
        within("neck.relief", self.relief, 0.0, MOST_RELIEF, "m")?;
        let most = self.most_relief();
        if self.relief > most {
            let accepted = format!(
                "it must lie between 0 and {} m, or crowns stand above the strings",
                plain(at_most(most))
            );
            return Err(Error::range("neck.relief", plain(self.relief), accepted));
        }
        Ok(())
    }

    /// The most relief, m, with which all crowns are below the string. (Fret 12 has the action whatever the relief. So the
    /// line under the crowns tilts with it, and those beyond fret 12 rise.)
    pub fn most_relief(&self) -> f64 {
        let room = |place: f64| {
            let straight = self.bowed_height(place, 0.0);
            let rise = self.bowed_height(place, 1.0) - straight;
            if rise > 0.0 { (-LEAST_CLEARANCE - straight) / rise } else { f64::INFINITY }
        };
        self.equal_places().into_iter().map(room).fold(MOST_RELIEF, f64::min).max(0.0)
    }

    /// Place of a fret in equal temperament, m from the nut; fractions of a fret lie between.
    pub fn equal_place(&self, fret: f64) -> f64 {
        equal_place(self.scale_length, fret)
    }

    /// Places of all frets in equal temperament, m from the nut, fret 1 first.
    pub fn equal_places(&self) -> Vec<f64> {
        (1..=self.frets).map(|fret| self.equal_place(fret as f64)).collect()
    }

    /// Height of a crown at `place` (m from the nut) over the string at rest, m: negative.
    ///
    /// The crowns lie on a straight line less a parabola that vanishes at fret 1 and the last fret; the
    /// line is set so that fret 1 has the nut clearance and fret 12 the action. (A neck that ends before fret 12 has no parabola
    /// beyond its frets, where one over so few of them would be steep.) Where it would come nearer to the string than
    /// 1e-5 m, beside the nut or where compensation moved the last fret to, it is cut off there.
    pub fn crown_height(&self, place: f64) -> f64 {
        self.bowed_height(place, self.relief).min(-LEAST_CLEARANCE)
    }

    /// The same with another relief, m, and however high.
    fn bowed_height(&self, place: f64, relief: f64) -> f64 {
        let (first, twelfth) = (self.equal_place(1.0), self.equal_place(12.0));
        let last = self.equal_place(self.frets as f64);
        let dip = |x: f64| {
            let span = last - first;
            let dip = if span <= 0.0 { 0.0 } else { relief * 4.0 * (x - first) * (last - x) / (span * span) };
            if self.frets < 12 { dip.max(0.0) } else { dip }
        };
        let slope = (self.action - dip(twelfth) - self.nut_clearance) / (twelfth - first);
        -(self.nut_clearance + slope * (place - first) + dip(place))
    }

    /// Where the board ends, m from the nut: there is nothing under the strings beyond.
    pub fn board_end(&self) -> f64 {
        (self.equal_place(self.frets as f64) + OVERHANG).min(self.scale_length)
    }

    /// Height of the board at `place` (m from the nut) over the string at rest, m, or nothing beyond
    /// its end.
    pub fn board_height(&self, place: f64) -> Option<f64> {
        (place <= self.board_end()).then(|| self.board_line(place))
    }

    /// The same wherever the board ends.
    pub fn board_line(&self, place: f64) -> f64 {
        self.crown_height(place) - self.fret_height
    }

    /// Places (m from the nut) and heights (m over the string at rest, negative) of the crowns of frets at `frets`, m from the
    /// nut, wear included.
    pub fn crowns(&self, frets: &[f64]) -> Vec<[f64; 2]> {
        let wear = |number: usize| {
            self.worn.iter().filter(|(fret, _)| *fret == number).map(|(_, wear)| wear).sum::<f64>()
        };
        let crown = |(index, &place): (usize, &f64)| [place, self.crown_height(place) - wear(index + 1)];
        frets.iter().enumerate().map(crown).collect()
    }

    /// The barrier under a string whose frets stand at `frets` (m from the nut).
    ///
    /// # Errors
    /// When the contact law is out of range.
    pub fn barrier(&self, frets: &[f64]) -> Result<Barrier, Error> {
        let end = self.board_end();
        let board = (0..=PIECES)
            .map(|piece| {
                let place = end * piece as f64 / PIECES as f64;
                [place, self.board_line(place)]
            })
            .collect();
        Ok(Barrier {
            law: ContactLaw::new("neck", self.stiffness, self.exponent)?,
            damping: self.damping,
            board: Some(Curve::Points(board)),
            frets: if self.fretless { Vec::new() } else { self.crowns(frets) },
            placement: FretPlacement::Kinked,
            board_reference_spacing: Some(self.board_reference_spacing),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Neck;

    /// Crowns lie under the line through frets 1 and 12 by no more than the relief, and the board follows them.
    #[test]
    fn no_crown_lies_lower_than_relief_explains() {
        let neck = crate::Setup::builtin("electric").expect("it is built in").neck;
        for frets in 1..=Neck::MOST_FRETS {
            let neck = Neck { frets, relief: 3e-4, ..neck.clone() };
            let straight = Neck { relief: 0.0, ..neck.clone() };
            assert!(neck.most_relief() >= 3e-4, "{frets} frets");
            let end = neck.board_end();
            for place in
                neck.equal_places().into_iter().chain((0..=100).map(|part| end * part as f64 / 100.0))
            {
                let dip = straight.crown_height(place) - neck.crown_height(place);
                // At 12 frets or more the parabola goes on beyond them, and the line rises with it.
                let range = if frets < 12 { 0.0 } else { f64::NEG_INFINITY }..=3e-4 * (1.0 + 1e-9);
                assert!(range.contains(&dip), "{frets} frets, {place} m: {dip:e} m");
            }
        }
    }
}
