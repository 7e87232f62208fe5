//! The strings as they move: where each is now, and the blur of where it has been since the last picture.

use egui::{Color32, Painter, Pos2, Stroke, pos2};
use low_action_dsp::Setup;
use low_action_dsp::setup::SetupString;

use super::Sight;
use crate::display::{POINTS, Snapshot, StringSeen};
use crate::editor::shapes::band;
use crate::editor::theme;

/// Densities of what strings are made of, kg/m³: steel, and nylon where the core is soft.
const STEEL: f64 = 7850.0;
const NYLON: f64 = 1100.0;
/// What is stiffer than this, Pa, is steel.
const STIFF: f64 = 5e10;
/// A string this much heavier than its core is wound.
const WINDING: f64 = 1.15;

/// Paints all strings, at rest where there is no picture of them yet.
pub(super) fn paint(painter: &Painter, sight: &Sight, setup: &Setup, snapshot: &Snapshot) {
    for (index, spec) in setup.string.iter().enumerate() {
        let (width, colour) = look(spec);
        let seen = snapshot.strings().get(index);
        let y = sight.y(index);
        let points: Vec<Pos2> = match seen {
            Some(seen) => points(sight, seen, y, &seen.displacement),
            None => [0.0, setup.neck.scale_length as f32].map(|place| pos2(sight.x(place), y)).to_vec(),
        };
        let shadow: Vec<Pos2> = points.iter().map(|point| pos2(point.x, y + 0.09 * sight.spacing)).collect();
        painter.line(shadow, Stroke::new(width + 1.5, Color32::from_black_alpha(70)));
        if let Some(seen) = seen {
            paint_blur(painter, sight, seen, y, colour);
        }
        painter.line(points, Stroke::new(width, colour));
    }
}

/// How thick a string is drawn, points, and in which colour.
pub(in crate::editor) fn look(string: &SetupString) -> (f32, Color32) {
    let density = if string.youngs_modulus > STIFF { STEEL } else { NYLON };
    let section = string.linear_density / density;
    let diameter = 2.0 * (section / std::f64::consts::PI).sqrt();
    let core = std::f64::consts::PI * string.core_radius * string.core_radius;
    let colour = if section > WINDING * core { theme::WOUND } else { theme::PLAIN };
    ((1.0 + 2.0 * 1e3 * diameter as f32).min(5.0), colour)
}

fn points(sight: &Sight, seen: &StringSeen, y: f32, heights: &[f32; POINTS]) -> Vec<Pos2> {
    let at = |(point, height): (usize, &f32)| pos2(sight.x(seen.place(point)), y - height * sight.lift);
    heights.iter().enumerate().map(at).collect()
}

/// Fills what lies between the lowest and the highest that a string has been.
fn paint_blur(painter: &Painter, sight: &Sight, seen: &StringSeen, y: f32, colour: Color32) {
    let wide = |point: usize| (seen.highest[point] - seen.lowest[point]) * sight.lift;
    if (0..POINTS).all(|point| wide(point) < 0.5) {
        return;
    }
    let colour = theme::faint(colour, 0.22);
    painter.add(band((0..POINTS).map(|point| {
        let x = sight.x(seen.place(point));
        [seen.highest[point], seen.lowest[point]].map(|height| (pos2(x, y - height * sight.lift), colour))
    })));
}
