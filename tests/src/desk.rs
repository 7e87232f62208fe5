//! The editor without a window or a host: what a hand does with the mouse goes in, what the host is told, what the
//! strings play and what is seen come out.

mod recorder;
mod steps;

use std::sync::Arc;

use egui::{Event, LayerId, Modifiers, PointerButton, Pos2, Ui, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use low_action::display::{Health, Writer, display};
use low_action::editor::theme::GROUND;
use low_action::editor::{Editor, SIZE, Sight};
use low_action::engine::{Engine, EngineOptions};
use low_action::params::LowActionParams;
use low_action::performance::PlayerEvent;
use low_action::plugin::meters::Meters;
use low_action::pointer::{Played, pointer};
use low_action_dsp::Setup;
use nice_plug::context::PluginApi;
use nice_plug::context::gui::GuiContext;
use nice_plug::prelude::Params;

pub use recorder::{Recorder, Told, is_gesture};

use crate::user::isolate;

/// Of the sound, Hz.
pub const RATE: f64 = 48_000.0;
/// Pictures a second.
pub const PICTURES: f64 = 60.0;

/// An editor, an engine that plays what is done in it, and a host that writes down what it is told.
pub struct Desk {
    /// The editor.
    pub harness: Harness<'static, Editor>,
    /// The host.
    pub host: Arc<Recorder>,
    /// What it sets.
    pub params: Arc<LowActionParams>,
    /// Lights and needles.
    pub meters: Arc<Meters>,
    /// What plays.
    pub engine: Engine,
    /// All that was played with the mouse.
    pub played: Vec<PlayerEvent>,
    /// The left channel of all that has sounded.
    pub sound: Vec<f32>,
    queue: Played,
    writer: Writer,
}

/// Shows the editor on the ground that its window has.
fn show(ui: &mut Ui, editor: &mut Editor, gui: &GuiContext) {
    let ground = ui.ctx().layer_painter(LayerId::background());
    ground.rect_filled(ui.ctx().content_rect(), 0.0, GROUND);
    editor.show(ui, gui);
}

impl Default for Desk {
    fn default() -> Self {
        Self::new()
    }
}

impl Desk {
    /// The electric guitar at the usual size, one pixel a point, seen for the first time.
    pub fn new() -> Self {
        Self::sized(1.0, 1.0)
    }

    /// The same in a window of so many times the usual size, with so many pixels a point.
    pub fn sized(times: f32, pixels: f32) -> Self {
        let builder = Harness::builder();
        Self::built(builder.with_size(times * vec2(SIZE[0], SIZE[1])).with_pixels_per_point(pixels))
    }

    /// The same without a host, as a program of its own.
    pub fn alone() -> Self {
        let builder = Harness::builder().with_size(vec2(SIZE[0], SIZE[1])).with_pixels_per_point(1.0);
        Self::under(PluginApi::Standalone, builder)
    }

    fn built(builder: egui_kittest::HarnessBuilder<Editor>) -> Self {
        Self::under(PluginApi::Clap, builder)
    }

    fn under(api: PluginApi, builder: egui_kittest::HarnessBuilder<Editor>) -> Self {
        isolate();
        let (params, meters) = (Arc::new(LowActionParams::default()), Arc::new(Meters::default()));
        let (writer, reader) = display();
        let (sender, queue) = pointer();
        let host = Arc::new(Recorder::new(params.clone(), api));
        let gui = GuiContext::new(host.clone());
        let editor = Editor::new(params.clone(), meters.clone(), reader, sender);
        let setup = Setup::builtin("electric").expect("it is built in");
        let options = EngineOptions { variation: 0.0, ..EngineOptions::new(setup, RATE) };
        let engine = Engine::new(&options).expect("it can be built");
        let harness = builder
            .with_step_dt(1.0 / PICTURES as f32)
            .with_context_setup(Editor::dress)
            .build_ui_state(move |ui, editor: &mut Editor| show(ui, editor, &gui), editor);
        let (played, sound) = (Vec::new(), Vec::new());
        let mut desk = Self { harness, host, params, meters, engine, played, sound, queue, writer };
        desk.picture();
        desk
    }

    /// Time passes, picture by picture.
    pub fn wait(&mut self, seconds: f64) {
        for _ in 0..(seconds * PICTURES).round() as usize {
            self.picture();
        }
    }

    /// One picture, and the sound from it to the next.
    pub fn picture(&mut self) {
        self.harness.step();
        while let Some(event) = self.queue.next() {
            self.played.push(event);
            self.engine.event(0, event);
        }
        let samples = (RATE / PICTURES) as usize;
        let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
        self.writer.look(true, &mut self.engine);
        self.engine.process(&mut left, &mut right);
        self.writer.write(&mut self.engine, samples, Health::default());
        self.meters.see_output(&left, &right);
        self.sound.extend(left);
    }

    /// The mouse goes somewhere.
    pub fn point(&mut self, at: Pos2) {
        self.harness.event(Event::PointerMoved(at));
        self.picture();
    }

    /// Its button goes down or up there.
    pub fn press(&mut self, at: Pos2, pressed: bool, modifiers: Modifiers) {
        let button = PointerButton::Primary;
        self.harness.event_modifiers(Event::PointerButton { pos: at, button, pressed, modifiers }, modifiers);
        self.picture();
    }

    /// The button goes down at the first place and up at the last, and the mouse takes so long from one to the next, s.
    pub fn drag(&mut self, way: &[Pos2], seconds: f64) {
        self.point(way[0]);
        self.press(way[0], true, Modifiers::NONE);
        for ends in way.windows(2) {
            let steps = (seconds * PICTURES).round().max(1.0) as usize;
            for step in 1..=steps {
                self.point(ends[0] + (ends[1] - ends[0]) * (step as f32 / steps as f32));
            }
        }
        self.press(way[way.len() - 1], false, Modifiers::NONE);
    }

    /// The window is closed; gives back what that plays.
    pub fn close(self) -> Vec<PlayerEvent> {
        let Self { harness, queue, .. } = self;
        drop(harness);
        std::iter::from_fn(|| queue.next()).collect()
    }

    /// Plays so that something is seen.
    pub fn play(&mut self, event: PlayerEvent) {
        self.engine.event(0, event);
    }

    /// Where things are in the picture of the strings.
    pub fn sight(&self) -> Sight {
        let area = self.harness.get_by_label("Strings").rect();
        Sight::new(area, &Setup::builtin("electric").expect("it is built in"))
    }

    /// A point of the picture of the strings: so far from the nut, m, and on a string counted from 0; between two at
    /// fractions.
    pub fn at(&self, place: f32, string: f32) -> Pos2 {
        let sight = self.sight();
        pos2(sight.x(place), sight.y(0) + string * sight.spacing)
    }

    /// The middle of something that has a name; of two, the one higher up: a handle in the picture of the strings.
    pub fn named(&self, name: &str) -> Pos2 {
        let places = self.harness.get_all_by_label(name).map(|node| node.rect().center());
        places.min_by(|one, other| one.y.total_cmp(&other.y)).expect("get_all finds one")
    }

    /// Names of all parameters.
    pub fn names(&self) -> Vec<String> {
        let map = self.params.param_map();
        // SAFETY: the pointers lead into the parameters, which the desk keeps.
        map.into_iter().map(|(_, param, _)| unsafe { param.name() }.to_owned()).collect()
    }

    /// The middle of a control in the panel that is seen, if it is there.
    pub fn control(&self, name: &str) -> Option<Pos2> {
        let tabs = self.named("Engine").y;
        let places = self.harness.query_all_by_label(name).map(|node| node.rect().center());
        places.into_iter().find(|place| place.y > tabs)
    }

    /// Clicks on something.
    pub fn click(&mut self, at: Pos2) {
        self.drag(&[at], 0.0);
    }

    /// Opens a panel.
    pub fn open(&mut self, tab: &str) {
        self.wait(0.05);
        self.click(self.named(tab));
        self.wait(0.05);
    }

    /// Presses a key.
    pub fn key(&mut self, key: egui::Key) {
        self.harness.key_press(key);
        self.wait(0.05);
    }
}
