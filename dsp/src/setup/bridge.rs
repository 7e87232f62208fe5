//! A wide bridge, which the strings wrap over.

use serde::{Deserialize, Serialize};

use crate::digits::{at_least, at_most, plain};
use crate::error::{Error, within};
use crate::grid::Grid;
use crate::model::Barrier;
use crate::neck::Neck;

/// A wide bridge that falls away under the strings, as on sitar and tanpura: its top is at the saddle, where
/// the strings end, and towards the nut it is part of a circle under them.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Bridge {
    /// How far it reaches from the saddle under the strings, m: 1e-4 or more, clear of the board, and as far at least as the grid
    /// points of each string are apart.
    pub length: f64,
    /// Radius of its curve, m, 1e-3 to 1e3: at x from the saddle it is x²/(2·radius) below the string, 10 m at most where it ends.
    pub radius: f64,
}

/// Pieces of the polyline that stands for a bridge's curve.
const PIECES: usize = 32;
/// Where board and bridge end, the barrier drops within this distance, m, to this height, m: deeper than
/// any string swings.
const EDGE: f64 = 1e-6;
const ABYSS: f64 = -0.05;
/// The least between board and bridge, m: both edges, and a bottom between them.
const GAP: f64 = 3.0 * EDGE;

impl Bridge {
    /// Height of its top so far from the saddle, m, over the string at rest, m: 0 at the saddle and negative elsewhere.
    pub fn height(&self, from_saddle: f64) -> f64 {
        -from_saddle * from_saddle / (2.0 * self.radius)
    }

    /// Refuses values outside their range beside a neck.
    pub(super) fn check(&self, neck: &Neck) -> Result<(), Error> {
        // (There is always room: with all its frets the shortest neck ends 4.5 mm before the saddle.)
        let (least, room) = (1e-4, neck.scale_length - neck.board_end() - GAP);
        if !(least..=room).contains(&self.length) {
            let most = plain(at_most(room));
            let accepted = format!("it must lie between {} and {most} m, clear of the board", plain(least));
            return Err(Error::range("bridge.length", plain(self.length), accepted));
        }
        let (tightest, widest) = (1e-3, 1e3);
        within("bridge.radius", self.radius, tightest, widest, "m")?;
        if self.height(self.length) >= -Barrier::FARTHEST {
            return Ok(());
        }
        let tightest = at_least(self.length * self.length / (2.0 * Barrier::FARTHEST));
        let accepted = format!(
            "of a bridge.length of {} m it must lie between {} and {} m, or the bridge ends more than {} m below the strings",
            plain(self.length),
            plain(tightest),
            plain(widest),
            plain(Barrier::FARTHEST),
        );
        Err(Error::range("bridge.radius", plain(self.radius), accepted))
    }

    /// Refuses one that lies between two points of a string's grid, and so would never be touched.
    pub(crate) fn check_grid(&self, grid: &Grid) -> Result<(), Error> {
        if self.length >= grid.spacing {
            return Ok(());
        }
        let least = plain(at_least(grid.spacing));
        let accepted =
            format!("points of the grid are {least} m apart, and it must be as long as that at least");
        Err(Error::range("bridge.length", plain(self.length), accepted))
    }

    /// Places, m from the nut, and heights, m, of what follows the end of the board. Between both there is nothing to touch.
    pub(super) fn outline(&self, neck: &Neck) -> impl Iterator<Item = [f64; 2]> {
        let (bridge, end) = (*self, neck.scale_length);
        let gap = [[neck.board_end() + EDGE, ABYSS], [end - bridge.length - EDGE, ABYSS]];
        let top = (0..=PIECES).map(move |piece| {
            let from_saddle = bridge.length * (1.0 - piece as f64 / PIECES as f64);
            [end - from_saddle, bridge.height(from_saddle)]
        });
        gap.into_iter().chain(top)
    }
}
