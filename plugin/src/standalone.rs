//! The instrument as a program of its own, playing through the sound card.

use nice_plug::prelude::nice_export_standalone_with_args;

use crate::plugin::LowAction;

/// Opens the instrument and plays what arrives on MIDI until it is interrupted; gives back whether that
/// could be done.
///
/// The options are the plugin framework's: `--midi-input NAME`, `--output-device NAME`,
/// `--sample-rate HZ`, `--period-size SAMPLES`, `--backend auto|jack|alsa|…`; `--help` lists them all, and
/// an empty name lists the devices. Without `--midi-input` ALSA, Core Audio and WASAPI connect no keyboard.
pub fn open(options: impl IntoIterator<Item = String>) -> bool {
    let arguments = std::iter::once("low-action --".to_owned()).chain(options);
    nice_export_standalone_with_args::<LowAction, _>(arguments)
}
