//! The editor: the strings over the fretboard, played with the mouse, and everything that can be set.
//!
//! ```text
//! header          instruments, A and B, undo, messages, meter
//! strings         all strings over the fretboard, seen from above
//! side            one string, seen from the side
//! panels          player | luthier | sound | engine
//! ```
//!
//! Every view is a function of [`Given`]: the parameters, the latest snapshot of the strings, the set-up that the
//! parameters ask for, and the way back to the audio thread. What a view remembers for itself is a struct of its own
//! that [`Editor`] keeps.

mod asked;
mod capture;
mod closing;
mod compare;
pub mod control;
mod given;
mod header;
mod history;
mod keys;
mod link;
mod noted;
mod notes;
pub mod panels;
mod presets;
mod shapes;
mod shortcuts;
mod side;
mod strings;
pub mod theme;

use std::sync::Arc;

use egui::{Rect, Ui, UiBuilder, ViewportCommand, pos2};
use nice_plug::context::PluginApi;
use nice_plug::context::gui::GuiContext;
use nice_plug::prelude::ParamSetter;
use nice_plug_egui::NiceEguiApp;
#[cfg(all(feature = "standalone", unix))]
use nice_plug_egui::RepaintNotifier;

use crate::display::{Reader, Snapshot};
use crate::params::LowActionParams;
use crate::params::words::Words;
use crate::plugin::layout::{SIZES, Seen};
use crate::plugin::meters::Meters;
use crate::pointer::Pointer;
pub use given::{Given, Plan};
use history::History;
pub use link::{Link, SIZE, Window};
use noted::Noted;
use panels::{TABS, Tab};
pub use strings::Sight;
use theme::{GAP, HEADER, PANELS, SIDE};

/// The editor, as long as the plugin lives; its window may be opened and closed many times.
pub struct Editor {
    params: Arc<LowActionParams>,
    meters: Arc<Meters>,
    reader: Reader,
    pointer: Pointer,
    gui: Option<GuiContext>,
    /// Has the window drawn, whoever asks for it.
    #[cfg(all(feature = "standalone", unix))]
    repaint: Option<RepaintNotifier>,
    plan: Plan,
    /// What is seen of strings that nobody has seen yet.
    nothing: Snapshot,
    words: Words,
    history: Arc<History>,
    keys: keys::Keys,
    /// What the window has yet to become as it was left.
    opening: Opening,
    /// Whether something was typed into at the last picture.
    typing: bool,
    header: header::Header,
    strings: strings::Strings,
    panels: panels::Panels,
}

impl Editor {
    /// An editor of these parameters, which sees and plays the strings.
    pub fn new(params: Arc<LowActionParams>, meters: Arc<Meters>, reader: Reader, pointer: Pointer) -> Self {
        Self {
            words: Words::of(&params),
            history: Arc::new(History::new(params.clone())),
            keys: keys::Keys::default(),
            opening: Opening::Zoom,
            typing: false,
            params,
            meters,
            reader,
            pointer,
            gui: None,
            #[cfg(all(feature = "standalone", unix))]
            repaint: None,
            plan: Plan::default(),
            nothing: Snapshot::default(),
            header: header::Header::default(),
            strings: strings::Strings::default(),
            panels: panels::Panels::default(),
        }
    }

    /// The same, whose window is drawn when that is asked for.
    #[cfg(all(feature = "standalone", unix))]
    fn drawn_by(self, repaint: RepaintNotifier) -> Self {
        Self { repaint: Some(repaint), ..self }
    }

    /// Colours, fonts and spacings of a new window.
    pub fn dress(context: &egui::Context) {
        theme::dress(context);
    }

    /// Draws everything and takes what the mouse does. `gui` is the way to the host.
    pub fn show(&mut self, ui: &mut Ui, gui: &GuiContext) {
        let fresh = self.reader.fetch();
        if !self.history.look(ui.input(|input| input.time)) {
            ui.ctx().request_repaint();
        }
        self.plan.follow(&self.params);
        let is_seen = self.plan.is_of(self.reader.latest());
        let noted = Noted { gui: gui.clone(), history: self.history.clone() };
        if self.opening == Opening::Zoom {
            closing::end_gestures(ui.ctx(), noted.clone(), self.strings.finger(), self.pointer.clone());
        }
        self.resume(ui);
        let given = Given {
            params: &self.params,
            setter: ParamSetter::new(&noted),
            meters: &self.meters,
            snapshot: if is_seen { self.reader.latest() } else { &self.nothing },
            fresh: fresh && is_seen,
            pointer: &self.pointer,
            plan: &self.plan,
            words: &self.words,
            history: &self.history,
            gui,
            keyboard: (gui.plugin_api() == PluginApi::Standalone).then(|| self.params.layout.seen().keys),
        };
        shortcuts::follow(ui, &given, self.typing);
        self.keys.follow(ui, &given);
        let window = ui.ctx().content_rect();
        let Areas { header, strings, side, panels } = Areas::of(window, self.panels.open);
        ui.set_clip_rect(window);
        place(ui, "header", header, |ui| self.header.show(ui, &given));
        place(ui, "strings", strings, |ui| self.strings.show(ui, &given));
        let watched = self.strings.watched();
        if let Some(side) = side {
            place(ui, "side", side, |ui| side::show(ui, &given, watched));
        }
        place(ui, "panels", panels, |ui| self.panels.show(ui, &given));
        let panel = Tab::ALL.iter().position(|tab| *tab == self.panels.tab).unwrap_or(0);
        let seen = Seen { panel, string: self.strings.watched(), ..self.params.layout.seen() };
        self.params.layout.keep(match self.opening {
            Opening::Done => Seen { size: Some(window.size().into()), zoom: ui.ctx().zoom_factor(), ..seen },
            _ => seen,
        });
        self.typing = ui.ctx().text_edit_focused();
        noted.end_dropped();
    }

