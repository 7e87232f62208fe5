//! Lists whose clones have room for as much.

use std::ops::{Deref, DerefMut};

/// A list whose clones have as much room as itself, so that stepping a clone allocates no more than stepping what it was
/// cloned from. (Those of a `Vec` have room for what is in it at that moment.)
#[derive(Debug, PartialEq)]
pub struct Roomy<T>(Vec<T>);

impl<T> Roomy<T> {
    /// An empty list with room for so many.
    pub(crate) fn with_capacity(capacity: usize) -> Self {
        Roomy(Vec::with_capacity(capacity))
    }
}

impl<T: Clone> Clone for Roomy<T> {
    fn clone(&self) -> Self {
        let mut list = Vec::with_capacity(self.0.capacity());
        list.extend_from_slice(&self.0);
        Roomy(list)
    }
}

impl<T> Deref for Roomy<T> {
    type Target = Vec<T>;
    #[inline(always)]
    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T> DerefMut for Roomy<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

impl<'a, T> IntoIterator for &'a Roomy<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;
    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<'a, T> IntoIterator for &'a mut Roomy<T> {
    type Item = &'a mut T;
    type IntoIter = std::slice::IterMut<'a, T>;
    #[inline(always)]
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter_mut()
    }
}
