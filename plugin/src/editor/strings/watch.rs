//! Which string the side view shows: the one that was played last, or over which the mouse has rested.
//!
//! Only passed over none is taken: the way from any of them down to the side view leads over all that lie below it.

use std::time::Duration;

use egui::Ui;

/// How long the mouse rests on a string before it is shown, s.
const REST: f64 = 0.25;

/// The string that the side view shows, and the one that it may show next.
#[derive(Debug, Default)]
pub(super) struct Watch {
    /// The one that is shown.
    pub string: usize,
    /// The one that the mouse is over, and since when, s.
    over: Option<(usize, f64)>,
}

impl Watch {
    /// Takes the string that the mouse is over at this picture, and the one that it has begun to play.
    pub fn follow(&mut self, ui: &Ui, over: Option<usize>, begun: Option<usize>) {
        let now = ui.input(|input| input.time);
        if let Some(string) = begun {
            self.string = string;
        }
        let Some(string) = over else {
            self.over = None;
            return;
        };
        let since = self.over.filter(|(before, _)| *before == string).map_or(now, |(_, since)| since);
        self.over = Some((string, since));
        if now - since >= REST {
            self.string = string;
        } else {
            // A mouse that rests asks for no picture.
            ui.ctx().request_repaint_after(Duration::from_secs_f64(REST - (now - since)));
        }
    }
}
