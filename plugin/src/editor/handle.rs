//! A parameter that is taken hold of in the picture itself.
//!
//! Dragging moves it, ten times as finely with Shift; a double click brings it back to its usual value; the arrow
//! keys move it by a step while it has the focus. The host is told where each gesture begins and ends.

use egui::{EventFilter, Key, Rect, Response, Sense, Ui, Vec2};
use nice_plug::prelude::{FloatParam, Param};

use super::Given;

/// How much finer a drag is with Shift.
const FINE: f32 = 0.1;

/// What is taken hold of.
pub struct Handle<'a> {
    /// The parameter.
    pub param: &'a FloatParam,
    /// How much the parameter grows for a point to the right and for a point down.
    pub growth: Vec2,
}

impl Handle<'_> {
    /// Takes hold of it in `area`.
    pub fn show(&self, ui: &mut Ui, given: &Given, area: Rect) -> Response {
        let id = ui.scope_id().with(self.param.name());
        let response = ui.interact(area, id, Sense::click_and_drag());
        let (param, setter) = (self.param, &given.setter);
        let value = param.unmodulated_plain_value();
        response.widget_info(|| egui::WidgetInfo::slider(true, f64::from(value), param.name()));
        let fine = if ui.input(|input| input.modifiers.shift) { FINE } else { 1.0 };
        if response.drag_started() {
            setter.begin_set_parameter(param);
            // What it moved until it was known to be a drag counts too.
            let before = response.total_drag_delta().unwrap_or_default() - response.drag_delta();
            ui.data_mut(|data| data.insert_temp(id, value + fine * self.growth.dot(before)));
        }
        if response.dragged() {
            let grown = fine * self.growth.dot(response.drag_delta());
            let held = ui.data(|data| data.get_temp(id)).unwrap_or(value) + grown;
            // Beyond the end the mouse has to come back before anything moves again.
            ui.data_mut(|data| data.insert_temp(id, held));
            setter.set_parameter(param, held.clamp(param.preview_plain(0.0), param.preview_plain(1.0)));
        }
        if response.drag_stopped() {
            setter.end_set_parameter(param);
        }
        if response.double_clicked() {
            self.set(given, param.default_plain_value());
        }
        if response.clicked() {
            response.request_focus();
        }
        if response.has_focus() {
            let own = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(id, own));
            let steps = ui.input(|input| {
                let pressed = |key| input.num_presses(key) as i32;
                let fine = input.modifiers.shift;
                (pressed(Key::ArrowRight) - pressed(Key::ArrowLeft), fine)
            });
            let stepped = match steps {
                (1.., fine) => Some(param.next_step(value, fine)),
                (..=-1, fine) => Some(param.previous_step(value, fine)),
                _ => None,
            };
            if let Some(stepped) = stepped {
                self.set(given, stepped);
            }
        }
        response.on_hover_text(format!("{}: {param}\n{}", param.name(), given.words.heard(param)))
    }

    fn set(&self, given: &Given, value: f32) {
        given.setter.begin_set_parameter(self.param);
        given.setter.set_parameter(self.param, value);
        given.setter.end_set_parameter(self.param);
    }
}
