//! What a figure sounds like, as a WAV file to listen to.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// A sound, in the unit of whatever was listened to.
pub struct Sound {
    /// The file is `NAME.wav`.
    pub name: String,
    /// Sample rate, Hz.
    pub rate: u32,
    /// The samples.
    pub samples: Vec<f64>,
}

/// Largest sample as a part of full scale: 3 dB below it.
const PEAK: f64 = 0.708;

impl Sound {
    /// Writes it as 16-bit WAV, made as loud as fits: for SI units there is `low-action scene --wav`.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let path = folder.join(&self.name).with_extension("wav");
        let describe = || format!("cannot write {}", path.display());
        fs::create_dir_all(folder).with_context(describe)?;
        let largest = self.samples.iter().fold(f64::MIN_POSITIVE, |most, sample| most.max(sample.abs()));
        let scale = PEAK * f64::from(i16::MAX) / largest;
        let sample_format = hound::SampleFormat::Int;
        let spec = hound::WavSpec { channels: 1, sample_rate: self.rate, bits_per_sample: 16, sample_format };
        let mut wav = hound::WavWriter::create(&path, spec).with_context(describe)?;
        for sample in &self.samples {
            wav.write_sample((sample * scale).round() as i16).with_context(describe)?;
        }
        wav.finalize().with_context(describe)?;
        println!("wrote {}", path.display());
        Ok(())
    }
}
