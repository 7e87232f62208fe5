//! What is timed.

mod bare;
mod by_hand;
mod chord;
mod instruments;
mod points;
mod strings;

pub use bare::{Bare, Linear};
pub use by_hand::ByHand;
pub use instruments::{Steps, chord, silent, strings_of};
pub use strings::{OneString, over_frets};

/// Samples of one measurement: a tenth of a second at 48 kHz.
pub const SAMPLES: usize = 4800;
