//! Mutexes whose contents no panicking thread can have left half-done.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Locks one, whatever has become of those who had locked it before.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
