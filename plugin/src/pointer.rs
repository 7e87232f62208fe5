//! What is played in the editor's picture of the strings, on its way to the audio thread.
//!
//! [`pointer()`] makes a pair: the [`Pointer`] belongs to the editor, [`Played`] to the audio thread, which plays what
//! it finds there at the start of the next block. The queue between them is bounded and without locks.

use std::sync::Arc;

use crossbeam::queue::ArrayQueue;

use crate::performance::PlayerEvent;

/// Events that can be on their way; a mouse sends a few hundred a second, and blocks are shorter than that.
const CAPACITY: usize = 512;

/// The side of the editor.
#[derive(Debug, Clone)]
pub struct Pointer(Arc<ArrayQueue<PlayerEvent>>);

/// The side of the audio thread.
#[derive(Debug)]
pub struct Played(Arc<ArrayQueue<PlayerEvent>>);

/// Makes both sides.
pub fn pointer() -> (Pointer, Played) {
    let queue = Arc::new(ArrayQueue::new(CAPACITY));
    (Pointer(queue.clone()), Played(queue))
}

impl Pointer {
    /// Plays something as soon as possible; `false` if so much is waiting that this is left out.
    pub fn play(&self, event: PlayerEvent) -> bool {
        self.0.push(event).is_ok()
    }
}

impl Played {
    /// The next event.
    pub fn next(&self) -> Option<PlayerEvent> {
        self.0.pop()
    }

    /// Forgets what waits.
    pub fn clear(&self) {
        while self.0.pop().is_some() {}
    }
}
