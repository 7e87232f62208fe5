//! What a note has for itself, beside its pluck. A note under the one that sounds has it when it comes back.

use super::{Manner, Note, StringPlayer};
use crate::performance::GestureSink;
use crate::performance::channel::Request;

/// Something a note has for itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Own {
    /// Its tuning, semitones.
    Tuning(f64),
    /// Factor of its finger's force, as its key is pressed.
    Pressure(f64),
    /// Another one, whatever presses its key.
    Firmness(f64),
    /// Depth of its vibrato, 0 to 1.
    Vibrato(f64),
}

impl Own {
    /// Says it of a note that is, or is to be, played in some manner.
    pub(crate) fn tell(self, manner: &mut Manner) {
        match self {
            Self::Tuning(semitones) => manner.tuning = semitones,
            Self::Pressure(factor) => manner.pressure = factor,
            Self::Firmness(factor) => manner.firmness = factor,
            Self::Vibrato(depth) => manner.vibrato = depth,
        }
    }
}

impl StringPlayer {
    /// Whether a key of a channel has the note that sounds.
    pub(crate) fn is_of(&self, channel: u8, key: u8) -> bool {
        self.note.is_some_and(|note| note.is(channel, key))
    }

    /// Channels and keys of its note and of those under it.
    pub(crate) fn keys(&self) -> impl Iterator<Item = (u8, u8)> + use<'_> {
        self.note.iter().chain(self.under.iter().flatten()).map(|note| (note.channel, note.key))
    }

    /// Whether it has that note, or is down under it.
    pub(crate) fn sounds(&self, channel: u8, key: u8) -> bool {
        self.is_of(channel, key) || self.under.iter().flatten().any(|note| note.is(channel, key))
    }

    /// The note of a key has something for itself: at once, or when it comes back.
    pub(crate) fn express(
        &mut self,
        time: u64,
        (channel, key): (u8, u8),
        own: Own,
        out: &mut impl GestureSink,
    ) {
        let sounds = self.is_of(channel, key);
        let Some(note) = self.notes().find(|note| note.is(channel, key)) else { return };
        own.tell(&mut note.manner);
        let firm = note.manner.firm();
        match own {
            _ if !sounds => {}
            Own::Tuning(semitones) => self.bend.tune(time, semitones),
            Own::Pressure(_) | Own::Firmness(_) => {
                let mut at = self.moment(time, out);
                self.fingers.press(firm, &mut at);
            }
            Own::Vibrato(depth) => self.swing(time, depth),
        }
    }

    /// Channels have said how hard keys are pressed, how deep they swing, or how hard the palm rests, of all their notes: those that
    /// are to come back have it then.
    pub(crate) fn hear(&mut self, request: Request, said: impl Fn(u8) -> Option<(Manner, f64)>) {
        for note in self.notes() {
            let Some((manner, palm)) = said(note.channel) else { continue };
            if matches!(request, Request::Press | Request::Reset) {
                note.manner.pressure = manner.pressure;
            }
            if matches!(request, Request::Swing | Request::Reset) {
                note.manner.vibrato = manner.vibrato;
            }
            if matches!(request, Request::Touch | Request::Reset) {
                note.palm = palm;
            }
        }
    }

    /// The note that sounds and those under it.
    pub(super) fn notes(&mut self) -> impl Iterator<Item = &mut Note> {
        self.note.iter_mut().chain(self.under.iter_mut().flatten())
    }
}
