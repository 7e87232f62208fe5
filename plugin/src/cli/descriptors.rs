//! What the program has open already, as paths name it: `-`, `/dev/stdout`, `/dev/fd/3`, `/proc/self/fd/3` and links to them.
//!
//! Such a path leads on to a file where the shell has put one. That file is somebody else's, who writes to it before and
//! after: what goes there is added, and nothing takes its place.

use std::fs;
use std::path::Path;

use super::paths::is_dash;
use crate::files::MOST_LINKS;

pub(super) const STANDARD_OUTPUT: u32 = 1;
pub(super) const STANDARD_ERROR: u32 = 2;

/// The number of what a path names, if that is open already, or would be by that number.
pub(super) fn descriptor(path: &Path) -> Option<u32> {
    if is_dash(path) {
        return Some(STANDARD_OUTPUT);
    }
    let mut place = path.to_owned();
    for _ in 0..MOST_LINKS {
        let folder = place.parent()?;
        let folder = if folder == Path::new("") { Path::new(".") } else { folder };
        if let Some(number) = place.file_name()?.to_str()?.parse().ok().filter(|_| has_descriptors(folder)) {
            return Some(number);
        }
        let next = fs::read_link(&place).ok()?;
        place = folder.join(next);
    }
    None
}

/// Whether what is written to a path goes to standard output.
pub(super) fn is_standard_output(path: &Path) -> bool {
    descriptor(path) == Some(STANDARD_OUTPUT)
}

/// Whether what is in a folder is what this program has open.
fn has_descriptors(folder: &Path) -> bool {
    let Ok(folder) = fs::canonicalize(folder) else { return false };
    // Where there is no /proc, as on macOS, the folder is no link.
    let own = fs::canonicalize("/proc/self").is_ok_and(|own| folder.starts_with(own));
    (own && folder.ends_with("fd")) || folder == Path::new("/dev/fd")
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn all_names_of_what_is_open_are_known() {
        let room = tempfile::tempdir().unwrap();
        let link = room.path().join("link");
        std::os::unix::fs::symlink("/dev/stderr", &link).unwrap();
        for (path, expected) in [
            ("-", Some(1)),
            ("/dev/stdout", Some(1)),
            ("/dev/fd/1", Some(1)),
            ("/dev/../dev/./fd/1", Some(1)),
            (link.to_str().unwrap(), Some(2)),
            ("/dev/fd/987654", Some(987_654)),
            ("/dev/null", None),
            ("/dev", None),
            ("1", None),
            ("./-", None),
            ("", None),
        ] {
            assert_eq!(descriptor(Path::new(path)), expected, "{path}");
        }
        if Path::new("/proc/self").exists() {
            assert_eq!(descriptor(Path::new("/proc/self/fd/1")), Some(1));
            assert_eq!(descriptor(Path::new("/proc/thread-self/fd/2")), Some(2));
            assert_eq!(descriptor(Path::new("/proc/self/1")), None);
        }
    }
}
