//! How it is computed: quality, iterations, energy, tension, load.

use egui::Ui;

use crate::editor::{Given, theme};

/// Draws the panel.
pub fn show(ui: &mut Ui, _given: &Given) {
    ui.colored_label(theme::SOFT_TEXT, "How it is computed: quality, iterations, energy, tension, load.");
}
