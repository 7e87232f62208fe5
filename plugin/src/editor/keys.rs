//! The computer's keys, where there is no host that wants them for itself: a piano, or strings and frets.
//!
//! Of the signs on the keyboard only letters and digits arrive from the window, so both make do with those.

mod channels;
mod frets;
mod piano;
mod repeats;

use egui::{Event, Key, Modifiers, Ui};
use low_action_dsp::Setup;

use super::Given;
use crate::performance::{PlayerEvent, StringDeed};
use crate::plugin::layout::{KeyMap, Keyboard};
use crate::plugin::order::{input, touching};
pub(super) use frets::{finger_place, keys_on_strings};

/// How hard notes are, 1 is the hardest.
const VELOCITY: f32 = 0.8;
/// How long a key has been down, s, when it may begin to repeat.
const REPEATS: f64 = 0.25;

/// What a key plays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sound {
    /// A MIDI key on a channel; the player finds its string, unless channels are strings.
    Note { channel: u8, key: u8 },
    /// A string, counted from 0, stopped at a fret, 0 for none.
    Stopped { string: usize, fret: usize },
}

/// A key that is down.
#[derive(Debug, Clone, Copy)]
struct Held {
    key: Key,
    sound: Sound,
    /// Since when, s.
    since: f64,
    /// Whether it went up at the last picture, unless it only repeats.
    leaves: bool,
}

impl Held {
    /// Whether it has been down for so long that it may begin to repeat.
    fn may_repeat(&self, now: f64) -> bool {
        now - self.since >= REPEATS
    }
}

/// What the keys remember.
#[derive(Debug, Default)]
pub struct Keys {
    /// As it was at the last picture.
    keyboard: Keyboard,
    /// Keys that are down, the latest last.
    held: Vec<Held>,
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
        let (events, now) = ui.input(|input| (input.events.clone(), input.time));
        // One that is pressed once more within a picture does not repeat. Of one that is down and plays nothing, as after
        // it was let go, it is not known since when.
        let may_repeat = |key| match self.held.iter().find(|held| held.key == key) {
            Some(held) => held.may_repeat(now),
            None => repeats::comes_down(&events, key).is_none(),
        };
        let mut halves = repeats::halves(&events, may_repeat);
        for (key, leaves) in self.held.iter().map(|held| (held.key, held.leaves)).collect::<Vec<_>>() {
            match repeats::comes_down(&events, key).filter(|_| leaves) {
                Some(down) => {
                    halves[down] = true;
                    self.stays(key);
                }
                None if leaves => self.release(given, key),
                None => {}
            }
        }
        for (event, is_half) in events.into_iter().zip(halves) {
            match event {
                // Whatever goes up from now on goes up elsewhere.
                Event::WindowFocused(false) => self.let_go(given),
                // Without Shift only Caps Lock writes so, under which no letter is known, nor heard of when it goes up.
                Event::Text(text) if is_capital(&text) => self.let_go(given),
                Event::Key { key, pressed: false, .. } if !is_half => self.lift(ui, given, key, now),
                Event::Key { key, pressed: true, repeat, modifiers, .. } => {
                    if let Some(moved) = moved(self.keyboard, key, modifiers, setup) {
                        ui.input_mut(|input| input.consume_key(modifiers, key));
                        self.let_go(given);
                        self.keyboard = moved;
                        given.params.layout.set_keys(moved);
                    } else if !repeat && !is_half && !modifiers.any() {
                        self.press(given, key, setup, now);
                    }
                }
                _ => {}
            }
        }
    }

    fn press(&mut self, given: &Given, key: Key, setup: &Setup, now: f64) {
        if self.held.iter().any(|held| held.key == key) {
            return;
        }
        let sound = match self.keyboard.map {
            KeyMap::Piano => piano::note(self.keyboard, key).map(|key| {
                let channel = channels::channel(input(given.params), setup, key, &self.channels());
                Sound::Note { channel, key }
            }),
            KeyMap::Frets => frets::stopped(self.keyboard, key, setup)
                .map(|(string, fret)| Sound::Stopped { string, fret }),
        };
        let Some(sound) = sound else { return };
        self.held.push(Held { key, sound, since: now, leaves: false });
        match sound {
            Sound::Note { channel, key } => {
                play(given, PlayerEvent::NoteOn { channel, key, velocity: VELOCITY });
            }
            Sound::Stopped { string, fret } => {
                put_finger(given, setup, string, fret);
                pluck(given, setup, string);
            }
        }
    }

    /// Channels of the notes that are held.
    fn channels(&self) -> Vec<u8> {
        let channel = |held: &Held| match held.sound {
            Sound::Note { channel, .. } => Some(channel),
            Sound::Stopped { .. } => None,
        };
        self.held.iter().filter_map(channel).collect()
    }

    /// A key goes up. One that may repeat comes down again at the next picture, if it does.
    fn lift(&mut self, ui: &Ui, given: &Given, key: Key, now: f64) {
        match self.held.iter_mut().find(|held| held.key == key) {
            Some(held) if held.may_repeat(now) => {
                held.leaves = true;
                ui.ctx().request_repaint();
            }
            _ => self.release(given, key),
        }
    }

    /// A key that seemed to go up is still down.
    fn stays(&mut self, key: Key) {
        self.held.iter_mut().filter(|held| held.key == key).for_each(|held| held.leaves = false);
    }

    fn release(&mut self, given: &Given, key: Key) {
        let Some(place) = self.held.iter().position(|held| held.key == key) else { return };
        let Held { sound, .. } = self.held.remove(place);
        let Sound::Stopped { string, .. } = sound else { return end(given, sound) };
        let on_string = |held: &Held| match held.sound {
            Sound::Stopped { string: other, fret } => (other == string).then_some(fret),
            Sound::Note { .. } => None,
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
        self.held.drain(..).for_each(|held| end(given, held.sound));
    }
}

/// Whether something that was written is one capital letter.
fn is_capital(text: &str) -> bool {
    let mut letters = text.chars();
    matches!((letters.next(), letters.next()), (Some(letter), None) if letter.is_uppercase())
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
        Sound::Note { channel, key } => play(given, PlayerEvent::NoteOff { channel, key }),
        Sound::Stopped { string, .. } => do_to(given, string, StringDeed::Damp),
    }
}
