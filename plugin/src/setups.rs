//! Set-ups by name: those that come with the program, and users' own in a folder of theirs.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use etcetera::BaseStrategy;
use low_action_dsp::Setup;

use crate::engine::{Engine, EngineOptions};
use crate::files;

/// Names of the set-ups that come with the program, the usual one first. Hosts number them in this order.
pub const SHIPPED: [&str; Setup::SHIPPED.len()] = Setup::SHIPPED;

/// Largest set-up file read, bytes; those that come with the program have a few thousand.
pub const LARGEST_FILE: u64 = 1 << 20;

/// The most letters of a name under which a set-up is saved.
pub const LONGEST_NAME: usize = 60;

/// Names the folder of users' own set-ups, in place of the usual one.
pub const FOLDER_VARIABLE: &str = "LOW_ACTION_INSTRUMENTS";

/// How set-up files end.
const EXTENSION: &str = "toml";

/// A user's own set-up file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SetupFile {
    /// Its name: the file's without its ending.
    pub name: String,
    /// Where it is.
    pub path: PathBuf,
}

/// Where a user's own set-ups are: the folder `instruments` of `low-action` among the user's data
/// (`~/.local/share` on Linux, `~/Library/Application Support` on macOS, `%APPDATA%` on Windows), or what
/// [`FOLDER_VARIABLE`] names. Nothing if the system knows no such place.
pub fn folder() -> Option<PathBuf> {
    if let Some(folder) = std::env::var_os(FOLDER_VARIABLE).filter(|folder| !folder.is_empty()) {
        return Some(folder.into());
    }
    Some(data_folder()?.join("instruments"))
}

/// The folder `low-action` among the user's data; nothing if the system knows no such place.
pub(crate) fn data_folder() -> Option<PathBuf> {
    let strategy = etcetera::base_strategy::choose_native_strategy().ok()?;
    Some(strategy.data_dir().join("low-action"))
}

/// The set-up files in a folder, in the order of their names; none if there is no folder.
pub fn files_in(folder: &Path) -> Vec<SetupFile> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<SetupFile> = entries
        .filter(|path| path.extension().is_some_and(|ending| ending == EXTENSION) && path.is_file())
        .filter_map(|path| Some(SetupFile { name: path.file_stem()?.to_str()?.to_owned(), path }))
        .collect();
    files.sort_by(|one, other| one.name.cmp(&other.name));
    files
}

/// A user's own set-ups, in the order of their names.
pub fn installed() -> Vec<SetupFile> {
    folder().map(|folder| files_in(&folder)).unwrap_or_default()
}

/// Whether two names may be one file's, on whatever system: some find a file by its name in large letters and in small ones alike.
pub(crate) fn may_be_same_name(one: &str, other: &str) -> bool {
    one.to_lowercase() == other.to_lowercase()
}

/// Names that Windows has for its devices, whatever comes after a dot.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];
const NUMBERED_DEVICES: [&str; 2] = ["com", "lpt"];

/// Whether a name is a device's on Windows, where no file can have it.
fn is_device(name: &str) -> bool {
    let name = name.to_lowercase();
    let is_numbered = |device: &&str| {
        let number = name.strip_prefix(*device).map(|rest| rest.chars().collect::<Vec<_>>());
        matches!(number.as_deref(), Some(['0'..='9' | '¹' | '²' | '³']))
    };
    DEVICES.contains(&name.as_str()) || NUMBERED_DEVICES.iter().any(is_numbered)
}

/// Whether two names are one file's. Windows and macOS find a file by its name in large letters and in small ones alike.
#[cfg(feature = "editor")]
pub(crate) fn is_same_name(one: &str, other: &str) -> bool {
    match cfg!(any(windows, target_os = "macos")) {
        true => may_be_same_name(one, other),
        false => one == other,
    }
}

/// Where the set-up of a name is in a folder, or would be.
pub(crate) fn place(name: &str, folder: &Path) -> PathBuf {
    folder.join(format!("{name}.{EXTENSION}"))
}

/// The text of a set-up file.
///
/// # Errors
/// When it cannot be read, is no text or is longer than [`LARGEST_FILE`].
pub fn read(path: &Path) -> Result<String> {
    let describe = || format!("cannot read the instrument {}", path.display());
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LARGEST_FILE + 1).read_to_end(&mut bytes));
    let size = read.with_context(describe)?;
    ensure!(size as u64 <= LARGEST_FILE, "{}: a set-up file has at most {LARGEST_FILE} bytes", describe());
    String::from_utf8(bytes).map_err(|_| anyhow!("{}: it is not UTF-8 text", describe()))
}

/// The set-up of a file's text, if it can be played: many a one whose values are all in their range has strings that cannot be
/// tuned. It is built as for most hosts, at 48 kHz and the usual quality; others may be refused where they are asked for.
///
/// # Errors
/// When it is no set-up, or cannot be built.
pub fn playable(text: &str) -> Result<Setup, low_action_dsp::Error> {
    let options = EngineOptions::new(Setup::from_toml(text)?, 48_000.0);
    Engine::new(&options)?;
    Ok(options.setup)
}

/// The name and the text of a set-up file that can be installed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checked {
    name: String,
    text: String,
}

