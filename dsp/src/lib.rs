//! The physics of Low Action.
//!
//! Scene → [`Model`] (coefficients) → [`State`] stepped by a [`Drive`] → strings → samples.

pub mod contact;
pub mod curve;
pub mod drive;
pub mod energy;
pub mod error;
mod filter;
pub mod gesture;
pub mod grid;
mod hands;
pub mod instrument;
pub mod intonation;
mod kernel;
pub mod model;
pub mod neck;
pub mod pickup;
mod queue;
mod ramp;
mod response;
pub mod scene;
pub mod setup;
pub mod simulation;
mod solver;
pub mod state;
pub mod string;

pub use drive::Drive;
pub use energy::{Energies, Entry, Ledger};
pub use error::Error;
pub use gesture::{FINGERS_PER_STRING, FingerSlot, Gesture, TimedGesture, Touch};
pub use instrument::{EngineSettings, Instrument, QueueFull, StringGeometry};
pub use model::{Barrier, Model, StringParameters};
pub use scene::{Scene, SolverSettings, Stencil};
pub use setup::Setup;
pub use simulation::Simulation;
pub use solver::Convergence;
pub use state::State;
pub use string::Scratch;
