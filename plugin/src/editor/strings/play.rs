//! Playing with the mouse.
//!
//! Dragged across strings it plucks each where it crosses it, the harder the faster. Pressed on a string over the board
//! it is a finger: it slides along while it is held and leaves when it is let go, or stays if Shift was down, so that
//! the other strings can be stopped too and all be strummed. The other button silences what it is pressed on and crosses.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use egui::{PointerButton, Pos2, Response, Ui};
use low_action_dsp::Setup;

use super::{Sight, hint};
use crate::editor::Given;
use crate::performance::{PlayerEvent, StringDeed};

/// How near to a string the mouse is on it, as a part of the distance between strings.
const ON_STRING: f32 = 0.3;
/// Speed across the strings, strings a second, at which a pluck is as hard as the hardest note's, and the power by which
/// force goes with speed: hands differ more in speed than in what they want to be heard.
const FAST: f32 = 30.0;
const CURVE: f32 = 0.6;
/// Force of the softest pluck, of the hardest, and of a click, as parts of the hardest note's.
const SOFTEST: f32 = 0.06;
const HARDEST: f32 = 2.0;
const CLICK: f32 = 0.5;
/// The least time between two pictures that a speed is taken from, s.
const LEAST_TIME: f32 = 1.0 / 240.0;

/// What the mouse is doing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Doing {
    /// Nothing.
    #[default]
    Nothing,
    /// Plucks what it crosses; where it was, and the string that was plucked where it was pressed and that it is still on.
    Strumming { before: Pos2, plucked: Option<usize> },
    /// Is a finger on a string, at a place (m from the nut).
    Pressing { string: usize, place: f32 },
}

/// The string that the mouse holds a finger on which is to leave with it; clones are of the same mouse.
#[derive(Debug, Clone)]
pub(in crate::editor) struct Finger(Arc<AtomicU8>);

impl Finger {
    const NOWHERE: u8 = u8::MAX;

    fn put(&self, string: usize) {
        self.0.store(u8::try_from(string).unwrap_or(Self::NOWHERE), Ordering::Relaxed);
    }

    /// Takes it off: gives the string, but only once, whoever asks.
    pub fn take(&self) -> Option<u8> {
        Some(self.0.swap(Self::NOWHERE, Ordering::Relaxed)).filter(|string| *string != Self::NOWHERE)
    }
}

impl Default for Finger {
    fn default() -> Self {
        Self(Arc::new(AtomicU8::new(Self::NOWHERE)))
    }
}

/// What the view remembers of the mouse.
#[derive(Debug, Default)]
pub(super) struct Play {
    doing: Doing,
    /// Where the other button was while it silences.
    silencing: Option<Pos2>,
    finger: Finger,
}

impl Play {
    /// The mouse's finger.
    pub fn finger(&self) -> Finger {
        self.finger.clone()
    }

    /// Whether the mouse is playing.
    pub fn is_busy(&self) -> bool {
        self.doing != Doing::Nothing || self.silencing.is_some()
    }

    /// Takes what the mouse has done since the last picture. Gives back the string that it has begun to play, if it has.
    pub fn follow(
        &mut self,
        ui: &Ui,
        response: &Response,
        sight: &Sight,
        setup: &Setup,
        given: &Given,
    ) -> Option<usize> {
        let (pressed, held, shift, seconds) = ui.input(|input| {
            let pointer = &input.pointer;
            (pointer.primary_pressed(), pointer.primary_down(), input.modifiers.shift, input.stable_dt)
        });
        let at = response.interact_pointer_pos().or(response.hover_pos());
        // Whose a press was is forgotten when the mouse leaves the window.
        let at = at.or_else(|| ui.input(|input| input.pointer.latest_pos().filter(|_| self.is_busy())));
        // A tap that is over at the next picture is no press of anybody's any more.
        let is_own = response.is_pointer_button_down_on() || response.clicked_by(PointerButton::Primary);
        let mut begun = None;
        if pressed
            && is_own
            && let Some(at) = at
        {
            // Between two pictures it may have been let go of elsewhere.
            self.end(given);
            begun = self.begin(at, shift, sight, setup, given);
        } else if let Some(at) = at.filter(|_| held) {
            self.go_on(at, seconds, sight, setup, given);
        }
        if !held {
            self.end(given);
        }
        self.silence(ui, response, at, sight, setup, given);
        if let Some(at) = response.hover_pos() {
            hint::show(ui, at, sight, setup);
        }
        begun
    }

