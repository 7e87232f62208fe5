//! The number of a slider: read, or typed with or without its unit.

use std::sync::Arc;

use egui::{Align2, Frame, Galley, Id, Key, Margin, Rect, Response, Sense, TextEdit, Ui, pos2, vec2};
use nice_plug::prelude::Param;

use super::{set, shown};
use crate::editor::{Given, theme};
use crate::params::settings;

/// Shows it at the right end of a row, beside the slider that answers with `slider`.
pub(super) fn show<P: Param>(ui: &mut Ui, given: &Given, param: &P, row: Rect, slider: &Response) {
    let id = slider.id.with("typed");
    if let Some(text) = ui.data(|data| data.get_temp::<String>(id)) {
        edit(ui, given, param, Field { row, id, text, slider });
        return;
    }
    let galley = laid_out(ui, given, param);
    let area = Align2::RIGHT_CENTER.anchor_size(row.right_center(), galley.size());
    // Not to be reached by Tab: Enter on the slider types as well.
    let number = ui.interact(area.expand2(vec2(4.0, 1.0)), id, Sense::CLICK);
    number.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Type {}", param.name()))
    });
    if number.hovered() {
        ui.painter().rect_filled(area.expand2(vec2(4.0, 1.0)), 3.0, theme::LIFTED);
    }
    ui.painter().galley(pos2(area.left(), area.top()), galley, theme::TEXT);
    let enter = slider.has_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if number.clicked() || enter {
        ui.data_mut(|data| data.insert_temp(id, shown(given, param)));
        ui.memory_mut(|memory| memory.request_focus(id.with("field")));
    }
}

/// Room that it takes while it is read, points.
pub(super) fn width<P: Param>(ui: &Ui, given: &Given, param: &P) -> f32 {
    laid_out(ui, given, param).size().x
}

fn laid_out<P: Param>(ui: &Ui, given: &Given, param: &P) -> Arc<Galley> {
    ui.painter().layout_no_wrap(shown(given, param), theme::SMALL, theme::TEXT)
}

/// A number that is being typed.
struct Field<'a> {
    row: Rect,
    id: Id,
    text: String,
    slider: &'a Response,
}

fn edit<P: Param>(ui: &mut Ui, given: &Given, param: &P, field: Field) {
    let Field { row, id, mut text, slider } = field;
    let value = settings::value(param.as_ptr(), &text);
    let area = Rect::from_min_max(pos2(row.center().x, row.top()), row.right_bottom() + vec2(4.0, 0.0));
    let own = id.with("field");
    let known = TextEdit::load_state(ui.ctx(), own).is_some();
    let edit = TextEdit::singleline(&mut text)
        .id(own)
        .font(theme::SMALL)
        .text_color(if value.is_ok() { theme::TEXT } else { theme::ALARM })
        .align(Align2::RIGHT_CENTER)
        .frame(Frame::new().fill(theme::GROUND).corner_radius(3.0))
        .margin(Margin::symmetric(4, 1));
    let response = ui.put(area, edit);
    if let Err(range) = &value {
        response.show_tooltip_text(range);
    }
    if !known && let Some(mut state) = TextEdit::load_state(ui.ctx(), own) {
        // All of it is replaced by what is typed first.
        let end = egui::text::CCursor::new(text.chars().count());
        let all = egui::text::CCursorRange::two(egui::text::CCursor::new(0), end);
        state.cursor.set_char_range(Some(all));
        TextEdit::store_state(ui.ctx(), own, state);
    }
    // One that was out of sight, behind another panel, is not typed in any more when it comes back.
    let is_left = known && !response.has_focus() && !response.lost_focus();
    if !response.lost_focus() && !is_left {
        ui.data_mut(|data| data.insert_temp(id, text));
        return;
    }
    ui.data_mut(|data| {
        data.remove::<String>(id);
        data.remove::<egui::text_edit::TextEditState>(own);
    });
    if is_left {
        return;
    }
    let (left, entered) = ui.input(|input| (input.key_pressed(Key::Escape), input.key_pressed(Key::Enter)));
    if let Ok(value) = value
        && !left
    {
        set(given, param, value);
    }
    if left || entered {
        slider.request_focus();
    }
}
