//! Pictures of what Low Action computes, as SVG.
//!
//! ```text
//! Simulation ─> Course, Profile, Ground ─> Panel (axes and layers) ─> Sheet (title, key, caption) ─> SVG
//! ```
//!
//! - A [`Course`] keeps one number of every sample of a run, however long, in a bounded number of bins.
//! - A [`Profile`] is the string at one moment, a [`Ground`] what lies under it.
//! - A [`Panel`] is one pair of axes with [`Layer`]s over them, a [`Sheet`] a page of panels.
//! - A [`SceneFigure`] watches any scene while it runs and makes such a page of it.
//!
//! The same run gives the same text on every machine: logarithms come from `libm`, and what is drawn is
//! rounded to whole units of a large page.

pub mod axis;
pub mod course;
pub mod describe;
pub mod ground;
mod key;
pub mod panel;
pub mod scene;
pub mod sheet;
pub mod style;

pub use axis::Axis;
pub use course::Course;
pub use ground::{Ground, Profile};
pub use panel::{Layer, Panel};
pub use scene::SceneFigure;
pub use sheet::Sheet;
pub use style::Stroke;
