//! What is wrong, beside a light for each: as much as there is room for, the rest under the mouse or in the menu.

use egui::{Label, Pos2, Rect, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use crate::editor::theme::{self, GAP, NEAR};

/// Radius of a light, points.
const LIGHT: f32 = 4.0;

/// Says it. As much as fits is read, and all of it under the mouse. What does not fit at all is read in the menu, where there is
/// one, or with what does.
pub(super) fn show(ui: &mut Ui, messages: &[String], area: Rect, menu: Option<Rect>) {
    let places = places(ui, messages, area);
    let (told, left_over) = messages.split_at(places.len());
    let is_more = !left_over.is_empty();
    for (index, (text, place)) in told.iter().zip(&places).enumerate() {
        let light = pos2(place.left() - NEAR, place.center().y);
        show_light(ui, light);
        let label = Label::new(RichText::new(text).color(theme::ALARM)).truncate();
        let response = ui.put(*place, label);
        if is_more && index + 1 == told.len() {
            response.on_hover_text(messages[index..].join("\n"));
            if menu.is_none() {
                show_light(ui, light - vec2(NEAR + 2.0, 0.0));
            }
        } else {
            response.on_hover_text(text);
        }
    }
    match menu {
        Some(more) if is_more => show_light(ui, more.right_top() + vec2(-2.0, 2.0)),
        None if is_more && told.is_empty() => show_alone(ui, messages, area),
        _ => {}
    }
}

/// Where messages go, from the right: those of the first that there is room for.
fn places(ui: &Ui, messages: &[String], area: Rect) -> Vec<Rect> {
    let mut rest = area;
    let place = |text: &String| {
        let galley = ui.painter().layout_no_wrap(text.clone(), theme::BODY_FONT, theme::ALARM);
        let width = galley.size().x.min(rest.width() - GAP);
        let place = Rect::from_min_max(pos2(rest.right() - width, rest.top()), rest.max);
        rest.max.x = place.left() - GAP - NEAR;
        (width >= GAP).then_some(place)
    };
    messages.iter().map_while(place).collect()
}

/// A light alone, between what is beside it, where there is no room for a word.
fn show_alone(ui: &Ui, messages: &[String], area: Rect) {
    let at = pos2(area.right() + 0.5 * GAP, area.center().y);
    show_light(ui, at);
    let around = Rect::from_center_size(at, vec2(GAP, 2.0 * GAP));
    let response = ui.interact(around, ui.scope_id().with("messages"), Sense::hover());
    let all = messages.join("\n");
    response.widget_info(|| WidgetInfo::labeled(Role::Status, true, &all));
    response.on_hover_text(all);
}

fn show_light(ui: &Ui, at: Pos2) {
    ui.painter().circle_filled(at, LIGHT, theme::ALARM);
}
