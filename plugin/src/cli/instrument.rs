//! Finding the set-up that `--instrument` names.

use std::path::{Path, PathBuf};

use anyhow::Context;
use low_action_dsp::Setup;

use super::Failure;
use crate::setups::{self, SHIPPED};

/// A set-up that comes with the program or was installed, by name, or one from a file.
pub(super) fn load(name: &str) -> Result<Setup, Failure> {
    if let Some(setup) = Setup::shipped(name) {
        return Ok(setup);
    }
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
    from_file(&path)
}

fn from_file(path: &Path) -> Result<Setup, Failure> {
    let text = setups::read(path)?;
    Ok(Setup::from_toml(&text).with_context(|| path.display().to_string())?)
}
