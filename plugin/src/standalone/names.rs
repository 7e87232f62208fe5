//! Devices by name.

use anyhow::{Result, ensure};

/// The one that is meant by a name: that bears it, or else the only one in whose name it stands, in large letters or small.
/// Systems put numbers and the names of ports into names that nobody knows beforehand.
///
/// # Errors
/// When there is none, or more than one.
pub(super) fn find(what: &str, known: &[String], name: &str) -> Result<String> {
    if known.iter().any(|one| one == name) {
        return Ok(name.to_owned());
    }
    let part = name.to_lowercase();
    let mut meant: Vec<&String> = known.iter().filter(|one| one.to_lowercase().contains(&part)).collect();
    meant.sort_unstable();
    meant.dedup();
    let names = |names: &[&String]| names.iter().map(|name| name.as_str()).collect::<Vec<_>>().join(" or ");
    ensure!(meant.len() < 2, "there is more than one {what} {name:?}: it may be {}", names(&meant));
    let there = match known {
        [] => "there is none at all".to_owned(),
        known => format!("it must be {}", names(&known.iter().collect::<Vec<_>>())),
    };
    let found = meant.first().map(|one| (*one).clone());
    found.ok_or_else(|| anyhow::anyhow!("there is no {what} {name:?}: {there}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As ALSA has them.
    fn found(name: &str) -> Result<String, String> {
        let known = ["Midi Through:Midi Through Port-0 14:0", "Keystation 49:Keystation 49 MIDI 1 24:0"];
        let more = ["Pads:Pads MIDI 1 28:0", "Pads:Pads MIDI 2 28:1", "Pads"];
        let known: Vec<String> = known.into_iter().chain(more).map(String::from).collect();
        find("MIDI input", &known, name).map_err(|error| error.to_string())
    }

    #[test]
    fn a_part_of_a_name_is_enough_if_no_other_has_it() {
        let keystation = Ok("Keystation 49:Keystation 49 MIDI 1 24:0".to_owned());
        for name in ["Keystation 49", "keystation", "24:0", "Keystation 49:Keystation 49 MIDI 1 24:0"] {
            assert_eq!(found(name), keystation, "{name}");
        }
        // A whole name is that, in how many others it may stand.
        assert_eq!(found("Pads"), Ok("Pads".to_owned()));
        assert_eq!(found("pads midi 2"), Ok("Pads:Pads MIDI 2 28:1".to_owned()));
        let told = "there is more than one MIDI input \"Pads:\": it may be Pads:Pads MIDI 1 28:0 or Pads:Pads MIDI 2 28:1";
        assert_eq!(found("Pads:"), Err(told.to_owned()));
    }

    /// The framework takes the first of them.
    #[test]
    fn what_has_one_name_is_one() {
        let known = ["USB Audio", "HDMI", "USB Audio"].map(String::from);
        assert_eq!(find("output", &known, "usb").expect("it is there"), "USB Audio");
    }

    #[test]
    fn what_is_not_there_is_told_with_what_is() {
        let known = ["Keys", "Pads"].map(String::from);
        let told = |known: &[String]| find("output", known, "Drums").unwrap_err().to_string();
        assert_eq!(told(&known), "there is no output \"Drums\": it must be Keys or Pads");
        assert_eq!(told(&[]), "there is no output \"Drums\": there is none at all");
    }
}
