//! The same done with many things, on several threads.

use std::convert::Infallible;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// What is made of each thing, on as many threads as there are processors, in their order whichever is done first. Whoever makes it
/// is told the thing's number, too.
pub fn each<T: Sync, R: Send>(things: &[T], make: impl Fn(usize, &T) -> R + Sync) -> Vec<R> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let Ok(made) = try_each(threads, things, |number, thing| Ok::<_, Infallible>(make(number, thing)));
    made
}

/// The same on so many threads, of what can fail: then nothing more is begun.
pub fn try_each<T: Sync, R: Send, E: Send>(
    threads: usize,
    things: &[T],
    make: impl Fn(usize, &T) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    let (next, made) = (AtomicUsize::new(0), Mutex::new(Vec::with_capacity(things.len())));
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(thing) = things.get(number) else { break };
            let one = make(number, thing);
            if one.is_err() {
                next.store(things.len(), Ordering::Relaxed);
            }
            made.lock().unwrap_or_else(|broken| broken.into_inner()).push((number, one));
        }
    };
    let threads = threads.clamp(1, things.len().max(1));
    // Whoever waits for them panics with them.
    thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let mut made = made.into_inner().unwrap_or_else(|broken| broken.into_inner());
    made.sort_unstable_by_key(|&(number, _)| number);
    made.into_iter().map(|(_, one)| one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_made_comes_in_order() {
        let things: Vec<u64> = (0..100).collect();
        // Those in front take longest.
        let made = each(&things, |number, &thing| {
            thread::sleep(std::time::Duration::from_micros(10 * (100 - thing)));
            (number as u64, 2 * thing)
        });
        assert_eq!(made, things.iter().map(|&thing| (thing, 2 * thing)).collect::<Vec<_>>());
        assert!(each(&[], |_, &(): &()| ()).is_empty());
    }

    #[test]
    fn nothing_is_begun_once_something_has_failed() {
        let begun = AtomicUsize::new(0);
        let made = try_each(1, &[1, 2, 3, 4], |_, &thing| {
            begun.fetch_add(1, Ordering::Relaxed);
            if thing == 2 { Err("two") } else { Ok(thing) }
        });
        assert_eq!((made, begun.into_inner()), (Err("two"), 2));
        assert_eq!(try_each(3, &[1, 2], |_, &thing| Ok::<_, ()>(2 * thing)), Ok(vec![2, 4]));
    }
}
