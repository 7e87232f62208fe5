//! Results of commands, which appear whole or not at all. (Why texts that are kept for the user have a way of their own is
//! said in `files`.)

use std::fs::{self, File};
use std::io::{self, Seek};
use std::iter;
use std::path::{Path, PathBuf, is_separator};

use anyhow::{Context, Result, anyhow, bail, ensure};
use tempfile::{PathPersistError, TempPath};

use super::descriptors::{self, STANDARD_ERROR, STANDARD_OUTPUT};
use super::names::shown;
use super::unfinished::{Unfinished, undisturbed};
use crate::files;

/// Where a result goes.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Target {
    /// What is open already, a device, a pipe or something else that cannot or must not be replaced: written directly.
    Stream(Stream),
    /// An ordinary file, made or replaced with its permissions: never a link, but what it leads to.
    File(PathBuf),
}

/// What is written directly.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Stream {
    StandardOutput,
    StandardError,
    Other(PathBuf),
}

/// A result being written. It is kept apart until it is [published](publish_all) and vanishes if that
/// never comes: an ordinary file is written beside its place and then renamed; standard output,
/// devices and pipes receive a finished copy.
#[derive(Debug)]
pub struct Draft {
    file: File,
    way: Way,
}

/// How a result gets where it goes.
#[derive(Debug)]
enum Way {
    Copied(Stream),
    /// To a place from beside it.
    Renamed(PathBuf, TempPath, Unfinished),
}

/// A result that only has to take its place.
struct Finished {
    file: File,
    beside: TempPath,
    place: PathBuf,
}

impl Draft {
    /// Begins a result that is to appear at `path`, where `-` is standard output.
    ///
    /// # Errors
    /// When the place is a folder or can have no file, the file there may not be written, or nothing can be written beside it.
    pub fn begin(path: &Path) -> Result<Self> {
        match Target::find(path)? {
            Target::File(place) => {
                let begun = Unfinished::beside(&place);
                let (file, unfinished) = begun.with_context(|| format!("cannot write {}", shown(path)))?;
                let (file, beside) = file.into_parts();
                Ok(Self { file, way: Way::Renamed(place, beside, unfinished) })
            }
            Target::Stream(stream) => {
                let file = undisturbed(|_| tempfile::tempfile());
                let folder = std::env::temp_dir();
                let describe = || format!("cannot make a temporary file in {}", shown(&folder));
                Ok(Self { file: file.with_context(describe)?, way: Way::Copied(stream) })
            }
        }
    }

    /// A handle to write (and seek) with.
    ///
    /// # Errors
    /// When the system has no more handles.
    pub fn handle(&self) -> io::Result<File> {
        self.file.try_clone()
    }
}

/// Whether a result is at its place already: an ordinary file, since what is written directly takes any number of results.
pub fn is_there(path: &Path) -> bool {
    matches!(Target::find(path), Ok(Target::File(place)) if place.is_file())
}

/// Lets finished results appear. What has to be copied, to a device or a pipe, may still fail, and comes first; the
/// others only have to be renamed, and whoever asks the program to stop meanwhile waits until they are.
///
/// # Errors
/// When the disk, device or pipe takes no more; no file appears after a device or a pipe that does not. Where a file cannot take
/// its place it is kept beside it, as hours may have gone into it, and so are those after it; the error names them, and what has
/// appeared before.
pub fn publish_all(drafts: Vec<Draft>) -> Result<()> {
    // They leave the list after their places have been taken, or they have vanished.
    let mut entries = Vec::new();
    let (mut copies, mut finished) = (Vec::new(), Vec::new());
    for Draft { file, way } in drafts {
        match way {
            Way::Copied(stream) => copies.push((file, stream)),
            Way::Renamed(place, beside, entry) => {
                // On the disk first: after a power failure there must not be an empty file under the name.
                file.sync_data().with_context(|| format!("cannot write {}", shown(&place)))?;
                finished.push(Finished { file, beside, place });
                entries.push(entry);
            }
        }
    }
    let mut appeared = Vec::new();
    for (mut file, stream) in copies {
        told(stream.take(&mut file), &appeared)?;
        appeared.push(stream.name());
    }
    undisturbed(|list| appear(finished, appeared, list))
}

