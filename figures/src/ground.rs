//! What a picture shows along the string: the string itself, and what lies under it.

use low_action_dsp::curve::Curve;
use low_action_dsp::model::Barrier;
use low_action_dsp::simulation::SceneString;
use low_action_dsp::{Error, Scene};

/// The string at one moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Profile {
    /// Points of the string with its ends, (m from the nut, mm).
    pub string: Vec<(f64, f64)>,
    /// Pads of the fingers over it, (m from the nut, mm).
    pub fingers: Vec<(f64, f64)>,
    /// Whether each of them touches it.
    pub touching: Vec<bool>,
}

/// The most points of a string that are drawn.
const MOST_POINTS: usize = 2000;

impl Profile {
    /// The string as it is.
    pub fn of(string: &SceneString) -> Profile {
        let heights = string.state.displacement();
        let every = string.model.grid.intervals.div_ceil(MOST_POINTS).max(1);
        let mut points = vec![(0.0, 0.0)];
        points.extend(string.places().zip(heights).step_by(every).map(|(x, u)| (x, 1e3 * u)));
        points.push((string.model.grid.length, 0.0));
        let fingers = string.state.fingers().iter().flatten();
        Profile {
            string: points,
            fingers: fingers.map(|finger| (finger.position, 1e3 * finger.height)).collect(),
            touching: string.fingers().map(|finger| finger.force > 0.0).collect(),
        }
    }

    /// The lowest and the highest point of string and fingers, mm.
    pub fn extent(&self) -> (f64, f64) {
        let heights = self.string.iter().chain(&self.fingers).map(|point| point.1);
        heights.fold((0.0, 0.0), |(low, high), height| (f64::min(low, height), f64::max(high, height)))
    }
}

/// What lies under the string.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ground {
    /// Length of the string, m.
    pub length: f64,
    /// The board's upper edge, (m from the nut, mm); empty without a board.
    pub board: Vec<(f64, f64)>,
    /// The crowns, (m from the nut, mm).
    pub crowns: Vec<(f64, f64)>,
}

impl Ground {
    /// Board and frets under a string of a scene, 0 for the first.
    ///
    /// # Errors
    /// When the scene's fretboard is refused.
    pub fn under(scene: &Scene, string: usize) -> Result<Ground, Error> {
        let length = scene.string[string].length;
        let Some(spec) = &scene.fretboard else { return Ok(Ground { length, ..Ground::default() }) };
        let barrier = Barrier::from_spec(spec, length)?;
        let board = match &barrier.board {
            None => Vec::new(),
            Some(Curve::Constant(height)) => vec![(0.0, 1e3 * height), (length, 1e3 * height)],
            Some(Curve::Points(points)) => points.iter().map(|p| (p[0], 1e3 * p[1])).collect(),
        };
        let crowns = barrier.frets.iter().map(|fret| (fret[0], 1e3 * fret[1])).collect();
        Ok(Ground { length, board, crowns })
    }

    /// The lowest and the highest point, mm.
    pub fn extent(&self) -> (f64, f64) {
        let heights = self.board.iter().chain(&self.crowns).map(|point| point.1);
        heights.fold((0.0, 0.0), |(low, high), height| (f64::min(low, height), f64::max(high, height)))
    }

    /// Height of the board at a place, mm, if there is one.
    pub fn board_at(&self, place: f64) -> Option<f64> {
        let pair = self.board.windows(2).find(|pair| place >= pair[0].0 && place <= pair[1].0)?;
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
        Some(y0 + (y1 - y0) * (place - x0) / (x1 - x0))
    }
}
