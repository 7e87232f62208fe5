//! Where gestures go from the player.

use low_action_dsp::{Gesture, Instrument, TimedGesture};

use super::Record;
use crate::performance::{GestureSink, TimedAnnotation, Unplayed};

/// The instrument as it is played: takes gestures, and keeps what is to be kept.
#[derive(Debug)]
pub(super) struct Played {
    pub instrument: Instrument,
    /// How much has been lost because too much came at once.
    pub lost: u64,
    /// Sample of the last gesture by which a string may begin to sound.
    pub touched: u64,
    /// What the player does, if that is kept.
    pub record: Option<Box<Record>>,
}

impl Played {
    pub fn new(instrument: Instrument) -> Self {
        Self { instrument, lost: 0, touched: 0, record: None }
    }

    /// Silence, and nothing has been done yet.
    pub fn reset(&mut self) {
        self.instrument.reset();
        (self.lost, self.touched) = (0, 0);
        if let Some(record) = &mut self.record {
            **record = Record::default();
        }
    }
}

impl GestureSink for Played {
    fn gesture(&mut self, gesture: TimedGesture) {
        // A step brings at most a handful of gestures a string and sample, far below the
        // instrument's capacity; should it ever be full, the loss is counted.
        match self.instrument.schedule(gesture) {
            Err(_) => self.lost += 1,
            Ok(()) => {
                // What bends or stills a string makes no sound of it.
                if !matches!(gesture.gesture, Gesture::Bend { .. } | Gesture::Still { .. }) {
                    self.touched = gesture.time.max(self.touched);
                }
                if let Some(record) = &mut self.record {
                    record.gestures.push(gesture);
                }
            }
        }
    }

    fn annotation(&mut self, annotation: TimedAnnotation) {
        if let Some(record) = &mut self.record {
            record.annotations.push(annotation);
        }
    }

    fn unplayed(&mut self, note: Unplayed) {
        if let Some(record) = &mut self.record {
            record.unplayed.push(note);
        }
    }
}
