//! Writes the music of the documentation: a file for each gesture (`docs/gestures`), pieces of ordinary density
//! (`docs/pieces`) and a phrase for each set-up (`docs/phrases`):
//! `cargo run -p low-action --example compose_music`.

mod gestures;
mod phrases;
mod pieces;
mod score;

use std::path::Path;

/// Every file: its path below the root of the repository, and its bytes.
pub fn compose() -> Vec<(String, Vec<u8>)> {
    let gestures =
        gestures::all().into_iter().map(|(name, score)| (format!("docs/gestures/{name}.mid"), score));
    let pieces = pieces::all().into_iter().map(|(name, score)| (format!("docs/pieces/{name}.mid"), score));
    let phrases = phrases::all().into_iter().map(|(name, score)| (format!("docs/phrases/{name}.mid"), score));
    gestures.chain(pieces).chain(phrases).map(|(path, score)| (path, score.into_bytes())).collect()
}

/// Writes the files.
#[allow(dead_code, reason = "the test that compares the committed files includes this one as a module")]
fn main() -> std::io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for (path, bytes) in compose() {
        let path = root.join(path);
        std::fs::create_dir_all(path.parent().unwrap_or(&root))?;
        std::fs::write(path, bytes)?;
    }
    Ok(())
}
