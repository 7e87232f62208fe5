//! What a luthier changes: action, relief, frets, strings, pickup.

use egui::Ui;

use crate::editor::{Given, theme};

/// Draws the panel.
pub fn show(ui: &mut Ui, _given: &Given) {
    ui.colored_label(theme::SOFT_TEXT, "What a luthier changes: action, relief, frets, strings, pickup.");
}
