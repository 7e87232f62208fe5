//! All strings over the fretboard, seen from above: places along the strings to scale, their motion magnified.

mod board;
mod caps;
mod glow;
mod handles;
mod hint;
mod motion;
mod play;
mod sight;
mod touch;
mod watch;

use egui::{Align2, Sense, Stroke, Ui, pos2};

use super::Given;
use super::shapes::fit_text;
use super::theme::{self, NEAR, TIGHT};
use crate::plugin::layout::KeyMap;
use glow::Glow;
pub(super) use play::Finger;
use play::Play;
pub use sight::Sight;
use watch::Watch;

/// What the view of the strings remembers.
#[derive(Debug, Default)]
pub struct Strings {
    glow: Glow,
    play: Play,
    watch: Watch,
}

impl Strings {
    /// The string that the side view shows, counted from 0.
    pub fn watched(&self) -> usize {
        self.watch.string
    }

    /// Has the side view show another, until the mouse asks for one.
    pub fn watch(&mut self, string: usize) {
        self.watch.string = string;
    }

    /// The mouse's finger, for whoever sees the window go.
    pub(super) fn finger(&self) -> Finger {
        self.play.finger()
    }

    /// Draws the strings.
    pub fn show(&mut self, ui: &mut Ui, given: &Given) {
        let area = ui.max_rect();
        let Some(setup) = given.plan.setup() else { return };
        let sight = Sight::new(area, setup);
        self.glow.follow(ui, given);
        let painter = ui.painter_at(area);
        board::paint(&painter, &sight, setup);
        self.glow.paint(&painter, &sight, given.snapshot);
        motion::paint(&painter, &sight, setup, given.snapshot);
        touch::paint(&painter, &sight, given.snapshot);
        self.glow.paint_plucks(&painter, &sight);
        if let Some(keyboard) = given.keyboard.filter(|keyboard| keyboard.map == KeyMap::Frets) {
            caps::paint(&painter, &sight, setup, keyboard);
        }
        paint_names(ui, &sight, setup);
        paint_scale(ui, &sight);
        // Not to be reached by Tab: keys do nothing to the picture as a whole.
        let response = ui.interact(area, ui.scope_id().with("strings"), Sense::CLICK | Sense::DRAG);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Strings"));
        let begun = self.play.follow(ui, &response, &sight, setup, given);
        let over = response.hover_pos().filter(|_| !self.play.is_busy()).and_then(|at| sight.over(at.y));
        self.watch.follow(ui, over, begun);
        // An instrument with fewer strings may have come.
        self.watch.string = self.watch.string.min(setup.string.len().saturating_sub(1));
        handles::show(ui, given, &sight, setup);
    }
}

/// Width under which there is no room for many words, points.
const ROOM: f32 = 720.0;

/// The name of each string, left of the nut.
fn paint_names(ui: &Ui, sight: &Sight, setup: &low_action_dsp::Setup) {
    if sight.spacing < theme::SMALL.size {
        return;
    }
    for (index, string) in setup.string.iter().enumerate() {
        let place = (pos2(sight.x(0.0) - 3.0 * TIGHT, sight.y(index)), Align2::RIGHT_CENTER);
        let look = (theme::BODY_FONT, theme::SOFT_TEXT);
        fit_text(ui.painter(), place, &string.name, look, theme::LEFT - 3.0 * TIGHT);
    }
}

/// Height under which a mark of a millimetre is no mark any more, points.
const LEAST_SCALE: f32 = 6.0;

/// How far a millimetre of motion goes in the picture, where that can be seen.
fn paint_scale(ui: &Ui, sight: &Sight) {
    let painter = ui.painter();
    let (right, bottom) = (sight.area.right() - NEAR, sight.area.bottom() - NEAR);
    let height = 1e-3 * sight.lift;
    if height < LEAST_SCALE {
        return;
    }
    let x = right - TIGHT;
    let stroke = Stroke::new(1.0, theme::SOFT_TEXT);
    painter.vline(x, bottom - height..=bottom, stroke);
    for y in [bottom - height, bottom] {
        painter.hline(x - 3.0..=x + 3.0, y, stroke);
    }
    let text = match sight.area.width() {
        ..ROOM => "1 mm".to_owned(),
        _ => format!("1 mm of motion, magnified {:.0} times", sight.magnification()),
    };
    painter.text(
        pos2(x - NEAR, bottom - 0.5 * height),
        Align2::RIGHT_CENTER,
        text,
        theme::SMALL,
        theme::SOFT_TEXT,
    );
}
