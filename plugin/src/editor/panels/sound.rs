//! What becomes of the sound: level, losses, tuning.

use egui::Ui;

use crate::editor::{Given, theme};

/// Draws the panel.
pub fn show(ui: &mut Ui, _given: &Given) {
    ui.colored_label(theme::SOFT_TEXT, "What becomes of the sound: level, losses, tuning.");
}
