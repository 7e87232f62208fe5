//! Files that are kept for the user, such as set-ups.
//!
//! They are short texts, written at once into a folder that may have to be made, and must outlive a power failure. What
//! commands compute is another matter (`cli/output`): it is written as it comes, goes to standard output and devices too,
//! can be computed again, and must vanish when the command is stopped. Both begin beside their place, by [`beside`] and
//! [`behind_links`], and take it by [`take_place`].

use std::fs::{self, File, Permissions};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use tempfile::{NamedTempFile, PathPersistError, TempPath};

/// Writes a text in place of what is there, in a folder that is made if need be. Where a link is, what it points to is
/// replaced.
///
/// # Errors
/// When the folder cannot be made or the file not be written; what was there is left.
pub(crate) fn put(target: &Path, text: &str) -> Result<()> {
    TextDraft::write(target, text)?.appear()
}

/// A text that is on the disk beside its place, so that nobody ever reads half of it; gone when dropped.
#[derive(Debug)]
pub(crate) struct TextDraft {
    file: NamedTempFile,
    /// Where it goes, and what that is called in messages.
    place: PathBuf,
    target: PathBuf,
}

impl TextDraft {
    /// Writes a text that is to appear at a place, as [`put`] does.
    ///
    /// # Errors
    /// When the folder cannot be made or the text not be written, or a folder is in its place.
    pub fn write(target: &Path, text: &str) -> Result<Self> {
        let place = behind_links(target).with_context(|| format!("cannot write {}", target.display()))?;
        if place.is_dir() {
            bail!("cannot write {}: it is a folder", target.display());
        }
        let folder = place.parent().unwrap_or(Path::new("."));
        let make = || format!("cannot make the folder {}", folder.display());
        ensure!(!folder.exists() || folder.is_dir(), "{}: it is a file", make());
        fs::create_dir_all(folder).with_context(make)?;
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
    /// When it can neither be renamed nor copied into what is there.
    pub fn appear(self) -> Result<()> {
        let (file, path) = self.file.into_parts();
        let placed = take_place(path, &file, &self.place).map_err(|error| error.error);
        placed.with_context(|| format!("cannot write {}", self.target.display()))
    }
}

/// Lets a finished file take the place that it was written beside. There are files that may be written and not replaced, as
/// one that is mounted by itself or another user's in a folder like `/tmp`: into such a one it is copied.
///
/// # Errors
/// When that fails, too; then the file is still where it was, and gone when dropped.
pub(crate) fn take_place(finished: TempPath, file: &File, place: &Path) -> Result<(), PathPersistError> {
    finished.persist(place).or_else(|refused| {
        if !fs::symlink_metadata(place).is_ok_and(|found| found.is_file()) {
            return Err(refused);
        }
        copy_over(file, place).map_err(|error| PathPersistError { error, ..refused })
    })
}

/// Writes a file's contents over another's.
fn copy_over(mut from: &File, to: &Path) -> io::Result<()> {
    let mut to = File::options().write(true).truncate(true).open(to)?;
    from.rewind()?;
    io::copy(&mut from, &mut to)?;
    to.sync_all()
}

/// What has been done before an error, in words: "only one and two were installed".
pub(crate) fn only(names: &[String], done: &str) -> String {
    match names {
        [] => format!("nothing was {done}"),
        [name] => format!("only {name} was {done}"),
        [names @ .., last] => format!("only {} and {last} were {done}", names.join(", ")),
    }
}

/// Links that are followed one after the other, as many as Linux follows.
pub(crate) const MOST_LINKS: usize = 40;

/// The file that a path leads to: what is written there goes where its links lead, also where nothing is yet.
///
/// # Errors
/// When links lead in a circle.
pub(crate) fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut place = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Ok(found) = fs::canonicalize(&place) {
            return Ok(found);
        }
        // (A relative link begins where it stands.)
        match fs::read_link(&place) {
            Ok(next) => place = place.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(place),
        }
    }
    Err(io::Error::other(format!("more than {MOST_LINKS} links lead on from it")))
}

