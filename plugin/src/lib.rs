//! Low Action.

pub mod cli;
pub mod controls;
pub mod demo;
pub mod engine;
pub mod midi_file;
pub mod params;
pub mod performance;
pub mod plugin;
pub mod setups;
#[cfg(feature = "standalone")]
pub mod standalone;
