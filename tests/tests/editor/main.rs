//! The plugin's editor, without a window: each file is a promise.

mod controls;
mod habits;
mod handles;
mod hands;
mod history;
mod keys;
mod lights;
mod narrow;
mod numbers;
mod side;
mod wheel;
