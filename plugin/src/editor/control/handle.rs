//! A parameter that is taken hold of in the picture itself.

use egui::{Rect, Response, Sense, Ui, Vec2};
use nice_plug::prelude::{FloatParam, Param};

use super::{Arrows, drag, explain, follow_keys, set};
use crate::editor::Given;

/// What is taken hold of.
pub struct Handle<'a> {
    /// The parameter.
    pub param: &'a FloatParam,
    /// How much the parameter grows for a point to the right and for a point down.
    pub growth: Vec2,
    /// The least and the largest value by which something still moves on this instrument: beyond, the mouse would move a
    /// number and nothing that is seen.
    pub reach: [f64; 2],
}

impl Handle<'_> {
    /// Takes hold of it in `area`. Arrows move it where they point.
    pub fn show(&self, ui: &mut Ui, given: &Given, area: Rect) -> Response {
        let id = ui.scope_id().with(self.param.name());
        let response = ui.interact(area, id, Sense::click_and_drag());
        let param = self.param;
        let value = given.plain(param);
        let [least, most] = self.ends();
        response.widget_info(|| egui::WidgetInfo::slider(true, f64::from(value), param.name()));
        drag(ui, given, param, &response, (value.max(least).min(most), self.growth), |held| {
            param.preview_normalized(held.max(least).min(most))
        });
        if response.double_clicked() {
            set(given, param, param.default_normalized_value());
        }
        let arrows = Arrows { right_is_less: self.growth.x < 0.0, up_is_less: self.growth.y > 0.0 };
        follow_keys(ui, given, param, &response, (arrows, 1.0));
        explain(given, param, response)
    }

    /// How far the parameter goes within reach.
    fn ends(&self) -> [f32; 2] {
        let [least, most] = [0.0, 1.0].map(|end| self.param.preview_plain(end));
        self.reach.map(|reach| (reach as f32).max(least).min(most))
    }
}
