//! The keyboards that could play, and which does.

use anyhow::{Result, ensure};
use jack::{Client, ClientOptions, PortFlags};
use midir::MidiInput;

/// A port that leads programs to each other and is no keyboard.
const THROUGH: &str = "Midi Through";

/// The names of all MIDI inputs of the system.
pub(super) fn of_system() -> Vec<String> {
    let Ok(midi) = MidiInput::new("Low Action") else { return Vec::new() };
    midi.ports().iter().filter_map(|port| midi.port_name(port).ok()).collect()
}

/// The names of the JACK server's ports at which keyboards arrive, if one runs; none is started.
pub(super) fn of_jack() -> Option<Vec<String>> {
    let (client, _) = Client::new("Low Action", ClientOptions::NO_START_SERVER).ok()?;
    Some(client.ports(None, Some("midi"), PortFlags::IS_PHYSICAL | PortFlags::IS_OUTPUT))
}

/// The one that is to play, if there is one: the named one, or the first.
///
/// # Errors
/// When the named one is not there.
pub(super) fn choose(known: &[String], named: Option<&str>) -> Result<Option<String>> {
    let Some(name) = named else {
        return Ok(known.iter().find(|name| !name.contains(THROUGH)).cloned());
    };
    let there = match known {
        [] => "there is none at all".to_owned(),
        known => format!("it must be {}", known.join(" or ")),
    };
    ensure!(known.iter().any(|one| one == name), "there is no MIDI input {name:?}: {there}");
    Ok(Some(name.to_owned()))
}

/// A line for each, for people to read.
pub(super) fn listed(known: &[String]) -> String {
    match known {
        [] => "  none\n".to_owned(),
        known => known.iter().map(|name| format!("  {name}\n")).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_keyboard_plays_or_the_named_one() {
        let known = ["Midi Through:0", "Keys", "Pads"].map(String::from);
        assert_eq!(choose(&known, None).unwrap().as_deref(), Some("Keys"));
        assert_eq!(choose(&known[..1], None).unwrap(), None, "what leads programs to each other is none");
        assert_eq!(choose(&known, Some("Pads")).unwrap().as_deref(), Some("Pads"));
        assert_eq!(choose(&known, Some("Midi Through:0")).unwrap().as_deref(), Some("Midi Through:0"));
        let told = choose(&known, Some("Drums")).unwrap_err().to_string();
        assert_eq!(told, "there is no MIDI input \"Drums\": it must be Midi Through:0 or Keys or Pads");
        let told = choose(&[], Some("Drums")).unwrap_err().to_string();
        assert_eq!(told, "there is no MIDI input \"Drums\": there is none at all");
    }
}
