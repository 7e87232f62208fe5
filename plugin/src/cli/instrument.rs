//! Finding the set-up that `--instrument` names.

use std::ffi::OsStr;
use std::path::PathBuf;

use anyhow::Context;
use low_action_dsp::Setup;

use super::Failure;
use crate::setups::{self, SHIPPED};

/// A set-up that comes with the program or was installed, by name, or one from a file; and where that file is, if one was
/// read.
pub(super) fn load(name: &OsStr) -> Result<(Setup, Option<PathBuf>), Failure> {
    if let Some(setup) = name.to_str().and_then(Setup::shipped) {
        return Ok((setup, None));
    }
    let (path, _, setup) = file(name)?;
    Ok((setup, Some(path)))
}

/// A set-up that was installed, by name, or one from a file: where it is, its text, and what it says.
pub(super) fn file(name: &OsStr) -> Result<(PathBuf, String, Setup), Failure> {
    let path = path(name)?;
    let text = setups::read(&path)?;
    let setup = Setup::from_toml(&text).with_context(|| path.display().to_string())?;
    Ok((path, text, setup))
}

/// Where the file is that a name or a path means.
fn path(name: &OsStr) -> Result<PathBuf, Failure> {
    let path = PathBuf::from(name);
    // A folder is no set-up, whatever it is called.
    if (path.exists() && !path.is_dir()) || path.components().count() > 1 {
        return Ok(path);
    }
    let installed = setups::installed();
    if let Some(file) = installed.iter().find(|file| name == file.name.as_str()) {
        return Ok(file.path.clone());
    }
    if path.extension().is_some() {
        return Ok(path);
    }
    // A bare word is a misspelt name.
    let own = installed.iter().map(|file| file.name.as_str());
    let known = SHIPPED.into_iter().chain(own).collect::<Vec<_>>().join(", ");
    let name = name.to_string_lossy();
    Err(Failure::Usage(format!("unknown instrument {name:?}: must be {known} or a set-up file")))
}
