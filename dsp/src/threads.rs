//! Strings shared out among threads, for rendering. Those that do not hear each other can each be played through a whole
//! stretch by whichever thread is free, and what they have played is added up in their order as ever: the same bits. Strings over a
//! body are one thread's work.

use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};
use std::thread;

use crate::instrument::Instrument;
use crate::together;

impl Instrument {
    /// The samples of [`Instrument::process_stems`], the strings shared out among so many threads. The longer the stretch, the
    /// less the threads cost; some thousand samples are enough. Over a body one thread does it all. It allocates, begins threads and waits for them: it is not for
    /// a thread of sound. While another instrument fades ([`Instrument::hand_over`]) one thread does it all.
    ///
    /// # Panics
    /// When a stem is shorter than the two channels.
    pub fn process_stems_by(
        &mut self,
        threads: NonZeroUsize,
        stems: &mut [&mut [f32]],
        left: &mut [f32],
        right: &mut [f32],
    ) {
        let count = left.len().min(right.len());
        let threads = threads.get().min(self.voices.len());
        if threads == 1 || self.together > 1 || count == 0 || self.is_fading() {
            return self.process_stems(stems, left, right);
        }
        let now = self.now;
        let last = now + (count - 1) as u64;
        let gestures: Vec<_> = std::iter::from_fn(|| self.queue.pop_due(last)).collect();
        let strings = Mutex::new(self.voices.iter_mut().enumerate());
        let next = || strings.lock().unwrap_or_else(PoisonError::into_inner).next();
        let work = || {
            while let Some((index, string)) = next() {
                together::play(string, now, gestures.iter().filter(|gesture| gesture.string == index), count);
            }
        };
        thread::scope(|scope| {
            for _ in 1..threads {
                // Where the system has no more threads, those that there are do its work.
                let _ = thread::Builder::new().spawn_scoped(scope, work);
            }
            work();
        });
        self.mix(0..count, stems, left, right);
    }
}
