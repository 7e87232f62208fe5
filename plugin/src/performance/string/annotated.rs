//! What is told of a string's notes, for labels.

use super::{Note, Start, StringPlayer};
use crate::performance::articulation::Stop;
use crate::performance::{Annotation, Excitation, GestureSink, Moment, NewNote};

impl StringPlayer {
    /// That the hands turn to a note.
    pub(super) fn new_note(&self, start: &Start) -> Annotation {
        Annotation::Begins(NewNote {
            channel: start.channel,
            key: start.key,
            velocity: start.velocity,
            asked: start.asked,
            returned: false,
            fret: start.fret,
            partial: (start.articulation.stop == Stop::Harmonic).then_some(start.order),
            palm: self.fingers.palm(),
        })
    }

    /// That they turn to one again whose key has been down under another, which goes up now. No finger touches a node for it.
    pub(super) fn returning_note(&self, note: &Note, time: u64) -> Annotation {
        Annotation::Begins(NewNote {
            channel: note.channel,
            key: note.key,
            velocity: note.velocity,
            asked: time,
            returned: true,
            fret: note.fret,
            partial: None,
            palm: self.fingers.palm(),
        })
    }

    /// Tells that the string sounds, so many seconds from now, and what does it.
    pub(super) fn tells_sound(
        &mut self,
        delay: f64,
        excitation: Excitation,
        at: &mut Moment<impl GestureSink>,
    ) {
        self.unheard = false;
        at.tells_later(delay, Annotation::Sounds(excitation));
    }
}
