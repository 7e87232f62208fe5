//! The `instruments` command: which set-ups there are, and more of them.

use std::io::Write;

use anyhow::{Context, Result};
use low_action_dsp::Setup;

use super::names::{escaped, shown};
use super::unfinished::undisturbed;
use super::{Failure, InstrumentsArgs, Outcome, instrument, say};
use crate::plugin::shelf::MOST_FILES;
use crate::setups::{self, FOLDER_VARIABLE, SHIPPED};

/// Installs or shows what is asked for, or lists what there is.
pub(super) fn run(arguments: &InstrumentsArgs) -> Outcome {
    if let Some(name) = &arguments.show {
        let (setup, _) = instrument::load(name)?;
        super::unless_closed(std::io::stdout().write_all(setup.to_toml()?.as_bytes()))?;
        return Ok(());
    }
    let folder = setups::folder().with_context(|| {
        format!("this system has no folder for a user's data: name one in {FOLDER_VARIABLE}")
    })?;
    if !arguments.install.is_empty() {
        let files = arguments.install.iter().map(|path| setups::check(path)).collect::<Result<Vec<_>>>()?;
        for (index, file) in files.iter().enumerate() {
            // The folder may be on a disk, or come to a computer, to which large letters are small ones.
            let is_same = |other: &setups::Checked| setups::may_be_same_name(other.name(), file.name());
            if let Some(other) = files[..index].iter().position(is_same) {
                let [one, two] = [other, index].map(|index| shown(&arguments.install[index]));
                let name = escaped(file.name());
                return Err(Failure::Usage(format!("{one} and {two} would both be installed as {name}")));
            }
        }
        // Told to stop meanwhile, it still installs them all: some would be neither what was nor what was asked for.
        for file in undisturbed(|_| setups::install(&files, &folder))? {
            say(&file.name, &format!("installed as {}", shown(&file.path)));
        }
        return Ok(());
    }
    let mut text = String::from("With the program:\n");
    for name in SHIPPED {
        let description = Setup::shipped(name).map(|setup| setup.description).unwrap_or_default();
        text += &format!("  {name:<18}{description}\n");
    }
    text += &format!("Yours, in {}:\n", shown(&folder));
    let files = setups::files_in(&folder);
    if files.is_empty() {
        text += "  none; `low-action instruments --install FILE` puts set-up files there\n";
    }
    for (index, file) in files.iter().enumerate() {
        let number = if index < MOST_FILES { format!("{}", index + 1) } else { "-".into() };
        let what = setups::read(&file.path).and_then(|text| Ok(setups::playable(&text)?));
        let what = what.map_or_else(|problem| format!("not usable: {problem:#}"), |setup| setup.description);
        text += &format!("  {number:>2} {:<15}{}\n", escaped(&file.name), super::one_line(&what));
    }
    if files.len() > MOST_FILES {
        text += &format!("  (the plugin has numbers for the first {MOST_FILES})\n");
    }
    super::unless_closed(std::io::stdout().write_all(text.as_bytes()))?;
    Ok(())
}
