//! The form of a WAV file that is there: how many channels and frames it has, at which rate and of which bits.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Bytes of a chunk's name and size, of the form at the beginning of a format chunk, and up to the format within an extensible one.
const HEAD: u64 = 8;
const FORM: usize = 16;
const EXTENDED: usize = 26;
/// Kinds of format: floating point, and one that says farther on which it is.
const FLOATING_POINT: u16 = 3;
const EXTENSIBLE: u16 = 0xFFFE;

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
        let mut file = File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        read(&mut file, length).ok().flatten()
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

/// Reads a file of so many bytes, chunk by chunk up to the samples.
fn read(file: &mut (impl Read + Seek), length: u64) -> io::Result<Option<Form>> {
    let mut begins = [0; 12];
    file.read_exact(&mut begins)?;
    let size = u64::from(four(&begins, 4));
    if !begins.starts_with(b"RIFF") || !begins.ends_with(b"WAVE") || size + HEAD != length {
        return Ok(None);
    }
    let (mut place, mut form) = (begins.len() as u64, None);
    while place < length {
        let mut head = [0; HEAD as usize];
        file.seek(SeekFrom::Start(place))?;
        file.read_exact(&mut head)?;
        let size = u64::from(four(&head, 4));
        place += HEAD;
        match &head[..4] {
            b"fmt " => {
                let mut bytes = Vec::new();
                file.take(size.min(EXTENDED as u64)).read_to_end(&mut bytes)?;
                form = (bytes.len() >= FORM).then_some(bytes);
            }
            b"data" => return Ok(form.filter(|_| place + size <= length).and_then(|form| told(&form, size))),
            _ => {}
        }
        // (Chunks are padded to an even length.)
        place += size + size % 2;
    }
    Ok(None)
}

/// What a format chunk says of so many bytes of samples.
fn told(form: &[u8], bytes: u64) -> Option<Form> {
    let (channels, frame, bits) = (two(form, 2), two(form, 12), two(form, 14));
    let kind = match two(form, 0) {
        EXTENSIBLE if form.len() >= EXTENDED => two(form, EXTENDED - 2),
        kind => kind,
    };
    let frames = bytes.checked_div(frame.into())?;
    let bit_depth = format!("{bits}{}", if kind == FLOATING_POINT { "f" } else { "" });
    Some(Form { channels, sample_rate: four(form, 4), bit_depth, frames })
}

fn two(bytes: &[u8], place: usize) -> u16 {
    u16::from_le_bytes([bytes[place], bytes[place + 1]])
}

fn four(bytes: &[u8], place: usize) -> u32 {
    u32::from(two(bytes, place)) | u32::from(two(bytes, place + 2)) << 16
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
        let read = |bytes: &[u8]| read(&mut Cursor::new(bytes), bytes.len() as u64).ok().flatten();
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
