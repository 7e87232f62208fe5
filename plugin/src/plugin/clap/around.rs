//! The framework's functions of an extension, and ours around them.

use std::sync::OnceLock;

/// Both, once they are known: the same for all instances.
pub(super) struct Around<T>(OnceLock<[T; 2]>);

impl<T: Copy> Around<T> {
    pub const fn new() -> Self {
        Self(OnceLock::new())
    }

    /// What ours are, made of the framework's the first time; nothing for nothing.
    ///
    /// # Safety
    /// The extension must be null or the framework's, whose functions are the same each time.
    pub unsafe fn around(&'static self, extension: *const T, ours: impl FnOnce(&T) -> T) -> *const T {
        // SAFETY: as above.
        let Some(inner) = (unsafe { extension.as_ref() }) else { return std::ptr::null() };
        let [_, outer] = self.0.get_or_init(|| [*inner, ours(inner)]);
        outer
    }

    /// The framework's.
    pub fn inner(&self) -> Option<&T> {
        self.0.get().map(|[inner, _]| inner)
    }
}
