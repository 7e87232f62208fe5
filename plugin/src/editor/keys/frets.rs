//! The keys as strings and frets: each row is a string, as they lie in the picture, and along it are the frets.

use egui::{Key, Modifiers};
use low_action_dsp::Setup;
use low_action_dsp::intonation::finger_position;

use crate::plugin::layout::Keyboard;

/// A row for each of four neighbouring strings.
const ROWS: [&[Key]; 4] = [
    &[
        Key::Num1,
        Key::Num2,
        Key::Num3,
        Key::Num4,
        Key::Num5,
        Key::Num6,
        Key::Num7,
        Key::Num8,
        Key::Num9,
        Key::Num0,
    ],
    &[Key::Q, Key::W, Key::E, Key::R, Key::T, Key::Y, Key::U, Key::I, Key::O, Key::P],
    &[Key::A, Key::S, Key::D, Key::F, Key::G, Key::H, Key::J, Key::K, Key::L],
    &[Key::Z, Key::X, Key::C, Key::V, Key::B, Key::N, Key::M],
];

/// The string (counted from 0) and the fret (0 for none) that a key plays, if any.
pub(super) fn stopped(keyboard: Keyboard, key: Key, setup: &Setup) -> Option<(usize, usize)> {
    let mut keys = keys_on_strings(keyboard, setup);
    keys.find(|(known, ..)| *known == key).map(|(_, string, fret)| (string, fret))
}

/// All keys that play, with their string (counted from 0) and fret (0 for none).
pub(in crate::editor) fn keys_on_strings(
    keyboard: Keyboard,
    setup: &Setup,
) -> impl Iterator<Item = (Key, usize, usize)> {
    let Keyboard { string: upper, fret: first, .. } = admitted(keyboard, setup);
    let (strings, frets) = (setup.string.len(), setup.neck.frets);
    let rows = ROWS.into_iter().enumerate().take(strings.saturating_sub(upper));
    rows.flat_map(move |(row, keys)| {
        let frets = (first..=frets).zip(keys);
        frets.map(move |(fret, key)| (*key, upper + row, fret))
    })
}

/// Page Up and Page Down move the rows from string to string, Ctrl with the arrows to the sides along them.
pub(super) fn moved(keyboard: Keyboard, key: Key, modifiers: Modifiers, setup: &Setup) -> Option<Keyboard> {
    let Keyboard { string, fret, .. } = admitted(keyboard, setup);
    let moved = match (key, modifiers.command) {
        (Key::PageUp, false) => Keyboard { string: string.saturating_sub(1), fret, ..keyboard },
        (Key::PageDown, false) => Keyboard { string: string + 1, fret, ..keyboard },
        (Key::ArrowLeft, true) => Keyboard { string, fret: fret.saturating_sub(1), ..keyboard },
        (Key::ArrowRight, true) => Keyboard { string, fret: fret + 1, ..keyboard },
        _ => return None,
    };
    Some(admitted(moved, setup))
}

/// The same where no row but the last is beyond the strings, and the shortest row ends at the last fret.
fn admitted(keyboard: Keyboard, setup: &Setup) -> Keyboard {
    let farthest = |count: usize, seen: usize| count.saturating_sub(seen);
    let shortest = ROWS[ROWS.len() - 1].len();
    Keyboard {
        string: keyboard.string.min(farthest(setup.string.len(), ROWS.len())),
        fret: keyboard.fret.min(farthest(setup.neck.frets + 1, shortest)),
        ..keyboard
    }
}

/// Where a finger stops a fret (1 for the first) of an equally tempered neck, m from the nut.
pub(in crate::editor) fn finger_place(setup: &Setup, fret: usize) -> f64 {
    finger_position(&setup.neck.equal_places(), fret, setup.behind())
}
