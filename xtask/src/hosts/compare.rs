//! Two sounds beside each other.

use std::fmt;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use low_action_dsp::Instrument;

/// A stereo sound.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sound {
    channels: [Vec<f32>; 2],
}

impl Sound {
    /// The first `frames` of a WAV file of 32-bit floating point.
    pub(super) fn from_wav(path: &Path, frames: usize) -> Result<Self> {
        let describe = || format!("cannot read {}", path.display());
        let reader = hound::WavReader::open(path).with_context(describe)?;
        let samples = reader.into_samples::<f32>().collect::<Result<Vec<_>, _>>().with_context(describe)?;
        Self::interleaved(&samples, frames)
    }

    /// The first `frames` of a file of interleaved samples, 32-bit floating point, least byte first.
    pub(super) fn from_raw(path: &Path, frames: usize) -> Result<Self> {
        let bytes = std::fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let samples: Vec<f32> =
            bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
        Self::interleaved(&samples, frames)
    }

    fn interleaved(samples: &[f32], frames: usize) -> Result<Self> {
        ensure!(samples.len() >= 2 * frames, "{} frames instead of {frames}", samples.len() / 2);
        let channel = |side| samples[..2 * frames].iter().skip(side).step_by(2).copied().collect();
        Ok(Self { channels: [channel(0), channel(1)] })
    }

    /// Sum of the squares from a frame on.
    fn energy(&self, from: usize) -> f64 {
        self.channels.iter().flat_map(|channel| &channel[from..]).map(|x| f64::from(*x).powi(2)).sum()
    }

    /// The first frame above −80 dBFS.
    fn onset(&self) -> Option<usize> {
        let [left, right] = &self.channels;
        left.iter().zip(right).position(|(l, r)| l.abs().max(r.abs()) > 1e-4)
    }
}

/// What the plugin tells hosts, samples: a host makes up for all of it or for none.
const LATENCY: usize = Instrument::LATENCY as usize;
/// Farthest shift looked for, samples: a host that plays late by a block or two is told by how much.
const FARTHEST: usize = 2048;

/// How two sounds differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Comparison {
    /// Samples by which the second comes later, as a whole.
    shift: usize,
    /// RMS of what is left over, as a part of the first one's.
    relative_rms: f64,
    /// How much later the second one's first sound is after the shift, samples.
    onset: Option<i64>,
    /// How much louder the second is, dB.
    level: f64,
}

impl Comparison {
    /// Refuses a difference above `tolerance`, a sound that is not there, or one that comes neither at its time nor by the
    /// plugin's latency later.
    pub(super) fn accept(&self, tolerance: f64) -> Result<()> {
        ensure!(
            [0, LATENCY].contains(&self.shift),
            "the sound is late by neither 0 nor {LATENCY} samples: {self}"
        );
        ensure!(self.onset == Some(0), "the first sound is not where it should be: {self}");
        ensure!(self.relative_rms <= tolerance, "the sounds differ by more than {tolerance:e}: {self}");
        Ok(())
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { shift, relative_rms, onset, level } = self;
        write!(out, "shift {shift} samples, relative RMS {relative_rms:.1e}, onset off by ")?;
        match onset {
            Some(samples) => write!(out, "{samples} samples")?,
            None => write!(out, "unknown: one is silent")?,
        }
        write!(out, ", level {level:+.4} dB")
    }
}

/// Compares what a host played with what was rendered. The shift is that of the first sound.
pub(super) fn compare(rendered: &Sound, played: &Sound) -> Comparison {
    let onsets = rendered.onset().zip(played.onset());
    let shift = onsets.map_or(0, |(first, second)| second.saturating_sub(first).min(FARTHEST));
    let frames = rendered.channels[0].len();
    let apart: f64 = rendered
        .channels
        .iter()
        .zip(&played.channels)
        .flat_map(|(a, b)| a[..frames - shift].iter().zip(&b[shift..]))
        .map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2))
        .sum();
    let (first, second) = (rendered.energy(0), played.energy(0));
    Comparison {
        shift,
        relative_rms: (apart / first.max(f64::MIN_POSITIVE)).sqrt(),
        onset: onsets.map(|(first, second)| second as i64 - first as i64 - shift as i64),
        level: 10.0 * (second / first.max(f64::MIN_POSITIVE)).log10(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(late: usize, gain: f32, pitch: f32) -> Sound {
        let sample = |n: usize| if n < 100 + late { 0.0 } else { gain * ((n - late) as f32 * pitch).sin() };
        let channel: Vec<f32> = (0..48_000).map(sample).collect();
        Sound { channels: [channel.clone(), channel] }
    }

    #[test]
    fn a_late_sound_is_the_same_sound_as_late_as_was_told() {
        let late = |samples| compare(&tone(0, 0.5, 0.05), &tone(samples, 0.5, 0.05));
        for samples in [0, LATENCY] {
            assert_eq!((late(samples).shift, late(samples).onset), (samples, Some(0)));
            assert!(late(samples).accept(1e-4).is_ok(), "{}", late(samples));
        }
        assert!(late(LATENCY + 1).accept(1e-4).is_err(), "a sample later than the host was told");
    }

    #[test]
    fn pitch_level_and_silence_are_noticed() {
        // A tenth of a cent, and a hundredth of a decibel.
        for other in [tone(0, 0.5, 0.05 * 1.000_058), tone(0, 0.5 * 1.00115, 0.05), tone(0, 0.0, 0.05)] {
            assert!(compare(&tone(0, 0.5, 0.05), &other).accept(1e-4).is_err());
        }
    }
}