    /// A window opens, which is to become as it was left.
    pub fn open(&mut self) {
        self.opening = Opening::Zoom;
        self.history.restart();
        // What was loud while nobody looked is over.
        self.meters.take_peaks();
        self.header.rest();
    }

    /// Goes on where the session left off; the window itself becomes as large as it was when it is opened.
    fn resume(&mut self, ui: &Ui) {
        let seen = self.params.layout.seen();
        self.panels.tab = Tab::ALL.get(seen.panel).copied().unwrap_or_default();
        self.strings.watch(seen.string);
        let context = ui.ctx();
        if self.opening == Opening::Zoom {
            context.set_zoom_factor(seen.zoom);
            self.opening = Opening::Size;
            if context.zoom_factor() != seen.zoom {
                // It is so at the next picture, and only then are points as large as those that the size is given in.
                context.request_repaint();
                return;
            }
        }
        if std::mem::take(&mut self.opening) == Opening::Size {
            let left = seen.size.map(egui::Vec2::from);
            if let Some(size) = left.filter(|size| *size != context.content_rect().size()) {
                context.send_viewport_cmd(ViewportCommand::InnerSize(size));
            }
        }
        let [least, largest] = SIZES;
        let zoom = context.zoom_factor();
        if !(least..=largest).contains(&zoom) {
            context.set_zoom_factor(zoom.clamp(least, largest));
        }
    }
}

impl NiceEguiApp for Editor {
    fn build(
        &mut self,
        context: egui::Context,
        gui: GuiContext,
        frame: &mut nice_plug_egui::Frame,
    ) -> Result<(), nice_plug_egui::baseview::HandlerError> {
        Self::dress(&context);
        // Cheaper than to paint it. The window takes the values as they are, whatever they are called.
        let [red, green, blue, _] = theme::GROUND.to_normalized_gamma_f32();
        frame.set_clear_color(egui::Rgba::from_rgb(red, green, blue));
        #[cfg(all(feature = "standalone", unix))]
        if let Some(repaint) = self.repaint.clone().filter(|_| gui.plugin_api() == PluginApi::Standalone) {
            crate::standalone::window::close_on_signals(repaint);
        }
        self.gui = Some(gui);
        self.open();
        Ok(())
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut nice_plug_egui::Frame) {
        if let Some(gui) = self.gui.clone() {
            self.show(ui, &gui);
            #[cfg(all(feature = "standalone", unix))]
            if crate::standalone::window::is_leaving() {
                ui.ctx().send_viewport_cmd(ViewportCommand::Close);
            }
            if gui.plugin_api() != PluginApi::Standalone {
                frame.set_key_capture(capture::kept(self.typing, ui.input(|input| input.modifiers.command)));
            }
        }
    }
}

/// What a window that opens has yet to become as it was left.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Opening {
    /// Everything in it has yet to become as large as it was, and then the window itself.
    Zoom,
    /// The window itself has.
    Size,
    /// Nothing.
    #[default]
    Done,
}

/// Where the parts of the window are.
struct Areas {
    header: Rect,
    strings: Rect,
    side: Option<Rect>,
    panels: Rect,
}

/// Height that a window must have for the panels to be seen at all times, and for the side view, points.
const FOR_PANELS: f32 = 600.0;
const FOR_SIDE: f32 = 400.0;
/// What the side view has of the height of a large window.
const SIDE_PART: f32 = 0.19;

impl Areas {
    /// Header, panels and side view have the height they need, if there is room for them, and the strings what is left.
    /// Where there is little room only the tabs of the panels are seen, until one is opened in place of the side view; where
    /// there is hardly any, what has room of it under its tabs.
    fn of(window: Rect, open: bool) -> Self {
        let row = |top: f32, bottom: f32| {
            let rect = Rect::from_min_max(pos2(window.left(), top), pos2(window.right(), bottom));
            rect.shrink2(egui::vec2(GAP, 0.0))
        };
        let header = row(window.top(), window.top() + HEADER);
        let mut bottom = window.bottom() - GAP;
        let mut take = |height: f32| {
            let taken = row((bottom - height).max(header.bottom()), bottom);
            bottom = taken.top() - GAP;
            taken
        };
        let crowded = window.height() < FOR_PANELS;
        let panels = take(if crowded && !open { TABS } else { PANELS });
        let for_side = if crowded && open { FOR_PANELS } else { FOR_SIDE };
        let side = (window.height() >= for_side).then(|| take(SIDE.max(SIDE_PART * window.height())));
        Self { header, strings: row(header.bottom(), bottom.max(header.bottom())), side, panels }
    }
}

/// Gives a part of the window to a view.
fn place(ui: &mut Ui, name: &'static str, area: Rect, view: impl FnOnce(&mut Ui)) {
    ui.scope_builder(UiBuilder::new().id_salt(name).max_rect(area), |ui| {
        ui.shrink_clip_rect(area);
        view(ui);
    });
}
