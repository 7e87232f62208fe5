//! Instruments to choose from, those that come with the program and the user's own, and saving one under a name.
//!
//! Choosing one brings it as its maker left it: what the panels change of neck, strings, pickup and hands goes back to
//! its usual values. Saving makes those changes part of the file that is written. Both are one entry of the history.

use egui::{Button, Popup, ScrollArea, TextEdit, Ui, vec2};
use low_action_dsp::Setup;
use nice_plug::prelude::{Enum, Param, Params};

use super::Given;
use super::compare::{Values, change};
use super::control::line;
use super::notes::name_by_sound;
use super::theme::{self, NEAR};
use crate::params::{InstrumentChoice, LowActionParams};
use crate::plugin::order::settled;
use crate::setups::{self, SHIPPED};

/// Width of the name, where there is room and where there is little, and of the list, points.
const WIDTH: f32 = 176.0;
const NARROWEST: f32 = 48.0;
const LIST: f32 = 280.0;
/// Width of the buttons beside the name, points.
const BESIDE: f32 = 94.0;
/// Highest that the list is, points; what is longer scrolls.
const HIGHEST: f32 = 400.0;

/// What the choice of instruments remembers.
#[derive(Debug, Default)]
pub struct Presets {
    /// The name that is being typed.
    name: String,
    /// Whether it is only now being asked for.
    asking: bool,
    /// Why nothing was saved under it, if so.
    problem: Option<String>,
}

impl Presets {
    /// Shows what is played, what is beside it in the list, the list itself and the way to save, in a row of so many
    /// points.
    pub fn show(&mut self, ui: &mut Ui, given: &Given, room: f32) {
        let (chosen, count) = (chosen(given), SHIPPED.len() + given.params.shelf.count());
        if ui.button("‹").on_hover_text("The instrument before").clicked() {
            choose(given, chosen.map_or(0, |index| (index + count - 1) % count));
        }
        let mut title = title(given, chosen);
        if is_changed(given) {
            title += " *";
        }
        let width = (room - BESIDE).clamp(NARROWEST, WIDTH);
        let size = vec2(width, ui.spacing().interact_size.y);
        let button = ui.add_sized(size, Button::new(title.as_str()).truncate());
        let button = button.on_hover_text("Instruments: those of the program and your own");
        if button.clicked() {
            given.params.shelf.look_again();
        }
        Popup::menu(&button).width(LIST).show(|ui| {
            ScrollArea::vertical().max_height(HIGHEST).show(ui, |ui| list(ui, given, chosen));
        });
        if ui.button("›").on_hover_text("The next instrument").clicked() {
            choose(given, chosen.map_or(0, |index| (index + 1) % count));
        }
        let save =
            ui.button("Save").on_hover_text("Save this instrument, with all that was changed, under a name");
        let was_refused =
            self.problem.is_some() && Popup::is_id_open(ui.ctx(), Popup::default_response_id(&save));
        if save.clicked() && !was_refused {
            let (number, shelf) = (number(given), &given.params.shelf);
            // A file in whose place another is played would be lost by it, unasked.
            self.name = shelf.name(number).filter(|_| shelf.plays(number)).unwrap_or_default();
            self.problem = None;
        }
        Popup::menu(&save)
            .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside)
            .show(|ui| self.ask(ui, given));
        if save.clicked() {
            self.asking = true;
            if was_refused {
                // What was typed is there to be put right.
                Popup::open_id(ui.ctx(), Popup::default_response_id(&save));
            }
        }
    }

    /// Asks for a name.
    fn ask(&mut self, ui: &mut Ui, given: &Given) {
        ui.set_min_width(LIST);
        let label = ui.label("Name of the instrument").id;
        let field = TextEdit::singleline(&mut self.name).desired_width(LIST).char_limit(setups::LONGEST_NAME);
        let field = ui.add(field).labelled_by(label);
        let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if std::mem::take(&mut self.asking) {
            field.request_focus();
        }
        let replaces = is_taken(given, self.name.trim());
        let button = Button::new(if replaces { "Replace" } else { "Save it" }).fill(theme::RAISED);
        let pressed = ui.add(button).clicked();
        if pressed || entered {
            self.problem = save(given, self.name.trim()).err();
            if self.problem.is_none() {
                ui.close();
            }
            self.asking = self.problem.is_some();
        }
        if let Some(problem) = &self.problem {
            ui.set_max_width(LIST);
            ui.colored_label(theme::ALARM, problem);
        }
        if let Some(folder) = setups::folder() {
            ui.colored_label(theme::SOFT_TEXT, format!("in {}", folder.display()));
        }
    }
}

/// Everything there is, to be chosen from.
fn list(ui: &mut Ui, given: &Given, chosen: Option<usize>) {
    let line = |ui: &mut Ui, index: usize, title: &str| {
        let response = line(ui, chosen == Some(index), title, LIST);
        if response.clicked() {
            choose(given, index);
            ui.close();
        }
        response
    };
    let heading = |ui: &mut Ui, text: &str, colour| {
        ui.horizontal(|ui| {
            ui.add_space(NEAR);
            ui.colored_label(colour, text);
        });
    };
    heading(ui, "With the program", theme::ACCENT);
    for (index, title) in InstrumentChoice::variants().iter().enumerate() {
        line(ui, index, title).on_hover_ui(|ui| {
            ui.label(Setup::shipped(SHIPPED[index]).map(|setup| setup.description).unwrap_or_default());
        });
    }
    heading(ui, "Your own", theme::ACCENT);
    let names = given.params.shelf.names();
    for (index, name) in names.iter().enumerate() {
        line(ui, SHIPPED.len() + index, name);
    }
    if names.is_empty() {
        heading(ui, "none yet: Save makes one", theme::SOFT_TEXT);
    }
}

