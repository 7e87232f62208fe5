//! How it is computed: quality, iterations, energy, tension, contacts, fingers, load.

use egui::{Align2, Rect, Ui, pos2, vec2};
use low_action_dsp::Setup;
use nice_plug::prelude::Enum;

use super::bar;
use super::cells::Cells;
use crate::display::{Health, StringSeen};
use crate::editor::Given;
use crate::editor::control::{NAME, choice, slider, switch};
use crate::editor::theme::{self, GAP};
use crate::params::{QualityChoice, RenderChoice};

/// What the panel remembers: numbers as they are shown, which follow slowly enough to be read.
#[derive(Debug, Default)]
pub struct Engine {
    load: f32,
    strings: Vec<[f32; COLUMNS.len()]>,
}

/// What is shown of each string.
const COLUMNS: [(&str, &str); 5] = [
    ("ITERATIONS", "Newton iterations of a step: how hard its contacts are to solve."),
    ("ENERGY", "Energy of its motion and stretching, without that of bending."),
    ("TENSION", "Tension now; the bar is what bends and stretching add to it, full at 5 %."),
    ("CONTACTS", "Frets and places of the board that it touches now."),
    ("FINGERS", "Force of the fingers on it."),
];
/// Iterations, contacts and newtons of fingers that fill a bar.
const FULL: [f32; 3] = [10.0, 24.0, 20.0];
/// Energies at the ends of its bar, J: from what is not heard any more to the hardest pluck.
const ENERGIES: [f32; 2] = [1e-9, 1e-1];
/// What fills a bar more than the tension at rest, as a part of it.
const STRETCH: f32 = 0.05;
/// Time in which a shown number comes near the true one, s.
const SLOW: f32 = 0.15;

impl Engine {
    /// Draws the panel.
    pub fn show(&mut self, ui: &mut Ui, given: &Given) {
        let instrument = &given.params.instrument;
        let mut cells = Cells::new(ui.max_rect(), 4);
        cells.group(ui, "HOW EXACTLY", 1);
        choice(ui, given, &instrument.quality, cells.next(), QualityChoice::variants().len());
        choice(ui, given, &instrument.render_quality, cells.next(), RenderChoice::variants().len());
        slider(ui, given, &instrument.iterations, cells.next());
        let last = cells.next();
        let half = 0.5 * (last.width() - GAP);
        switch(ui, given, &instrument.relax, last.with_max_x(last.left() + half));
        self.follow(ui, given);
        self.show_load(ui, last.with_min_x(last.right() - half));
        cells.group(ui, "", 3);
        if let Some(setup) = given.plan.setup() {
            self.show_strings(ui, cells.rest(), setup, given.snapshot.strings());
        }
    }

    /// Follows the latest snapshot.
    fn follow(&mut self, ui: &Ui, given: &Given) {
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        let part = 1.0 - (-seconds / SLOW).exp();
        self.load += part * (given.meters.load() - self.load);
        let strings = given.snapshot.strings();
        if self.strings.len() != strings.len() {
            self.strings = strings.iter().map(numbers).collect();
        }
        for (shown, seen) in self.strings.iter_mut().zip(strings) {
            for (shown, now) in shown.iter_mut().zip(numbers(seen)) {
                *shown += part * (now - *shown);
            }
        }
    }

    fn show_load(&self, ui: &mut Ui, area: Rect) {
        let response = ui.interact(area, ui.scope_id().with("load"), egui::Sense::hover());
        response.on_hover_text("How much of the time there is goes into the sound");
        let name = pos2(area.left(), area.top() + 0.5 * NAME);
        ui.painter().text(name, Align2::LEFT_CENTER, "CPU", theme::SMALL, theme::SOFT_TEXT);
        let colour = if f64::from(self.load) > Health::LATE { theme::ALARM } else { theme::CALM };
        let row = area.with_min_y(area.top() + NAME);
        bar::paint(ui, row, self.load, &format!("{:.0} %", 100.0 * self.load), colour);
    }

    /// A row for each string, under the names of the columns.
    fn show_strings(&self, ui: &mut Ui, area: Rect, setup: &Setup, strings: &[StringSeen]) {
        let row = bar::row_height(area, setup.string.len());
        let left = area.left() + bar::LEFT;
        let width = ((area.right() - left + GAP) / COLUMNS.len() as f32 - GAP).max(8.0);
        for (column, (name, hint)) in COLUMNS.into_iter().enumerate() {
            let from = left + column as f32 * (width + GAP);
            let title = Rect::from_min_max(pos2(from, area.top() - 16.0), pos2(from + width, area.bottom()));
            let place = title.left_top();
            ui.painter().text(place, Align2::LEFT_TOP, name, theme::SMALL, theme::ACCENT);
            ui.interact(title, ui.scope_id().with(name), egui::Sense::hover()).on_hover_text(hint);
        }
        for (index, string) in setup.string.iter().enumerate() {
            let middle = area.top() + (index as f32 + 0.5) * row;
            bar::paint_name(ui, pos2(area.left(), middle), (row, index), &string.name);
            let Some((shown, seen)) = self.strings.get(index).zip(strings.get(index)) else { continue };
            for (column, (part, number, colour)) in bars(shown, seen.rest_tension).into_iter().enumerate() {
                let from = pos2(left + column as f32 * (width + GAP), middle - 0.5 * row);
                bar::paint(ui, Rect::from_min_size(from, vec2(width, row)), part, &number, colour);
            }
        }
    }
}

/// What is shown of a string, in the order of the columns.
fn numbers(seen: &StringSeen) -> [f32; COLUMNS.len()] {
    let fingers = seen.fingers.iter().flatten().map(|finger| finger.force).sum();
    [seen.iterations, seen.energy, seen.tension, seen.contacts as f32, fingers]
}

/// The same as bars: how full, what is read, which colour.
fn bars(shown: &[f32; COLUMNS.len()], rest: f32) -> [(f32, String, egui::Color32); COLUMNS.len()] {
    let [iterations, energy, tension, contacts, fingers] = *shown;
    let heard = (energy.max(ENERGIES[0]) / ENERGIES[0]).ln() / (ENERGIES[1] / ENERGIES[0]).ln();
    [
        (tenths(iterations) / FULL[0], format!("{iterations:.1}"), theme::ACCENT),
        (heard, joules(energy), theme::PLUCK),
        ((tension / rest.max(1e-3) - 1.0) / STRETCH, format!("{tension:.1} N"), theme::STEEL),
        (tenths(contacts) / FULL[1], format!("{contacts:.1}"), theme::FLASH),
        (tenths(fingers) / FULL[2], format!("{fingers:.1} N"), theme::FINGER),
    ]
}

/// As much as is read of a number: no bar stands beside a 0.
fn tenths(number: f32) -> f32 {
    0.1 * (10.0 * number).round()
}

/// An energy in the unit that suits it.
fn joules(energy: f32) -> String {
    match energy {
        ..1e-9 => "0".into(),
        ..1e-6 => format!("{:.0} nJ", 1e9 * energy),
        ..1e-3 => format!("{:.1} µJ", 1e6 * energy),
        _ => format!("{:.1} mJ", 1e3 * energy),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_bar_stands_beside_a_0() {
        for number in [0.0, 1e-3, 0.049, 0.051, 0.2, 0.5, 1.0, 7.3] {
            let bars = bars(&[number, 0.0, 60.0, number, number], 60.0);
            for (part, shown, _) in bars {
                assert_eq!(
                    part > 0.0,
                    shown.contains(|digit: char| ('1'..='9').contains(&digit)) && shown != "60.0 N",
                    "{shown}"
                );
            }
        }
    }
}
