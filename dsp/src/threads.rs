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
    /// less the threads cost; some thousand samples are enough. Over a body, and while another instrument fades
    /// ([`Instrument::hand_over`]), one thread does it all. It allocates, begins threads and waits for them: it is not for a thread
    /// of sound.
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
        self.play_by(threads, stems, left, right);
    }

    /// The same; gives back how many threads have shared the work.
    fn play_by(
        &mut self,
        threads: NonZeroUsize,
        stems: &mut [&mut [f32]],
        left: &mut [f32],
        right: &mut [f32],
    ) -> usize {
        let count = left.len().min(right.len());
        let threads = threads.get().min(self.voices.len());
        if threads == 1 || self.together > 1 || count == 0 || self.is_fading() {
            self.process_stems(stems, left, right);
            return 1;
        }
        let now = self.now;
        let last = now + (count - 1) as u64;
        let gestures: Vec<_> = std::iter::from_fn(|| self.queue.pop_due(last)).collect();
        let shared = share(threads, self.voices.iter_mut().enumerate(), |(index, string)| {
            together::play(string, now, gestures.iter().filter(|gesture| gesture.string == index), count);
        });
        self.mix(0..count, stems, left, right);
        shared
    }
}

/// Has tasks done, each by whichever of so many threads is free, this one among them; gives back how many there were.
fn share<T>(threads: usize, tasks: impl Iterator<Item = T> + Send, does: impl Fn(T) + Sync) -> usize {
    let tasks = Mutex::new(tasks);
    let next = || tasks.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work = || {
        while let Some(task) = next() {
            does(task);
        }
    };
    thread::scope(|scope| {
        // Where the system has no more threads, those that there are do its work.
        let others =
            (1..threads).filter(|_| thread::Builder::new().spawn_scoped(scope, work).is_ok()).count();
        work();
        1 + others
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Condvar;
    use std::time::Duration;

    use super::*;
    use crate::quality::Quality;
    use crate::setup::Setup;

    /// Each task ends only when all are under way: one thread alone would wait for the second with the first in its hands.
    #[test]
    fn tasks_are_done_at_the_same_time() {
        for threads in [2, 3] {
            let (under_way, more) = (Mutex::new(0), Condvar::new());
            let shared = share(threads, 0..threads, |_| {
                let mut count = under_way.lock().unwrap_or_else(PoisonError::into_inner);
                *count += 1;
                more.notify_all();
                // A minute is for ever: it has what does not come fail instead of hang.
                let met = more.wait_timeout_while(count, Duration::from_secs(60), |count| *count < threads);
                assert!(met.is_ok_and(|(count, _)| *count == threads), "nobody else works");
            });
            assert_eq!(shared, threads);
        }
    }

    #[test]
    fn as_many_threads_as_are_asked_for_share_the_strings() {
        let shared = |name: &str, threads: usize| {
            let setup = Setup::builtin(name).expect("it is built in");
            let settings = Quality::Draft.settings(48_000.0);
            let mut instrument = Instrument::new(&setup, &settings).expect("it can be built");
            let (mut left, mut right) = ([0.0; 16], [0.0; 16]);
            let threads = NonZeroUsize::new(threads).expect("there is one");
            instrument.play_by(threads, &mut [], &mut left, &mut right)
        };
        // No more than there are strings; and those over a body are one thread's work.
        for (name, asked, expected) in
            [("electric", 1, 1), ("electric", 2, 2), ("electric", 64, 6), ("bass", 64, 4), ("steel", 2, 1)]
        {
            assert_eq!(shared(name, asked), expected, "{name} by {asked}");
        }
    }
}
