//! Finding the set-up that `--instrument` names.

use std::path::PathBuf;

use anyhow::Context;
use low_action_dsp::Setup;

use super::Failure;
use crate::setups::{self, SHIPPED};

/// A set-up that comes with the program or was installed, by name, or one from a file.
pub(super) fn load(name: &str) -> Result<Setup, Failure> {
    match Setup::shipped(name) {
        Some(setup) => Ok(setup),
        None => Ok(file(name)?.1),
    }
}

/// A set-up that was installed, by name, or one from a file: its text, and what it says.
pub(super) fn file(name: &str) -> Result<(String, Setup), Failure> {
    let mut path = PathBuf::from(name);
    // A bare word that is no file is the name of an installed set-up, or a misspelt one.
    if !path.exists() && path.extension().is_none() && path.components().count() == 1 {
        let installed = setups::installed();
        let Some(file) = installed.iter().find(|file| file.name == name) else {
            let own = installed.iter().map(|file| file.name.as_str());
            let known = SHIPPED.into_iter().chain(own).collect::<Vec<_>>().join(", ");
            return Err(Failure::Usage(format!(
                "unknown instrument {name:?}: must be {known} or a set-up file"
            )));
        };
        path.clone_from(&file.path);
    }
    let text = setups::read(&path)?;
    let setup = Setup::from_toml(&text).with_context(|| path.display().to_string())?;
    Ok((text, setup))
}
