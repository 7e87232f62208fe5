//! Two sets of values, A and B, to be compared by ear.

use nice_plug::params::internals::ParamPtr;
use nice_plug::prelude::Params;

use super::Given;
use super::noted::put;
use crate::plugin::shelf::Kept;

/// Parameters and their values, 0 to 1.
pub type Values = Vec<(ParamPtr, f32)>;

/// A set-up file to be played: its number, and what that stands for if it is not what the folder has.
pub type File = (u32, Option<Kept>);

/// A whole set of values.
#[derive(Debug)]
struct Set {
    values: Values,
    file: File,
}

/// Two sets of values, of which one is heard.
#[derive(Debug, Default)]
pub struct Compare {
    /// Whether B is heard.
    pub is_b: bool,
    /// The one that is not heard; none if it is the same.
    other: Option<Set>,
}

impl Compare {
    /// Hears A or B.
    pub fn hear(&mut self, given: &Given, b: bool) {
        if self.is_b == b {
            return;
        }
        self.is_b = b;
        let present = Set::present(given);
        if let Some(Set { values, file }) = self.other.replace(present) {
            change(given, &values, file);
        }
    }

    /// Makes the one that is not heard the same as the other.
    pub fn copy(&mut self) {
        self.other = None;
    }
}

impl Set {
    /// All values as they are.
    fn present(given: &Given) -> Self {
        let number = given.history.number();
        let map = given.params.param_map().into_iter();
        let values = map.map(|(_, param, _)| (param, given.history.asked.value(param))).collect();
        Self { values, file: (number, given.params.shelf.held(number)) }
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
