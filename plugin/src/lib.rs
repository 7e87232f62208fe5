//! Low Action.

pub mod cli;
pub mod demo;
pub mod engine;
pub mod midi_file;
pub mod performance;
