//! The instrument as a program of its own, playing through the sound card.
//!
//! The plugin framework opens the devices and plays. Here it is told which, and what to begin with; where it would
//! go on without any sound, this ends with an error (`pulse`).

mod keyboards;
mod names;
mod pulse;
mod server;
mod way;
pub(crate) mod window;

use anyhow::{Result, bail};
use cpal::traits::{DeviceTrait, HostTrait};
use nice_plug::prelude::nice_export_standalone_with_args;

use crate::cli::say;
use crate::params::{Start, begin_with};
use crate::plugin::LowAction;
pub use way::Way;
use way::{JACK, NOTHING};

/// Hz, where nobody says otherwise.
const SAMPLE_RATE: u32 = 48_000;
/// Samples computed at a time, where nobody says otherwise.
const PERIOD: u32 = 256;

/// Which devices are to be used.
#[derive(Debug, Clone, Default)]
pub struct Devices {
    /// `auto`, `jack`, `alsa`, `core-audio`, `wasapi` or `none`; nothing is `auto`.
    pub backend: Option<String>,
    /// Where the sound goes; nothing is what the system usually takes.
    pub output: Option<String>,
    /// Which keyboard plays; nothing is the first there is.
    pub keyboard: Option<String>,
    /// Hz, but for JACK, which has its own; nothing is the usual 48,000.
    pub sample_rate: Option<u32>,
    /// Samples computed at a time, but for JACK; nothing is the usual 256.
    pub period: Option<u32>,
    /// More of the framework's options.
    pub others: Vec<String>,
}

impl Devices {
    /// The way to them; none is opened.
    ///
    /// # Errors
    /// When there is none.
    pub fn way(&self) -> Result<Way> {
        Way::to(self, Way::may_need_server(self).then(server::running).flatten())
    }
}

/// Opens the instrument and plays what arrives on MIDI until its window is closed or it is interrupted.
///
/// # Errors
/// When no device can be opened, or not the one that was named; the log says more.
pub fn open(mut start: Start, devices: &Devices, way: &Way) -> Result<()> {
    let windowed = cfg!(feature = "editor") && window::prepare(&mut start);
    let until = if windowed { "until its window is closed" } else { "until Ctrl+C" };
    let (layout, blocks) = (start.layout.clone(), start.blocks.clone());
    begin_with(start);
    if let Some(warning) = way.given_in_vain(devices) {
        say("warning", &warning);
    }
    let name = &way.name;
    let mut arguments = vec![
        "low-action --".to_owned(),
        format!("--backend={name}"),
        format!("--sample-rate={}", way.sample_rate),
    ];
    if name != JACK && !given(&devices.others, "--period-size") {
        arguments.push(format!("--period-size={}", devices.period.unwrap_or(PERIOD)));
    }
    if name == NOTHING {
        say("low-action", &format!("plays to nobody, {until}"));
    } else {
        let (known, sources, option) = match &way.server {
            Some(server) => (server.keyboards.clone(), server.sources.clone(), "--connect-jack-midi-input"),
            None => {
                let output = devices.output.as_deref();
                let output = output.map(|name| names::find("output", &outputs(), name)).transpose()?;
                let output = output.filter(|_| !given(&devices.others, "--output-device"));
                arguments.extend(output.map(|name| format!("--output-device={name}")));
                let inputs = keyboards::of_system();
                (inputs.clone(), inputs, "--midi-input")
            }
        };
        match keyboards::choose(&known, &sources, devices.keyboard.as_deref())? {
            // (Named to the framework itself, which takes no option twice.)
            _ if given(&devices.others, option) => {
                say("low-action", &format!("plays what is named after --, {until}"));
            }
            Some(name) => {
                say("low-action", &format!("plays what {name} sends, {until}"));
                arguments.push(format!("{option}={name}"));
            }
            None if windowed => say("warning", "there is no MIDI keyboard: mouse and computer keys play"),
            None => say("warning", "there is no MIDI keyboard: nothing will be heard"),
        }
    }
    arguments.extend(devices.others.iter().cloned());
    pulse::watch(blocks, name);
    if nice_export_standalone_with_args::<LowAction, _>(arguments) {
        if windowed {
            window::keep(&layout);
        }
        return Ok(());
    }
    bail!("no sound can be played by {name}: `low-action --list-devices` shows what there is")
}

/// Whether an option is among those for the framework, with its value or before it.
fn given(others: &[String], option: &str) -> bool {
    others
        .iter()
        .any(|other| other.strip_prefix(option).is_some_and(|rest| rest.is_empty() || rest.starts_with('=')))
}

/// The names of all outputs of the system.
fn outputs() -> Vec<String> {
    let devices = cpal::default_host().output_devices().into_iter().flatten();
    devices.filter_map(|device| Some(device.description().ok()?.name().to_owned())).collect()
}

/// What there is to choose from, for people to read.
pub fn list() -> String {
    let host = cpal::default_host();
    let usual = host.default_output_device().and_then(|device| device.description().ok());
    let mut text = String::from("Outputs (--output-device NAME, or a part of it):\n");
    let names = outputs().into_iter();
    let mut lines: Vec<String> = names
        .map(|name| {
            let is_usual = usual.as_ref().is_some_and(|usual| usual.name() == name);
            format!("  {name}{}\n", if is_usual { " (the usual one)" } else { "" })
        })
        .collect();
    if lines.is_empty() {
        lines.push("  none\n".into());
    }
    text += &lines.concat();
    text += "MIDI inputs (--midi-input NAME, or a part of it; the first keyboard if none is named):\n";
    text += &keyboards::listed(&keyboards::of_system());
    match server::running() {
        Some(server) => {
            text += "A JACK server runs, which --backend auto takes. Its MIDI inputs (--midi-input NAME):\n";
            text += &keyboards::listed(&server.sources);
        }
        None => text += "With a JACK server running, outputs and inputs are its own: --backend jack.\n",
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_for_the_framework_are_known_in_both_forms() {
        let option = "--connect-jack-midi-input";
        for (others, expected) in [
            (&["--connect-jack-midi-input=vmpk:out"][..], true),
            (&["--tempo", "90", "--connect-jack-midi-input", "vmpk:out"], true),
            (&["--connect-jack-midi-inputs=x"], false),
            (&["--connect-jack-inputs=system:capture_1"], false),
            (&[], false),
        ] {
            let others: Vec<String> = others.iter().map(|&other| other.to_owned()).collect();
            assert_eq!(given(&others, option), expected, "{others:?}");
        }
    }
}
