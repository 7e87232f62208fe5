//! What a luthier changes: the instrument, action, relief, frets, pickup and the tuning of the strings.

use egui::{Ui, text::LayoutJob, vec2};
use nice_plug::prelude::{Enum, Param};

use super::cells::Cells;
use crate::editor::compare::change;
use crate::editor::control::{choice, slider, titled_slider, unless_idle};
use crate::editor::{Given, theme};
use crate::params::{InstrumentChoice, idle};
use crate::plugin::shelf::NONE;

/// Draws the panel.
pub fn show(ui: &mut Ui, given: &Given) {
    let (instrument, setup) = (&given.params.instrument, &given.params.setup);
    let mut cells = Cells::new(ui.max_rect(), 6);
    cells.group(ui, "INSTRUMENT", 2);
    given.history.together(|| {
        let count = InstrumentChoice::variants().len();
        if choice(ui, given, &instrument.instrument, cells.next(), count).changed() {
            // A file takes its place, so that nothing would come of the choice.
            let none = instrument.file.preview_normalized(NONE as i32);
            change(given, &[(instrument.file.as_ptr(), none)], (NONE, None));
        }
    });
    given.history.together(|| {
        let count = 1 + given.params.shelf.count();
        let files = choice(ui, given, &instrument.file, cells.next(), count);
        if files.clicked() {
            given.params.shelf.look_again();
        }
        if files.changed() {
            // The one in the folder as it is now, also where the session keeps another under its number.
            let number = given.history.number();
            let value = instrument.file.preview_normalized(number as i32);
            change(given, &[(instrument.file.as_ptr(), value)], (number, None));
        }
    });
    let rest = cells.rest();
    if let Some(setup) = given.plan.setup() {
        let job =
            LayoutJob::simple(setup.description.clone(), theme::BODY_FONT, theme::SOFT_TEXT, rest.width());
        let galley = ui.painter().layout_job(job);
        // (No control, which would have room above its name.)
        ui.painter().galley(rest.min + vec2(0.0, theme::NEAR), galley, theme::SOFT_TEXT);
    }
    cells.group(ui, "NECK", 1);
    for param in [&setup.action, &setup.relief, &setup.fret_height] {
        slider(ui, given, param, cells.next());
    }
    cells.group(ui, "PICKUP", 1);
    let why_idle = |id: &str| given.plan.setup().and_then(|setup| idle::why(id, setup));
    let reason = why_idle("pickup_position");
    unless_idle(ui, cells.next(), reason, |ui, area| slider(ui, given, &setup.pickup_position, area));
    slider(ui, given, &setup.pickup_blend, cells.next());
    cells.group(ui, "OPEN STRINGS", 2);
    let strings = given.plan.setup().map_or(&[][..], |setup| &setup.string);
    for (index, string) in given.params.strings.iter().enumerate() {
        let sounding = strings.get(index);
        let title = sounding.map(|sounding| format!("String {}: {}", index + 1, sounding.name));
        let reason = why_idle(&format!("{}{}", idle::STRING_TUNING, index + 1));
        unless_idle(ui, cells.next(), reason, |ui, area| match &title {
            Some(title) => titled_slider(ui, given, &string.tuning, area, title),
            None => slider(ui, given, &string.tuning, area),
        });
    }
}
