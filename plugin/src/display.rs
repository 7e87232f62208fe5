//! What the editor sees of the strings: still pictures, one way, some sixty a second.
//!
//! [`display()`] makes a pair. The [`Writer`] belongs to the audio thread, which fills a [`Snapshot`] now and then
//! while somebody looks; the [`Reader`] belongs to the editor, which looks at the latest. The snapshots are made
//! once and go round through two bounded queues without locks: nothing is allocated, nobody waits, and nothing the
//! audio thread does depends on whether anybody looks.

mod fill;
mod snapshot;

use std::sync::Arc;

use crossbeam::queue::ArrayQueue;

use crate::engine::Engine;
pub use snapshot::{FingerSeen, FretSeen, POINTS, PluckSeen, Snapshot, StringSeen};

/// Snapshots a second at most: as many as a screen shows.
pub const RATE: f64 = 60.0;

/// Snapshots a second of strings that are still, which look the same in all of them.
const STILL_RATE: f64 = 4.0;

/// Level of the sound, 1 is full scale, below which strings are still: what moves them is seen no more, and the meter shows
/// nothing.
const STILL: f64 = 1e-4;

/// Snapshots on their way at once: one being filled, one waiting and one on its way back.
const UNDER_WAY: usize = 3;

/// The queues between the two sides.
#[derive(Debug)]
struct Queues {
    /// Filled and not yet seen, the latest last.
    filled: ArrayQueue<Box<Snapshot>>,
    /// Seen, to be filled again.
    seen: ArrayQueue<Box<Snapshot>>,
}

/// How the machine copes, as a snapshot tells it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Health {
    /// Part of the available time that the sound takes, 1 is all there is.
    pub load: f32,
    /// Whether contacts are solved less exactly because there is not time enough.
    pub relaxed: bool,
}

impl Health {
    /// Above this part of the available time contacts are solved less exactly.
    pub const LATE: f64 = 0.85;
}

/// The side of the audio thread.
#[derive(Debug)]
pub struct Writer {
    queues: Arc<Queues>,
    looked_at: bool,
    /// Samples since the last snapshot.
    waited: f64,
    written: u64,
    /// Whether all strings were still in the last snapshot.
    still: bool,
}

/// The side of the editor.
#[derive(Debug)]
pub struct Reader {
    queues: Arc<Queues>,
    latest: Box<Snapshot>,
}

/// Makes a writer and its reader; allocates all that they will ever use.
pub fn display() -> (Writer, Reader) {
    let queues = Arc::new(Queues { filled: ArrayQueue::new(UNDER_WAY), seen: ArrayQueue::new(UNDER_WAY) });
    for _ in 0..UNDER_WAY {
        // There is room for exactly so many.
        queues.seen.push(Box::default()).ok();
    }
    let writer =
        Writer { queues: queues.clone(), looked_at: false, waited: f64::INFINITY, written: 0, still: false };
    (writer, Reader { queues, latest: Box::default() })
}

impl Writer {
    /// Whether somebody looks; to be said before a block is played.
    pub fn look(&mut self, looked_at: bool, engine: &mut Engine) {
        engine.observe(looked_at);
        if looked_at && !self.looked_at {
            self.waited = f64::INFINITY;
        }
        self.looked_at = looked_at;
    }

    /// Takes a snapshot if somebody looks and it is time for one, after a block of so many samples; says whether it
    /// did.
    pub fn write(&mut self, engine: &mut Engine, samples: usize, health: Health) -> bool {
        self.waited += samples as f64;
        let still = engine.level() < STILL;
        let rate = if still && self.still { STILL_RATE } else { RATE };
        if !self.looked_at || self.waited * rate < engine.instrument().sample_rate() {
            return false;
        }
        // One that nobody has fetched is out of date, but for what has happened in it.
        let missed = self.queues.filled.pop();
        let Some(mut snapshot) = self.queues.seen.pop() else {
            // There are more than the reader can have in its hands.
            missed.map(|missed| self.queues.filled.push(missed));
            return false;
        };
        let looked_on = self.waited.is_finite();
        self.written += 1;
        (self.waited, self.still) = (0.0, still);
        snapshot.fill(engine, self.written, health);
        engine.observe_anew();
        if let Some(missed) = missed {
            // What happened before somebody looked again is over.
            if looked_on {
                snapshot.go_on_from(&missed);
            }
            self.queues.seen.push(missed).ok();
        }
        if let Err(snapshot) = self.queues.filled.push(snapshot) {
            // There is room for all of them; should there not be, forgetting is what neither waits nor frees.
            std::mem::forget(snapshot);
        }
        true
    }
}

impl Reader {
    /// Fetches the latest snapshot; `false` if there is none that has not been seen.
    pub fn fetch(&mut self) -> bool {
        let mut new = false;
        while let Some(mut next) = self.queues.filled.pop() {
            if new {
                next.go_on_from(&self.latest);
            }
            let old = std::mem::replace(&mut self.latest, next);
            self.queues.seen.push(old).ok();
            new = true;
        }
        new
    }

    /// The latest snapshot that was fetched; without strings before the first.
    pub fn latest(&self) -> &Snapshot {
        &self.latest
    }
}
