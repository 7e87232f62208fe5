//! What is held when a host closes the window. The library tells nobody that it is closed, but what the window remembers goes
//! with it. A program of its own ends then.

use std::sync::Arc;

use egui::{Context, Id};
#[cfg(feature = "standalone")]
use nice_plug::context::PluginApi;

use super::noted::Noted;
use super::strings::Finger;
use crate::performance::{PlayerEvent, StringDeed};
use crate::pointer::Pointer;

/// Goes when the window does.
struct Closing {
    noted: Noted,
    finger: Finger,
    pointer: Pointer,
}

impl Drop for Closing {
    fn drop(&mut self) {
        self.noted.end_dropped();
        // What was held at the last picture, too.
        self.noted.end_dropped();
        // No mouse will ever be let go of in it: a finger that was to leave then leaves now.
        if let Some(string) = self.finger.take() {
            self.pointer.play(PlayerEvent::Touched { string, deed: StringDeed::Lift });
        }
        #[cfg(feature = "standalone")]
        if self.noted.gui.plugin_api() == PluginApi::Standalone {
            crate::standalone::window::gone();
        }
    }
}

/// Ends the gestures that are under way when a new window is closed, and takes the mouse's finger off its string.
pub fn end_gestures(window: &Context, noted: Noted, finger: Finger, pointer: Pointer) {
    let closing = Closing { noted, finger, pointer };
    window.data_mut(|data| data.insert_temp(Id::unique("closing"), Arc::new(closing)));
}
