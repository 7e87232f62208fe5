//! Between the views and the host: what passes on all that is set, and has the history note it.

use std::sync::Arc;

use nice_plug::context::PluginApi;
use nice_plug::context::gui::{GuiContext, GuiContextInner};
use nice_plug::params::internals::ParamPtr;
use nice_plug::prelude::PluginState;

use super::history::History;

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
#[derive(Clone)]
pub struct Noted {
    /// The host.
    pub gui: GuiContext,
    /// What notes all that goes there.
    pub history: Arc<History>,
}

impl Noted {
    /// Ends the gestures of all that was gone at this picture, and begins another.
    pub fn end_dropped(&self) {
        for param in self.history.dropped() {
            // SAFETY: only the plugin's parameters are set in its editor, and they outlive it.
            unsafe { self.raw_end_set_parameter(param) };
        }
    }
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
