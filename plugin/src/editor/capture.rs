//! Which keys a host does not get while the window has the keyboard: those that controls are moved by, and all while
//! something is typed. The space bar and whatever else a host goes by stay the host's, where the system lets a window pass keys on:
//! on macOS. On Windows and Linux the library drops what is not taken.

use nice_plug_egui::{Key, KeyCapture};

/// What moves a control, goes on to the next, types a number or closes a list.
const OWN: [&str; 11] = [
    "ArrowLeft",
    "ArrowRight",
    "ArrowUp",
    "ArrowDown",
    "Tab",
    "Enter",
    "Escape",
    "Home",
    "End",
    "Delete",
    "Backspace",
];
/// What undoes and redoes, and brings back the usual size, with Ctrl or Cmd.
const COMMANDS: [&str; 4] = ["z", "Z", "y", "0"];

/// What is kept from a host, while something is typed or not, and while Ctrl or Cmd is down or not.
pub(super) fn kept(typing: bool, command: bool) -> KeyCapture {
    if typing {
        return KeyCapture::CaptureAll;
    }
    let commands = if command { &COMMANDS[..] } else { &[] };
    KeyCapture::CaptureKeys(OWN.iter().chain(commands).filter_map(|name| name.parse::<Key>().ok()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn has(capture: &KeyCapture, name: &str) -> bool {
        let key: Key = name.parse().expect("it is a key");
        match capture {
            KeyCapture::CaptureAll => true,
            KeyCapture::CaptureKeys(keys) => keys.contains(&key),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn hosts_get_what_moves_no_control() {
        let (usual, commanded, typing) = (kept(false, false), kept(false, true), kept(true, false));
        for name in OWN {
            assert!(has(&usual, name) && has(&commanded, name) && has(&typing, name), "{name}");
        }
        for name in [" ", "a", "r", "F5", "z", "0"] {
            assert!(!has(&usual, name) && has(&typing, name), "{name:?}");
        }
        assert!(has(&commanded, "z") && has(&commanded, "y") && has(&commanded, "0"));
        assert!(!has(&commanded, "s"));
    }
}
