//! Gestures waiting for their sample.

use crate::gesture::TimedGesture;
use crate::roomy::Roomy;

/// No room for another gesture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("more than {CAPACITY} gestures wait at once")]
pub struct QueueFull;

/// How many gestures may wait at once.
const CAPACITY: usize = 4096;

/// Gestures in order of time, and of arrival where times are equal.
#[derive(Debug, Clone)]
pub(crate) struct Queue {
    /// Latest first, so that the next one is at the end.
    waiting: Roomy<TimedGesture>,
}

impl Queue {
    /// Empty, with all the room it will ever need.
    pub fn new() -> Self {
        Queue { waiting: Roomy::with_capacity(CAPACITY) }
    }

    /// Adds a gesture.
    pub fn push(&mut self, gesture: TimedGesture) -> Result<(), QueueFull> {
        if self.waiting.len() == CAPACITY {
            return Err(QueueFull);
        }
        let place = self.waiting.partition_point(|other| other.time > gesture.time);
        self.waiting.insert(place, gesture);
        Ok(())
    }

    /// How many wait.
    pub fn len(&self) -> usize {
        self.waiting.len()
    }

    /// The time of the next gesture.
    pub fn next_time(&self) -> Option<u64> {
        self.waiting.last().map(|gesture| gesture.time)
    }

    /// Takes the next gesture if it is due at `now`.
    pub fn pop_due(&mut self, now: u64) -> Option<TimedGesture> {
        if self.next_time()? <= now { self.waiting.pop() } else { None }
    }

    /// Takes over all that waits in another queue.
    pub fn take_over(&mut self, other: &Queue) {
        self.waiting.clear();
        self.waiting.extend_from_slice(&other.waiting);
    }

    /// Forgets everything that waits.
    pub fn clear(&mut self) {
        self.waiting.clear();
    }
}