/// A file in the same folder as another, so that renaming it is one step; gone when dropped. It has the permissions of the
/// file whose place it is to take, so that what was private stays so. Where nothing new may be in that folder and a file is there
/// that may be written, it is among the system's temporary files instead, and can only be copied.
///
/// # Errors
/// When none can be made there, or the file that is there is not to be written.
pub(crate) fn beside(path: &Path) -> io::Result<NamedTempFile> {
    let kept = permissions_there(path)?;
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".low-action-").suffix(".part");
    // (What is to have others is private until it has them.)
    if let Some(permissions) = usual_permissions().filter(|_| kept.is_none()) {
        builder.permissions(permissions);
    }
    // (The error would name the file beside it, which nobody has asked for.)
    let plain = |error: io::Error| match error.raw_os_error() {
        Some(code) => io::Error::from_raw_os_error(code),
        None => error.kind().into(),
    };
    let file = builder.tempfile_in(folder).map_err(plain).or_else(|refused| match refused.kind() {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem if kept.is_some() => {
            builder.tempfile().map_err(|_| refused)
        }
        _ => Err(refused),
    })?;
    if let Some(kept) = kept {
        // (Not where they are so already: there are file systems that know no others.)
        if file.as_file().metadata()?.permissions() != kept {
            file.as_file().set_permissions(kept)?;
        }
    }
    Ok(file)
}

/// The permissions of the file at a place, if one is there.
///
/// # Errors
/// When it may not be written: renaming asks the folder only, and would replace it all the same.
fn permissions_there(path: &Path) -> io::Result<Option<Permissions>> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() => {
            File::options().write(true).open(path)?;
            Ok(Some(found.permissions()))
        }
        _ => Ok(None),
    }
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
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    #[test]
    fn what_a_link_points_to_is_replaced() {
        let folder = tempfile::tempdir().expect("there is room");
        let [far, link] = ["far.toml", "link.toml"].map(|name| folder.path().join(name));
        fs::write(&far, "old").expect("it can be written");
        symlink(&far, &link).expect("links can be made");
        put(&link, "new").expect("it can be written");
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(&far).expect("it is there"), "new");
    }

    #[test]
    fn what_a_link_points_to_is_made() {
        let folder = tempfile::tempdir().expect("there is room");
        let [new, link, other] =
            ["there/new.toml", "link.toml", "other.toml"].map(|name| folder.path().join(name));
        symlink("there/new.toml", &link).expect("links can be made");
        symlink("link.toml", &other).expect("links can be made");
        put(&other, "text").expect("it can be written");
        assert!(link.is_symlink() && other.is_symlink());
        assert_eq!(fs::read_to_string(&new).expect("it is there"), "text");
        let circle = folder.path().join("circle.toml");
        symlink("circle.toml", &circle).expect("links can be made");
        let error = format!("{:#}", put(&circle, "text").expect_err("it leads nowhere"));
        assert!(error.contains("circle.toml") && error.contains("link") && circle.is_symlink(), "{error}");
    }

    #[test]
    fn what_cannot_be_renamed_can_be_copied() {
        let folder = tempfile::tempdir().expect("there is room");
        let [own, part] = ["own.toml", "part"].map(|name| folder.path().join(name));
        fs::write(&own, "something longer").expect("it can be written");
        fs::write(&part, "new").expect("it can be written");
        let file = File::options().read(true).append(true).open(&part).expect("it is there");
        // (Renaming is refused as it is elsewhere for other reasons: what is to be renamed is not there.)
        fs::remove_file(&part).expect("it is ours");
        let part = TempPath::try_from_path(part).expect("it is a whole path");
        take_place(part, &file, &own).expect("it can be copied");
        assert_eq!(fs::read_to_string(&own).expect("it is there"), "new");
    }

    #[test]
    fn what_is_replaced_keeps_its_permissions() {
        let folder = tempfile::tempdir().expect("there is room");
        let file = folder.path().join("own.toml");
        let mode = || fs::metadata(&file).expect("it is there").permissions().mode() & 0o777;
        for kept in [0o600, 0o664, 0o644] {
            fs::write(&file, "old").expect("it can be written");
            fs::set_permissions(&file, Permissions::from_mode(kept)).expect("it is ours");
            put(&file, "new").expect("it can be written");
            assert_eq!((mode(), fs::read_to_string(&file).expect("it is there").as_str()), (kept, "new"));
        }
    }
}
