//! What a luthier changes: the instrument, action, relief, frets, pickup and the tuning of the strings.

use egui::{Ui, text::LayoutJob};
use nice_plug::prelude::Enum;

use super::cells::Cells;
use crate::editor::control::{choice, slider};
use crate::editor::{Given, theme};
use crate::params::InstrumentChoice;

/// Draws the panel.
pub fn show(ui: &mut Ui, given: &Given) {
    let (instrument, setup) = (&given.params.instrument, &given.params.setup);
    let mut cells = Cells::new(ui.max_rect(), 6);
    cells.group(ui, "INSTRUMENT", 2);
    choice(ui, given, &instrument.instrument, cells.next(), InstrumentChoice::variants().len());
    choice(ui, given, &instrument.file, cells.next(), 1 + given.params.shelf.count());
    let rest = cells.rest();
    if let Some(setup) = given.plan.setup() {
        let job =
            LayoutJob::simple(setup.description.clone(), theme::BODY_FONT, theme::SOFT_TEXT, rest.width());
        let galley = ui.painter().layout_job(job);
        ui.painter().galley(rest.min, galley, theme::SOFT_TEXT);
    }
    cells.group(ui, "NECK", 1);
    for param in [&setup.action, &setup.relief, &setup.fret_height] {
        slider(ui, given, param, cells.next());
    }
    cells.group(ui, "PICKUP", 1);
    for param in [&setup.pickup_position, &setup.pickup_blend] {
        slider(ui, given, param, cells.next());
    }
    cells.group(ui, "OPEN STRINGS", 2);
    for string in &given.params.strings {
        slider(ui, given, &string.tuning, cells.next());
    }
}
