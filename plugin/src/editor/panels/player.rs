//! How the hands act: where and how hard they pluck, how firmly fingers press, how notes are taken.

use egui::Ui;
use nice_plug::prelude::Enum;

use super::cells::Cells;
use crate::editor::Given;
use crate::editor::control::{choice, slider, switch};
use crate::params::{ControlParams, InputChoice, LegatoChoice, PlayerParams, StringOrder};

/// Draws the panel.
pub fn show(ui: &mut Ui, given: &Given) {
    let PlayerParams {
        pluck_position,
        pluck_force,
        pluck_softest,
        pluck_duration,
        velocity_curve,
        variation,
        finger_force,
        finger_hardness,
        finger_mass,
        finger_hover,
        hand_damping,
    } = &given.params.player;
    let ControlParams {
        input_mode,
        first_channel,
        string_order,
        bend_range,
        ignore_rpn,
        tremolo_arm,
        legato,
        keyswitches,
    } = &given.params.control;
    let mut cells = Cells::new(ui.max_rect(), 6);
    cells.group(ui, "PLUCKS", 2);
    for param in [pluck_position, pluck_force, pluck_softest, pluck_duration, velocity_curve, variation] {
        slider(ui, given, param, cells.next());
    }
    cells.group(ui, "FINGERS", 2);
    for param in [finger_force, finger_hardness, finger_mass, finger_hover, hand_damping, tremolo_arm] {
        slider(ui, given, param, cells.next());
    }
    choice(ui, given, legato, cells.next(), LegatoChoice::variants().len());
    cells.group(ui, "NOTES", 2);
    choice(ui, given, input_mode, cells.next(), InputChoice::variants().len());
    slider(ui, given, first_channel, cells.next());
    choice(ui, given, string_order, cells.next(), StringOrder::variants().len());
    slider(ui, given, bend_range, cells.next());
    switch(ui, given, ignore_rpn, cells.next());
    slider(ui, given, keyswitches, cells.next());
}
