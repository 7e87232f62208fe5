//! Helpers shared by the promise tests.

pub mod cases;
pub mod clicks;
pub mod command;
pub mod dense;
pub mod desk;
pub mod hands;
pub mod host;
pub mod labelled;
pub mod labelled_pitch;
pub mod midi;
pub mod npz;
pub mod numbers;
pub mod pages;
pub mod paper;
pub mod parameters;
#[cfg(feature = "pictures")]
pub mod pictures;
pub mod pitch;
pub mod plain_string;
pub mod ringing;
pub mod scenes;
pub mod session;
pub mod stage;
pub mod user;
pub mod watch;
