//! Two sets of values, A and B, to be compared by ear.

use std::sync::{Mutex, MutexGuard};

use nice_plug::params::internals::ParamPtr;

use super::Given;
use super::noted::put;
use crate::locked::lock;
use crate::plugin::shelf::Kept;

/// Parameters and their values, 0 to 1.
pub type Values = Vec<(ParamPtr, f32)>;

/// A set-up file to be played: its number, and what that stands for if it is not what the folder has.
pub type File = (u32, Option<Kept>);

/// A whole set of values.
#[derive(Debug)]
pub(crate) struct Set {
    /// All values.
    pub values: Values,
    /// The file that is played.
    pub file: File,
}

#[derive(Debug, Default)]
struct Inside {
    is_b: bool,
    /// The one that is not heard; none if it is the same.
    other: Option<Set>,
}

/// Two sets of values, of which one is heard. The history has them: who goes back over a change from one to the other hears the
/// other again, under its own letter.
#[derive(Debug, Default)]
pub struct Compare(Mutex<Inside>);

impl Compare {
    /// Whether B is heard.
    pub fn is_b(&self) -> bool {
        self.inside().is_b
    }

    /// Makes the one that is not heard the same as the other.
    pub fn copy(&self) {
        self.inside().other = None;
    }

    /// A or B is to be heard from now on: keeps what was heard if that is the other one, and gives back what it is itself
    /// if it is not the same.
    pub(crate) fn turn(&self, b: bool, present: impl FnOnce() -> Set) -> Option<Set> {
        let mut inside = self.inside();
        if inside.is_b == b {
            return None;
        }
        inside.is_b = b;
        inside.other.replace(present())
    }

    /// Both are the same, and A is heard.
    pub fn forget(&self) {
        *self.inside() = Inside::default();
    }

    fn inside(&self) -> MutexGuard<'_, Inside> {
        lock(&self.0)
    }
}

/// Hears A or B.
pub fn hear(given: &Given, b: bool) {
    let history = given.history;
    let was_b = history.compare.is_b();
    if let Some(Set { values, file }) = history.compare.turn(b, || history.present()) {
        history.together(|| {
            history.turns_from(was_b);
            change(given, &values, file);
        });
    }
}

/// Sets those that are different and plays a file, as one entry of the history.
pub fn change(given: &Given, values: &[(ParamPtr, f32)], (number, file): File) {
    let host = given.setter.raw_context;
    given.history.together(|| {
        given.history.play_file(number, file);
        for &(param, value) in values {
            if given.history.asked.value(param) != value {
                put(host, param, value);
            }
        }
    });
}