impl Checked {
    /// What it will be called.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// Writes set-up files into a folder, which is made if need be, in place of those of the same name: all or none.
///
/// # Errors
/// When one cannot be written. Should the system refuse only to rename what is written, it names those that were before it.
pub fn install(files: &[Checked], folder: &Path) -> Result<Vec<SetupFile>> {
    let draft = |Checked { name, text }: &Checked| -> Result<_> {
        let file = SetupFile { name: name.clone(), path: place(name, folder) };
        Ok((files::TextDraft::write(&file.path, text)?, file))
    };
    appear(files.iter().map(draft).collect::<Result<_>>()?)
}

/// Lets drafts appear, one after the other.
fn appear(drafts: Vec<(files::TextDraft, SetupFile)>) -> Result<Vec<SetupFile>> {
    let mut installed: Vec<SetupFile> = Vec::with_capacity(drafts.len());
    for (draft, file) in drafts {
        draft.appear().with_context(|| {
            let names: Vec<String> = installed.iter().map(|file| file.name.clone()).collect();
            files::only(&names, "installed")
        })?;
        installed.push(file);
    }
    Ok(installed)
}

/// Reads a set-up file that is to be installed.
///
/// # Errors
/// When it is no set-up, cannot be [played](playable) or has the name of one that comes with the program.
pub fn check(path: &Path) -> Result<Checked> {
    let text = read(path)?;
    playable(&text).with_context(|| path.display().to_string())?;
    let name = path.file_stem().and_then(|name| name.to_str());
    let name = name.with_context(|| format!("{} has no name that could be shown", path.display()))?;
    ensure!(!SHIPPED.contains(&name), "{name} comes with the program: give {} another name", path.display());
    Ok(Checked { name: name.to_owned(), text })
}

/// Saves a set-up under its own name in a folder, which is made if need be, in place of one of the same name.
///
/// # Errors
/// When the name is empty, longer than [`LONGEST_NAME`], has anything but letters, digits, spaces, - and _ in it, is a device's on
/// Windows or that of one that comes with the program, a value is out of its range, it cannot be [played](playable), or the file
/// cannot be written.
pub fn save(setup: &Setup, folder: &Path) -> Result<SetupFile> {
    let name = setup.name.trim();
    let usable = |letter: char| letter.is_alphanumeric() || " -_".contains(letter);
    ensure!(
        (1..=LONGEST_NAME).contains(&name.chars().count()) && name.chars().all(usable),
        "an instrument cannot be named {name:?}: it must be 1 to {LONGEST_NAME} letters, digits, spaces, - or _"
    );
    ensure!(!SHIPPED.contains(&name), "{name} comes with the program: give yours another name");
    ensure!(!is_device(name), "an instrument cannot be named {name:?}: Windows has it for a device");
    setup.check().with_context(|| name.to_owned())?;
    let text = setup.to_toml()?;
    playable(&text).with_context(|| name.to_owned())?;
    let file = SetupFile { name: name.to_owned(), path: place(name, folder) };
    files::put(&file.path, &text)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// It would be saved in place of one that can be, and something else be played.
    #[test]
    fn what_cannot_be_played_is_not_saved() {
        let folder = tempfile::tempdir().expect("there is room");
        let electric = Setup::builtin("electric").expect("it is built in");
        let mut setup = Setup { name: "Mine".into(), ..electric };
        let file = save(&setup, folder.path()).expect("it can be played");
        let before = read(&file.path).expect("it is there");
        // In all ranges, but too stiff to sound so low.
        (setup.string[0].pitch, setup.string[0].core_radius) = (20.0, 0.005);
        setup.check().expect("all is in its range");
        let error = format!("{:#}", save(&setup, folder.path()).expect_err("no such string can be"));
        assert!(error.starts_with("Mine: string[1]") && !error.contains('\n'), "{error}");
        assert_eq!(read(&file.path).expect("it is there"), before);
    }

    #[test]
    fn what_was_installed_before_an_error_is_named() {
        let folder = tempfile::tempdir().expect("there is room");
        let draft = |name: &str| {
            let file = SetupFile { name: name.into(), path: place(name, folder.path()) };
            (files::TextDraft::write(&file.path, "text").expect("there is room"), file)
        };
        let drafts = ["one", "two", "three", "four"].map(draft);
        // Somebody else is quicker.
        fs::create_dir(place("three", folder.path())).expect("there is room");
        let error = format!("{:#}", appear(drafts.into()).expect_err("a folder is there"));
        assert!(error.starts_with("only one and two were installed: cannot write "), "{error}");
        assert!(error.contains("three.toml"), "{error}");
        // The drafts that were left have gone.
        let names: Vec<_> = files_in(folder.path()).into_iter().map(|file| file.name).collect();
        assert_eq!(names, ["one", "two"]);
        assert_eq!(fs::read_dir(folder.path()).expect("it is there").count(), 3);
    }

    #[test]
    fn names_that_windows_has_for_devices_are_refused() {
        let folder = tempfile::tempdir().expect("there is room");
        let setup = Setup::shipped("electric").expect("it is there");
        for (name, refused) in [
            ("con", true),
            ("Nul", true),
            ("AUX", true),
            ("prn", true),
            ("com1", true),
            ("LPT9", true),
            ("lpt", false),
            ("com10", false),
            ("concert", false),
            ("my aux", false),
        ] {
            let saved = save(&Setup { name: name.into(), ..setup.clone() }, folder.path());
            assert_eq!(saved.is_err(), refused, "{name}: {saved:?}");
            if let Err(error) = saved {
                assert!(error.to_string().contains(name) && error.to_string().contains("Windows"), "{error}");
            }
        }
    }
}
