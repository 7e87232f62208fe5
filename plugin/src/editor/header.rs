//! The top of the window: what is played, what can be compared and undone, what is wrong, how loud it is.

mod lights;

use egui::containers::menu::menu_style;
use egui::{
    Align, Align2, Button, Frame, Label, Layout, Popup, PopupCloseBehavior, Rect, RichText, Role, Sense,
    Style, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use super::Given;
use super::compare;
use super::presets::Presets;
use super::shortcuts::COMMAND;
use super::theme::{self, GAP, NEAR, TIGHT};

/// What the header remembers.
#[derive(Debug)]
pub struct Header {
    /// Levels as they are shown: they fall slowly.
    levels: [f32; 2],
    /// The highest since somebody has said that they have seen it.
    highest: [f32; 2],
    presets: Presets,
}

/// Widest that the meter is, points.
const METER: f32 = 160.0;
/// Height of the buttons, points.
const BUTTON: f32 = 24.0;
/// Room that A and B, undo and redo need beside the instrument, points; where there is less they are in a menu.
const FOR_COMPARING: f32 = 560.0;
/// Width of the button that opens it, and the least one of the menu, points.
const MORE: f32 = 28.0;
const MENU: f32 = 96.0;
/// Widest that a message in it is, points.
const MESSAGE: f32 = 200.0;
/// Width that the header must have for the program's name to be in it, points.
const FOR_TITLE: f32 = 440.0;
/// Lowest level shown, dB under full scale.
const FLOOR: f32 = -60.0;
/// Width of the end that says that full scale was reached, points.
const CLIPPED: f32 = 4.0;
/// Size of the number of the highest level, points.
const HIGHEST: egui::Vec2 = vec2(48.0, 14.0);
/// How fast the meter falls, dB a second.
const FALL: f32 = 24.0;

impl Default for Header {
    fn default() -> Self {
        Self { levels: [FLOOR; 2], highest: [FLOOR; 2], presets: Presets::default() }
    }
}

impl Header {
    /// Draws it.
    pub fn show(&mut self, ui: &mut Ui, given: &Given) {
        let area = ui.max_rect();
        let middle = area.center().y;
        let mut left = area.left();
        if area.width() >= FOR_TITLE {
            let (place, align) = (pos2(left, middle), Align2::LEFT_CENTER);
            let title = ui.painter().text(place, align, "Low Action", theme::HEADING, theme::TEXT);
            left = title.right() + GAP;
        }
        let width = METER.min(0.2 * area.width());
        let meter = Rect::from_min_size(pos2(area.right() - width, middle - 6.0), vec2(width, 12.0));
        self.show_meter(ui, given, meter);
        let row = Rect::from_min_max(pos2(left, area.top()), pos2(meter.left() - GAP, area.bottom()));
        let messages = Self::messages(given);
        let builder = UiBuilder::new().max_rect(row).layout(Layout::left_to_right(Align::Center));
        let taken = ui.scope_builder(builder, |ui| {
            ui.spacing_mut().item_spacing.x = TIGHT;
            ui.spacing_mut().interact_size.y = BUTTON;
            if row.width() > FOR_COMPARING {
                self.presets.show(ui, given, row.width());
                ui.add_space(NEAR);
                show_compare(ui, given);
                ui.add_space(NEAR);
                show_history(ui, given);
                None
            } else {
                self.presets.show(ui, given, row.width() - TIGHT - MORE);
                Some(show_more(ui, given, &messages))
            }
        });
        let rest = row.with_min_x(taken.response.rect.right() + GAP);
        lights::show(ui, &messages, rest, taken.inner);
    }

    /// Has the meter begin at its lowest.
    pub fn rest(&mut self) {
        self.levels = [FLOOR; 2];
        self.highest = [FLOOR; 2];
    }

    /// What a player should know of: too little time, a file that is missing.
    fn messages(given: &Given) -> Vec<String> {
        let late = match () {
            () if given.meters.relaxed() => Some("Over budget: contacts are solved less exactly"),
            () if given.meters.load() > 1.0 => Some("Over budget: the sound breaks up"),
            () => None,
        };
        [late.map(str::to_owned), given.params.shelf.message()].into_iter().flatten().collect()
    }

    /// Both channels, one over the other.
    fn show_meter(&mut self, ui: &mut Ui, given: &Given, area: Rect) {
        // Not to be reached by Tab: there is nothing to set.
        let response = ui.interact(area.expand(TIGHT), ui.scope_id().with("meter"), Sense::CLICK);
        if response.clicked() {
            self.highest = [FLOOR; 2];
        }
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        let painter = ui.painter();
        let rows = self.levels.iter_mut().zip(&mut self.highest).zip(given.meters.take_peaks());
        for (row, ((level, highest), peak)) in rows.enumerate() {
            let now = 20.0 * peak.max(1e-6).log10();
            *level = now.max(*level - FALL * seconds).max(FLOOR);
            *highest = now.max(*highest);
            let height = (area.height() - 2.0) / 2.0;
            let top = area.top() + row as f32 * (height + 2.0);
            let bar = Rect::from_min_size(pos2(area.left(), top), vec2(area.width(), height));
            painter.rect_filled(bar, 1.0, theme::RAISED);
            let part = 1.0 - *level / FLOOR;
            let colour = if *level >= 0.0 { theme::ALARM } else { theme::CALM };
            painter.rect_filled(bar.with_max_x(bar.left() + part * bar.width()), 1.0, colour);
            if *highest >= 0.0 {
                painter.rect_filled(bar.with_min_x(bar.right() - CLIPPED), 1.0, theme::ALARM);
            }
            if *level > FLOOR {
                ui.ctx().request_repaint();
            }
        }
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::Meter, true, "Meter");
            let loudest = self.levels[0].max(self.levels[1]);
            info.current_text_value = Some(format!("{loudest:.1} dB"));
            info
        });
        let highest = self.highest[0].max(self.highest[1]);
        show_highest(ui, highest, area);
        response.on_hover_text(format!(
            "Level of both channels, from 60 dB below full scale; red at full scale, and the end stays so. Highest so far: \
             {highest:.1} dB. A click begins anew"
        ));
    }
}

