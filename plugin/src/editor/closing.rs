//! What is held when a host closes the window. The library tells nobody that it is closed, but what the window remembers goes
//! with it.

use std::sync::Arc;

use egui::{Context, Id};

use super::noted::Noted;

/// Goes when the window does.
struct Closing(Noted);

impl Drop for Closing {
    fn drop(&mut self) {
        self.0.end_dropped();
        // What was held at the last picture, too.
        self.0.end_dropped();
    }
}

/// Ends the gestures that are under way when a new window is closed.
pub fn end_gestures(window: &Context, noted: Noted) {
    window.data_mut(|data| data.insert_temp(Id::unique("closing"), Arc::new(Closing(noted))));
}
