//! Files that are kept for the user.

use std::fs::{self, Permissions};
use std::io::{self, Write};
use std::path::Path;

use anyhow::{Context, Result};
use tempfile::NamedTempFile;

/// Writes a text in place of what is there, in a folder that is made if need be. Where a link is, what it points to is
/// replaced.
///
/// # Errors
/// When the folder cannot be made or the file not be written; what was there is left.
pub(crate) fn put(target: &Path, text: &str) -> Result<()> {
    let place = fs::canonicalize(target).unwrap_or_else(|_| target.to_owned());
    let folder = place.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    // Beside it and then renamed, so that nobody ever reads half of it.
    let write = || -> io::Result<()> {
        let mut draft = beside(&place)?;
        draft.write_all(text.as_bytes())?;
        // On the disk first: after a power failure there must not be an empty file under the name.
        draft.as_file().sync_all()?;
        draft.persist(&place)?;
        Ok(())
    };
    write().with_context(|| format!("cannot write {}", target.display()))
}

/// A file in the same folder as another, so that renaming it is one step; gone when dropped.
///
/// # Errors
/// When none can be made there.
pub(crate) fn beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".low-action-").suffix(".part");
    if let Some(permissions) = usual_permissions() {
        builder.permissions(permissions);
    }
    // (The error would name the file beside it, which nobody has asked for.)
    builder.tempfile_in(folder).map_err(|error| match error.raw_os_error() {
        Some(code) => io::Error::from_raw_os_error(code),
        None => error.kind().into(),
    })
}

/// What any new file gets (the user's mask still applies); temporary files are private otherwise.
#[cfg(unix)]
fn usual_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

/// Elsewhere a new file's permissions come from its folder.
#[cfg(not(unix))]
fn usual_permissions() -> Option<Permissions> {
    None
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn what_a_link_points_to_is_replaced() {
        let folder = tempfile::tempdir().expect("there is room");
        let [far, link] = ["far.toml", "link.toml"].map(|name| folder.path().join(name));
        fs::write(&far, "old").expect("it can be written");
        std::os::unix::fs::symlink(&far, &link).expect("links can be made");
        put(&link, "new").expect("it can be written");
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(&far).expect("it is there"), "new");
    }
}
