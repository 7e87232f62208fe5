//! The form of a WAV file that is there: how many channels and frames it has, at which rate and of which bits.

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use hound::{SampleFormat, WavReader};

/// What a WAV file holds, but for the samples themselves.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::cli) struct Form {
    pub channels: u16,
    /// Hz.
    pub sample_rate: u32,
    /// As `--bit-depth` says it.
    pub bit_depth: String,
    pub frames: u64,
}

impl Form {
    /// That of a file, if it is a WAV file as long as it says: it may have been copied, and the copy broken off.
    pub(in crate::cli) fn of_whole(path: &Path) -> Option<Self> {
        let file = File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        read(BufReader::new(file), length)
    }

    /// How it differs from another that is wanted, in words.
    pub(in crate::cli) fn difference(&self, wanted: &Self) -> Option<String> {
        let words = |form: &Self| {
            let Self { channels, sample_rate, bit_depth, frames } = form;
            let plural = if *channels == 1 { "" } else { "s" };
            [
                format!("{channels} channel{plural}"),
                format!("{sample_rate} Hz"),
                format!("{bit_depth} bit"),
                format!("{frames} samples"),
            ]
        };
        let mut pairs = words(self).into_iter().zip(words(wanted));
        pairs.find(|(is, wanted)| is != wanted).map(|(is, wanted)| format!("is of {is} and not {wanted}"))
    }
}

/// Reads a file of so many bytes up to the samples.
fn read(mut file: impl Read + Seek, length: u64) -> Option<Form> {
    let mut begins = [0; 8];
    file.read_exact(&mut begins).ok()?;
    let [.., a, b, c, d] = begins;
    if u64::from(u32::from_le_bytes([a, b, c, d])) + begins.len() as u64 != length {
        return None;
    }
    file.rewind().ok()?;
    let mut reader = WavReader::new(file).ok()?;
    let (spec, frames) = (reader.spec(), reader.duration());
    let bits = spec.bits_per_sample;
    // (It takes a header's word for how long the data are.)
    let data = u64::from(reader.len()) * u64::from(bits / 8);
    if reader.seek(0).is_err() || reader.into_inner().stream_position().ok()? + data > length {
        return None;
    }
    let bit_depth = format!("{bits}{}", if spec.sample_format == SampleFormat::Float { "f" } else { "" });
    Some(Form { channels: spec.channels, sample_rate: spec.sample_rate, bit_depth, frames: frames.into() })
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Cursor;

    use super::super::{BitDepth, WavFile};
    use super::*;
    use crate::cli::output::publish_all;

    /// A file of three frames as this program writes it.
    fn written(channels: u16, depth: BitDepth) -> (Form, Vec<u8>) {
        let room = tempfile::tempdir().unwrap();
        let path = room.path().join("x.wav");
        let mut file = WavFile::begin(&path, channels, 44_100, depth).unwrap();
        file.write((0..3 * channels).map(|_| 0.25)).unwrap();
        publish_all(vec![file.complete().unwrap()]).unwrap();
        (Form::of_whole(&path).unwrap(), fs::read(&path).unwrap())
    }

    #[test]
    fn what_is_written_is_what_is_read() {
        for channels in [1, 2] {
            for depth in [BitDepth::Int16, BitDepth::Int24, BitDepth::Float32] {
                let bit_depth = depth.to_string();
                let expected = Form { channels, sample_rate: 44_100, bit_depth, frames: 3 };
                assert_eq!(written(channels, depth).0, expected);
            }
        }
    }

    #[test]
    fn whatever_is_no_whole_sound_has_no_form() {
        let (form, whole) = written(2, BitDepth::Float32);
        let read = |bytes: &[u8]| read(Cursor::new(bytes), bytes.len() as u64);
        assert_eq!(read(&whole), Some(form));
        for length in 0..whole.len() {
            assert_eq!(read(&whole[..length]), None, "{length}");
            // Nor does one panic that says it is whole, or that anything else is.
            let mut cut = whole[..length].to_vec();
            if let Some(size) = cut.get_mut(4..8) {
                size.copy_from_slice(&(length as u32).saturating_sub(8).to_le_bytes());
                assert_eq!(read(&cut), None, "{length}");
            }
            for value in [0, 1, 255] {
                let mut other = whole.clone();
                other[length] = value;
                let _ = read(&other);
            }
        }
    }

    #[test]
    fn the_first_difference_is_told() {
        let form = written(2, BitDepth::Int24).0;
        assert_eq!(form.difference(&form), None);
        for (other, expected) in [
            (Form { channels: 1, frames: 9, ..form.clone() }, "is of 2 channels and not 1 channel"),
            (Form { sample_rate: 8_000, ..form.clone() }, "is of 44100 Hz and not 8000 Hz"),
            (Form { frames: 9, ..form.clone() }, "is of 3 samples and not 9 samples"),
            (Form { bit_depth: "16".into(), ..form.clone() }, "is of 24 bit and not 16 bit"),
        ] {
            assert_eq!(form.difference(&other).as_deref(), Some(expected));
        }
    }
}
