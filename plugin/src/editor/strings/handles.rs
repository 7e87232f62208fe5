//! What can be moved along the strings: the place of the pluck and the pickup.

use egui::{Align2, Color32, CursorIcon, Rect, Shape, Stroke, Ui, pos2, vec2};
use low_action_dsp::Setup;
use low_action_dsp::setup::Pickup;

use super::Sight;
use crate::editor::control::Handle;
use crate::editor::{Given, theme};

/// Size of a handle, points: enough for a finger.
const SIZE: egui::Vec2 = vec2(24.0, 20.0);

/// Shows the handles over the board's upper edge, each with a line down across the strings.
pub(super) fn show(ui: &mut Ui, given: &Given, sight: &Sight, setup: &Setup) {
    let scale = setup.neck.scale_length as f32;
    // To the right is towards the saddle; the parameters count millimetres away from it.
    let growth = vec2(-1e3 / sight.along, 0.0);
    if let Some(player) = given.plan.player() {
        let handle = Handle { param: &given.params.player.pluck_position, growth };
        let place = scale - player.pluck_position as f32;
        mark(ui, given, sight, &handle, place, ("pluck", Align2::LEFT_BOTTOM), theme::PLUCK);
    }
    if let Pickup::Magnetic { position, .. } = setup.pickup {
        let handle = Handle { param: &given.params.setup.pickup_position, growth };
        let label = ("pickup", Align2::RIGHT_BOTTOM);
        mark(ui, given, sight, &handle, scale - position as f32, label, theme::STEEL);
    }
}

fn mark(
    ui: &mut Ui,
    given: &Given,
    sight: &Sight,
    handle: &Handle,
    place: f32,
    (label, side): (&str, Align2),
    colour: Color32,
) {
    let board = sight.board(place, place);
    let tip = pos2(board.left(), board.top());
    let area = Rect::from_min_size(pos2(tip.x - 0.5 * SIZE.x, tip.y - SIZE.y), SIZE);
    let response = handle.show(ui, given, area).on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    let taken = response.dragged() || response.hovered() || response.has_focus();
    let colour = if taken { colour } else { theme::faint(colour, 0.75) };
    let painter = ui.painter();
    let line = Stroke::new(1.0, theme::faint(colour, if taken { 0.8 } else { 0.35 }));
    painter.extend(Shape::dashed_line(&[tip, pos2(tip.x, board.bottom())], line, 3.0, 5.0));
    let shape = [vec2(-6.0, -11.0), vec2(6.0, -11.0), vec2(6.0, -5.0), vec2(0.0, 0.0), vec2(-6.0, -5.0)];
    let points = shape.map(|corner| tip + corner).to_vec();
    painter.add(Shape::convex_polygon(points, colour, Stroke::NONE));
    let beside = if side == Align2::LEFT_BOTTOM { -6.0 } else { 6.0 };
    painter.text(pos2(tip.x + beside, tip.y - 14.0), side, label, theme::SMALL, colour);
}
