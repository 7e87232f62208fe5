//! How the hands act: where and how hard they pluck, how firmly fingers press.

use egui::Ui;

use crate::editor::{Given, theme};

/// Draws the panel.
pub fn show(ui: &mut Ui, _given: &Given) {
    ui.colored_label(
        theme::SOFT_TEXT,
        "How the hands act: where and how hard they pluck, how firmly fingers press.",
    );
}
