//! Commands, and the files they read and write: each file is a promise.

mod documented_ranges;
mod instruments_command;
mod labels_besides;
mod labels_glides;
mod labels_notes;
mod labels_set;
mod labels_sound;
mod midi_input;
mod midi_selection;
mod midi_sequences;
mod same_everywhere;
mod scene_beginnings;
mod scene_command;
mod scene_errors;
mod scene_figure;
mod scene_properties;
mod scene_trace;

use low_action_tests::command::Workplace;

/// An empty folder to run the command line in.
fn workplace() -> Workplace {
    Workplace::new(env!("CARGO_BIN_EXE_low-action-command"))
}
