//! Bars with a number: a look at something that cannot be set.

use egui::{Align2, Color32, Pos2, Rect, Ui, pos2};

use crate::editor::shapes::fit_text;
use crate::editor::theme;

/// Highest that a row is, points.
const HIGHEST: f32 = 24.0;
/// Room for the number, points.
const NUMBER: f32 = 56.0;

/// Height of each of so many rows.
pub(super) fn row_height(area: Rect, rows: usize) -> f32 {
    (area.height() / rows.max(1) as f32).min(HIGHEST)
}

/// A bar that is full to a part of it, 0 to 1 (more is full), and its number to the right.
pub(super) fn paint(ui: &Ui, area: Rect, part: f32, number: &str, colour: Color32) {
    let painter = ui.painter();
    let middle = area.center().y.round();
    let right = (area.right() - NUMBER).max(area.left());
    let bar = Rect::from_min_max(pos2(area.left(), middle - 2.0), pos2(right, middle + 2.0));
    painter.rect_filled(bar, 2.0, theme::RAISED);
    let part = if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0) };
    painter.rect_filled(bar.with_max_x(bar.left() + part * bar.width()), 2.0, colour);
    if area.height() >= theme::SMALL.size {
        painter.text(pos2(area.right(), middle), Align2::RIGHT_CENTER, number, theme::SMALL, theme::TEXT);
    }
}

/// Room for the name of a row, left of its bars, points.
pub(super) const LEFT: f32 = 40.0;

/// The name of a row so high, one of many: where rows are lower than letters some go without, so that no name lies over another.
pub(super) fn paint_name(ui: &Ui, at: Pos2, (row, index): (f32, usize), name: &str) {
    let every = (theme::SMALL.size / row.max(1.0)).ceil() as usize;
    if !index.is_multiple_of(every) {
        return;
    }
    let look = (theme::SMALL, theme::SOFT_TEXT);
    fit_text(ui.painter(), (at, Align2::LEFT_CENTER), name, look, LEFT - theme::TIGHT);
}
