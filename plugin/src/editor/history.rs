//! Undo and redo: one entry for each gesture that is finished in the editor, whichever view made it.
//!
//! [`Noted`] stands between the views and the host, passes everything on and notes it. What a host does by itself is
//! no gesture of the editor's, and is not undone.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use nice_plug::context::PluginApi;
use nice_plug::context::gui::{GuiContext, GuiContextInner};
use nice_plug::params::internals::ParamPtr;
use nice_plug::prelude::PluginState;

use crate::params::LowActionParams;

/// Entries that are kept.
const MOST: usize = 100;

/// A parameter before and after, 0 to 1.
#[derive(Debug, Clone, Copy)]
struct Change {
    param: ParamPtr,
    before: f32,
    after: f32,
}

#[derive(Debug, Default)]
struct Inside {
    /// Gestures that have begun.
    under_way: Vec<Change>,
    /// What is one entry together, while it is being done.
    together: Option<Vec<Change>>,
    done: VecDeque<Vec<Change>>,
    undone: Vec<Vec<Change>>,
}

/// What has been done in an editor.
pub struct History {
    /// Keeps what the pointers lead to.
    _params: Arc<LowActionParams>,
    inside: Mutex<Inside>,
}

impl History {
    /// Of these parameters, so far empty.
    pub fn new(params: Arc<LowActionParams>) -> Self {
        Self { _params: params, inside: Mutex::default() }
    }

    /// All gestures that are made meanwhile are one entry.
    pub fn together(&self, act: impl FnOnce()) {
        self.inside().together = Some(Vec::new());
        act();
        let mut inside = self.inside();
        if let Some(changes) = inside.together.take() {
            inside.keep(changes);
        }
    }

    /// Whether there is something to undo, and to redo.
    pub fn can(&self) -> [bool; 2] {
        let inside = self.inside();
        [!inside.done.is_empty(), !inside.undone.is_empty()]
    }

    /// Takes the last entry back.
    pub fn undo(&self, gui: &GuiContext) {
        let Some(entry) = self.inside().done.pop_back() else { return };
        // Past the history, which notes nothing of it.
        let host = gui.param_setter().raw_context;
        for change in entry.iter().rev() {
            put(host, change.param, change.before);
        }
        self.inside().undone.push(entry);
    }

    /// Does again what was taken back last.
    pub fn redo(&self, gui: &GuiContext) {
        let Some(entry) = self.inside().undone.pop() else { return };
        let host = gui.param_setter().raw_context;
        for change in &entry {
            put(host, change.param, change.after);
        }
        self.inside().done.push_back(entry);
    }

    fn begin(&self, param: ParamPtr) {
        // SAFETY: only parameters of `_params` are set in the editor, and they live as long as this.
        let before = unsafe { param.unmodulated_normalized_value() };
        self.inside().under_way.push(Change { param, before, after: before });
    }

    fn set(&self, param: ParamPtr, value: f32) {
        let mut inside = self.inside();
        if let Some(change) = inside.under_way.iter_mut().find(|change| change.param == param) {
            change.after = value;
        }
    }

    fn end(&self, param: ParamPtr) {
        let mut inside = self.inside();
        if let Some(place) = inside.under_way.iter().position(|change| change.param == param) {
            let change = inside.under_way.remove(place);
            if change.before != change.after {
                inside.keep(vec![change]);
            }
        }
    }

    /// Nothing a panicking view could have left half-done matters here.
    fn inside(&self) -> MutexGuard<'_, Inside> {
        self.inside.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inside {
    fn keep(&mut self, changes: Vec<Change>) {
        if changes.is_empty() {
            return;
        }
        if let Some(together) = &mut self.together {
            together.extend(changes);
            return;
        }
        self.undone.clear();
        if self.done.len() == MOST {
            self.done.pop_front();
        }
        self.done.push_back(changes);
    }
}

/// Sets one of the plugin's parameters in one gesture, 0 to 1.
pub fn put(host: &dyn GuiContextInner, param: ParamPtr, value: f32) {
    // SAFETY: the parameter is the plugin's, and lives as long as its history.
    unsafe {
        host.raw_begin_set_parameter(param);
        host.raw_set_parameter_normalized(param, value);
        host.raw_end_set_parameter(param);
    }
}

/// The way to the host, past the history.
pub struct Noted {
    /// The host.
    pub gui: GuiContext,
    /// What notes all that goes there.
    pub history: Arc<History>,
}

impl GuiContextInner for Noted {
    fn plugin_api(&self) -> PluginApi {
        self.gui.plugin_api()
    }

    unsafe fn raw_begin_set_parameter(&self, param: ParamPtr) {
        self.history.begin(param);
        // SAFETY: as promised by the caller.
        unsafe { self.gui.raw_begin_set_parameter(param) };
    }

    unsafe fn raw_set_parameter_normalized(&self, param: ParamPtr, normalized: f32) {
        self.history.set(param, normalized);
        // SAFETY: as promised by the caller.
        unsafe { self.gui.raw_set_parameter_normalized(param, normalized) };
    }

    unsafe fn raw_end_set_parameter(&self, param: ParamPtr) {
        // SAFETY: as promised by the caller.
        unsafe { self.gui.raw_end_set_parameter(param) };
        self.history.end(param);
    }

    fn get_state(&self) -> PluginState {
        self.gui.get_state()
    }

    fn set_state(&self, state: PluginState) {
        self.gui.set_state(state);
    }

    fn request_restart(&self) {
        self.gui.request_restart();
    }
}
