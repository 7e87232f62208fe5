//! Where engines are built and taken apart: a thread beside the audio thread.
//!
//! Orders go in, finished replacements come out, and what was replaced comes back to be dropped here. The
//! queues are bounded and without locks; the audio thread neither allocates nor waits, except where the
//! host renders offline and [`Workshop::wait`] is what makes a rendering repeatable.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crossbeam::queue::ArrayQueue;

use super::order::Order;
use super::shelf::Shelf;
use crate::engine::Replacement;

/// A replacement, or why there is none, in one line.
type Built = Result<Box<Replacement>, String>;

/// What came of an order.
pub(super) struct Finished {
    pub order: Order,
    pub result: Built,
}

/// The door between the two threads.
struct Counter {
    /// The latest order; an older one that was not begun yet is dropped.
    orders: ArrayQueue<Order>,
    finished: ArrayQueue<Finished>,
    /// What is no longer needed.
    used: ArrayQueue<Built>,
    closing: AtomicBool,
}

/// A workshop and its thread.
pub(super) struct Workshop {
    counter: Arc<Counter>,
    thread: Option<JoinHandle<()>>,
}

/// How long the thread sleeps if nobody wakes it, and the audio thread while it waits offline.
const NAP: Duration = Duration::from_millis(250);
const SHORT_NAP: Duration = Duration::from_micros(200);

impl Workshop {
    /// Opens it; starts the thread.
    pub fn open(shelf: Shelf) -> std::io::Result<Self> {
        let counter = Arc::new(Counter {
            orders: ArrayQueue::new(1),
            finished: ArrayQueue::new(2),
            used: ArrayQueue::new(16),
            closing: AtomicBool::new(false),
        });
        let inside = counter.clone();
        let thread =
            thread::Builder::new().name("low-action workshop".into()).spawn(move || work(&inside, &shelf))?;
        Ok(Self { counter, thread: Some(thread) })
    }

    /// Orders an engine; one that was ordered before and not begun is forgotten.
    pub fn order(&self, order: Order) {
        self.counter.orders.force_push(order);
        self.wake();
    }

    /// What has been finished, if anything.
    pub fn collect(&self) -> Option<Finished> {
        self.counter.finished.pop()
    }

    /// Waits for an order to be finished; for offline rendering only. Nothing if the workshop has failed.
    pub fn wait(&self, order: &Order) -> Option<Finished> {
        loop {
            match self.collect() {
                Some(finished) if finished.order == *order => return Some(finished),
                Some(other) => self.give_back(other.result),
                None if self.thread.as_ref().is_none_or(JoinHandle::is_finished) => return None,
                None => thread::sleep(SHORT_NAP),
            }
        }
    }

    /// Takes back what is no longer needed.
    pub fn give_back(&self, used: Built) {
        // The queue has room for more than can be under way; should it ever be full, forgetting is the
        // one thing that neither blocks nor gives back memory here.
        if let Err(used) = self.counter.used.push(used) {
            std::mem::forget(used);
        }
        self.wake();
    }

    fn wake(&self) {
        if let Some(thread) = &self.thread {
            thread.thread().unpark();
        }
    }
}

impl Drop for Workshop {
    fn drop(&mut self) {
        self.counter.closing.store(true, Ordering::Relaxed);
        self.wake();
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

/// The life of the thread.
fn work(counter: &Counter, shelf: &Shelf) {
    while !counter.closing.load(Ordering::Relaxed) {
        while counter.used.pop().is_some() {}
        match counter.orders.pop() {
            Some(order) => {
                let result = order.build(shelf, Replacement::new).map(Box::new);
                if let Err(problem) = &result {
                    shelf.tell_also(format!("{problem}; what was there before plays on"));
                }
                // What nobody has collected is outdated by now.
                counter.finished.force_push(Finished { order, result });
            }
            None => thread::park_timeout(NAP),
        }
    }
}
