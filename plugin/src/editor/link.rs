//! Between the plugin and its editor: what the framework wants to know of a window.

use std::sync::Arc;

use nice_plug::editor::dpi::LogicalSize;
use nice_plug::editor::{ResizeHint, SizeConstraints};
use nice_plug_egui::{
    EguiEditor, EguiEditorState, EguiNiceSettings, GraphicsConfig, RepaintNotifier, create_egui_editor,
};

use super::Editor;
use crate::display::Reader;
use crate::params::{LowActionParams, start};
pub use crate::plugin::layout::SIZE;
use crate::plugin::layout::SIZES;
use crate::plugin::meters::Meters;
use crate::pointer::Pointer;

/// The editor's window, as the framework has it.
pub type Window = EguiEditor<Editor>;

/// The plugin's end of its editor.
pub struct Link {
    state: Arc<EguiEditorState>,
    repaint: RepaintNotifier,
    /// Until the framework has asked for it; none where there can be no window.
    editor: Option<Editor>,
}

impl Link {
    /// Makes an editor, whose window is closed.
    pub fn new(params: Arc<LowActionParams>, meters: Arc<Meters>, reader: Reader, pointer: Pointer) -> Self {
        let repaint = RepaintNotifier::new();
        let make = || {
            let editor = Editor::new(params, meters, reader, pointer);
            #[cfg(all(feature = "standalone", unix))]
            let editor = editor.drawn_by(repaint.clone());
            editor
        };
        Self {
            state: EguiEditorState::from_size(LogicalSize::new(SIZE[0], SIZE[1]), 1.0),
            editor: (!start().windowless).then(make),
            repaint,
        }
    }

    /// Whether the window is open.
    pub fn is_open(&self) -> bool {
        self.state.is_open()
    }

    /// Has an open window drawn anew soon; neither waits nor allocates.
    pub fn repaint(&self) {
        self.repaint.request_repaint();
    }

    /// The window, the first time it is asked for, if there can be one.
    pub fn window(&mut self) -> Option<Window> {
        let size = |part: f32| Some(LogicalSize::new(part * SIZE[0], part * SIZE[1]));
        let hint = ResizeHint {
            size_constraints: SizeConstraints::logical(size(SIZES[0]), size(SIZES[1])),
            ..ResizeHint::RESIZABLE
        };
        // Costs a fifth of the drawing by software, and no picture here is smooth enough to show it.
        let graphics = GraphicsConfig { dithering: false, ..GraphicsConfig::default() };
        let settings = EguiNiceSettings::new()
            .with_tile("Low Action")
            .with_graphics_config(graphics)
            .with_resize_hint(hint);
        create_egui_editor(self.state.clone(), self.repaint.clone(), settings, self.editor.take()?)
    }
}
