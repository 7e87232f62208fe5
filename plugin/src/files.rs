//! Files that are kept for the user.

use std::fs;
use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};

/// Writes a text in place of what is there, in a folder that is made if need be.
///
/// # Errors
/// When the folder cannot be made or the file not be written; what was there is left.
pub(crate) fn put(target: &Path, text: &str) -> Result<()> {
    let folder = target.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    // Beside it and then renamed, so that nobody ever reads half of it.
    let write = || -> std::io::Result<()> {
        let mut draft = tempfile::NamedTempFile::new_in(folder)?;
        draft.write_all(text.as_bytes())?;
        draft.persist(target)?;
        Ok(())
    };
    write().with_context(|| format!("cannot write {}", target.display()))
}
