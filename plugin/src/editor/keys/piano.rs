//! The keys as a piano: two rows of letters are white keys, with their black ones in the row above each.

use egui::{Key, Modifiers};

use crate::plugin::layout::Keyboard;

/// From C to B, and from C to E, one octave on.
const LOWER: [Key; 12] =
    [Key::Z, Key::S, Key::X, Key::D, Key::C, Key::V, Key::G, Key::B, Key::H, Key::N, Key::J, Key::M];
const UPPER: [Key; 17] = [
    Key::Q,
    Key::Num2,
    Key::W,
    Key::Num3,
    Key::E,
    Key::R,
    Key::Num5,
    Key::T,
    Key::Num6,
    Key::Y,
    Key::Num7,
    Key::U,
    Key::I,
    Key::Num9,
    Key::O,
    Key::Num0,
    Key::P,
];
/// The first key of each row, as MIDI numbers them: 60 is middle C.
const FIRST: [i32; 2] = [48, 60];
/// Octaves that the rows can be moved, down and up.
const OCTAVES: [i32; 2] = [-3, 3];

/// The MIDI key that a key plays, if any.
pub(super) fn note(keyboard: Keyboard, key: Key) -> Option<u8> {
    let rows = [&LOWER[..], &UPPER].into_iter().zip(FIRST);
    let mut notes = rows.filter_map(|(row, first)| {
        let along = row.iter().position(|known| *known == key)? as i32;
        let octave = keyboard.octave.clamp(OCTAVES[0], OCTAVES[1]);
        u8::try_from(first + 12 * octave + along).ok().filter(|note| *note < 128)
    });
    notes.next()
}

/// Page Up and Page Down move both rows by an octave.
pub(super) fn moved(keyboard: Keyboard, key: Key, modifiers: Modifiers) -> Option<Keyboard> {
    let way = match key {
        Key::PageUp if !modifiers.command => 1,
        Key::PageDown if !modifiers.command => -1,
        _ => return None,
    };
    let octave = (keyboard.octave.clamp(OCTAVES[0], OCTAVES[1]) + way).clamp(OCTAVES[0], OCTAVES[1]);
    Some(Keyboard { octave, ..keyboard })
}
