//! The keyboards that could play, and which does.

use anyhow::Result;
use midir::MidiInput;

use super::names;

/// A port that leads programs to each other and is no keyboard.
const THROUGH: &str = "Midi Through";

/// The names of all MIDI inputs of the system.
pub(super) fn of_system() -> Vec<String> {
    let Ok(midi) = MidiInput::new("Low Action") else { return Vec::new() };
    midi.ports().iter().filter_map(|port| midi.port_name(port).ok()).collect()
}

/// The one that is to play, if there is one: of all sources the named one, or the first keyboard.
///
/// # Errors
/// When the named one is not there, or it may be several.
pub(super) fn choose(
    keyboards: &[String],
    sources: &[String],
    named: Option<&str>,
) -> Result<Option<String>> {
    match named {
        Some(name) => names::find("MIDI input", sources, name).map(Some),
        None => Ok(keyboards.iter().find(|name| !name.contains(THROUGH)).cloned()),
    }
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
        let choose = |known: &[String], named| super::choose(known, known, named);
        assert_eq!(choose(&known, None).unwrap().as_deref(), Some("Keys"));
        assert_eq!(choose(&known[..1], None).unwrap(), None, "what leads programs to each other is none");
        assert_eq!(choose(&known, Some("Pads")).unwrap().as_deref(), Some("Pads"));
        assert_eq!(choose(&known, Some("key")).unwrap().as_deref(), Some("Keys"), "a part of it is enough");
        assert_eq!(choose(&known, Some("Midi Through:0")).unwrap().as_deref(), Some("Midi Through:0"));
        let told = choose(&known, Some("Drums")).unwrap_err().to_string();
        assert_eq!(told, "there is no MIDI input \"Drums\": it must be Midi Through:0 or Keys or Pads");
        let told = choose(&[], Some("Drums")).unwrap_err().to_string();
        assert_eq!(told, "there is no MIDI input \"Drums\": there is none at all");
    }

    #[test]
    fn another_program_plays_if_it_is_named() {
        let sources = ["system:midi_capture_1", "vmpk:out"].map(String::from);
        let chosen = |named| choose(&sources[..1], &sources, named).unwrap();
        assert_eq!(chosen(Some("vmpk")).as_deref(), Some("vmpk:out"));
        assert_eq!(chosen(Some("capture")).as_deref(), Some("system:midi_capture_1"));
        assert_eq!(chosen(None).as_deref(), Some("system:midi_capture_1"));
        assert_eq!(choose(&[], &sources, None).unwrap(), None, "no program plays that nobody has named");
    }
}
