//! What a plugin shares with the door through which its host came in: the framework stands between them and lets neither hand
//! anything to the other.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use super::waiting::Waiting;

thread_local! {
    /// What the next plugin that is made on this thread shares with its door.
    static SHARED: Cell<Option<Arc<Door>>> = const { Cell::new(None) };
}

/// The plugin's side and the host's.
#[derive(Default)]
pub(super) struct Door {
    /// What a host has sent without having anything played.
    pub waiting: Waiting,
    /// For how long what is played may ring on, samples.
    tail: AtomicU32,
    /// Whether the host has the plugin activated.
    active: AtomicBool,
    /// Whether the host hides an editor that it keeps.
    hidden: AtomicBool,
}

impl Door {
    /// That of the plugin that is being made.
    pub fn of_the_new() -> Arc<Self> {
        SHARED.take().unwrap_or_default()
    }

    /// What is made with a plugin in it, and its door.
    pub fn shared_with<T>(make: impl FnOnce() -> T) -> (T, Arc<Self>) {
        let door = Arc::new(Self::default());
        SHARED.set(Some(door.clone()));
        let made = make();
        SHARED.take();
        (made, door)
    }

    /// The host has it activated, or no longer.
    pub fn be_active(&self, active: bool) {
        self.active.store(active, Ordering::Relaxed);
    }

    /// Whether a host that had stopped may be asked to go on: one that has not activated the plugin is not to do so for that.
    pub fn is_active(&self) -> bool {
        self.active.load(Ordering::Relaxed)
    }

    /// The host hides the editor, or no longer.
    pub fn hide(&self, hidden: bool) {
        self.hidden.store(hidden, Ordering::Relaxed);
    }

    /// Whether nobody can see the editor, even if it is open.
    pub fn is_hidden(&self) -> bool {
        self.hidden.load(Ordering::Relaxed)
    }

    /// What is played may ring on for so long from now on.
    pub fn ring(&self, samples: u32) {
        self.tail.store(samples, Ordering::Relaxed);
    }

    /// For how long it may, as hosts are told, whatever sounds: many ask only before there is anything, and cut what they export
    /// by it. What the plugin says of the present is longer where it is endless.
    pub fn tail(&self, said: u32) -> u32 {
        said.max(self.tail.load(Ordering::Relaxed))
    }
}
