//! What becomes of the sound: level, tuning, losses, and how long the strings ring with them.

use egui::{Align2, Rect, Ui, pos2, vec2};
use low_action_dsp::Setup;

use super::cells::Cells;
use crate::editor::control::{slider, switch, unless_idle};
use crate::editor::theme::{self, GAP};
use crate::editor::{Given, panels::bar};
use crate::params::idle;

/// Times longer than this fill their bar, s.
const LONGEST: f64 = 40.0;
/// The partials whose times are shown.
const PARTIALS: [u32; 2] = [1, 10];

/// Draws the panel.
pub fn show(ui: &mut Ui, given: &Given) {
    let (setup, output) = (&given.params.setup, &given.params.output);
    let mut cells = Cells::new(ui.max_rect(), 6);
    cells.group(ui, "OUTPUT", 1);
    slider(ui, given, &output.level, cells.next());
    switch(ui, given, &output.bypass, cells.next());
    cells.group(ui, "PITCH", 1);
    slider(ui, given, &setup.tuning, cells.next());
    slider(ui, given, &given.params.control.tremolo_arm, cells.next());
    switch(ui, given, &setup.tension_modulation, cells.next());
    cells.group(ui, "LOSSES", 1);
    slider(ui, given, &setup.loss_0, cells.next());
    slider(ui, given, &setup.loss_1, cells.next());
    let reason = given.plan.setup().and_then(|setup| idle::why("idle_hands", setup));
    let idle_hands = &given.params.player.idle_hands;
    unless_idle(ui, cells.next(), reason, |ui, area| slider(ui, given, idle_hands, area));
    cells.group(ui, "HOW LONG OPEN STRINGS RING", 3);
    if let Some(setup) = given.plan.setup() {
        show_times(ui, cells.rest(), setup);
    }
}

/// Time in which a partial of an open string falls by 60 dB, s: infinite where it loses nothing.
fn ringing_time(setup: &Setup, string: usize, partial: u32) -> f64 {
    1000_f64.ln() / setup.decay(string, f64::from(partial))
}

/// A time as it is written beside its bar.
fn in_words(seconds: f64) -> String {
    if seconds.is_finite() { format!("{seconds:.1} s") } else { "endless".into() }
}

/// A row for each string: its first and its tenth partial.
fn show_times(ui: &mut Ui, area: Rect, setup: &Setup) {
    let response = ui.interact(area, ui.scope_id().with("times"), egui::Sense::hover());
    response
        .on_hover_text("The time in which an open string falls by 60 dB, its lowest partial and its tenth");
    let row = bar::row_height(area, setup.string.len());
    let width = (0.5 * (area.width() - bar::LEFT - GAP)).max(8.0);
    for (index, string) in setup.string.iter().enumerate() {
        let middle = area.top() + (index as f32 + 0.5) * row;
        bar::paint_name(ui, pos2(area.left(), middle), (row, index), &string.name);
        for (column, partial) in PARTIALS.into_iter().enumerate() {
            let time = ringing_time(setup, index, partial);
            let left = area.left() + bar::LEFT + column as f32 * (width + GAP);
            let place = Rect::from_min_size(pos2(left, middle - 0.5 * row), vec2(width, row));
            bar::paint(ui, place, (time / LONGEST).sqrt() as f32, &in_words(time), theme::CALM);
        }
    }
    for (column, partial) in PARTIALS.into_iter().enumerate() {
        let left = area.left() + bar::LEFT + column as f32 * (width + GAP);
        let text = if partial == 1 { "fundamental".to_owned() } else { format!("partial {partial}") };
        let place = pos2(left + width, area.top() - theme::TIGHT);
        ui.painter().text(place, Align2::RIGHT_BOTTOM, text, theme::SMALL, theme::SOFT_TEXT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_loses_nothing_rings_endlessly() {
        let mut setup = Setup::builtin("electric").expect("it is built in");
        assert_eq!(in_words(ringing_time(&setup, 0, 1)), "8.8 s");
        (setup.string[0].loss_0, setup.string[0].loss_1) = (0.0, 0.0);
        assert_eq!(in_words(ringing_time(&setup, 0, 10)), "endless");
        // As long as a time that fills its bar, or longer.
        assert_eq!(ringing_time(&setup, 0, 1) / LONGEST, f64::INFINITY);
    }
}
