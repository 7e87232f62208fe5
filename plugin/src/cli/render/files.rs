//! The files of one rendering: the stereo sound, and on request each string's own.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::cli::RenderArgs;
use crate::cli::output::Draft;
use crate::cli::unfinished::NewFolders;
use crate::cli::wav::{Findings, WavFile};

/// The files of one rendering.
pub(super) struct Files {
    pub mix: WavFile,
    pub stems: Vec<WavFile>,
    /// Vanishes after the files in it, and only without them.
    folder: NewFolders,
}

impl Files {
    /// Begins them all, so that a full disk or a missing folder shows before the work.
    pub(super) fn begin(arguments: &RenderArgs, output: &Path, strings: &[&str]) -> Result<Self> {
        let (rate, depth) = (arguments.sample_rate, arguments.bit_depth);
        let mix = WavFile::begin(output, 2, rate, depth)?;
        let folder = arguments.stems.as_ref().map(|folder| {
            NewFolders::make(folder).with_context(|| format!("cannot make the folder {}", folder.display()))
        });
        let folder = folder.transpose()?.unwrap_or_default();
        let stems = stem_paths(arguments, strings).into_iter();
        let stems = stems.map(|path| WavFile::begin(&path, 1, rate, depth)).collect::<Result<_>>()?;
        Ok(Self { mix, stems, folder })
    }

    /// Completes all files, then lets them appear: a disk that is full for one leaves none. Returns what
    /// was found in the stereo file and in the strings' own.
    pub(super) fn finish(self) -> Result<[Findings; 2]> {
        let (draft, mix) = self.mix.complete()?;
        let mut drafts = vec![draft];
        let mut stems = Findings::default();
        for file in self.stems {
            let (draft, findings) = file.complete()?;
            stems.peak = stems.peak.max(findings.peak);
            stems.not_finite += findings.not_finite;
            drafts.push(draft);
        }
        drafts.into_iter().try_for_each(Draft::publish)?;
        drop(self.folder);
        Ok([mix, stems])
    }
}

/// Where the strings' own sounds go, if they are wanted.
pub(super) fn stem_paths(arguments: &RenderArgs, strings: &[&str]) -> Vec<PathBuf> {
    let Some(folder) = &arguments.stems else { return Vec::new() };
    strings.iter().enumerate().map(|(index, name)| folder.join(stem_name(index, name))).collect()
}

/// The most letters of a string's name in that of its file.
const LONGEST_NAME: usize = 50;

/// File name of a string's own sound: its number from 1 and its name, without what file systems
/// mind.
fn stem_name(index: usize, string: &str) -> String {
    let name: String = string
        .chars()
        .take(LONGEST_NAME)
        .map(|c| if c.is_alphanumeric() || "-_#+".contains(c) { c } else { '_' })
        .collect();
    format!("{}-{name}.wav", index + 1)
}
