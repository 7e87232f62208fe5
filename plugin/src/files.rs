//! Files that are kept for the user.

use std::fs::{self, Permissions};
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
        let mut builder = tempfile::Builder::new();
        if let Some(permissions) = usual_permissions() {
            builder.permissions(permissions);
        }
        let mut draft = builder.tempfile_in(folder)?;
        draft.write_all(text.as_bytes())?;
        draft.persist(target)?;
        Ok(())
    };
    write().with_context(|| format!("cannot write {}", target.display()))
}

/// What any new file gets (the user's mask still applies); temporary files are private otherwise.
#[cfg(unix)]
pub(crate) fn usual_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

/// Elsewhere a new file's permissions come from its folder.
#[cfg(not(unix))]
pub(crate) fn usual_permissions() -> Option<Permissions> {
    None
}
