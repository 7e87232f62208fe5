//! Low Action.

pub mod cli;
pub mod controls;
pub mod demo;
pub mod display;
#[cfg(feature = "editor")]
pub mod editor;
pub mod engine;
mod files;
pub mod midi_file;
pub mod params;
pub mod performance;
pub mod plugin;
pub mod pointer;
pub mod setups;
#[cfg(feature = "standalone")]
pub mod standalone;
