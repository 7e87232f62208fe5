//! What a picture shows along the string: the string itself, and what lies under it.

use low_action_dsp::Scene;
use low_action_dsp::curve::Curve;
use low_action_dsp::model::{Contact, ContactKind};
use low_action_dsp::simulation::SceneString;

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

/// Straight lines that a parabola is drawn by: its arc is off theirs by a 4096th of what it is off its chord.
const LINES: u32 = 64;

/// What there is of a board between the ends of a string, (m from the nut, mm).
fn cut(board: &Curve, length: f64) -> Vec<(f64, f64)> {
    let corners: Vec<f64> = match board {
        Curve::Constant(_) => vec![0.0, length],
        Curve::Points(points) => points.iter().map(|point| point[0]).collect(),
        Curve::Parabola(_) => (0..=LINES).map(|i| length * (f64::from(i) / f64::from(LINES))).collect(),
    };
    let (Some(first), Some(last)) = (corners.first(), corners.last()) else { return Vec::new() };
    let (start, end) = (first.max(0.0), last.min(length));
    if start > end {
        return Vec::new();
    }
    let between = corners.iter().copied().filter(|&place| place > start && place < end);
    let places = std::iter::once(start).chain(between).chain([end]);
    places.map(|place| (place, 1e3 * board.at(place))).collect()
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
    /// Board and frets under a string of a scene, where they act.
    pub fn under(string: &SceneString, scene: &Scene) -> Ground {
        let length = string.model.grid.length;
        let board = scene.fretboard.as_ref().and_then(|fretboard| fretboard.board.as_ref());
        let crown = |contact: &Contact| match contact.kind {
            ContactKind::Fret { .. } => Some((contact.place, 1e3 * contact.height)),
            ContactKind::Board { .. } => None,
        };
        Ground {
            length,
            board: board.map_or(Vec::new(), |board| cut(&board.under(length), length)),
            crowns: string.model.contacts.iter().filter_map(crown).collect(),
        }
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

#[cfg(test)]
mod tests {
    use low_action_dsp::Simulation;

    use super::*;

    fn ground(fretboard: &str) -> Ground {
        let text = "sample_rate = 44100\nduration = 0.1\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                    tension = 60.0\n[fretboard]\nstiffness = 1e10\nexponent = 1.5\n";
        let scene = Scene::from_toml(&format!("{text}{fretboard}\n")).unwrap();
        Ground::under(Simulation::new(&scene).unwrap().string(0), &scene)
    }

    #[test]
    fn only_what_is_under_the_string_is_drawn() {
        let board =
            ground("board = [[-1.0, -10.0], [0.0, -0.002], [0.3, -0.004], [0.65, -0.002], [2.0, -10.0]]")
                .board;
        assert_eq!(board, [(0.0, -2.0), (0.3, -4.0), (0.65, -2.0)]);
        let board = ground("board = [[-0.5, -0.002], [0.5, -0.004]]").board;
        assert_eq!(board, [(0.0, -3.0), (0.5, -4.0)]);
        assert_eq!(ground("board = [[-0.5, -0.002], [-0.1, -0.004]]").board, []);
        assert_eq!(ground("board = -0.002").board, [(0.0, -2.0), (0.65, -2.0)]);
        let parabola = ground("board = { nut = -0.001, middle = -0.003, bridge = -0.001 }");
        assert_eq!((parabola.board[0], parabola.board[64]), ((0.0, -1.0), (0.65, -1.0)));
        // Its deepest point is drawn, and between any two the arc is off by less than a thousandth of its 2 mm.
        for (place, height) in [(0.325, -3.0), (0.65 / 4.0, -2.5), (0.65 * 0.3, -2.68)] {
            let drawn = parabola.board_at(place).expect("it is all along the string");
            assert!((drawn - height).abs() < 2e-3, "{drawn} mm at {place} m");
        }
    }

    #[test]
    fn frets_are_drawn_where_they_act() {
        let frets = "frets = [0.2, 0.4]\nfret_top = [-0.001, -0.002]\nfret_placement = ";
        let exact = ground(&format!("{frets}\"exact\"")).crowns;
        assert_eq!(exact, [(0.2, -1.0), (0.4, -2.0)]);
        let nearest = ground(&format!("{frets}\"nearest\"")).crowns;
        for (near, exact) in nearest.iter().zip(&exact) {
            assert!(
                near.0 != exact.0 && (near.0 - exact.0).abs() < 1e-3 && near.1 == exact.1,
                "{near:?} {exact:?}"
            );
        }
    }
}
