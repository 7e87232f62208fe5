//! One of a few things, chosen from a list.

use egui::{
    Align2, Button, CursorIcon, Popup, Rect, Response, ScrollArea, Sense, Shape, Stroke, Ui, pos2, vec2,
};
use nice_plug::prelude::Param;

use super::{Arrows, NAME, come_into_sight, explain, follow_keys, is_taken, paint_name, set, shown};
use crate::editor::shapes::fit_text;
use crate::editor::{Given, theme};

/// Highest that a list is, points; what is longer scrolls.
const HIGHEST: f32 = 320.0;

/// Shows it: the first `count` values of the parameter can be chosen. Its answer is changed where one is, be it the same.
pub fn choice<P: Param>(ui: &mut Ui, given: &Given, param: &P, area: Rect, count: usize) -> Response {
    let id = ui.scope_id().with(param.name());
    let mut response = ui.interact(area, id, Sense::click());
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::ComboBox, true, param.name());
        info.current_text_value = Some(shown(given, param));
        info
    });
    let steps = param.step_count().unwrap_or(1).max(1) as f32;
    let last = count.saturating_sub(1) as f32 / steps;
    // The next one stands below in the list.
    let arrows = Arrows { up_is_less: true, ..Arrows::default() };
    // Not whether the value is another than it was: a host may move it meanwhile.
    let mut is_chosen_here = follow_keys(ui, given, param, &response, (arrows, last));
    come_into_sight(&response);
    paint_name(ui, param.name(), area, &response, f32::INFINITY);
    paint_value(ui, &shown(given, param), area, &response);
    let chosen = given.value(param);
    Popup::menu(&response).width(area.width()).show(|ui| {
        ScrollArea::vertical().max_height(HIGHEST).show(ui, |ui| {
            for index in 0..count {
                let value = index as f32 / steps;
                let text = param.normalized_value_to_string(value, true);
                let is_chosen = (value - chosen).abs() < 0.5 / steps;
                let mut line = line(ui, is_chosen, &text, area.width());
                if let Some(heard) = given.words.heard_of(param, index) {
                    line = line.on_hover_ui(|ui| {
                        ui.set_max_width(280.0);
                        ui.label(heard);
                    });
                }
                if line.clicked() {
                    set(given, param, value);
                    is_chosen_here = true;
                    ui.close();
                }
            }
        });
    });
    if is_chosen_here {
        response.mark_changed();
    }
    explain(given, param, response.on_hover_cursor(CursorIcon::PointingHand))
}

/// A line of a list.
pub fn line(ui: &mut Ui, is_chosen: bool, text: &str, width: f32) -> Response {
    ui.spacing_mut().button_padding = vec2(theme::NEAR, 0.0);
    ui.add(Button::selectable(is_chosen, text).min_size(vec2(width, 0.0)))
}

/// The value in a box with a mark that there are others, cut off where there is no room.
fn paint_value(ui: &Ui, text: &str, area: Rect, response: &Response) {
    let painter = ui.painter();
    let row = Rect::from_min_max(pos2(area.left(), area.top() + NAME), area.max);
    painter.rect_filled(row, 4.0, if is_taken(response) { theme::LIFTED } else { theme::RAISED });
    let inside = row.shrink2(vec2(6.0, 0.0)).with_max_x(row.right() - 16.0);
    let place = (inside.left_center(), Align2::LEFT_CENTER);
    fit_text(painter, place, text, (theme::SMALL, theme::TEXT), inside.width());
    let middle = pos2(row.right() - 10.0, row.center().y);
    let corners = [vec2(-3.5, -2.0), vec2(3.5, -2.0), vec2(0.0, 2.5)].map(|corner| middle + corner);
    painter.add(Shape::convex_polygon(corners.to_vec(), theme::SOFT_TEXT, Stroke::NONE));
}