/// The highest level under the right end of the meter, once there was one.
fn show_highest(ui: &mut Ui, highest: f32, meter: Rect) {
    if highest <= FLOOR {
        return;
    }
    let colour = if highest >= 0.0 { theme::ALARM } else { theme::SOFT_TEXT };
    let text = RichText::new(format!("{highest:.1} dB")).font(theme::SMALL).color(colour);
    let corner = pos2(meter.right() - HIGHEST.x, meter.bottom() + 2.0);
    ui.put(Rect::from_min_size(corner, HIGHEST), Label::new(text));
}

/// A button, and behind it what has no room beside it; it stays open, since one compares more than once. Gives back
/// where the button is.
fn show_more(ui: &mut Ui, given: &Given, messages: &[String]) -> Rect {
    let more = ui.add_sized(vec2(MORE, BUTTON), Button::new("…"));
    more.widget_info(|| WidgetInfo::labeled(Role::Button, true, "More"));
    let more = more.on_hover_text("More: A and B to compare, undo and redo");
    let style = |style: &mut Style| {
        menu_style(style);
        style.spacing.button_padding = vec2(NEAR, TIGHT);
    };
    let menu = Popup::menu(&more).style(style).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    menu.show(|ui| {
        ui.set_min_width(MENU);
        show_compare(ui, given);
        ui.separator();
        show_history(ui, given);
        for text in messages {
            ui.separator();
            ui.set_max_width(MESSAGE);
            Frame::NONE.inner_margin(vec2(NEAR, TIGHT)).show(ui, |ui| {
                ui.with_layout(Layout::top_down(Align::LEFT), |ui| {
                    ui.colored_label(theme::ALARM, text);
                });
            });
        }
    });
    more.rect
}

/// Two sets of values to hear one after the other.
fn show_compare(ui: &mut Ui, given: &Given) {
    let sides = &given.history.compare;
    for (b, name) in [(false, "A"), (true, "B")] {
        let button = Button::selectable(sides.is_b() == b, name).frame_when_inactive(true);
        if ui.add(button).on_hover_text("Hear one set of values, then the other").clicked() {
            compare::hear(given, b);
        }
    }
    let copy = if sides.is_b() { "B to A" } else { "A to B" };
    if ui.button(copy).on_hover_text("Make the other the same as what is heard").clicked() {
        sides.copy();
    }
}

/// Undo and redo.
fn show_history(ui: &mut Ui, given: &Given) {
    let [undo, redo] = given.history.can();
    let mut button = |can: bool, name: &str, key: char| {
        let keys = format!("{COMMAND}+{key}");
        ui.add_enabled(can, Button::new(name)).on_hover_text(&keys).on_disabled_hover_text(&keys).clicked()
    };
    if button(undo, "Undo", 'Z') {
        given.history.undo(given.gui);
    }
    if button(redo, "Redo", 'Y') {
        given.history.redo(given.gui);
    }
}
