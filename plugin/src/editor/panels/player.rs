//! How the hands act: where and how hard they pluck, how firmly fingers press, how notes are taken.

use egui::{Align2, Button, Rect, RichText, Ui, pos2, vec2};
use nice_plug::prelude::Enum;

use super::cells::Cells;
use crate::editor::control::{NAME, choice, slider, switch, unless_idle};
use crate::editor::{Given, theme};
use crate::params::{ControlParams, InputChoice, LegatoChoice, PlayerParams, StringOrder};
use crate::plugin::layout::{KeyMap, Keyboard};

/// Draws the panel.
pub fn show(ui: &mut Ui, given: &Given) {
    let PlayerParams {
        pluck_position,
        pluck_force,
        pluck_softest,
        pluck_duration,
        pluck_release,
        velocity_curve,
        variation,
        take,
        finger_force,
        finger_hardness,
        finger_mass,
        finger_hover,
        hand_damping,
        // Beside the losses, in the panel of the sound.
        idle_hands: _,
    } = &given.params.player;
    let ControlParams {
        input_mode,
        first_channel,
        string_order,
        bend_range,
        ignore_rpn,
        // Beside the tuning, in the panel of the sound.
        tremolo_arm: _,
        legato,
        keyswitches,
        hand_position,
        capo,
        hand_controllers,
    } = &given.params.control;
    let mut cells = Cells::new(ui.max_rect(), 6);
    cells.group(ui, "PLUCKS", 2);
    for param in
        [pluck_position, pluck_force, pluck_duration, pluck_release, pluck_softest, velocity_curve, variation]
    {
        slider(ui, given, param, cells.next());
    }
    slider(ui, given, take, cells.next());
    cells.group(ui, "FINGERS", 2);
    for param in [finger_force, finger_hardness, finger_mass, finger_hover, hand_damping] {
        slider(ui, given, param, cells.next());
    }
    slider(ui, given, capo, cells.next());
    choice(ui, given, legato, cells.next(), LegatoChoice::variants().len());
    slider(ui, given, hand_position, cells.next());
    cells.group(ui, "NOTES", 2);
    choice(ui, given, input_mode, cells.next(), InputChoice::variants().len());
    let by_strings = given.plain(input_mode) == InputChoice::Strings;
    let reason = (!by_strings).then_some("Only where the input mode is a channel per string.");
    unless_idle(ui, cells.next(), reason, |ui, area| slider(ui, given, first_channel, area));
    let count = StringOrder::variants().len();
    unless_idle(ui, cells.next(), reason, |ui, area| choice(ui, given, string_order, area, count));
    slider(ui, given, bend_range, cells.next());
    switch(ui, given, ignore_rpn, cells.next());
    slider(ui, given, keyswitches, cells.next());
    switch(ui, given, hand_controllers, cells.next());
    if let Some(keyboard) = given.keyboard {
        show_keys(ui, given, keyboard, cells.next());
    }
}

/// What the computer's keys can be, and what is said of each.
const MAPS: [(KeyMap, &str, &str); 2] = [
    (
        KeyMap::Piano,
        "Piano",
        "Two rows of letters are white keys, the rows above them the black ones. Page Up and Page Down: octaves.",
    ),
    (
        KeyMap::Frets,
        "Frets",
        "Four rows are four strings, the keys along them frets. Page Up and Page Down: other strings. Ctrl (on a Mac \
         Cmd) with the arrows to the sides: other frets.",
    ),
];

/// Chooses what the computer's keys are.
fn show_keys(ui: &mut Ui, given: &Given, keyboard: Keyboard, area: Rect) {
    let name = pos2(area.left(), area.top() + 0.5 * NAME);
    ui.painter().text(name, Align2::LEFT_CENTER, "Computer keys", theme::SMALL, theme::SOFT_TEXT);
    let row = area.with_min_y(area.top() + NAME);
    let width = 0.5 * (row.width() - theme::TIGHT);
    for (index, (map, text, explanation)) in MAPS.into_iter().enumerate() {
        let left = row.left() + index as f32 * (width + theme::TIGHT);
        let place = Rect::from_min_size(pos2(left, row.top()), vec2(width, row.height()));
        let text = RichText::new(text).font(theme::SMALL);
        let response = ui.put(place, Button::selectable(keyboard.map == map, text).frame_when_inactive(true));
        if response.on_hover_text(explanation).clicked() {
            given.params.layout.set_keys(Keyboard { map, ..keyboard });
        }
    }
}
