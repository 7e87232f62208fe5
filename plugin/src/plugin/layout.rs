//! How the editor was left: its size, what was seen in it. A session keeps it, or a file where there is none, and
//! nothing of the sound depends on it.

use std::fs;
use std::path::Path;
use std::sync::{Arc, Mutex};

use anyhow::{Context, Result};
use nice_plug::params::persist::PersistentField;
use serde::{Deserialize, Serialize};

use crate::files;
use crate::locked::lock;

/// Usual size of the window, in points.
pub const SIZE: [f32; 2] = [1120.0, 760.0];
/// Least and largest size of the window, whatever the size of what is in it, and of that, as parts of the usual one.
pub const SIZES: [f32; 2] = [0.5, 3.0];

/// What the computer's keys are, where there is no host that wants them for itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum KeyMap {
    /// A piano.
    #[default]
    Piano,
    /// Frets along strings.
    Frets,
}

/// What the computer's keys play.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Keyboard {
    /// What they are.
    pub map: KeyMap,
    /// Octaves by which the piano is moved up.
    pub octave: i32,
    /// The string of the upper row, counted from 0.
    pub string: usize,
    /// The fret of the first key of each row, 0 for the open string.
    pub fret: usize,
}

/// What was seen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Seen {
    /// Which panel, counted from 0.
    pub panel: usize,
    /// The string seen from the side, counted from 0.
    pub string: usize,
    /// Of the window, points, which are as large as everything in it; none before it was ever open.
    pub size: Option<[f32; 2]>,
    /// Of everything in it, 1 as usual.
    pub zoom: f32,
    /// What the computer's keys play.
    pub keys: Keyboard,
}

impl Default for Seen {
    fn default() -> Self {
        Self { panel: 0, string: 0, size: None, zoom: 1.0, keys: Keyboard::default() }
    }
}

impl Seen {
    /// The same with sizes that a window can have.
    fn admitted(self) -> Self {
        let [least, largest] = SIZES;
        let fit = |value: f32, usual: f32| match value.is_finite() {
            true => value.clamp(least * usual, largest * usual),
            false => usual,
        };
        let zoom = fit(self.zoom, 1.0);
        // In a window of the same size there are fewer points the larger they are.
        let [usual_width, usual_height] = SIZE.map(|usual| usual / zoom);
        let size = self.size.map(|[width, height]| [fit(width, usual_width), fit(height, usual_height)]);
        Self { size, zoom, ..self }
    }
}

/// Keeps it, for all that share it; the audio thread never looks.
#[derive(Debug, Clone, Default)]
pub struct Layout(Arc<Mutex<Seen>>);

impl Layout {
    /// What was seen last.
    pub fn seen(&self) -> Seen {
        *lock(&self.0)
    }

    /// Keeps what is seen now.
    pub fn keep(&self, seen: Seen) {
        *lock(&self.0) = seen.admitted();
    }

    /// Has the computer's keys play something else.
    pub fn set_keys(&self, keys: Keyboard) {
        self.keep(Seen { keys, ..self.seen() });
    }

    /// Becomes what [`save`](Self::save) has written; stays as it is where there is no such file.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn load(&self, path: &Path) -> Result<()> {
        let describe = || format!("cannot read how the window was left in {}", path.display());
        if path.exists() {
            let text = fs::read_to_string(path).with_context(describe)?;
            self.keep(serde_json::from_str(&text).with_context(describe)?);
        }
        Ok(())
    }

    /// Writes it, for the next time, in a folder that is made if need be.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(&self.seen())?;
        files::put(path, &text).context("cannot keep how the window was left")
    }
}

impl<'a> PersistentField<'a, Seen> for Layout {
    fn set(&self, seen: Seen) {
        self.keep(seen);
    }

    fn map<F, R>(&self, read: F) -> R
    where
        F: Fn(&Seen) -> R,
    {
        read(&self.seen())
    }
}
