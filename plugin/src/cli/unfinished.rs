//! What has been begun and is not yet finished: where the program is told to stop, nothing of it is left.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};

/// All of it in this process.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// The exit code of programs that were told to stop: 128 and the number of Ctrl+C's signal, as shells have it.
const STOPPED: i32 = 130;

/// A file or folder that vanishes if the program is told to stop while this lives.
#[derive(Debug)]
pub(super) struct Unfinished(PathBuf);

impl Unfinished {
    pub fn new(path: &Path) -> Self {
        watch();
        list().push(path.to_owned());
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
    pub fn make(folder: &Path) -> std::io::Result<Self> {
        let missing = folder.ancestors().take_while(|folder| **folder != *"" && !folder.exists());
        let missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
        fs::create_dir_all(folder)?;
        // The outermost last, as they can only vanish from within.
        Ok(Self(missing.iter().map(|folder| Unfinished::new(folder)).collect()))
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

fn list() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Has Ctrl+C, and where there are such things a request to end and a terminal that is closed, clean up.
fn watch() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let stop = || {
            // The list stays locked, so that nothing more is begun.
            let list = list();
            for path in list.iter() {
                fs::remove_file(path).ok();
            }
            for path in list.iter() {
                fs::remove_dir(path).ok();
            }
            std::process::exit(STOPPED);
        };
        // Who has signals ignored, as nohup does and shells do in the background, keeps it so.
        ctrlc::try_set_handler(stop).ok();
    });
}
