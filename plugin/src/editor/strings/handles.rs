//! What can be moved along the strings: the place of the pluck and the pickup.

use egui::{Align2, Color32, CursorIcon, Rect, Shape, Stroke, Ui, pos2, vec2};
use low_action_dsp::Setup;
use low_action_dsp::setup::Pickup;

use super::Sight;
use crate::controls::{coil_places, pluck_places};
use crate::editor::control::Handle;
use crate::editor::{Given, theme};

/// Size of a handle, points: enough for a finger.
const SIZE: egui::Vec2 = vec2(24.0, 20.0);
/// How far a word reaches over its own mark, points, and how far it stays off where the other mark is so close.
const OVER: f32 = 6.0;
const OFF: f32 = 4.0;
const CLOSE: f32 = 16.0;

/// How a handle looks.
struct Mark {
    text: &'static str,
    colour: Color32,
    /// Where it is, points.
    x: f32,
    /// Where its word begins or ends.
    beside: f32,
    /// Whether the word ends there.
    to_the_left: bool,
}

/// Shows the handles over the board's upper edge, each with a line down across the strings.
pub(super) fn show(ui: &mut Ui, given: &Given, sight: &Sight, setup: &Setup) {
    let scale = setup.neck.scale_length as f32;
    // To the right is towards the saddle; the parameters count millimetres away from it.
    let growth = vec2(-1e3 / sight.along, 0.0);
    let pluck = given.plan.player().map(|player| sight.x(scale - player.pluck_position as f32));
    let pickup = match setup.pickup {
        Pickup::Magnetic { position, .. } => Some(sight.x(scale - position as f32)),
        Pickup::Bridge {} | Pickup::Microphone {} => None,
    };
    let mark = |text, colour, x: f32, other: Option<f32>| {
        // Words are on the sides that do not face each other.
        let to_the_left = other.map_or(text == PICKUP, |other| x < other || (x == other && text == PICKUP));
        let off = if other.is_some_and(|other| (x - other).abs() < CLOSE) { OFF } else { -OVER };
        Mark { text, colour, x, beside: if to_the_left { x - off } else { x + off }, to_the_left }
    };
    let (params, own) = (given.params, given.plan.own().unwrap_or(setup));
    // The parameters count from where the set-up has them.
    let from = |place: f64, ends: [f64; 2]| ends.map(|end| 1e3 * (end - place));
    let scale = setup.neck.scale_length;
    if let Some(x) = pluck {
        let place = own.player.pluck_position;
        let reach = from(place, pluck_places(place, scale));
        let handle = Handle { param: &params.player.pluck_position, growth, reach };
        show_mark(ui, given, sight, &handle, &mark(PLUCK, theme::PLUCK, x, pickup));
    }
    if let (Some(x), Pickup::Magnetic { position, aperture, .. }) = (pickup, &own.pickup) {
        let reach = from(*position, coil_places(*position, *aperture, scale));
        let handle = Handle { param: &params.setup.pickup_position, growth, reach };
        show_mark(ui, given, sight, &handle, &mark(PICKUP, theme::STEEL, x, pluck));
    }
}

const PLUCK: &str = "pluck";
const PICKUP: &str = "pickup";

fn show_mark(ui: &mut Ui, given: &Given, sight: &Sight, handle: &Handle, mark: &Mark) {
    let board = sight.board(0.0, 0.0);
    let tip = pos2(mark.x, board.top());
    let area = Rect::from_min_size(pos2(tip.x - 0.5 * SIZE.x, tip.y - SIZE.y), SIZE);
    let response = handle.show(ui, given, area).on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    let taken = response.dragged() || response.hovered() || response.has_focus();
    let colour = if taken { mark.colour } else { theme::faint(mark.colour, 0.75) };
    let painter = ui.painter();
    let line = Stroke::new(1.0, theme::faint(colour, if taken { 0.8 } else { 0.35 }));
    painter.extend(Shape::dashed_line(&[tip, pos2(tip.x, board.bottom())], line, 3.0, 5.0));
    let shape = [vec2(-6.0, -11.0), vec2(6.0, -11.0), vec2(6.0, -5.0), vec2(0.0, 0.0), vec2(-6.0, -5.0)];
    let points = shape.map(|corner| tip + corner).to_vec();
    painter.add(Shape::convex_polygon(points, colour, Stroke::NONE));
    let anchor = if mark.to_the_left { Align2::RIGHT_BOTTOM } else { Align2::LEFT_BOTTOM };
    painter.text(pos2(mark.beside, tip.y - 14.0), anchor, mark.text, theme::SMALL, colour);
}
