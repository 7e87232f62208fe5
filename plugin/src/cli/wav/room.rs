//! Room for a chunk that the crate `hound` does not write, before the data of its files.

use std::io::{Result, Seek, SeekFrom, Write};

use hound::SampleFormat;

use super::header::{FACT, FACT_SIZE};

/// A file in which all that `hound` writes from some place on stands farther back.
pub(super) struct WithRoom<F> {
    file: F,
    /// As `hound` counts.
    place: u64,
    room: u64,
}

impl<F: Write + Seek> WithRoom<F> {
    /// An empty file, with room for what a sample format asks for.
    pub(super) fn new(file: F, format: SampleFormat) -> Self {
        let room = if format == SampleFormat::Float { FACT_SIZE } else { 0 };
        Self { file, place: 0, room }
    }

    fn go_to(&mut self, place: u64) -> Result<u64> {
        let behind = if place < FACT { 0 } else { self.room };
        self.file.seek(SeekFrom::Start(place + behind))?;
        self.place = place;
        Ok(place)
    }
}

impl<F: Write + Seek> Write for WithRoom<F> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        // (No further than to the room, the first time.)
        let before = FACT.checked_sub(self.place).filter(|&left| left > 0);
        let most = before.map_or(bytes.len(), |left| bytes.len().min(left as usize));
        let written = self.file.write(&bytes[..most])?;
        self.place += written as u64;
        if before == Some(written as u64) {
            self.go_to(FACT)?;
        }
        Ok(written)
    }

    fn flush(&mut self) -> Result<()> {
        self.file.flush()
    }
}

impl<F: Write + Seek> Seek for WithRoom<F> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::Current(by) => self.place.checked_add_signed(by),
            SeekFrom::End(by) => (self.file.seek(SeekFrom::End(by))?).checked_sub(self.room),
        };
        self.go_to(place.ok_or(std::io::ErrorKind::InvalidInput)?)
    }
}
