//! The files of one rendering: the stereo sound, and on request each string's own and the labels.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::labels::{LabelFile, Labelled};
use super::warn;
use crate::cli::RenderArgs;
use crate::cli::names::shown;
use crate::cli::output::publish_all;
use crate::cli::unfinished::NewFolders;
use crate::cli::wav::WavFile;

/// The files of one rendering.
pub(super) struct Files {
    pub mix: WavFile,
    pub stems: Vec<WavFile>,
    pub labels: Option<LabelFile>,
    /// Vanishes after the files in it, and only without them.
    folder: NewFolders,
}

impl Files {
    /// Begins them all, so that a full disk or a missing folder shows before the work.
    pub(super) fn begin(arguments: &RenderArgs, output: &Path, strings: &[&str]) -> Result<Self> {
        let (rate, depth) = (arguments.sample_rate, arguments.bit_depth);
        // The other files may be to go there, too. (Should one be refused, this goes after those before.)
        let folder = arguments.stems.as_ref().map(|folder| {
            let describe = || format!("cannot make the folder {}", shown(folder));
            ensure!(!folder.exists() || folder.is_dir(), "{}: it is a file", describe());
            NewFolders::make(folder).with_context(describe)
        });
        let folder = folder.transpose()?.unwrap_or_default();
        let mix = WavFile::begin(output, 2, rate, depth)?;
        let paths = stem_paths(arguments, strings);
        let stems = paths.iter().map(|path| WavFile::begin(path, 1, rate, depth)).collect::<Result<_>>()?;
        let labels = arguments.labels.as_deref().map(LabelFile::begin).transpose()?;
        if let Some(folder) = &arguments.stems {
            warn_of_others(arguments, folder, &paths, output);
        }
        Ok(Self { mix, stems, labels, folder })
    }

    /// Completes all files, then lets them appear: a disk that is full for one leaves none. The stereo sound comes last, so
    /// that who finds it has the others, too, even if the program is killed meanwhile and tidies nothing up.
    pub(super) fn finish(self, labelled: Labelled) -> Result<()> {
        let sound = self.mix.complete()?;
        let mut drafts = Vec::new();
        if let Some(labels) = self.labels {
            drafts.push(labels.complete(labelled)?);
        }
        for file in self.stems {
            drafts.push(file.complete()?);
        }
        drafts.push(sound);
        publish_all(drafts)?;
        drop(self.folder);
        Ok(())
    }
}

/// Where the strings' own sounds go, if they are wanted.
pub(super) fn stem_paths(arguments: &RenderArgs, strings: &[&str]) -> Vec<PathBuf> {
    let Some(folder) = &arguments.stems else { return Vec::new() };
    strings.iter().enumerate().map(|(index, name)| folder.join(stem_name(index, name))).collect()
}

/// Warns of files in a folder that look like sounds of strings and are none of those being written.
fn warn_of_others(arguments: &RenderArgs, folder: &Path, paths: &[PathBuf], output: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    let is_other = |name: &OsString| {
        let looks_like_it = name.to_str().is_some_and(is_stem_name);
        let mut written = paths.iter().map(PathBuf::as_path).chain([output]);
        looks_like_it && !written.any(|path| path.file_name() == Some(name.as_os_str()))
    };
    let mut others: Vec<OsString> = entries.filter(is_other).collect();
    others.sort();
    if let Some(first) = others.first() {
        let (folder, first) = (shown(folder), shown(Path::new(first)));
        let which = match others.len() {
            1 => format!("{first}, which is"),
            count => format!("{count} files, such as {first}, which are"),
        };
        warn(arguments, &format!("{folder} also holds {which} not of this song"));
    }
}

/// Whether a file's name is a number and a string's name.
fn is_stem_name(name: &str) -> bool {
    let number = name.strip_suffix(".wav").and_then(|name| name.split_once('-')).map(|(number, _)| number);
    number.is_some_and(|number| !number.is_empty() && number.chars().all(|c| c.is_ascii_digit()))
}

/// The most letters of a string's name in that of its file.
const LONGEST_NAME: usize = 50;

/// File name of a string's own sound: its number from 1 and its name, without what file systems
/// mind.
pub(super) fn stem_name(index: usize, string: &str) -> String {
    let name: String = string
        .chars()
        .take(LONGEST_NAME)
        .map(|c| if c.is_alphanumeric() || "-_#+".contains(c) { c } else { '_' })
        .collect();
    format!("{}-{name}.wav", index + 1)
}
