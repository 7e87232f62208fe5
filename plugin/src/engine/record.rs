//! What the player does, kept for labels.

use low_action_dsp::TimedGesture;

use super::Engine;
use crate::performance::{TimedAnnotation, Unplayed};

/// What a player has done. Order is that of time on each string, but for plucks (and what is told of them) up to a millisecond
/// ahead.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    /// All that the strings were given.
    pub gestures: Vec<TimedGesture>,
    /// What became of notes.
    pub annotations: Vec<TimedAnnotation>,
    /// Notes that no string got.
    pub unplayed: Vec<Unplayed>,
}

impl Engine {
    /// Has what the player does kept from now on. The sound is the same bits. Unlike everything else, this takes memory as it
    /// goes: it is not for a thread of sound.
    pub fn record(&mut self) {
        self.played.record = Some(Box::default());
    }

    /// What the player has done since then, which is kept no longer; nothing if it was not.
    pub fn take_record(&mut self) -> Record {
        self.played.record.take().map_or_else(Record::default, |record| *record)
    }
}
