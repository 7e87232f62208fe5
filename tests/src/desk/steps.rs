//! What is done to controls, and taken back.

use egui::{Event, Key, Modifiers};

use super::Desk;

impl Desk {
    /// Types a value into the control of a parameter.
    pub fn enter(&mut self, tab: &str, name: &str, value: &str) {
        self.open(tab);
        let place = self.control(&format!("Type {name}")).expect("it has a number");
        self.click(place);
        self.wait(0.05);
        self.harness.event(Event::Text(value.into()));
        self.key(Key::Enter);
        self.wait(0.5);
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        self.wait(0.05);
    }

    /// Takes the last step that was taken back once more.
    pub fn redo(&mut self) {
        self.harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
        self.wait(0.05);
    }

    /// The action, as a multiple of the instrument's own, to the step of its parameter.
    pub fn action(&self) -> f32 {
        (100.0 * self.params.setup.action.value()).round() / 100.0
    }
}
