//! Files that are kept for the user.

use std::fs::{self, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use tempfile::NamedTempFile;

/// Writes a text in place of what is there, in a folder that is made if need be. Where a link is, what it points to is
/// replaced.
///
/// # Errors
/// When the folder cannot be made or the file not be written; what was there is left.
pub(crate) fn put(target: &Path, text: &str) -> Result<()> {
    Draft::write(target, text)?.appear()
}

/// A text that is on the disk beside its place, so that nobody ever reads half of it; gone when dropped.
#[derive(Debug)]
pub(crate) struct Draft {
    file: NamedTempFile,
    /// Where it goes, and what that is called in messages.
    place: PathBuf,
    target: PathBuf,
}

impl Draft {
    /// Writes a text that is to appear at a place, as [`put`] does.
    ///
    /// # Errors
    /// When the folder cannot be made or the text not be written, or a folder is in its place.
    pub fn write(target: &Path, text: &str) -> Result<Self> {
        let place = fs::canonicalize(target).unwrap_or_else(|_| target.to_owned());
        if place.is_dir() {
            bail!("cannot write {}: it is a folder", target.display());
        }
        let folder = place.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
        let write = || -> io::Result<NamedTempFile> {
            let mut file = beside(&place)?;
            file.write_all(text.as_bytes())?;
            // On the disk first: after a power failure there must not be an empty file under the name.
            file.as_file().sync_all()?;
            Ok(file)
        };
        let file = write().with_context(|| format!("cannot write {}", target.display()))?;
        Ok(Self { file, place, target: target.to_owned() })
    }

    /// Takes the place of what is there.
    ///
    /// # Errors
    /// When it cannot be renamed; what was there is left.
    pub fn appear(self) -> Result<()> {
        let renamed = self.file.persist(&self.place).map_err(|error| error.error);
        renamed.map(drop).with_context(|| format!("cannot write {}", self.target.display()))
    }
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
