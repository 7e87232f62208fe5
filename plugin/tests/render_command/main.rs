//! The promise of `low-action render`: it plays what can be played, refuses the rest in one clear line
//! with the right exit code, and never leaves half a file. Run on the program itself.

// A panic is a test's report.
#![allow(clippy::unwrap_used)]

mod hands;
mod in_vain;
mod labels;
mod left_out;
#[cfg(target_os = "linux")]
mod mounted;
#[cfg(unix)]
mod open_already;
mod refusals;
mod room;
mod skipping;
mod sounds;
mod tails;
mod threads;
