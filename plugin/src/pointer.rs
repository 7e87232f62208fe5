//! What is played in the editor's picture of the strings, on its way to the audio thread.
//!
//! [`pointer()`] makes a pair: the [`Pointer`] belongs to the editor, [`Played`] to the audio thread, which plays what
//! it finds there at the start of the next block. The queue between them is bounded and without locks. What was done
//! while a host asked for no sound is not played later, all at once: it is forgotten.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crossbeam::queue::ArrayQueue;

use crate::performance::PlayerEvent;

/// Events that can be on their way; a mouse sends a few hundred a second, and blocks are shorter than that.
const CAPACITY: usize = 512;

/// How long an event may wait: longer than any block takes (8,192 samples at 8 kHz are a second).
pub(crate) const OLD: Duration = Duration::from_millis(1500);

/// What is on its way, and since when.
type Queue = Arc<ArrayQueue<(Instant, PlayerEvent)>>;

/// The side of the editor.
#[derive(Debug, Clone)]
pub struct Pointer(Queue);

/// The side of the audio thread.
#[derive(Debug)]
pub struct Played(Queue);

/// Makes both sides.
pub fn pointer() -> (Pointer, Played) {
    let queue = Arc::new(ArrayQueue::new(CAPACITY));
    (Pointer(queue.clone()), Played(queue))
}

impl Pointer {
    /// Plays something as soon as possible; `false` if so much is waiting that this is left out.
    pub fn play(&self, event: PlayerEvent) -> bool {
        self.0.push((Instant::now(), event)).is_ok()
    }
}

impl Played {
    /// The next event. After a pause so long that nobody expects any of them now, all are forgotten, and what they may have
    /// left sounding stops.
    pub fn next(&self) -> Option<PlayerEvent> {
        self.next_at(Instant::now())
    }

    fn next_at(&self, now: Instant) -> Option<PlayerEvent> {
        let (since, event) = self.0.pop()?;
        if now.saturating_duration_since(since) <= OLD {
            return Some(event);
        }
        self.clear();
        Some(PlayerEvent::AllNotesOff)
    }

    /// Forgets what waits.
    pub fn clear(&self) {
        while self.0.pop().is_some() {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::performance::StringDeed;

    #[test]
    fn what_waited_too_long_is_forgotten() {
        let deed = |deed| PlayerEvent::Touched { string: 0, deed };
        let (pressed, damped) = (deed(StringDeed::Press { position: 0.1 }), deed(StringDeed::Damp));
        let (pointer, played) = pointer();
        let fill = || assert!(pointer.play(pressed) && pointer.play(damped));
        fill();
        let soon = Instant::now() + OLD / 2;
        assert_eq!(
            [played.next_at(soon), played.next_at(soon), played.next_at(soon)],
            [Some(pressed), Some(damped), None]
        );
        fill();
        let late = Instant::now() + 2 * OLD;
        assert_eq!([played.next_at(late), played.next_at(late)], [Some(PlayerEvent::AllNotesOff), None]);
    }
}
