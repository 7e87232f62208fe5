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
}

impl Handle<'_> {
    /// Takes hold of it in `area`. Arrows move it where they point.
    pub fn show(&self, ui: &mut Ui, given: &Given, area: Rect) -> Response {
        let id = ui.scope_id().with(self.param.name());
        let response = ui.interact(area, id, Sense::click_and_drag());
        let param = self.param;
        let value = given.plain(param);
        response.widget_info(|| egui::WidgetInfo::slider(true, f64::from(value), param.name()));
        let ends = [param.preview_plain(0.0), param.preview_plain(1.0)];
        drag(ui, given, param, &response, (value, self.growth), |held| {
            param.preview_normalized(held.clamp(ends[0], ends[1]))
        });
        if response.double_clicked() {
            set(given, param, param.default_normalized_value());
        }
        let arrows = Arrows { right_is_less: self.growth.x < 0.0, up_is_less: self.growth.y > 0.0 };
        follow_keys(ui, given, param, &response, arrows);
        explain(given, param, response)
    }
}
