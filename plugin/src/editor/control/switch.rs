//! Something that is on or off.

use egui::{Align2, CursorIcon, Rect, Response, Sense, Ui, pos2, vec2};
use nice_plug::prelude::{BoolParam, Param};

use super::{
    Arrows, NAME, come_into_sight, explain, follow_keys, is_taken, paint_name, set, shown, strength,
};
use crate::editor::{Given, theme};

/// Shows it. A click turns it over.
pub fn switch(ui: &mut Ui, given: &Given, param: &BoolParam, area: Rect) -> Response {
    let id = ui.scope_id().with(param.name());
    let response = ui.interact(area, id, Sense::click());
    let on = given.plain(param);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, on, param.name()));
    if response.clicked() {
        set(given, param, if on { 0.0 } else { 1.0 });
    }
    follow_keys(ui, given, param, &response, (Arrows::default(), 1.0));
    come_into_sight(&response);
    paint_name(ui, param.name(), area, &response, f32::INFINITY);
    let painter = ui.painter();
    let slot = Rect::from_min_size(pos2(area.left(), area.top() + NAME + 1.0), vec2(28.0, 14.0));
    let fill = match on {
        true => strength(&response),
        false if is_taken(&response) => theme::LIFTED,
        false => theme::RAISED,
    };
    painter.rect_filled(slot, 7.0, fill);
    let knob = pos2(if on { slot.right() - 7.0 } else { slot.left() + 7.0 }, slot.center().y);
    painter.circle_filled(knob, 5.0, if on { theme::GROUND } else { theme::SOFT_TEXT });
    let place = pos2(slot.right() + theme::NEAR, slot.center().y);
    painter.text(place, Align2::LEFT_CENTER, shown(given, param), theme::SMALL, theme::TEXT);
    explain(given, param, response.on_hover_cursor(CursorIcon::PointingHand))
}
