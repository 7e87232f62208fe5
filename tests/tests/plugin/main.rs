//! The plugin in a host: each file is a promise.

mod announced;
mod budget;
mod controls;
mod disorder;
mod documents;
mod exchange;
mod links;
mod modulated;
mod notes;
mod outputs;
mod parameters;
mod passes;
mod plays;
mod rest;
mod sessions;
mod told;
mod waking;
