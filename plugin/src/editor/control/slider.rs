//! A number on a line.
//!
//! The wheel moves it by steps. A click on the number, or Enter, types one.

use egui::{CursorIcon, Event, Id, MouseWheelUnit, Rect, Response, Sense, Stroke, Ui, Vec2, pos2, vec2};
use nice_plug::prelude::Param;

use super::{
    Arrows, NAME, come_into_sight, drag, explain, follow_keys, is_taken, number, paint_name, set, step,
    strength,
};
use crate::editor::Given;
use crate::editor::theme::{self, TIGHT};

/// Points of a wheel without notches that are as much as a notch.
const NOTCH: f32 = 24.0;

/// How long a window goes on scrolling after a notch, s.
const SMOOTHED: f64 = 0.3;

/// Shows it.
pub fn slider<P: Param>(ui: &mut Ui, given: &Given, param: &P, area: Rect) -> Response {
    titled_slider(ui, given, param, area, param.name())
}

/// Shows it under another name than that of its parameter.
pub fn titled_slider<P: Param>(ui: &mut Ui, given: &Given, param: &P, area: Rect, title: &str) -> Response {
    let id = ui.scope_id().with(param.name());
    let mut response = ui.interact(area, id, Sense::click_and_drag());
    let value = given.value(param);
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::slider(true, f64::from(value), param.name());
        info.current_text_value = Some(title.to_owned());
        info
    });
    let growth = vec2(1.0 / area.width().max(1.0), 0.0);
    drag(ui, given, param, &response, (value, growth), |held| {
        param.preview_normalized(param.preview_plain(held.clamp(0.0, 1.0)))
    });
    if response.double_clicked() {
        set(given, param, param.default_normalized_value());
    }
    step(given, param, (notches(ui, id, area), 1.0), ui.input(|input| input.modifiers.shift));
    follow_keys(ui, given, param, &response, (Arrows::default(), 1.0));
    come_into_sight(&response);
    paint_name(ui, title, area, &response, area.width() - number::width(ui, given, param) - TIGHT);
    paint_line(ui, (param, value), area, &response);
    response = response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    let response = explain(given, param, response);
    let row = Rect::from_min_size(area.min, vec2(area.width(), NAME));
    number::show(ui, given, param, row, &response);
    response
}

/// Notches that the wheel has turned over an area.
fn notches(ui: &Ui, id: Id, area: Rect) -> i32 {
    if !ui.rect_contains_pointer(area) {
        return 0;
    }
    let turned: f32 = ui.input(|input| {
        // To the side it scrolls a narrow window's panel, but systems also turn it there with Shift.
        let along = |delta: Vec2, shift: bool| if shift { delta.x + delta.y } else { delta.y };
        let turn = |event: &Event| match event {
            Event::MouseWheel { unit, delta, modifiers, .. } => {
                let turned = along(*delta, modifiers.shift || input.modifiers.shift);
                if *unit == MouseWheelUnit::Point { turned / NOTCH } else { turned }
            }
            _ => 0.0,
        };
        input.events.iter().map(turn).sum()
    });
    keep_from_scrolling(ui, id);
    let id = id.with("turned");
    let turned = ui.data(|data| data.get_temp::<f32>(id)).unwrap_or(0.0) + turned;
    ui.data_mut(|data| data.insert_temp(id, turned.fract()));
    turned.trunc() as i32
}

/// Up and down the wheel is the slider's, and with Shift whatever it does: the panel stays where it is, also while the last notch
/// would still move it.
fn keep_from_scrolling(ui: &Ui, id: Id) {
    let id = id.with("fine");
    let (now, shift, is_turned) = ui.input(|input| {
        let shift = input.modifiers.shift;
        let turns = |event: &Event| match event {
            Event::MouseWheel { modifiers, .. } => shift || modifiers.shift,
            _ => false,
        };
        (input.time, shift, input.events.iter().any(turns))
    });
    if is_turned {
        ui.data_mut(|data| data.insert_temp(id, now));
    }
    let turned = ui.data(|data| data.get_temp::<f64>(id));
    ui.input_mut(|input| {
        input.smooth_scroll_delta.y = 0.0;
        if shift || turned.is_some_and(|turned| now - turned < SMOOTHED) {
            input.smooth_scroll_delta.x = 0.0;
        }
    });
}

/// The line, full from the usual value to the present one, and where a host's modulation has it.
fn paint_line<P: Param>(ui: &Ui, (param, value): (&P, f32), area: Rect, response: &Response) {
    let painter = ui.painter();
    let y = area.top() + NAME + 8.0;
    let line = Rect::from_min_max(pos2(area.left(), y - 2.0), pos2(area.right(), y + 2.0));
    let at = |value: f32| line.left() + value * line.width();
    let usual = param.default_normalized_value();
    painter.rect_filled(line, 2.0, if is_taken(response) { theme::LIFTED } else { theme::RAISED });
    let (from, to) = (at(value.min(usual)), at(value.max(usual)));
    painter.rect_filled(line.with_min_x(from).with_max_x(to), 2.0, strength(response));
    painter.vline(at(usual), line.y_range().expand(2.0), Stroke::new(1.0, theme::SOFT_TEXT));
    painter.circle_filled(
        pos2(at(value), y),
        5.0,
        if is_taken(response) { theme::TEXT } else { theme::BONE },
    );
    let modulated = param.modulated_normalized_value();
    if modulated != param.unmodulated_normalized_value() {
        painter.circle_stroke(pos2(at(modulated), y), 4.0, Stroke::new(1.5, theme::PLUCK));
    }
}
