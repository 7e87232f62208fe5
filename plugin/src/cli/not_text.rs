//! Arguments that are no text in UTF-8, where only text will do. Names of files may be any bytes.

use std::any::TypeId;
use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

use clap::Command;

use super::names::escaped;

/// Of which option a value is no text, and that value, in one line: the parser names neither.
pub(super) fn told(command: &Command, arguments: &[OsString]) -> Option<String> {
    let before = std::iter::once(OsStr::new("")).chain(arguments.iter().map(OsString::as_os_str));
    before.zip(arguments).find_map(|(before, argument)| {
        argument.to_str().is_none().then_some(())?;
        let text = argument.to_string_lossy();
        let (option, value) = if !text.starts_with('-') {
            (before.to_str()?, &*text)
        } else if text.starts_with("--") {
            text.split_once('=')?
        } else {
            text.split_at_checked(2)?
        };
        let takes_text = |known: &clap::Arg| {
            let paths = [TypeId::of::<PathBuf>(), TypeId::of::<OsString>()];
            !paths.iter().any(|path| known.get_value_parser().type_id() == *path)
        };
        let known = command.get_arguments().find(|known| is_called(known, option))?;
        let value = escaped(value);
        takes_text(known).then(|| format!("invalid value '{value}' for '{known}': it is not UTF-8 text"))
    })
}

/// Whether an option is called so, dashes included.
fn is_called(known: &clap::Arg, option: &str) -> bool {
    match option.strip_prefix("--") {
        Some(long) => known.get_long() == Some(long),
        None => option.strip_prefix('-').is_some_and(|short| short.chars().eq(known.get_short())),
    }
}
