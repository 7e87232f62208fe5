//! Two sets of values, A and B, to be compared by ear.

use nice_plug::params::internals::ParamPtr;
use nice_plug::prelude::Params;

use super::Given;
use super::history::put;

/// Parameters and their values, 0 to 1.
pub type Values = Vec<(ParamPtr, f32)>;

/// Two sets of values, of which one is heard.
#[derive(Debug, Default)]
pub struct Compare {
    /// Whether B is heard.
    pub is_b: bool,
    /// The one that is not heard; none if it is the same.
    other: Option<Values>,
}

impl Compare {
    /// Hears A or B.
    pub fn hear(&mut self, given: &Given, b: bool) {
        if self.is_b == b {
            return;
        }
        self.is_b = b;
        let present = values(given);
        if let Some(other) = self.other.replace(present) {
            change(given, &other);
        }
    }

    /// Makes the one that is not heard the same as the other.
    pub fn copy(&mut self) {
        self.other = None;
    }
}

/// All values as they are.
fn values(given: &Given) -> Values {
    let map = given.params.param_map().into_iter();
    // SAFETY: the pointers lead into the parameters, which outlive this.
    map.map(|(_, param, _)| (param, unsafe { param.unmodulated_normalized_value() })).collect()
}

/// Sets those that are different, as one entry of the history.
pub fn change(given: &Given, values: &[(ParamPtr, f32)]) {
    let host = given.setter.raw_context;
    given.history.together(|| {
        for &(param, value) in values {
            // SAFETY: the pointers lead into the parameters, which outlive this.
            if unsafe { param.unmodulated_normalized_value() } != value {
                put(host, param, value);
            }
        }
    });
}
