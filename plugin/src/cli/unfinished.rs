//! What has been begun and is not yet finished: where the program is told to stop, nothing of it is left.
//!
//! Whatever is made is made while the list is held, and is in it before the list is let go. Who cleans up takes the list
//! too, and so never looks between the two. That happens on a thread of its own, which may wait.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, Once};
use std::{fs, io};

use tempfile::NamedTempFile;

use super::stopping;
use crate::files;
use crate::locked::lock;

/// All of it in this process.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A file or folder that vanishes if the program is told to stop while this lives.
#[derive(Debug)]
pub(super) struct Unfinished(PathBuf);

impl Unfinished {
    /// Makes a file beside another, as [`files::beside`] does.
    pub fn beside(path: &Path) -> io::Result<(NamedTempFile, Self)> {
        undisturbed(|list| {
            let file = files::beside(path)?;
            let unfinished = Self::enter(file.path(), list);
            Ok((file, unfinished))
        })
    }

    fn enter(path: &Path, list: &mut Vec<PathBuf>) -> Self {
        list.push(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        list().retain(|path| *path != self.0);
    }
}

/// Folders that a command makes for its results. Those that are empty when it ends vanish with it.
#[derive(Debug, Default)]
pub(super) struct NewFolders(Vec<Unfinished>);

impl NewFolders {
    /// Makes a folder and those it lies in, unless they are there.
    pub fn make(folder: &Path) -> io::Result<Self> {
        let (new, made) = undisturbed(|list| {
            let missing = folder.ancestors().take_while(|folder| **folder != *"" && !folder.exists());
            // The outermost last, as they can only vanish from within.
            let new = Self(missing.map(|folder| Unfinished::enter(folder, list)).collect());
            (new, fs::create_dir_all(folder))
        });
        // Where the innermost cannot be made, those it lies in vanish with the others. (That takes the list.)
        made.map(|()| new)
    }
}

impl Drop for NewFolders {
    fn drop(&mut self) {
        for Unfinished(folder) in &self.0 {
            // What has anything in it stays.
            fs::remove_dir(folder).ok();
        }
    }
}

/// Does something that is not to be broken off: whoever asks the program to stop waits for its end. It must not let go of
/// anything [`Unfinished`], which takes the list.
pub(super) fn undisturbed<T>(work: impl FnOnce(&mut Vec<PathBuf>) -> T) -> T {
    // Before anything is there. What asks earlier ends the program by itself, which is as good.
    watch();
    work(&mut list())
}

fn list() -> MutexGuard<'static, Vec<PathBuf>> {
    lock(&UNFINISHED)
}

/// Has whatever asks the program to stop clean up.
fn watch() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        stopping::when_asked(|stop| {
            // The list stays locked, so that nothing more is begun.
            let list = list();
            for path in list.iter() {
                fs::remove_file(path).ok();
            }
            for path in list.iter() {
                fs::remove_dir(path).ok();
            }
            stop.end_program();
        });
    });
}
