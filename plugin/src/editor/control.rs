//! Controls: one for each kind of parameter in the panels, and one for those in the pictures, all with the same habits.
//!
//! In the panels the name stands over each, the value with its unit beside it or under it. Dragging moves a number, ten
//! times as finely with Shift, and a double click brings it back to its usual value. Tab reaches a control, arrows move
//! it, Home and End bring it to its ends, Delete and Backspace to its usual value. The host is told where each gesture begins
//! and ends.

mod choice;
mod handle;
mod number;
mod slider;
mod switch;

use egui::{
    Align2, Color32, EventFilter, Key, Modifiers, Rect, Response, Stroke, StrokeKind, Ui, Vec2, pos2, vec2,
};
use nice_plug::prelude::Param;

use super::shapes::fit_text;
use super::{Given, theme};
pub use choice::{choice, line};
pub use handle::Handle;
pub use slider::{slider, titled_slider};
pub use switch::switch;

/// Height of a control, points.
pub const HEIGHT: f32 = 32.0;
/// Height of the row with its name, points.
pub const NAME: f32 = 16.0;

/// How much finer a drag is with Shift.
const FINE: f32 = 0.1;

/// Sets a parameter in one gesture, 0 to 1; not while it is dragged, which is one gesture already, nor to what it is.
fn set<P: Param>(given: &Given, param: &P, normalized: f32) {
    // What hosts round is the same again as a plain value.
    let is_there = param.preview_plain(normalized) == given.plain(param);
    if is_there || given.history.is_under_way(param.as_ptr()) {
        return;
    }
    given.setter.begin_set_parameter(param);
    given.setter.set_parameter_normalized(param, normalized);
    given.setter.end_set_parameter(param);
}

/// Moves a parameter by so many steps, up or down, but not past the last value, 0 to 1, that there is to choose. Gives back
/// whether it is another value.
fn step<P: Param>(given: &Given, param: &P, (steps, last): (i32, f32), fine: bool) -> bool {
    let before = given.value(param);
    if steps == 0 || given.history.is_under_way(param.as_ptr()) {
        return false;
    }
    let mut value = before;
    for _ in 0..steps.abs() {
        value = if steps > 0 {
            param.next_normalized_step(value, fine)
        } else {
            param.previous_normalized_step(value, fine)
        };
    }
    let value = value.min(last);
    given.history.stepping(|| set(given, param, value));
    value != before
}

/// Has a parameter follow the mouse while it is dragged. `value` is the present one and how much it grows for a point to
/// the right and for a point down, in any unit; `normalized` makes it what the host is told, 0 to 1.
fn drag<P: Param>(
    ui: &Ui,
    given: &Given,
    param: &P,
    response: &Response,
    (value, growth): (f32, Vec2),
    normalized: impl FnOnce(f32) -> f32,
) {
    let (id, setter) = (response.id, &given.setter);
    let growth = if ui.input(|input| input.modifiers.shift) { FINE * growth } else { growth };
    if response.drag_started() {
        // Arrows go on where the drag has left it.
        response.request_focus();
        setter.begin_set_parameter(param);
        // What it moved until it was known to be a drag counts too.
        let before = response.total_drag_delta().unwrap_or_default() - response.drag_delta();
        ui.data_mut(|data| data.insert_temp(id, value + growth.dot(before)));
    }
    if response.dragged() {
        if !given.history.hold(param.as_ptr()) {
            // It was gone for a while, as on an instrument without a coil, and that gesture has ended.
            setter.begin_set_parameter(param);
            ui.data_mut(|data| data.insert_temp(id, value));
        }
        let held = ui.data(|data| data.get_temp(id)).unwrap_or(value) + growth.dot(response.drag_delta());
        // Beyond the end the mouse has to come back before anything moves again.
        ui.data_mut(|data| data.insert_temp(id, held));
        setter.set_parameter_normalized(param, normalized(held));
    }
    if response.drag_stopped() && given.history.hold(param.as_ptr()) {
        setter.end_set_parameter(param);
    }
}

/// Which way arrows move a value: up by those to the right and upwards, or the other way.
#[derive(Debug, Clone, Copy, Default)]
struct Arrows {
    right_is_less: bool,
    up_is_less: bool,
}

