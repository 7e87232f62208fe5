//! The computer's keys as a piano, where there is no host that wants them for itself.
//!
//! Two rows of letters are white keys, with their black ones in the row above each: from Z on an octave below, from Q
//! on middle C and above it. Page Up and Page Down move both by an octave.

use egui::{Event, Key, Ui};

use super::Given;
use crate::performance::PlayerEvent;

/// From C to B, and from C to E, one octave on. Of the signs on the keyboard, only letters and digits arrive from the window.
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
/// How hard notes are, 1 is the hardest.
const VELOCITY: f32 = 0.8;

/// What the keys remember.
#[derive(Debug, Default)]
pub struct Keys {
    octave: i32,
    /// Keys that are down, and the notes they play.
    held: Vec<(Key, u8)>,
}

impl Keys {
    /// Takes what the keys have done since the last picture.
    pub fn follow(&mut self, ui: &Ui, given: &Given) {
        // With Shift, letters neither come nor go: nothing may hang on one that went so.
        if ui.ctx().text_edit_focused() || ui.input(|input| !input.focused || input.modifiers.shift) {
            self.let_go(given);
            return;
        }
        let events: Vec<Event> = ui.input(|input| input.events.clone());
        for event in events {
            let Event::Key { key, pressed, repeat, modifiers, .. } = event else { continue };
            match key {
                Key::PageUp | Key::PageDown if pressed && !modifiers.command => {
                    self.let_go(given);
                    let way = if key == Key::PageUp { 1 } else { -1 };
                    self.octave = (self.octave + way).clamp(OCTAVES[0], OCTAVES[1]);
                }
                _ if !pressed => self.release(given, key),
                _ if repeat || modifiers.command || modifiers.ctrl || modifiers.alt => {}
                _ => self.press(given, key),
            }
        }
    }

    fn press(&mut self, given: &Given, key: Key) {
        let Some(note) = note(key, self.octave) else { return };
        if self.held.iter().any(|(held, _)| *held == key) {
            return;
        }
        self.held.push((key, note));
        given.pointer.play(PlayerEvent::NoteOn { channel: 0, key: note, velocity: VELOCITY });
    }

    fn release(&mut self, given: &Given, key: Key) {
        self.held.retain(|&(held, note)| {
            if held == key {
                given.pointer.play(PlayerEvent::NoteOff { channel: 0, key: note });
            }
            held != key
        });
    }

    fn let_go(&mut self, given: &Given) {
        for (_, note) in self.held.drain(..) {
            given.pointer.play(PlayerEvent::NoteOff { channel: 0, key: note });
        }
    }
}

/// The MIDI key that a key plays, if any.
fn note(key: Key, octave: i32) -> Option<u8> {
    let rows = [&LOWER[..], &UPPER].into_iter().zip(FIRST);
    let mut notes = rows.filter_map(|(row, first)| {
        let along = row.iter().position(|known| *known == key)? as i32;
        u8::try_from(first + 12 * octave + along).ok().filter(|note| *note < 128)
    });
    notes.next()
}
