//! `cargo xtask figures`: draws the pictures of the documentation from scenes in the repository.
//!
//! Each figure is one entry of [`FIGURES`] and one module. Scenes are run through the same library as
//! everything else, so that a picture cannot disagree with the code.

mod string_over_frets;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use low_action_dsp::Scene;

/// One picture.
struct Figure {
    /// Its name on the command line; the picture is `NAME.svg`.
    name: &'static str,
    /// Draws it from the scenes in the first folder to the file.
    draw: fn(&Path, &Path) -> Result<()>,
}

/// Every picture, in the order in which they are drawn.
const FIGURES: &[Figure] = &[Figure { name: "string_over_frets", draw: string_over_frets::draw }];

/// Draws the figures named, or all of them, into `docs/figures`.
///
/// # Errors
/// When a name is unknown, a scene cannot be read or a picture cannot be written.
pub fn run(names: &[String]) -> Result<()> {
    if let Some(unknown) = names.iter().find(|name| FIGURES.iter().all(|figure| figure.name != **name)) {
        let known: Vec<_> = FIGURES.iter().map(|figure| figure.name).collect();
        bail!("unknown figure `{unknown}`: there are {}", known.join(", "));
    }
    let folder = folder();
    for figure in FIGURES {
        if names.is_empty() || names.iter().any(|name| name == figure.name) {
            let file = folder.join(figure.name).with_extension("svg");
            (figure.draw)(&folder, &file).with_context(|| format!("figure `{}`", figure.name))?;
            println!("wrote {}", file.display());
        }
    }
    Ok(())
}

/// Where scenes are read and pictures written.
fn folder() -> PathBuf {
    // `cargo xtask` may be called from anywhere within the repository.
    let package =
        std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from("xtask"), PathBuf::from);
    package.parent().unwrap_or(Path::new("")).join("docs/figures")
}

/// Reads a scene.
fn scene(folder: &Path, name: &str) -> Result<Scene> {
    let path = folder.join(name).with_extension("toml");
    let text = std::fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
    Scene::from_toml(&text).with_context(|| format!("in {}", path.display()))
}

/// Colours that stay apart for every kind of colour vision: of the set by Okabe and Ito (2008).
mod colour {
    use plotters::style::RGBColor;

    /// The string.
    pub const STRING: RGBColor = RGBColor(0, 114, 178);
    /// Where something touches.
    pub const CONTACT: RGBColor = RGBColor(213, 94, 0);
    /// Board.
    pub const BOARD: RGBColor = RGBColor(231, 220, 200);
    /// Frets, nut and saddle.
    pub const METAL: RGBColor = RGBColor(110, 110, 110);
    /// Text and axes.
    pub const INK: RGBColor = RGBColor(40, 40, 40);
    /// Lines behind the picture.
    pub const FAINT: RGBColor = RGBColor(215, 215, 215);
}
