//! What keys do wherever the focus is: undo, redo, zoom, silence; and what they do not, as it is the host's.

use egui::{Event, Key, Modifiers, Ui};

use super::Given;
use crate::performance::PlayerEvent;
use crate::plugin::layout::SIZES;

/// The key that goes with them.
pub(super) const COMMAND: &str = if cfg!(target_os = "macos") { "Cmd" } else { "Ctrl" };
/// By how much everything becomes larger or smaller at once.
const ZOOM: f32 = 0.1;

/// Takes what the keys have done since the last picture, in which something was typed into or not.
pub(super) fn follow(ui: &Ui, given: &Given, typing: bool) {
    if given.keyboard.is_none() {
        leave_space(ui);
    }
    silence(ui, given, typing);
    change(ui, given);
}

/// In a host the space bar is the transport's, unless something is typed: it must not press what was clicked last.
fn leave_space(ui: &Ui) {
    if !ui.ctx().text_edit_focused() {
        let is_space = |event: &Event| matches!(event, Event::Key { key: Key::Space, .. });
        ui.input_mut(|input| input.events.retain(|event| !is_space(event)));
    }
}

/// Escape silences all strings, unless it ends typing or closes a list. A field has lost the keyboard to it by now, so it
/// counts what was typed into before.
fn silence(ui: &Ui, given: &Given, typing: bool) {
    let meant_for_others = typing || egui::Popup::is_any_open(ui.ctx());
    if !meant_for_others && ui.input(|input| input.key_pressed(Key::Escape)) {
        given.pointer.play(PlayerEvent::AllNotesOff);
    }
}

/// Undo, redo and zoom.
fn change(ui: &Ui, given: &Given) {
    if ui.ctx().text_edit_focused() {
        return;
    }
    let pressed = |modifiers, key| ui.input_mut(|input| input.consume_key(modifiers, key));
    // The longer one first: Ctrl+Z would take it as well.
    if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y) {
        given.history.redo(given.gui);
    } else if pressed(Modifiers::COMMAND, Key::Z) {
        given.history.undo(given.gui);
    }
    for (key, change) in [(Key::ArrowUp, ZOOM), (Key::ArrowDown, -ZOOM)] {
        if pressed(Modifiers::COMMAND, key) {
            let zoom = ui.ctx().zoom_factor() + change;
            ui.ctx().set_zoom_factor(zoom.clamp(SIZES[0], SIZES[1]));
        }
    }
}