/// Takes what the keyboard does to a control that has the focus, up to the last value, 0 to 1, that there is to choose. Gives
/// back whether it has set another value.
fn follow_keys<P: Param>(
    ui: &Ui,
    given: &Given,
    param: &P,
    response: &Response,
    (arrows, last): (Arrows, f32),
) -> bool {
    if response.clicked() {
        response.request_focus();
    }
    if !response.has_focus() {
        return false;
    }
    let own = EventFilter { horizontal_arrows: true, vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, own));
    let (steps, fine, end) = ui.input_mut(|input| {
        let fine = input.modifiers.shift;
        let mut pressed = |key| {
            input.count_and_consume_key(Modifiers::NONE, key)
                + input.count_and_consume_key(Modifiers::SHIFT, key)
        };
        let right = pressed(Key::ArrowRight) as i32 - pressed(Key::ArrowLeft) as i32;
        let up = pressed(Key::ArrowUp) as i32 - pressed(Key::ArrowDown) as i32;
        let steps =
            if arrows.right_is_less { -right } else { right } + if arrows.up_is_less { -up } else { up };
        let ends = [
            (Key::Home, 0.0),
            (Key::End, last),
            (Key::Delete, param.default_normalized_value()),
            (Key::Backspace, param.default_normalized_value()),
        ];
        let end = ends.into_iter().filter(|(key, _)| pressed(*key) > 0).map(|(_, value)| value).last();
        (steps, fine, end)
    });
    let mut is_another = step(given, param, (steps, last), fine);
    if let Some(end) = end.filter(|_| !given.history.is_under_way(param.as_ptr())) {
        is_another |= end != given.value(param);
        set(given, param, end);
    }
    is_another
}

/// Shows a control, and veils it where nothing comes of it at present, for a reason that is told under the mouse. It can be set
/// all the same: another instrument may ask for it.
pub fn unless_idle(
    ui: &mut Ui,
    area: Rect,
    reason: Option<&str>,
    show: impl FnOnce(&mut Ui, Rect) -> Response,
) -> Response {
    let response = show(ui, area);
    let Some(reason) = reason else { return response };
    let veil = area.expand2(vec2(theme::NEAR, 0.0));
    ui.painter().rect_filled(veil, 0.0, theme::faint(theme::SURFACE, theme::VEIL));
    response.on_hover_text(reason)
}

/// Scrolls a panel that has no room for all of its controls to the one that has got the focus.
fn come_into_sight(response: &Response) {
    if response.gained_focus() {
        response.scroll_to_me(None);
    }
}

/// A musician's words for it, under the mouse.
fn explain<P: Param>(given: &Given, param: &P, response: Response) -> Response {
    response.on_hover_ui(|ui| {
        ui.set_max_width(280.0);
        ui.label(format!("{}: {}", param.name(), shown(given, param)));
        ui.colored_label(theme::SOFT_TEXT, given.words.heard(param));
        let steps = param.step_count().unwrap_or_default() as f32;
        let index = (given.value(param) * steps).round() as usize;
        if let Some(heard) = given.words.heard_of(param, index) {
            ui.colored_label(theme::SOFT_TEXT, heard);
        }
    })
}

/// The value with its unit.
fn shown<P: Param>(given: &Given, param: &P) -> String {
    param.normalized_value_to_string(given.value(param), true)
}

/// The name in its row, as far as there is room for it, and a ring around all of it while it has the focus.
fn paint_name(ui: &Ui, name: &str, area: Rect, response: &Response, room: f32) {
    let colour = if is_taken(response) { theme::TEXT } else { theme::SOFT_TEXT };
    let place = (pos2(area.left(), area.top() + 0.5 * NAME), Align2::LEFT_CENTER);
    fit_text(ui.painter(), place, name, (theme::SMALL, colour), room);
    if response.has_focus() {
        let ring = Stroke::new(1.0, theme::ACCENT);
        ui.painter().rect_stroke(area.expand2(vec2(6.0, 2.0)), 4.0, ring, StrokeKind::Inside);
    }
}

fn is_taken(response: &Response) -> bool {
    response.hovered() || response.dragged() || response.has_focus()
}

/// The colour of what a control shows of its value.
fn strength(response: &Response) -> Color32 {
    if is_taken(response) { theme::ACCENT } else { theme::faint(theme::ACCENT, 0.75) }
}