/// The number of the user's file that is played, 0 for none.
fn number(given: &Given) -> u32 {
    given.history.number()
}

/// Where in the list what is played stands, if it does: a session's own file by its name, as the folder may have another
/// under its number.
fn chosen(given: &Given) -> Option<usize> {
    let (number, shelf) = (number(given), &given.params.shelf);
    if number == 0 {
        return Some(given.plain(&given.params.instrument.instrument).to_index());
    }
    let name = shelf.name(number)?;
    Some(SHIPPED.len() + shelf.names().iter().position(|listed| *listed == name)?)
}

fn title(given: &Given, chosen: Option<usize>) -> String {
    match chosen {
        Some(index) if index < SHIPPED.len() => InstrumentChoice::variants()[index].to_owned(),
        _ => given.params.shelf.name(number(given)).unwrap_or_else(|| "no such file".into()),
    }
}

/// Plays one of the list as its maker left it.
fn choose(given: &Given, index: usize) {
    let instrument = &given.params.instrument;
    let mut values = usual(given.params);
    let file = match index.checked_sub(SHIPPED.len()) {
        None => {
            let choice = instrument.instrument.preview_normalized(InstrumentChoice::from_index(index));
            values.push((instrument.instrument.as_ptr(), choice));
            0
        }
        Some(file) => file as i32 + 1,
    };
    values.push((instrument.file.as_ptr(), instrument.file.preview_normalized(file)));
    // The one in the folder, whatever the session keeps under its number.
    change(given, &values, (file.unsigned_abs(), None));
}

/// Whether something of the user's has this name: a file that was there in the beginning, or one that somebody else has
/// put there since.
fn is_taken(given: &Given, name: &str) -> bool {
    given.params.shelf.names().iter().any(|known| setups::is_same_name(known, name))
        || setups::folder().is_some_and(|folder| setups::place(name, &folder).exists())
}

/// Writes what is played, with all that was changed, to the user's folder, and plays that.
fn save(given: &Given, name: &str) -> Result<(), String> {
    let own = given.plan.own().ok_or("there is nothing to save yet")?;
    let folder = setups::folder().ok_or("this system has no folder for a user's data")?;
    let mut setup = Setup { name: name.into(), ..settled(given.params, own) };
    name_by_sound(&mut setup, own);
    let file = setups::save(&setup, &folder).map_err(|error| format!("{error:#}"))?;
    let text = setups::read(&file.path).map_err(|error| format!("{error:#}"))?;
    let kept = given.params.shelf.add(file, text)?;
    let number = kept.number();
    let param = &given.params.instrument.file;
    let mut values = usual(given.params);
    values.push((param.as_ptr(), param.preview_normalized(number as i32)));
    change(given, &values, (number, Some(kept)));
    Ok(())
}

/// What there is of the player that no [`Setup`] keeps: how strokes follow velocity and differ from one another.
const NOT_KEPT: [&str; 4] = ["pluck_softest", "velocity_curve", "variation", "take"];

/// What an instrument's own values are changed by, all at their usual values: what [`Setup`] keeps of them.
fn usual(params: &LowActionParams) -> Values {
    let of_setups = |group: &str| ["Set-up", "Player"].contains(&group) || group.starts_with("Strings");
    let kept = params
        .param_map()
        .into_iter()
        .filter(|(id, _, group)| of_setups(group) && !NOT_KEPT.contains(&id.as_str()));
    // SAFETY: the pointers lead into the parameters, which outlive this.
    kept.map(|(_, param, _)| (param, unsafe { param.default_normalized_value() })).collect()
}

/// Whether anything is changed of the instrument that was chosen.
fn is_changed(given: &Given) -> bool {
    let asked = &given.history.asked;
    // What hosts round is the same again as a plain value.
    // SAFETY: the pointers lead into the parameters, which outlive this.
    usual(given.params)
        .iter()
        .any(|(param, _)| unsafe { param.preview_plain(asked.value(*param)) != param.default_plain_value() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Start;
    use crate::plugin::shelf::Shelf;

    /// What saving writes of a parameter is what choosing another instrument puts back, and nothing else is.
    #[test]
    fn what_goes_back_is_what_a_set_up_keeps() {
        let params = LowActionParams::new(Shelf::new(Vec::new()), &Start::default());
        // A coil, a body, and a string for each that can be tuned.
        let mut owns = ["electric", "steel"].map(|name| Setup::builtin(name).expect("it is built in"));
        for own in &mut owns {
            own.string.resize(params.strings.len(), own.string[0].clone());
        }
        let as_they_come = owns.clone().map(|own| settled(&params, &own));
        let put_back: Vec<_> = usual(&params).into_iter().map(|(param, _)| param).collect();
        for (id, param, _) in params.param_map() {
            // SAFETY: the pointer leads into the parameters, which outlive this.
            let mut is_kept_at = |value: f32| unsafe {
                let usual = param.default_normalized_value();
                param._internal_set_normalized_value(value);
                let kept = owns.iter().zip(&as_they_come).any(|(own, was)| settled(&params, own) != *was);
                param._internal_set_normalized_value(usual);
                kept
            };
            let is_kept = [0.0, 0.7, 1.0].into_iter().any(&mut is_kept_at);
            assert_eq!(put_back.contains(&param), is_kept, "{id}");
        }
    }
}
