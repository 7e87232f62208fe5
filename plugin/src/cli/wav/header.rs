//! What the WAV files of the crate `hound` lack.

use std::io::{Read, Result, Seek, SeekFrom, Write};

/// Where the fields of its headers stand, and what they hold, little-endian.
const SIZE: u64 = 4;
const FORMAT: u64 = 20;
const EXTENSIBLE: [u8; 2] = [0xFE, 0xFF];
const CHANNELS: u64 = 22;
const CHANNEL_MASK: u64 = 40;
const SAMPLE_FORMAT: u64 = 44;
const FLOATING_POINT: [u8; 2] = [3, 0];

/// Where the chunk `fact` stands in files of floating point, and its bytes: how many frames there are. Microsoft's standard asks
/// for one of all formats but whole numbers.
pub(super) const FACT: u64 = 60;
pub(super) const FACT_SIZE: u64 = 12;
/// Where the size of the data stands behind it.
const DATA_SIZE: u64 = FACT + FACT_SIZE + 4;

/// The loudspeaker of a single channel, in front in the middle. (`hound` says left, which encoders refuse.)
const CENTRE: u32 = 4;

/// Mends a finished file: a single channel is in the middle, floating point has its `fact`, for which there is [room](super::room),
/// and the data are padded to an even length.
pub(super) fn mend(file: &mut (impl Read + Write + Seek)) -> Result<()> {
    let (format, channels) = (field(file, FORMAT)?, field(file, CHANNELS)?);
    if format == EXTENSIBLE && u16::from_le_bytes(channels) == 1 {
        put(file, CHANNEL_MASK, &CENTRE.to_le_bytes())?;
    }
    // (Of whole numbers of 16 bits there are data at that place.)
    if format == EXTENSIBLE && field(file, SAMPLE_FORMAT)? == FLOATING_POINT {
        let frames =
            u32::from_le_bytes(field(file, DATA_SIZE)?) / (4 * u32::from(u16::from_le_bytes(channels)));
        let fact = [&b"fact"[..], &4_u32.to_le_bytes(), &frames.to_le_bytes()].concat();
        put(file, FACT, &fact)?;
    }
    let length = file.seek(SeekFrom::End(0))?;
    if !length.is_multiple_of(2) {
        // (The size of the whole counts this byte; that of the data does not.)
        file.write_all(&[0])?;
    }
    let size = file.seek(SeekFrom::End(0))? as u32 - 8;
    put(file, SIZE, &size.to_le_bytes())
}

fn field<const BYTES: usize>(file: &mut (impl Read + Seek), place: u64) -> Result<[u8; BYTES]> {
    let mut bytes = [0; BYTES];
    file.seek(SeekFrom::Start(place))?;
    file.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn put(file: &mut (impl Write + Seek), place: u64, bytes: &[u8]) -> Result<()> {
    file.seek(SeekFrom::Start(place))?;
    file.write_all(bytes)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use hound::{SampleFormat, WavReader, WavSpec, WavWriter};

    use super::super::room::WithRoom;
    use super::*;

    /// A mended file of so many frames of one sample.
    fn mended(channels: u16, bits_per_sample: u16, frames: u16) -> Vec<u8> {
        let sample_format = if bits_per_sample == 32 { SampleFormat::Float } else { SampleFormat::Int };
        let spec = WavSpec { channels, sample_rate: 48_000, bits_per_sample, sample_format };
        let mut file = Cursor::new(Vec::new());
        let mut writer = WavWriter::new(WithRoom::new(&mut file, sample_format), spec).unwrap();
        for _ in 0..frames * channels {
            match sample_format {
                SampleFormat::Int => writer.write_sample(-7).unwrap(),
                SampleFormat::Float => writer.write_sample(-7.0_f32).unwrap(),
            }
        }
        writer.finalize().unwrap();
        mend(&mut file).unwrap();
        file.into_inner()
    }

    #[test]
    fn sizes_are_even_and_a_single_channel_is_in_the_middle() {
        for (channels, bits, frames) in
            [(1, 24, 3), (1, 24, 4), (2, 24, 3), (1, 16, 3), (1, 32, 3), (2, 32, 1), (1, 24, 0)]
        {
            let file = mended(channels, bits, frames);
            let of = format!("{channels} {bits} {frames}");
            let number = |place: usize| u32::from_le_bytes(*file[place..].first_chunk().unwrap());
            assert_eq!(file.len() % 2, 0, "{of}");
            assert_eq!(number(4) as usize, file.len() - 8, "{of}");
            let data = file.windows(4).position(|four| four == b"data").unwrap();
            assert_eq!(number(data + 4), u32::from(channels * bits / 8 * frames), "{of}");
            // The format is extensible, and the mask at its place, where the first chunk has 40 bytes.
            if number(16) == 40 {
                assert_eq!(number(40), if channels == 1 { 4 } else { 3 }, "{of}");
            } else {
                assert_eq!(bits, 16, "{of}");
            }
            let fact = file.windows(4).position(|four| four == b"fact");
            assert_eq!(fact, (bits == 32).then_some(60), "{of}");
            if let Some(fact) = fact {
                assert_eq!(
                    (number(fact + 4), number(fact + 8), data),
                    (4, u32::from(frames), fact + 12),
                    "{of}"
                );
            }
            let mut reader = WavReader::new(Cursor::new(file)).unwrap();
            if bits == 32 {
                assert!(reader.samples::<f32>().all(|sample| sample.unwrap() == -7.0), "{of}");
            }
            assert_eq!((reader.spec().bits_per_sample, reader.duration()), (bits, u32::from(frames)), "{of}");
        }
    }
}
