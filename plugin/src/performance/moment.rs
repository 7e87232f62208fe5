//! Gestures on their way to an instrument.

use low_action_dsp::{Gesture, TimedGesture};

use super::{Annotation, TimedAnnotation, Unplayed};

/// Somewhere gestures go: the instrument, or a list in a test.
pub trait GestureSink {
    /// Takes a gesture. Those of one string come in order of time, except that a pluck may be
    /// handed over up to a millisecond ahead of it. What a finger does that is late is handed over when it is told to come.
    fn gesture(&mut self, gesture: TimedGesture);

    /// Is told what becomes of a note. Most do not listen.
    fn annotation(&mut self, _annotation: TimedAnnotation) {}

    /// Is told of a note that no string gets. Fewer listen.
    fn unplayed(&mut self, _note: Unplayed) {}
}

impl GestureSink for Vec<TimedGesture> {
    fn gesture(&mut self, gesture: TimedGesture) {
        self.push(gesture);
    }
}

/// A sample at which gestures are made on one string.
pub(crate) struct Moment<'a, S: GestureSink> {
    pub time: u64,
    pub string: usize,
    pub sample_rate: f64,
    pub out: &'a mut S,
}

impl<S: GestureSink> Moment<'_, S> {
    /// Makes a gesture now.
    pub(crate) fn does(&mut self, gesture: Gesture) {
        self.does_later(0.0, gesture);
    }

    /// Makes a gesture so many seconds from now.
    pub(crate) fn does_later(&mut self, seconds: f64, gesture: Gesture) {
        self.out.gesture(TimedGesture { time: self.after(seconds), string: self.string, gesture });
    }

    /// Tells what becomes of the string's note now.
    pub(crate) fn tells(&mut self, annotation: Annotation) {
        self.tells_later(0.0, annotation);
    }

    /// Tells what becomes of it so many seconds from now.
    pub(crate) fn tells_later(&mut self, seconds: f64, annotation: Annotation) {
        let time = self.after(seconds);
        self.out.annotation(TimedAnnotation { time, string: self.string, annotation });
    }

    /// The sample so many seconds from now.
    pub(crate) fn after(&self, seconds: f64) -> u64 {
        self.time + (seconds * self.sample_rate).round() as u64
    }
}
