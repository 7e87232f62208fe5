//! WAV files of the three sample formats, and what is known of the sound once it is written.

mod form;
mod header;
mod room;

use std::fmt;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, Result, anyhow};
use hound::{SampleFormat, WavSpec, WavWriter};

use super::names::shown;
use super::output::Draft;
pub(super) use form::Form;
use room::WithRoom;

/// Bytes a WAV file can hold: sizes are 32-bit, and the header takes some.
const LARGEST_FILE: u64 = u32::MAX as u64 - 1024;

/// Why no more is written to one that holds as much.
const FULL: &str = "a WAV file holds 4 GiB and no more";

/// How samples are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BitDepth {
    /// Whole numbers of 16 bits.
    Int16,
    /// Whole numbers of 24 bits.
    Int24,
    /// Floating point of 32 bits: nothing is clipped.
    Float32,
}

impl BitDepth {
    fn bits(self) -> u16 {
        match self {
            Self::Int16 => 16,
            Self::Int24 => 24,
            Self::Float32 => 32,
        }
    }

    /// Samples per channel that fit in one file.
    pub(super) fn largest_length(self, channels: u16) -> u64 {
        LARGEST_FILE / (u64::from(self.bits() / 8) * u64::from(channels))
    }
}

impl fmt::Display for BitDepth {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Int16 => "16",
            Self::Int24 => "24",
            Self::Float32 => "32f",
        })
    }
}

impl FromStr for BitDepth {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "16" => Ok(Self::Int16),
            "24" => Ok(Self::Int24),
            "32f" => Ok(Self::Float32),
            _ => Err("must be 16, 24 or 32f".into()),
        }
    }
}

/// What was written.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Findings {
    /// Largest size of a sample, 1 is full scale.
    pub peak: f32,
    /// Samples that were no finite number (written as they are in floating point, as 0 otherwise).
    pub not_finite: u64,
}

impl Findings {
    /// Another sample is there.
    pub(super) fn look(&mut self, sample: f32) {
        self.peak = self.peak.max(sample.abs());
        self.not_finite += u64::from(!sample.is_finite());
    }
}

/// A WAV file being written.
pub(super) struct WavFile {
    path: PathBuf,
    draft: Draft,
    writer: WavWriter<BufWriter<WithRoom<File>>>,
    depth: BitDepth,
    /// Samples of all channels that it still has room for.
    left: u64,
    findings: Findings,
}

impl WavFile {
    /// Begins a file that appears at `path` when it is [completed](Self::complete) and published.
    pub(super) fn begin(path: &Path, channels: u16, sample_rate: u32, depth: BitDepth) -> Result<Self> {
        let sample_format = match depth {
            BitDepth::Float32 => SampleFormat::Float,
            BitDepth::Int16 | BitDepth::Int24 => SampleFormat::Int,
        };
        let spec = WavSpec { channels, sample_rate, bits_per_sample: depth.bits(), sample_format };
        let draft = Draft::begin(path)?;
        let writer = draft
            .handle()
            .map_err(hound::Error::from)
            .and_then(|file| WavWriter::new(BufWriter::new(WithRoom::new(file, sample_format)), spec))
            .with_context(|| format!("cannot write {}", shown(path)))?;
        let left = depth.largest_length(channels) * u64::from(channels);
        Ok(Self { path: path.to_owned(), draft, writer, depth, left, findings: Findings::default() })
    }

    /// Adds samples, channels of one instant side by side.
    pub(super) fn write(&mut self, samples: impl Iterator<Item = f32>) -> Result<()> {
        for sample in samples {
            // What counts its bytes would begin again at 0.
            let left = self.left.checked_sub(1);
            self.left = left.with_context(|| format!("cannot write {}: {FULL}", shown(&self.path)))?;
            self.findings.look(sample);
            let written = match self.depth {
                BitDepth::Int16 => self.writer.write_sample(whole(sample, 16)),
                BitDepth::Int24 => self.writer.write_sample(whole(sample, 24)),
                BitDepth::Float32 => self.writer.write_sample(sample),
            };
            written.map_err(|error| self.refused(error))?;
        }
        Ok(())
    }

    /// What has been written so far.
    pub(super) fn findings(&self) -> Findings {
        self.findings
    }

    /// Completes the file, which then waits to be published.
    pub(super) fn complete(self) -> Result<Draft> {
        let Self { path, draft, writer, .. } = self;
        let finished = writer.finalize().map_err(plain);
        let mended = finished.and_then(|()| Ok(header::mend(&mut draft.handle()?)?));
        mended.with_context(|| format!("cannot write {}", shown(&path)))?;
        Ok(draft)
    }

    fn refused(&self, error: hound::Error) -> anyhow::Error {
        plain(error).context(format!("cannot write {}", shown(&self.path)))
    }
}

/// The system's own error where there is one.
fn plain(error: hound::Error) -> anyhow::Error {
    match error {
        hound::Error::IoError(error) => anyhow!(error),
        other => anyhow!(other),
    }
}

/// The nearest whole number of so many bits; louder than full scale is clipped, and what is not a
/// number becomes 0.
fn whole(sample: f32, bits: u32) -> i32 {
    let scale = f64::from(1_i32 << (bits - 1));
    (f64::from(sample) * scale).round().clamp(-scale, scale - 1.0) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_file_takes_no_more() {
        let room = tempfile::tempdir().unwrap();
        let mut file = WavFile::begin(&room.path().join("x.wav"), 2, 48_000, BitDepth::Int24).unwrap();
        assert!(file.left * 3 <= LARGEST_FILE && file.left * 3 > LARGEST_FILE - 6);
        file.left = 4;
        file.write([0.1; 4].into_iter()).unwrap();
        let error = format!("{:#}", file.write([0.1; 2].into_iter()).unwrap_err());
        assert!(
            error.starts_with("cannot write ")
                && error.ends_with("x.wav: a WAV file holds 4 GiB and no more")
        );
        drop(file);
        assert_eq!(std::fs::read_dir(room.path()).unwrap().count(), 0);
    }

    #[test]
    fn whole_numbers_round_and_clip() {
        assert_eq!(whole(0.5, 16), 16_384);
        assert_eq!(whole(1.0, 16), 32_767);
        assert_eq!(whole(-1.0, 16), -32_768);
        assert_eq!(whole(-9.0, 24), -8_388_608);
        assert_eq!(whole(f32::INFINITY, 24), 8_388_607);
        assert_eq!(whole(f32::NAN, 24), 0);
        assert_eq!(whole(0.6 / 32_768.0, 16), 1);
    }
}
