//! Files of the repository that a command writes: all of them or none.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// Writes texts to their files. Each is first written beside its file and only then takes its place, so that none is left
/// half-written, and none is changed where another cannot be written.
pub fn write_all(files: &[(PathBuf, String)]) -> Result<()> {
    let written = files.iter().try_for_each(|(file, text)| {
        fs::write(beside(file), text).with_context(|| format!("cannot write {}", file.display()))
    });
    let placed = written.and_then(|()| {
        files.iter().try_for_each(|(file, _)| {
            fs::rename(beside(file), file).with_context(|| format!("cannot write {}", file.display()))
        })
    });
    if placed.is_err() {
        files.iter().for_each(|(file, _)| drop(fs::remove_file(beside(file))));
    }
    placed
}

/// Writes one.
pub fn write(file: &Path, text: String) -> Result<()> {
    write_all(&[(file.to_owned(), text)])
}

/// Where a file stands until it is whole.
fn beside(file: &Path) -> PathBuf {
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    file.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_are_written_or_none() {
        let folder = std::env::temp_dir().join(format!("low-action-files-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("it can be made");
        let (page, picture) = (folder.join("page.md"), folder.join("none/picture.svg"));
        fs::write(&page, "old").expect("it can be written");
        let files = [(page.clone(), "new".to_owned()), (picture.clone(), "new".to_owned())];
        let refused = write_all(&files).expect_err("there is no such folder").to_string();
        assert!(refused.contains("picture.svg"), "{refused}");
        assert_eq!(fs::read_to_string(&page).expect("it is there"), "old");
        fs::create_dir(folder.join("none")).expect("it can be made");
        write_all(&files).expect("both can be written");
        assert_eq!(fs::read_to_string(&page).expect("it is there"), "new");
        assert_eq!(fs::read_dir(&folder).expect("it is there").count(), 2, "nothing is left beside them");
        fs::remove_dir_all(&folder).expect("it is there");
    }
}
