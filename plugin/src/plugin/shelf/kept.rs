//! The file that a session keeps, and how it is saved with it.

use std::sync::atomic::Ordering;

use nice_plug::params::persist::PersistentField;
use serde::{Deserialize, Serialize};

use super::{NO_FILE, NONE, Shelf, lock};

/// A set-up file that is kept with the session.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Kept {
    pub(super) number: u32,
    pub(super) name: String,
    pub(super) text: String,
}

impl Kept {
    /// The number under which it can be chosen.
    #[cfg(feature = "editor")]
    pub(crate) fn number(&self) -> u32 {
        self.number
    }
}

/// What a session saves of the shelf.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Saved(Option<Kept>);

impl<'a> PersistentField<'a, Saved> for Shelf {
    fn set(&self, Saved(saved): Saved) {
        let mut kept = lock(&self.0.kept);
        let number = saved.as_ref().map_or(NONE, |saved| saved.number);
        *kept = saved;
        *lock(&self.0.promised) = None;
        self.0.awaited.store(NONE, Ordering::Release);
        self.0.stands_for.store(number, Ordering::Relaxed);
        self.0.edition.fetch_add(1, Ordering::Relaxed);
        self.0.loads.fetch_add(1, Ordering::Relaxed);
    }

    fn map<F, R>(&self, read: F) -> R
    where
        F: Fn(&Saved) -> R,
    {
        let number = self.0.chosen.load(Ordering::Relaxed);
        if number == NONE {
            return read(&Saved(None));
        }
        // What cannot be read is saved by its name, so that whoever opens the session learns what is missing.
        let missing = |_| {
            let name = self.file(number).map_or_else(|| NO_FILE.into(), |file| file.name);
            Kept { number, name, text: String::new() }
        };
        read(&Saved(Some(self.take_up(number).unwrap_or_else(missing))))
    }
}
