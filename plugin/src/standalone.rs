//! The instrument as a program of its own, playing through the sound card.
//!
//! The plugin framework opens the devices and plays. Here it is told which, and what to begin with; where it would
//! go on without any sound, this ends with an error (`pulse`).

mod keyboards;
mod names;
mod outputs;
mod pulse;
mod server;
mod way;
pub(crate) mod window;

use anyhow::{Context, Result, bail};
use nice_plug::prelude::nice_export_standalone_with_args;

use crate::cli::say;
use crate::params::{Start, begin_with};
use crate::plugin::LowAction;
pub use way::Way;
use way::{JACK, NATIVE, NOTHING};

/// Hz, where nobody says otherwise and the output takes it.
const SAMPLE_RATE: u32 = 48_000;
/// Samples computed at a time, where nobody says otherwise and the output takes them.
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
    /// Hz, but for JACK, which has its own; nothing is what the output takes that is nearest to 48,000.
    pub sample_rate: Option<u32>,
    /// Samples computed at a time, but for JACK; nothing is what the output takes that is nearest to 256.
    pub period: Option<u32>,
    /// More of the framework's options.
    pub others: Vec<String>,
}

impl Devices {
    /// The way to them; none is opened.
    ///
    /// # Errors
    /// When there is none, or the output does not take what is asked for.
    pub fn way(&self) -> Result<Way> {
        let mut way = Way::to(self, Way::may_need_server(self).then(server::running).flatten())?;
        if way.name == NATIVE {
            let output = self.output.as_deref();
            way.output = output.map(|name| names::find("output", &outputs::names(), name)).transpose()?;
            // (Named to the framework itself, which takes no option twice.)
            if let Some(name) = value(&self.others, "--output-device") {
                way.output = Some(name.to_owned());
            }
            let (name, offers) = outputs::offers(way.output.as_deref());
            let period = value(&self.others, "--period-size").map_or(self.period, |value| value.parse().ok());
            let fit = outputs::fit(&name, &offers, self.sample_rate, period);
            let played = fit.with_context(|| format!("no sound can be played by {NATIVE}"));
            (way.sample_rate, way.period) = played?;
        }
        Ok(way)
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
        arguments.push(format!("--period-size={}", way.period));
    }
    if name == NOTHING {
        say("low-action", &format!("plays to nobody, {until}"));
    } else {
        let (known, sources, option) = match &way.server {
            Some(server) => (server.keyboards.clone(), server.sources.clone(), "--connect-jack-midi-input"),
            None => {
                let output = way.output.iter().filter(|_| !given(&devices.others, "--output-device"));
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

/// The value of an option among those for the framework.
fn value<'a>(others: &'a [String], option: &str) -> Option<&'a str> {
    others.iter().enumerate().find_map(|(index, other)| match other.strip_prefix(option)? {
        "" => others.get(index + 1).map(String::as_str),
        rest => rest.strip_prefix('='),
    })
}

/// What there is to choose from, for people to read.
pub fn list() -> String {
    let mut text = String::from(
        "Outputs (--output-device NAME, or a part of it), with --sample-rate and --period-size:\n",
    );
    text += &outputs::listed();
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
            assert_eq!(value(&others, option), expected.then_some("vmpk:out"), "{others:?}");
        }
        assert_eq!(value(&[option.to_owned()], option), None);
    }
}
