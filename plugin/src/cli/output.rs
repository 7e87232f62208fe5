//! Results of commands, which appear whole or not at all. (Why texts that are kept for the user have a way of their own is
//! said in `files`.)

use std::fs::{self, File};
use std::io::{self, Seek};
use std::path::{Path, PathBuf, is_separator};

use anyhow::{Context, Result, bail, ensure};
use tempfile::TempPath;

use super::descriptors::{self, STANDARD_ERROR, STANDARD_OUTPUT};
use super::names::shown;
use super::unfinished::{Unfinished, undisturbed};
use crate::files;

/// Where a result goes.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Target {
    StandardOutput,
    StandardError,
    /// A device, a pipe or something else that is open already: written directly, since it cannot or must not be replaced.
    Stream(PathBuf),
    /// An ordinary file, made or replaced with its permissions: never a link, but what it leads to.
    File(PathBuf),
}

/// A result being written. It is kept apart until [`publish`](Self::publish) and vanishes if that
/// never comes: an ordinary file is written beside its place and then renamed; standard output,
/// devices and pipes receive a finished copy.
#[derive(Debug)]
pub struct Draft {
    target: Target,
    file: File,
    beside: Option<(TempPath, Unfinished)>,
}

impl Draft {
    /// Begins a result that is to appear at `path`, where `-` is standard output.
    ///
    /// # Errors
    /// When the place is a folder or can have no file, the file there may not be written, or nothing can be written beside it.
    pub fn begin(path: &Path) -> Result<Self> {
        let target = Target::find(path)?;
        let describe = || format!("cannot write {}", shown(path));
        let (file, beside) = match &target {
            Target::File(path) => {
                let (file, unfinished) = Unfinished::beside(path).with_context(describe)?;
                let (file, beside) = file.into_parts();
                (file, Some((beside, unfinished)))
            }
            Target::StandardOutput | Target::StandardError | Target::Stream(_) => {
                let file = undisturbed(|_| tempfile::tempfile());
                let folder = std::env::temp_dir();
                let describe = || format!("cannot make a temporary file in {}", shown(&folder));
                (file.with_context(describe)?, None)
            }
        };
        Ok(Self { target, file, beside })
    }

    /// A handle to write (and seek) with.
    ///
    /// # Errors
    /// When the system has no more handles.
    pub fn handle(&self) -> io::Result<File> {
        self.file.try_clone()
    }

    /// Lets the finished result appear.
    ///
    /// # Errors
    /// When the disk, device or pipe takes no more; nothing is left behind.
    pub fn publish(mut self) -> Result<()> {
        match (&self.target, self.beside) {
            (Target::StandardOutput, _) => {
                copy(&mut self.file, &mut io::stdout().lock()).context("cannot write to standard output")
            }
            (Target::StandardError, _) => {
                copy(&mut self.file, &mut io::stderr().lock()).context("cannot write to standard error")
            }
            (Target::Stream(path), _) => stream(path)
                .and_then(|mut stream| copy(&mut self.file, &mut stream))
                .with_context(|| format!("cannot write {}", shown(path))),
            (Target::File(path), beside) => {
                beside.map_or(Ok(()), |(beside, _unfinished)| rename(beside, path))
            }
        }
    }
}

fn rename(finished: TempPath, path: &Path) -> Result<()> {
    finished
        .persist(path)
        .map_err(|error| error.error)
        .with_context(|| format!("cannot write {}", shown(path)))
}

/// Lets several finished results appear. What has to be copied, to a device or a pipe, may still fail, and comes first; the
/// others only have to be renamed, and whoever asks the program to stop meanwhile waits until they are.
///
/// # Errors
/// As for one; no file appears after a device or a pipe that takes no more.
pub fn publish_all(drafts: Vec<Draft>) -> Result<()> {
    let (files, copies): (Vec<Draft>, Vec<Draft>) =
        drafts.into_iter().partition(|draft| matches!(draft.target, Target::File(_)));
    copies.into_iter().try_for_each(Draft::publish)?;
    let (mut finished, mut unfinished) = (Vec::new(), Vec::new());
    for Draft { target, beside, .. } in files {
        if let (Target::File(path), Some((beside, entry))) = (target, beside) {
            finished.push((beside, path));
            unfinished.push(entry);
        }
    }
    // They leave the list after their places have been taken.
    undisturbed(|_| finished.into_iter().try_for_each(|(beside, path)| rename(beside, &path)))
}

impl Target {
    fn find(path: &Path) -> Result<Self> {
        let describe = || format!("cannot write {}", shown(path));
        match descriptors::descriptor(path) {
            Some(STANDARD_OUTPUT) => return Ok(Self::StandardOutput),
            Some(STANDARD_ERROR) => return Ok(Self::StandardError),
            Some(_) => {
                fs::metadata(path).with_context(describe)?;
                return Ok(Self::Stream(path.to_owned()));
            }
            None => {}
        }
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => bail!("cannot write {}: it is a folder", shown(path)),
            Ok(found) if !found.is_file() => Ok(Self::Stream(path.to_owned())),
            found => {
                let place = files::behind_links(path).with_context(describe)?;
                if found.is_err() {
                    check_new(&place).with_context(describe)?;
                }
                Ok(Self::File(place))
            }
        }
    }
}

/// Refuses a place where nothing is and no file can be made.
fn check_new(path: &Path) -> Result<()> {
    // (The parts of a path are no help: those of `new/` and of `new/.` are those of `new`.)
    let letters = path.as_os_str().as_encoded_bytes();
    let last = letters.rsplit(|&letter| is_separator(letter.into())).next();
    ensure!(!matches!(last, Some(b"" | b"." | b"..")), "that names a folder, not a file");
    if let Some(folder) = path.parent().filter(|folder| **folder != *"") {
        let is_missing = fs::metadata(folder).is_err_and(|error| error.kind() == io::ErrorKind::NotFound);
        ensure!(!is_missing, "the folder {} does not exist", shown(folder));
    }
    match fs::symlink_metadata(path) {
        // Most often a name that is too long.
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error.into()),
        _ => Ok(()),
    }
}

/// Opens what is not replaced. Where it is a file, it is one that somebody has open: what is in it stays.
fn stream(path: &Path) -> io::Result<File> {
    let is_file = fs::metadata(path)?.is_file();
    File::options().write(true).append(is_file).open(path)
}

fn copy(from: &mut File, to: &mut impl io::Write) -> io::Result<()> {
    from.rewind()?;
    io::copy(from, to)?;
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_no_file_can_be_is_found_out_at_the_beginning() {
        let room = tempfile::tempdir().unwrap();
        fs::write(room.path().join("file"), "").unwrap();
        let long = "x".repeat(300);
        for (name, expected) in [
            ("new/", "that names a folder, not a file"),
            ("new/.", "that names a folder, not a file"),
            ("file/", "that names a folder, not a file"),
            ("..", "it is a folder"),
            ("no/such/x.wav", "no/such does not exist"),
            (long.as_str(), "cannot write"),
        ] {
            let path = room.path().join(name);
            let error = format!("{:#}", Draft::begin(&path).unwrap_err());
            assert!(error.contains(expected) && error.contains(name), "{name}: {error}");
        }
        assert_eq!(fs::read_dir(room.path()).unwrap().count(), 1);
        Draft::begin(&room.path().join("new")).unwrap().publish().unwrap();
        assert!(room.path().join("new").is_file());
    }
}