/// Lets finished files take their places, one after the other. Those that are kept beside them leave the list.
fn appear(finished: Vec<Finished>, mut appeared: Vec<String>, list: &mut Vec<PathBuf>) -> Result<()> {
    let mut finished = finished.into_iter();
    while let Some(Finished { file, beside, place }) = finished.next() {
        if let Err(PathPersistError { error, path }) = files::take_place(beside, &file, &place) {
            let cannot = format!("cannot write {}", shown(&place));
            let left = iter::once((path, place)).chain(finished.map(|other| (other.beside, other.place)));
            let kept = left.filter_map(|(path, place)| {
                let path = path.keep().ok().filter(|path| path.exists())?;
                list.retain(|entry| *entry != path);
                Some(format!("{} as {}", shown(&place), shown(&path)))
            });
            let kept: Vec<String> = kept.collect();
            let error = match kept.as_slice() {
                [] => anyhow!(error),
                kept => anyhow!("{error}; kept: {}", kept.join(", ")),
            };
            return told(Err(error.context(cannot)), &appeared);
        }
        appeared.push(shown(&place));
    }
    Ok(())
}

/// An error with what has appeared before it.
fn told(result: Result<()>, appeared: &[String]) -> Result<()> {
    match appeared {
        [] => result,
        names => result.with_context(|| files::only(names, "written")),
    }
}

impl Stream {
    /// What it is called in messages.
    fn name(&self) -> String {
        match self {
            Self::StandardOutput => "standard output".to_owned(),
            Self::StandardError => "standard error".to_owned(),
            Self::Other(path) => shown(path),
        }
    }

    /// Takes a finished copy.
    fn take(&self, file: &mut File) -> Result<()> {
        let describe = || match self {
            Self::StandardOutput | Self::StandardError => format!("cannot write to {}", self.name()),
            Self::Other(_) => format!("cannot write {}", self.name()),
        };
        let copied = match self {
            Self::StandardOutput => copy(file, &mut io::stdout().lock()),
            Self::StandardError => copy(file, &mut io::stderr().lock()),
            Self::Other(path) => open(path).and_then(|mut stream| copy(file, &mut stream)),
        };
        copied.with_context(describe)
    }
}

impl Target {
    fn find(path: &Path) -> Result<Self> {
        let describe = || format!("cannot write {}", shown(path));
        match descriptors::descriptor(path) {
            Some(STANDARD_OUTPUT) => return Ok(Self::Stream(Stream::StandardOutput)),
            Some(STANDARD_ERROR) => return Ok(Self::Stream(Stream::StandardError)),
            Some(_) => {
                fs::metadata(path).with_context(describe)?;
                return Ok(Self::Stream(Stream::Other(path.to_owned())));
            }
            None => {}
        }
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => bail!("cannot write {}: it is a folder", shown(path)),
            Ok(found) if !found.is_file() => Ok(Self::Stream(Stream::Other(path.to_owned()))),
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
fn open(path: &Path) -> io::Result<File> {
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
    use std::io::Write;

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
        publish_all(vec![Draft::begin(&room.path().join("new")).unwrap()]).unwrap();
        assert!(room.path().join("new").is_file());
    }

    #[test]
    fn what_cannot_take_its_place_is_kept_and_named() {
        let room = tempfile::tempdir().unwrap();
        let draft = |name: &str| {
            let draft = Draft::begin(&room.path().join(name)).unwrap();
            draft.handle().unwrap().write_all(name.as_bytes()).unwrap();
            draft
        };
        let drafts = ["one", "two", "three", "four"].map(draft);
        // Somebody else is quicker.
        fs::create_dir(room.path().join("three")).unwrap();
        let error = format!("{:#}", publish_all(drafts.into()).unwrap_err());
        let place = |name: &str| shown(&room.path().join(name));
        let begins = format!(
            "only {} and {} were written: cannot write {}: ",
            place("one"),
            place("two"),
            place("three")
        );
        assert!(error.starts_with(&begins), "{error}");
        let (_, kept) = error.split_once("; kept: ").unwrap();
        for (kept, name) in kept.split(", ").zip(["three", "four"]) {
            let (of, path) = kept.split_once(" as ").unwrap();
            assert_eq!((of, fs::read_to_string(path).unwrap().as_str()), (place(name).as_str(), name));
        }
        assert_eq!(kept.split(", ").count(), 2);
        assert_eq!(fs::read_dir(room.path()).unwrap().count(), 5);
    }
}
