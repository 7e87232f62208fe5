//! Board and frets under one string, and the contacts that they are over a grid.

use super::{Contact, ContactKind};
use crate::contact::ContactLaw;
use crate::curve::{Along, CountOrList, Curve, MOST_FRETS, OneOrEach};
use crate::error::{Error, ranged, within};
use crate::grid::{AT_NODE, Grid, Reading};
use crate::scene::{FretPlacement, FretboardSpec};

/// Place of a fret in equal temperament, m from the nut, of a string of a length, m: fret m leaves 2^(−m/12) of it.
pub(crate) fn equal_place(length: f64, fret: f64) -> f64 {
    length * (1.0 - libm::exp2(-fret / 12.0))
}

/// Board and frets under one string.
#[derive(Debug, Clone, PartialEq)]
pub struct Barrier {
    /// Contact law of a fret, and of a board point unless `board_reference_spacing` is given; its stiffness 1e-3 to 1e30
    /// N/m^exponent.
    pub law: ContactLaw,
    /// Hunt–Crossley damping of board and frets, s/m, 0 to 1e5.
    pub damping: f64,
    /// Height of the board, −10 to 10 m, over places, m, in increasing order; none beyond the ends of its points or its parabola.
    pub board: Option<Curve>,
    /// Places, m from the nut, and heights, −10 to 10 m, of the crowns; 1000 at most.
    pub frets: Vec<[f64; 2]>,
    /// Where frets act on the grid.
    pub placement: FretPlacement,
    /// Spacing for which the law's stiffness holds at board points, m, 1e-6 to 1e3.
    pub board_reference_spacing: Option<f64>,
}

impl Barrier {
    /// How far a board or a crown may be from the string at rest, m: ten times farther than anybody needs.
    pub(crate) const FARTHEST: f64 = 10.0;
    /// What the damping may be, s/m.
    pub(crate) const DAMPING: [f64; 2] = [0.0, 1e5];
    /// What the spacing may be for which the law's stiffness holds at board points, m.
    pub(crate) const REFERENCE_SPACING: [f64; 2] = [1e-6, 1e3];

    /// The barrier of a scene under a string of the given length, m.
    ///
    /// # Errors
    /// When a value of the description is out of its range.
    pub fn from_spec(spec: &FretboardSpec, length: f64) -> Result<Self, Error> {
        spec.check()?;
        let places: Vec<f64> = match &spec.frets {
            CountOrList::Count(count) => (1..=*count).map(|fret| equal_place(length, fret as f64)).collect(),
            CountOrList::List(places) => places.clone(),
        };
        let height = |i: usize| match &spec.fret_top {
            None => 0.0,
            Some(OneOrEach::One(height)) => *height,
            Some(OneOrEach::Each(heights)) => heights[i],
        };
        Ok(Barrier {
            law: ContactLaw::new("fretboard", spec.stiffness, spec.exponent)?,
            damping: spec.damping,
            board: spec.board.as_ref().map(|board| board.under(length)),
            frets: places.iter().enumerate().map(|(i, &x)| [x, height(i)]).collect(),
            placement: spec.fret_placement,
            board_reference_spacing: spec.board_reference_spacing,
        })
    }

    /// Refuses what no barrier can have. (Whether frets are on the string is seen on its grid.)
    fn check(&self) -> Result<(), Error> {
        ranged("fretboard.stiffness", self.law.stiffness(), ContactLaw::STIFFNESS, "N/m^exponent")?;
        ranged("fretboard.damping", self.damping, Self::DAMPING, "s/m")?;
        if let Some(board) = &self.board {
            board.check("fretboard.board", Along::ANYWHERE, -Self::FARTHEST, Self::FARTHEST, "m")?;
        }
        within("number of fretboard.frets", self.frets.len() as f64, 0.0, MOST_FRETS as f64, "")?;
        for (i, [_, height]) in self.frets.iter().enumerate() {
            within(&format!("fretboard.fret_top[{}]", i + 1), *height, -Self::FARTHEST, Self::FARTHEST, "m")?;
        }
        if let Some(spacing) = self.board_reference_spacing {
            ranged("fretboard.board_reference_spacing", spacing, Self::REFERENCE_SPACING, "m")?;
        }
        Ok(())
    }

    /// The contacts over a grid, in order of place. The barrier is one height at each point: where several frets share it, that of
    /// the highest; and a fret at a grid point stands there instead of the board, higher or not.
    pub(super) fn contacts(&self, grid: &Grid) -> Result<Vec<Contact>, Error> {
        self.check()?;
        let mut contacts = Vec::new();
        let damping = self.damping;
        if let Some(board) = &self.board {
            let scale = self.board_reference_spacing.map_or(1.0, |spacing| grid.spacing / spacing);
            let law = self.law.with_stiffness(self.law.stiffness() * scale);
            for node in 1..grid.intervals {
                let place = grid.place(node);
                let beyond = match board {
                    Curve::Constant(_) => false,
                    Curve::Points(p) => place < p[0][0] || place > p[p.len() - 1][0],
                    Curve::Parabola(parabola) => place > parabola.end,
                };
                if !beyond {
                    let reading = Reading::at_node(grid, node);
                    let kind = ContactKind::Board { node };
                    contacts.push(Contact {
                        place,
                        reading,
                        law,
                        damping,
                        height: board.at(place),
                        radiation: 0.0,
                        kind,
                    });
                }
            }
        }
        for (index, &[place, height]) in self.frets.iter().enumerate() {
            grid.check_place(&format!("fretboard.frets[{}]", index + 1), place)?;
            let (place, reading) = match self.placement {
                FretPlacement::Exact | FretPlacement::Kinked => (place, grid.reading(place)),
                FretPlacement::Nearest => {
                    // Half way between two it is the one farther from the nut, however the quotient is rounded.
                    let node = (place / grid.spacing + AT_NODE).round() as usize;
                    let node = node.clamp(1, grid.intervals - 1);
                    (grid.place(node), Reading::at_node(grid, node))
                }
            };
            let kind = ContactKind::Fret { index };
            let fret = Contact { place, reading, law: self.law, damping, height, radiation: 0.0, kind };
            let same = contacts.iter().position(|other| other.reading == reading);
            match same {
                Some(i) if matches!(contacts[i].kind, ContactKind::Board { .. }) => contacts[i] = fret,
                Some(i) if contacts[i].height >= height => {}
                Some(i) => contacts[i] = fret,
                None => contacts.push(fret),
            }
        }
        contacts.sort_by(|a, b| a.place.total_cmp(&b.place));
        Ok(contacts)
    }
}
