//! Finding the set-up that `--instrument` names.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use anyhow::{Context, anyhow};
use low_action_dsp::Setup;

use super::Failure;

/// Largest set-up file read, bytes; the built-in ones have a few thousand.
const LARGEST_FILE: u64 = 1 << 20;

/// A set-up that comes with the program, by name, or one from a file.
pub(super) fn load(name: &str) -> Result<Setup, Failure> {
    if let Some(setup) = Setup::shipped(name) {
        return Ok(setup);
    }
    let path = Path::new(name);
    // A bare word that is no file is a misspelt name rather than a missing file.
    if !path.exists() && path.extension().is_none() && path.components().count() == 1 {
        let known = [&Setup::BUILTIN[..], &Setup::PRESETS[..]].concat().join(", ");
        return Err(Failure::Usage(format!("unknown instrument {name:?}: must be {known} or a set-up file")));
    }
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(LARGEST_FILE + 1).read_to_string(&mut text));
    let describe = || format!("cannot read the instrument {name}");
    if read.with_context(describe)? as u64 > LARGEST_FILE {
        let error = anyhow!("a set-up file has at most {LARGEST_FILE} bytes").context(describe());
        return Err(error.into());
    }
    Ok(Setup::from_toml(&text).with_context(|| name.to_owned())?)
}
