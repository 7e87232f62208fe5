//! The files of one rendering: the stereo sound, and on request each string's own.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::cli::RenderArgs;
use crate::cli::output::Draft;
use crate::cli::wav::{Findings, WavFile};

/// The files of one rendering.
pub(super) struct Files {
    pub mix: WavFile,
    pub stems: Vec<WavFile>,
}

impl Files {
    /// Begins them all, so that a full disk or a missing folder shows before the work.
    pub(super) fn begin(arguments: &RenderArgs, output: &Path, strings: &[&str]) -> Result<Self> {
        let (rate, depth) = (arguments.sample_rate, arguments.bit_depth);
        let mix = WavFile::begin(output, 2, rate, depth)?;
        let mut stems = Vec::new();
        if let Some(folder) = &arguments.stems {
            fs::create_dir_all(folder)
                .with_context(|| format!("cannot make the folder {}", folder.display()))?;
            for (index, name) in strings.iter().enumerate() {
                let path = folder.join(stem_name(index, name));
                stems.push(WavFile::begin(&path, 1, rate, depth)?);
            }
        }
        Ok(Self { mix, stems })
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
        Ok([mix, stems])
    }
}

/// File name of a string's own sound: its number from 1 and its name, without what file systems
/// mind.
fn stem_name(index: usize, string: &str) -> String {
    let name: String =
        string.chars().map(|c| if c.is_alphanumeric() || "-_#+".contains(c) { c } else { '_' }).collect();
    format!("{}-{name}.wav", index + 1)
}
