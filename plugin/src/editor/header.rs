//! The top of the window: what is played, what is wrong, how loud it is.

use egui::{Align2, Rect, Ui, pos2, vec2};

use super::Given;
use super::theme::{self, GAP, NEAR};

/// What the header remembers.
#[derive(Debug)]
pub struct Header {
    /// Levels as they are shown: they fall slowly.
    levels: [f32; 2],
}

/// Lowest level shown, dB under full scale.
const FLOOR: f32 = -60.0;
/// How fast the meter falls, dB a second.
const FALL: f32 = 24.0;

impl Default for Header {
    fn default() -> Self {
        Self { levels: [FLOOR; 2] }
    }
}

impl Header {
    /// Draws it.
    pub fn show(&mut self, ui: &mut Ui, given: &Given) {
        let area = ui.max_rect();
        let middle = area.center().y;
        let painter = ui.painter();
        let title = painter.text(
            pos2(area.left(), middle),
            Align2::LEFT_CENTER,
            "Low Action",
            theme::HEADING,
            theme::TEXT,
        );
        let name = given.params.instrument.instrument.to_string();
        let name = painter.text(
            pos2(title.right() + GAP, middle + 1.0),
            Align2::LEFT_CENTER,
            name,
            theme::BODY_FONT,
            theme::SOFT_TEXT,
        );
        let meter = Rect::from_min_size(pos2(area.right() - 160.0, middle - 6.0), vec2(160.0, 12.0));
        self.show_meter(ui, given, meter);
        let left = name.right() + GAP;
        let between = Rect::from_min_max(pos2(left, area.top()), pos2(meter.left() - GAP, area.bottom()));
        show_lights(ui, given, between);
    }

    /// Both channels, one over the other.
    fn show_meter(&mut self, ui: &Ui, given: &Given, area: Rect) {
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        let painter = ui.painter();
        for (row, (level, peak)) in self.levels.iter_mut().zip(given.meters.take_peaks()).enumerate() {
            let now = 20.0 * peak.max(1e-6).log10();
            *level = now.max(*level - FALL * seconds).max(FLOOR);
            let height = (area.height() - 2.0) / 2.0;
            let top = area.top() + row as f32 * (height + 2.0);
            let bar = Rect::from_min_size(pos2(area.left(), top), vec2(area.width(), height));
            painter.rect_filled(bar, 1.0, theme::RAISED);
            let part = 1.0 - *level / FLOOR;
            let colour = if *level > -0.1 { theme::ALARM } else { theme::CALM };
            painter.rect_filled(bar.with_max_x(bar.left() + part * bar.width()), 1.0, colour);
            if *level > FLOOR {
                ui.ctx().request_repaint();
            }
        }
    }
}

/// What a player should know of: too little time, a file that is missing. As much as fits is read, and all of it under
/// the mouse.
fn show_lights(ui: &mut Ui, given: &Given, area: Rect) {
    let mut rest = area;
    let mut say = |text: &str| {
        let label = egui::Label::new(egui::RichText::new(text).color(theme::ALARM)).truncate();
        let galley = ui.painter().layout_no_wrap(text.to_owned(), theme::BODY_FONT, theme::ALARM);
        let width = galley.size().x.min(rest.width() - GAP);
        if width < GAP {
            return;
        }
        let place = Rect::from_min_max(pos2(rest.right() - width, rest.top()), rest.max);
        ui.painter().circle_filled(pos2(place.left() - NEAR, place.center().y), 4.0, theme::ALARM);
        ui.put(place, label).on_hover_text(text);
        rest.max.x = place.left() - GAP - NEAR;
    };
    if given.meters.relaxed() {
        say("Over budget: contacts are solved less exactly");
    }
    if let Some(message) = given.params.shelf.message() {
        say(&message);
    }
}