    /// The button goes down. Gives back the string that it is on, if on any.
    fn begin(&mut self, at: Pos2, shift: bool, sight: &Sight, setup: &Setup, given: &Given) -> Option<usize> {
        let string = sight.nearest(at.y);
        let place = sight.place(at.x);
        if !on_string(at, sight) {
            self.doing = Doing::Strumming { before: at, plucked: None };
            return None;
        }
        if over_board(place, setup) {
            // One that was left there goes with the mouse.
            self.doing = Doing::Pressing { string, place };
            if !shift {
                self.finger.put(string);
            }
            self.deed(given, string, StringDeed::Press { position: place });
        } else {
            self.doing = Doing::Strumming { before: at, plucked: Some(string) };
            self.pluck(given, string, place, CLICK);
        }
        Some(string)
    }

    fn go_on(&mut self, at: Pos2, seconds: f32, sight: &Sight, setup: &Setup, given: &Given) {
        match &mut self.doing {
            Doing::Nothing => {}
            Doing::Strumming { before, plucked } => {
                let from = std::mem::replace(before, at);
                let mut pressed = plucked.take();
                let speed = (at.y - from.y).abs() / sight.spacing / seconds.max(LEAST_TIME);
                let force = (speed / FAST).powf(CURVE).clamp(SOFTEST, HARDEST);
                for (string, x) in crossed(from, at, sight, setup.string.len()) {
                    // The press has plucked it already.
                    if pressed.take_if(|pressed| *pressed == string).is_none() {
                        self.pluck(given, string, sight.place(x), force);
                    }
                }
                // When it comes back from another place it is plucked again.
                let pressed = pressed.filter(|string| is_on(at, sight, *string));
                self.doing = Doing::Strumming { before: at, plucked: pressed };
            }
            Doing::Pressing { string, place } => {
                // The finger stays over the board.
                let end = setup.neck.board_end() as f32;
                let (string, new) = (*string, sight.place(at.x).max(0.0).min(end));
                if *place != new {
                    *place = new;
                    self.deed(given, string, StringDeed::Press { position: new });
                }
            }
        }
    }

    fn end(&mut self, given: &Given) {
        self.doing = Doing::Nothing;
        if let Some(string) = self.finger.take() {
            self.deed(given, string.into(), StringDeed::Lift);
        }
    }

    /// The other button silences at once, and while it is held all that it crosses.
    fn silence(
        &mut self,
        ui: &Ui,
        response: &Response,
        at: Option<Pos2>,
        sight: &Sight,
        setup: &Setup,
        given: &Given,
    ) {
        let button = PointerButton::Secondary;
        let (pressed, held) =
            ui.input(|input| (input.pointer.button_pressed(button), input.pointer.button_down(button)));
        let is_own = response.is_pointer_button_down_on() || response.clicked_by(button);
        let from = self.silencing.take();
        let Some(at) = at else { return };
        if pressed && is_own {
            self.deed(given, sight.nearest(at.y), StringDeed::Damp);
        } else if let Some(from) = from {
            for (string, _) in crossed(from, at, sight, setup.string.len()) {
                self.deed(given, string, StringDeed::Damp);
            }
        }
        self.silencing = Some(at).filter(|_| held && (from.is_some() || (pressed && is_own)));
    }

    /// Plucks with a part of the hardest note's force.
    fn pluck(&self, given: &Given, string: usize, position: f32, part: f32) {
        let Some(player) = given.plan.player() else { return };
        let force = part * player.pluck_force as f32;
        self.deed(given, string, StringDeed::Pluck { position, force });
    }

    fn deed(&self, given: &Given, string: usize, deed: StringDeed) {
        if let Ok(string) = u8::try_from(string) {
            given.pointer.play(PlayerEvent::Touched { string, deed });
        }
    }
}

/// Whether the mouse is on a string there.
pub(super) fn on_string(at: Pos2, sight: &Sight) -> bool {
    is_on(at, sight, sight.nearest(at.y))
}

fn is_on(at: Pos2, sight: &Sight, string: usize) -> bool {
    (at.y - sight.y(string)).abs() < ON_STRING * sight.spacing
}

/// The strings, of so many, that lie between two places, in the order in which they are crossed, and where each is.
fn crossed(from: Pos2, to: Pos2, sight: &Sight, count: usize) -> impl Iterator<Item = (usize, f32)> {
    let down = to.y > from.y;
    (0..count).map(move |step| if down { step } else { count - 1 - step }).filter_map(move |string| {
        let y = sight.y(string);
        let part = (y - from.y) / (to.y - from.y);
        ((from.y < y) != (to.y < y)).then_some((string, from.x + part * (to.x - from.x)))
    })
}

/// Whether a place (m from the nut) is over the board.
pub(super) fn over_board(place: f32, setup: &Setup) -> bool {
    (0.0..setup.neck.board_end() as f32).contains(&place)
}
