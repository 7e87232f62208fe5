//! The instrument as a program of its own, playing through the sound card.
//!
//! The plugin framework opens the devices and plays. Here it is told which, and what to begin with; where it would
//! go on without any sound, this ends with an error (`pulse`).

mod keyboards;
mod pulse;
pub(crate) mod window;

use anyhow::{Result, bail, ensure};
use cpal::traits::{DeviceTrait, HostTrait};
use nice_plug::prelude::nice_export_standalone_with_args;

use crate::cli::say;
use crate::params::{Start, begin_with};
use crate::plugin::LowAction;

/// The system's own way to its devices, by the framework's name for it.
const NATIVE: &str = if cfg!(target_os = "macos") {
    "core-audio"
} else if cfg!(target_os = "windows") {
    "wasapi"
} else {
    "alsa"
};
/// The way through the JACK server, which knows its own devices.
const JACK: &str = "jack";
/// No way at all, by our name for it and by the framework's: for those who only look at the editor.
const NONE: &str = "none";
const NOTHING: &str = "dummy";
/// What stands for JACK if a server runs, and for the system's own way otherwise.
const AUTO: &str = "auto";

/// Which devices are to be used.
#[derive(Debug, Clone, Default)]
pub struct Devices {
    /// `auto`, `jack`, `alsa`, `core-audio`, `wasapi` or `none`; nothing is `auto`.
    pub backend: Option<String>,
    /// Where the sound goes; nothing is what the system usually takes.
    pub output: Option<String>,
    /// Which keyboard plays; nothing is the first there is.
    pub keyboard: Option<String>,
    /// Hz, but for JACK, which has its own.
    pub sample_rate: u32,
    /// Samples computed at a time, but for JACK.
    pub period: u32,
    /// More of the framework's options.
    pub others: Vec<String>,
}

/// Opens the instrument and plays what arrives on MIDI until its window is closed or it is interrupted.
///
/// # Errors
/// When no device can be opened, or not the one that was named; the log says more.
pub fn open(mut start: Start, devices: &Devices) -> Result<()> {
    let windowed = cfg!(feature = "editor") && window::prepare(&mut start);
    let until = if windowed { "until its window is closed" } else { "until Ctrl+C" };
    let (layout, blocks) = (start.layout.clone(), start.blocks.clone());
    begin_with(start);
    let asked = devices.backend.as_deref().unwrap_or(AUTO);
    let jack = matches!(asked, AUTO | JACK).then(keyboards::of_jack).flatten();
    ensure!(asked != JACK || jack.is_some(), "no sound can be played by jack: no JACK server runs");
    let way = match asked {
        AUTO if jack.is_some() => JACK,
        AUTO => NATIVE,
        NONE => NOTHING,
        named => named,
    };
    if let Some(warning) = given_in_vain(way, devices) {
        say("warning", &warning);
    }
    let mut arguments = vec!["low-action --".to_owned(), format!("--backend={way}")];
    if way != JACK {
        arguments.push(format!("--sample-rate={}", devices.sample_rate));
        arguments.push(format!("--period-size={}", devices.period));
    }
    if way == NOTHING {
        say("low-action", &format!("plays to nobody, {until}"));
    } else {
        let (known, option) = if way == JACK {
            (jack.unwrap_or_default(), "--connect-jack-midi-input")
        } else {
            arguments.extend(devices.output.as_ref().map(|name| format!("--output-device={name}")));
            (keyboards::of_system(), "--midi-input")
        };
        match keyboards::choose(&known, devices.keyboard.as_deref())? {
            Some(name) => {
                say("low-action", &format!("plays what {name} sends, {until}"));
                arguments.push(format!("{option}={name}"));
            }
            None if windowed => say("warning", "there is no MIDI keyboard: mouse and computer keys play"),
            None => say("warning", "there is no MIDI keyboard: nothing will be heard"),
        }
    }
    arguments.extend(devices.others.iter().cloned());
    pulse::watch(blocks, way);
    if nice_export_standalone_with_args::<LowAction, _>(arguments) {
        if windowed {
            window::keep(&layout);
        }
        return Ok(());
    }
    bail!("no sound can be played by {way}: `low-action --list-devices` shows what there is")
}

/// That devices were named where the way to them takes no names, if so.
fn given_in_vain(way: &str, devices: &Devices) -> Option<String> {
    let output = ("--output-device", &devices.output);
    let (backend, options) = match way {
        JACK => (JACK, vec![output]),
        NOTHING => (NONE, vec![output, ("--midi-input", &devices.keyboard)]),
        _ => return None,
    };
    let given =
        options.into_iter().filter_map(|(option, name)| Some(format!("{option} {:?}", name.as_ref()?)));
    let given: Vec<String> = given.collect();
    (!given.is_empty())
        .then(|| format!("--backend {backend} does not take {}: --backend {NATIVE} does", given.join(" or ")))
}

/// What there is to choose from, for people to read.
pub fn list() -> String {
    let host = cpal::default_host();
    let usual = host.default_output_device().and_then(|device| device.description().ok());
    let mut text = String::from("Outputs (--output-device NAME):\n");
    let outputs = host.output_devices().map(Iterator::collect::<Vec<_>>).unwrap_or_default();
    let names = outputs.iter().filter_map(|device| device.description().ok());
    let mut lines: Vec<String> = names
        .map(|one| {
            let is_usual = usual.as_ref().is_some_and(|usual| usual.name() == one.name());
            format!("  {}{}\n", one.name(), if is_usual { " (the usual one)" } else { "" })
        })
        .collect();
    if lines.is_empty() {
        lines.push("  none\n".into());
    }
    text += &lines.concat();
    text += "MIDI inputs (--midi-input NAME; the first keyboard if none is named):\n";
    text += &keyboards::listed(&keyboards::of_system());
    match keyboards::of_jack() {
        Some(known) => {
            text += "A JACK server runs, which --backend auto takes. Its MIDI inputs (--midi-input NAME):\n";
            text += &keyboards::listed(&known);
        }
        None => text += "With a JACK server running, outputs and inputs are its own: --backend jack.\n",
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_named_in_vain_are_told() {
        let named =
            Devices { output: Some("USB".into()), keyboard: Some("Keys".into()), ..Devices::default() };
        let told = given_in_vain(JACK, &named);
        let one = format!("--backend jack does not take --output-device \"USB\": --backend {NATIVE} does");
        assert_eq!(told, Some(one));
        let told = given_in_vain(NOTHING, &named);
        assert!(told.is_some_and(|told| told.contains("\"USB\" or --midi-input \"Keys\"")));
        let told = given_in_vain(NOTHING, &Devices { output: None, ..named.clone() });
        assert!(
            told.is_some_and(|told| told.starts_with("--backend none does not take --midi-input \"Keys\":"))
        );
        assert_eq!(given_in_vain(NATIVE, &named), None);
        assert_eq!(given_in_vain(JACK, &Devices::default()), None);
    }
}
