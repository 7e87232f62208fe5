//! Where gestures go from the player.

use low_action_dsp::{Gesture, Instrument, TimedGesture};

use super::Record;
use crate::performance::{GestureSink, TimedAnnotation, Unplayed};

/// Hands gestures to the instrument, and keeps what is to be kept.
pub(super) struct Sink<'a> {
    instrument: &'a mut Instrument,
    lost: &'a mut u64,
    touched: &'a mut u64,
    record: Option<&'a mut Record>,
}

impl<'a> Sink<'a> {
    pub(super) fn of(
        instrument: &'a mut Instrument,
        lost: &'a mut u64,
        touched: &'a mut u64,
        record: &'a mut Option<Box<Record>>,
    ) -> Self {
        Self { instrument, lost, touched, record: record.as_deref_mut() }
    }
}

impl GestureSink for Sink<'_> {
    fn gesture(&mut self, gesture: TimedGesture) {
        // A step brings at most a handful of gestures a string and sample, far below the
        // instrument's capacity; should it ever be full, the loss is counted.
        match self.instrument.schedule(gesture) {
            Err(_) => *self.lost += 1,
            Ok(()) => {
                // What bends or stills a string makes no sound of it.
                if !matches!(gesture.gesture, Gesture::Bend { .. } | Gesture::Still { .. }) {
                    *self.touched = gesture.time.max(*self.touched);
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
