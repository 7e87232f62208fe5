//! The computer's keys, where there is no host that wants them for itself: a piano, or strings and frets.
//!
//! Of the signs on the keyboard only letters and digits arrive from the window, so both make do with those.

mod frets;
mod piano;

use egui::{Event, Key, Modifiers, Ui};
use low_action_dsp::Setup;

use super::Given;
use crate::performance::{PlayerEvent, StringDeed};
use crate::plugin::layout::{KeyMap, Keyboard};
use crate::plugin::order::touching;
pub(super) use frets::{finger_place, keys_on_strings};

/// How hard notes are, 1 is the hardest.
const VELOCITY: f32 = 0.8;

/// What a key plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sound {
    /// A MIDI key; the player finds its string.
    Note(u8),
    /// A string, counted from 0, stopped at a fret, 0 for none.
    Stopped { string: usize, fret: usize },
}

/// What the keys remember.
#[derive(Debug, Default)]
pub struct Keys {
    /// As it was at the last picture.
    keyboard: Keyboard,
    /// Keys that are down and what they play, the latest last.
    held: Vec<(Key, Sound)>,
}

impl Keys {
    /// Takes what the keys have done since the last picture.
    pub fn follow(&mut self, ui: &Ui, given: &Given) {
        let (Some(keyboard), Some(setup)) = (given.keyboard, given.plan.setup()) else { return };
        if self.keyboard != keyboard {
            self.let_go(given);
            self.keyboard = keyboard;
        }
        // With Shift, letters neither come nor go: nothing may hang on one that went so.
        if ui.ctx().text_edit_focused() || ui.input(|input| input.modifiers.shift) {
            self.let_go(given);
            return;
        }
        let events: Vec<Event> = ui.input(|input| input.events.clone());
        for event in events {
            if event == Event::WindowFocused(false) {
                // Whatever goes up from now on goes up elsewhere.
                self.let_go(given);
            }
            let Event::Key { key, pressed, repeat, modifiers, .. } = event else { continue };
            if !pressed {
                self.release(given, key);
            } else if let Some(moved) = moved(self.keyboard, key, modifiers, setup) {
                ui.input_mut(|input| input.consume_key(modifiers, key));
                self.let_go(given);
                self.keyboard = moved;
                given.params.layout.set_keys(moved);
            } else if !repeat && !modifiers.any() {
                self.press(given, key, setup);
            }
        }
    }

    fn press(&mut self, given: &Given, key: Key, setup: &Setup) {
        let sound = match self.keyboard.map {
            KeyMap::Piano => piano::note(self.keyboard, key).map(Sound::Note),
            KeyMap::Frets => frets::stopped(self.keyboard, key, setup)
                .map(|(string, fret)| Sound::Stopped { string, fret }),
        };
        let Some(sound) = sound.filter(|_| self.held.iter().all(|(held, _)| *held != key)) else { return };
        self.held.push((key, sound));
        match sound {
            Sound::Note(key) => play(given, PlayerEvent::NoteOn { channel: 0, key, velocity: VELOCITY }),
            Sound::Stopped { string, fret } => {
                put_finger(given, setup, string, fret);
                pluck(given, setup, string);
            }
        }
    }

    fn release(&mut self, given: &Given, key: Key) {
        let Some(place) = self.held.iter().position(|(held, _)| *held == key) else { return };
        let (_, sound) = self.held.remove(place);
        let Sound::Stopped { string, .. } = sound else { return end(given, sound) };
        let on_string = |&(_, held): &(Key, Sound)| match held {
            Sound::Stopped { string: other, fret } => (other == string).then_some(fret),
            Sound::Note(_) => None,
        };
        if self.held[place..].iter().any(|held| on_string(held).is_some()) {
            // A later key has the string.
            return;
        }
        match (self.held.iter().rev().find_map(on_string), given.plan.setup()) {
            // One that is still down takes it again, without a pluck.
            (Some(fret), Some(setup)) => put_finger(given, setup, string, fret),
            _ => end(given, sound),
        }
    }

    fn let_go(&mut self, given: &Given) {
        self.held.drain(..).for_each(|(_, sound)| end(given, sound));
    }
}

/// What is played after a key that moves the keyboard; nothing for others.
fn moved(keyboard: Keyboard, key: Key, modifiers: Modifiers, setup: &Setup) -> Option<Keyboard> {
    match keyboard.map {
        KeyMap::Piano => piano::moved(keyboard, key, modifiers),
        KeyMap::Frets => frets::moved(keyboard, key, modifiers, setup),
    }
}

fn play(given: &Given, event: PlayerEvent) {
    given.pointer.play(event);
}

fn do_to(given: &Given, string: usize, deed: StringDeed) {
    if let Ok(string) = u8::try_from(string) {
        play(given, PlayerEvent::Touched { string, deed });
    }
}

/// Another finger takes the string; at fret 0 none does.
fn put_finger(given: &Given, setup: &Setup, string: usize, fret: usize) {
    do_to(given, string, StringDeed::Lift);
    if fret > 0 {
        let position = finger_place(setup, fret) as f32;
        do_to(given, string, StringDeed::Press { position });
    }
}

/// Plucks a string where notes are plucked.
fn pluck(given: &Given, setup: &Setup, string: usize) {
    let Some(player) = given.plan.player() else { return };
    let position = (setup.neck.scale_length - player.pluck_position) as f32;
    let force = touching(given.params).strength(f64::from(VELOCITY)) * player.pluck_force;
    do_to(given, string, StringDeed::Pluck { position, force: force as f32 });
}

/// What a key played is over.
fn end(given: &Given, sound: Sound) {
    match sound {
        Sound::Note(key) => play(given, PlayerEvent::NoteOff { channel: 0, key }),
        Sound::Stopped { string, .. } => do_to(given, string, StringDeed::Damp),
    }
}
