//! The panels under the strings, one at a time behind tabs.

mod bar;
mod cells;
mod engine;
mod luthier;
mod player;
mod sound;

use egui::{Rect, Sense, Ui, UiBuilder, pos2, vec2};

use super::Given;
use super::theme::{self, NEAR};

/// Which panel is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tab {
    /// How the hands act.
    #[default]
    Player,
    /// What a luthier changes.
    Luthier,
    /// What becomes of the sound.
    Sound,
    /// How it is computed.
    Engine,
}

impl Tab {
    /// All, in order.
    pub const ALL: [Self; 4] = [Self::Player, Self::Luthier, Self::Sound, Self::Engine];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Player => "Player",
            Self::Luthier => "Luthier",
            Self::Sound => "Sound",
            Self::Engine => "Engine",
        }
    }

    /// What is in it.
    fn hint(self) -> &'static str {
        match self {
            Self::Player => "What hands do, and how notes are taken",
            Self::Luthier => "Instrument, neck, pickup and tuning",
            Self::Sound => "Level, pitch and losses",
            Self::Engine => "How exactly it is computed, and what the strings do",
        }
    }
}

/// What the panels remember.
#[derive(Debug, Default)]
pub struct Panels {
    /// The one that is seen.
    pub tab: Tab,
    /// Whether it is open where there is little room.
    pub open: bool,
    engine: engine::Engine,
}

/// Height of the row of tabs, points.
pub(super) const TABS: f32 = 32.0;
/// Width of a tab where there is room for all, points.
const TAB: f32 = 80.0;
/// What is narrower than this is scrolled, points.
const NARROWEST: f32 = 1072.0;
/// Rows of controls that panels are made for. What is lower is scrolled.
const ROWS: usize = 4;

impl Panels {
    /// Draws the tabs and the panel that is seen.
    pub fn show(&mut self, ui: &mut Ui, given: &Given) {
        let area = ui.max_rect();
        ui.painter().rect_filled(area, theme::ROUND, theme::SURFACE);
        let tabs = Rect::from_min_size(area.min, vec2(area.width(), TABS));
        self.show_tabs(ui, tabs);
        if area.height() <= TABS {
            return;
        }
        let inside = Rect::from_min_max(pos2(area.left(), tabs.bottom()), area.max).shrink2(vec2(NEAR, NEAR));
        ui.scope_builder(UiBuilder::new().id_salt(self.tab.name()).max_rect(inside), |ui| {
            let is_low = inside.height() < cells::height(ROWS);
            egui::ScrollArea::new([true, is_low]).show(ui, |ui| {
                let size = vec2(inside.width().max(NARROWEST), inside.height().max(cells::height(ROWS)));
                let (whole, _) = ui.allocate_exact_size(size, Sense::hover());
                // Room for the rings around controls that have the focus.
                let whole = whole.shrink2(vec2(NEAR, 0.0));
                ui.scope_builder(UiBuilder::new().max_rect(whole), |ui| self.show_tab(ui, given));
            });
        });
    }

    fn show_tab(&mut self, ui: &mut Ui, given: &Given) {
        match self.tab {
            Tab::Player => player::show(ui, given),
            Tab::Luthier => luthier::show(ui, given),
            Tab::Sound => sound::show(ui, given),
            Tab::Engine => self.engine.show(ui, given),
        }
    }

    fn show_tabs(&mut self, ui: &mut Ui, area: Rect) {
        let mut left = area.left() + NEAR;
        let width = TAB.min((area.width() - 2.0 * NEAR) / Tab::ALL.len() as f32);
        for tab in Tab::ALL {
            let place = Rect::from_min_size(pos2(left, area.top()), vec2(width, area.height()));
            left += width;
            let response = ui.interact(place, ui.scope_id().with(tab.name()), Sense::click());
            let response = response.on_hover_text(tab.hint());
            let chosen = self.tab == tab;
            response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Tab, true, chosen, tab.name()));
            if response.clicked() {
                // The second time closes it again, which is seen where there is little room.
                self.open = !(self.open && chosen);
                self.tab = tab;
            }
            let colour = match () {
                () if chosen => theme::ACCENT,
                () if response.hovered() || response.has_focus() => theme::TEXT,
                () => theme::SOFT_TEXT,
            };
            let painter = ui.painter();
            painter.text(place.center(), egui::Align2::CENTER_CENTER, tab.name(), theme::BODY_FONT, colour);
            if chosen || response.has_focus() {
                let line = Rect::from_min_max(
                    pos2(place.left() + NEAR, place.bottom() - 2.0),
                    pos2(place.right() - NEAR, place.bottom()),
                );
                painter.rect_filled(line, 1.0, colour);
            }
        }
        let below = egui::Stroke::new(1.0, theme::LINE);
        ui.painter().hline(area.x_range(), area.bottom(), below);
    }
}
