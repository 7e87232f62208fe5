//! What the parameters begin with, where there is no host to set them.

use std::sync::atomic::AtomicU64;
use std::sync::{Arc, OnceLock};

use super::{InstrumentChoice, Setting};
use crate::engine::Quality;
use crate::plugin::layout::Layout;

/// What to begin with.
#[derive(Debug, Clone, Default)]
pub struct Start {
    /// Instrument that comes with the program.
    pub instrument: InstrumentChoice,
    /// A set-up that is played in its place: name and text.
    pub file: Option<(String, String)>,
    /// How much computing.
    pub quality: Quality,
    /// What is set of everything else, the later ones in place of those before.
    pub settings: Vec<Setting>,
    /// Whether there is no display to open a window on.
    pub windowless: bool,
    /// How the window was left; all that are made share it.
    pub layout: Layout,
    /// How many blocks of sound have been asked for; all that are made count them together.
    pub blocks: Arc<AtomicU64>,
}

static START: OnceLock<Start> = OnceLock::new();

/// Has all plugins that are made from now on begin so; the first time counts.
pub fn begin_with(start: Start) {
    START.get_or_init(|| start);
}

/// What to begin with: what is usual, unless something else was said.
pub(crate) fn start() -> Start {
    START.get().cloned().unwrap_or_default()
}
