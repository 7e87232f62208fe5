//! What is there already of a rendering: whether it is all of it, whole, and the sound that would be rendered.

use std::iter;
use std::path::{Path, PathBuf};

use super::files::stem_paths;
use super::labels;
use crate::cli::RenderArgs;
use crate::cli::names::shown;
use crate::cli::output::is_there;
use crate::cli::wav::Form;

/// The files of a rendering that are all there, and whole.
pub(super) struct There {
    /// The sound first, and then the strings' own.
    sounds: Vec<(PathBuf, Form)>,
}

impl There {
    /// All of them; or else why it has to be rendered again, in words, if any is there.
    pub(super) fn look(
        arguments: &RenderArgs,
        output: &Path,
        strings: &[&str],
    ) -> Result<Self, Option<String>> {
        let mut paths = vec![output.to_owned()];
        paths.extend(stem_paths(arguments, strings));
        let labels = arguments.labels.as_deref();
        if !paths.iter().map(PathBuf::as_path).chain(labels).any(is_there) {
            return Err(None);
        }
        let not = |path: &Path| {
            Some(format!("{} is not {}", shown(path), if is_there(path) { "whole" } else { "there" }))
        };
        let mut sounds = Vec::new();
        for path in paths {
            let form = Form::of_whole(&path).filter(|_| is_there(&path)).ok_or_else(|| not(&path))?;
            sounds.push((path, form));
        }
        match labels.filter(|path| !(is_there(path) && labels::are_whole(path))) {
            Some(path) => Err(not(path)),
            None => Ok(Self { sounds }),
        }
    }

    /// How they differ from what is asked for, in words, as far as anybody knows: by the options, and by how many samples the labels
    /// say there are. Without labels strings' own sounds are still as long as the sound.
    pub(super) fn difference(&self, arguments: &RenderArgs, samples: Option<u64>) -> Option<String> {
        let frames = samples.or_else(|| Some(self.sounds.first()?.1.frames))?;
        let channels = iter::once(2).chain(iter::repeat(1));
        self.sounds.iter().zip(channels).find_map(|((path, form), channels)| {
            let (sample_rate, bit_depth) = (arguments.sample_rate, arguments.bit_depth.to_string());
            let wanted = Form { channels, sample_rate, bit_depth, frames };
            Some(format!("{} {}", shown(path), form.difference(&wanted)?))
        })
    }
}
