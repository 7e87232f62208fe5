//! The board of a scene, as it may be given: a height, heights along the strings, or three of them.

use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use crate::curve::{Along, Curve, Parabola};
use crate::digits::{at_most, plain};
use crate::error::{Error, within};
use crate::model::Barrier;

/// The board under all strings of a scene.
#[derive(Debug, Clone, PartialEq)]
pub enum BoardSpec {
    /// A height, m, −10 to 0, or a profile `[[x, height], …]`, beyond whose ends there is no board.
    Profile(Curve),
    /// The parabola through three heights, under each string from its nut to its bridge.
    Parabola(BoardHeights),
}

/// Three heights of a board that is a parabola.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoardHeights {
    /// At the nut, m, −10 to 0.
    pub nut: f64,
    /// Half way between nut and bridge of each string, m, −10 to 0, and so low that the parabola is nowhere above 0.
    pub middle: f64,
    /// At the bridge, m, −10 to 0.
    pub bridge: f64,
}

impl BoardSpec {
    /// The board under a string of a length, m.
    pub fn under(&self, length: f64) -> Curve {
        match self {
            BoardSpec::Profile(profile) => profile.clone(),
            BoardSpec::Parabola(BoardHeights { nut, middle, bridge }) => {
                Curve::Parabola(Parabola { end: length, values: [*nut, *middle, *bridge] })
            }
        }
    }

    /// Refuses heights out of their range.
    pub(super) fn check(&self) -> Result<(), Error> {
        let low = -Barrier::FARTHEST;
        let heights = match self {
            BoardSpec::Profile(profile) => {
                return profile.check("fretboard.board", Along::ANYWHERE, low, 0.0, "m");
            }
            BoardSpec::Parabola(heights) => heights,
        };
        within("fretboard.board.nut", heights.nut, low, 0.0, "m")?;
        within("fretboard.board.bridge", heights.bridge, low, 0.0, "m")?;
        let high = heights.highest_middle();
        if heights.middle >= low && heights.middle <= high {
            return Ok(());
        }
        let accepted = format!(
            "it must lie between {} and {} m, for the board to be nowhere above the strings at rest",
            plain(low),
            plain(at_most(high))
        );
        Err(Error::range("fretboard.board.middle", plain(heights.middle), accepted))
    }
}

impl BoardHeights {
    /// The highest middle with which the parabola is nowhere above 0, m, between ends that are not.
    ///
    /// Over the part s of the length it is nut·(1 − s)² + 2m·s(1 − s) + bridge·s², with m = 2·middle − (nut + bridge)/2. If m is
    /// √(nut·bridge), that is −(√−nut·(1 − s) − √−bridge·s)², which touches 0; with a lower m it is lower everywhere between.
    fn highest_middle(&self) -> f64 {
        let highest = 0.25 * (self.nut + self.bridge) + 0.5 * (self.nut * self.bridge).sqrt();
        // It is no more than that of equal ends, but for rounding.
        highest.min(0.0)
    }
}

impl From<Curve> for BoardSpec {
    fn from(profile: Curve) -> Self {
        BoardSpec::Profile(profile)
    }
}

impl<'de> Deserialize<'de> for BoardSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct BoardVisitor;
        impl<'de> Visitor<'de> for BoardVisitor {
            type Value = BoardSpec;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a height, a list of pairs [[place, height], ...] or three heights { nut, middle, bridge }")
            }
            fn visit_f64<E: serde::de::Error>(self, height: f64) -> Result<BoardSpec, E> {
                Ok(Curve::Constant(height).into())
            }
            fn visit_i64<E: serde::de::Error>(self, height: i64) -> Result<BoardSpec, E> {
                Ok(Curve::Constant(height as f64).into())
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<BoardSpec, A::Error> {
                Curve::deserialize(SeqAccessDeserializer::new(list)).map(BoardSpec::Profile)
            }
            fn visit_map<A: MapAccess<'de>>(self, table: A) -> Result<BoardSpec, A::Error> {
                BoardHeights::deserialize(MapAccessDeserializer::new(table)).map(BoardSpec::Parabola)
            }
        }
        // (Not by an untagged choice, which could not say what is wrong inside.)
        deserializer.deserialize_any(BoardVisitor)
    }
}
