//! Which files a command reads and writes: no result may take the place of another, or of what it is made from.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::descriptors::descriptor;
use super::names::shown;
use super::{Failure, Outcome};
use crate::files;

/// A file that a command was told of: what it is to the user, and where.
pub(super) type Named = (String, PathBuf);

/// Standard input or output.
pub(super) fn is_dash(path: &Path) -> bool {
    path == Path::new("-")
}

/// Reads a file or standard input: of more bytes than are accepted one more, so that an endless source ends and can be refused.
pub(super) fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if is_dash(path) {
        io::stdin().lock().take(most + 1).read_to_end(&mut bytes)?;
    } else {
        File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// Refuses to write two results, or a result and something that is read, to one file.
pub(super) fn keep_apart(read: &[Named], written: &[Named]) -> Outcome {
    let read = read.iter().filter(|(_, path)| !is_dash(path)).map(|named| (named, false));
    let all: Vec<(&Named, bool)> = read.chain(written.iter().map(|named| (named, true))).collect();
    for (index, ((name, path), _)) in all.iter().enumerate() {
        for ((other, other_path), is_written) in &all[index + 1..] {
            if *is_written && is_same_file(path, other_path) {
                let path = shown(other_path);
                return Err(Failure::Usage(format!("{name} and {other} name the same file, {path}")));
            }
        }
    }
    Ok(())
}

/// Whether two paths lead to one file, or to one thing that is open already, such as standard output; devices take any number
/// of results.
fn is_same_file(one: &Path, other: &Path) -> bool {
    // (Standard output is the file that it goes to.)
    let [one, other] = [one, other].map(|path| if is_dash(path) { Path::new("/dev/stdout") } else { path });
    let is_device = |path| fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
    let is_open = descriptor(one).is_some_and(|number| descriptor(other) == Some(number));
    is_open || (place(one) == place(other) && !is_device(one))
}

/// Where a path leads, by what is there of it: a file that is yet to be made has a folder already, or that has.
fn place(path: &Path) -> PathBuf {
    let Ok(path) = files::behind_links(path) else { return path.to_owned() };
    let made = |path: &Path| {
        let (folder, name) = (path.parent()?, path.file_name()?);
        let folder = if folder == Path::new("") { Path::new(".") } else { folder };
        Some(place(folder).join(name))
    };
    fs::canonicalize(&path).ok().or_else(|| made(&path)).unwrap_or(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_are_not_there_yet_are_told_apart_by_their_folders() {
        for (one, other, same) in [
            ("no.wav", "./no.wav", true),
            ("no.wav", "src/../no.wav", true),
            ("no/such/no.wav", "./no/./such/no.wav", true),
            ("no.wav", "src/no.wav", false),
            ("no.wav", "no.npz", false),
            ("-", "-", true),
            ("-", "./-", false),
        ] {
            assert_eq!(is_same_file(Path::new(one), Path::new(other)), same, "{one} {other}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_file_that_is_not_there_yet_is_that_file() {
        let room = tempfile::tempdir().unwrap();
        let [link, new] = ["link.wav", "new.wav"].map(|name| room.path().join(name));
        std::os::unix::fs::symlink("new.wav", &link).unwrap();
        assert!(is_same_file(&link, &new));
    }

    #[cfg(unix)]
    #[test]
    fn what_is_open_already_is_the_same_by_each_of_its_names() {
        for (one, other, same) in [
            ("-", "/dev/stdout", true),
            ("/dev/fd/1", "/dev/stdout", true),
            ("/dev/fd/71", "/dev/fd/72", false),
            ("/dev/null", "/dev/null", false),
        ] {
            assert_eq!(is_same_file(Path::new(one), Path::new(other)), same, "{one} {other}");
            assert_eq!(is_same_file(Path::new(other), Path::new(one)), same, "{one} {other}");
        }
    }

    #[test]
    fn what_is_only_read_may_be_read_twice() {
        let named = |name: &str, path: &str| (name.to_owned(), PathBuf::from(path));
        let (song, setup) = (named("the song", "a"), named("the instrument", "./a"));
        assert!(keep_apart(&[song.clone(), setup.clone()], &[named("-o", "b")]).is_ok());
        assert!(keep_apart(&[song, setup], &[named("-o", "src/../a")]).is_err());
        assert!(keep_apart(&[named("the scene", "-")], &[named("--wav", "-")]).is_ok());
        assert!(keep_apart(&[], &[named("--wav", "-"), named("--trace", "-")]).is_err());
    }
}
