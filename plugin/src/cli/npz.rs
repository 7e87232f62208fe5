//! NPZ files written in one pass: arrays of known size that all grow together.
//!
//! An NPZ file is a ZIP archive of NPY arrays, and a ZIP archive is usually written one entry after
//! the other; a simulation however yields a row of every array at each step. Nothing is compressed
//! here and all sizes are known beforehand, so each array's place in the file is known as well: rows
//! are gathered and written where they belong, in little memory and without a second copy on the disk.
//!
//! The records are those of the ZIP specification (PKWARE APPNOTE.TXT 6.3.3, section 4.3), with
//! 64-bit sizes throughout. No date is written, so that equal contents make equal files.

use std::fs::File;
use std::io::{self, Seek, SeekFrom, Write};

use crc32fast::Hasher;
use npyz::{DType, WriterBuilder};

/// Bytes gathered for all arrays together before they are written.
const GATHERED: usize = 64 << 20;
/// Bytes gathered for one array, at least and at most: few large arrays need no more, and many small
/// ones should not be written number by number.
const GATHERED_EACH: std::ops::RangeInclusive<usize> = 256..=1 << 20;

/// ZIP version needed for 64-bit sizes, times ten (APPNOTE 4.4.3.2).
const VERSION: u16 = 45;
/// 1 January 1980, the first date there is (APPNOTE 4.4.6).
const NO_DATE: u16 = (1 << 5) | 1;
/// Says that a 32- or 16-bit field is found in its 64-bit form elsewhere.
const SEE_64: u32 = u32::MAX;
/// Name of the extra field with 64-bit sizes (APPNOTE 4.5.3).
const EXTRA_64: u16 = 1;

/// What an array holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Numbers of 64 bits.
    Real,
    /// Whole numbers of 32 bits, 0 or more.
    Count,
    /// Whole numbers of 64 bits, 0 or more.
    Whole,
    /// Text of so many characters, 1 or more.
    Text(u64),
}

impl Kind {
    /// NumPy's name of the type, little-endian.
    fn name(self) -> String {
        match self {
            Kind::Real => "<f8".into(),
            Kind::Count => "<u4".into(),
            Kind::Whole => "<u8".into(),
            Kind::Text(characters) => format!("<U{characters}"),
        }
    }

    fn bytes(self) -> u64 {
        match self {
            Kind::Real | Kind::Whole => 8,
            Kind::Count => 4,
            Kind::Text(characters) => 4 * characters,
        }
    }
}

/// An array of an NPZ file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Array {
    pub name: String,
    pub kind: Kind,
    /// Its lengths, the one that changes most slowly first; none for a single value.
    pub shape: Vec<u64>,
}

impl Array {
    /// Bytes of its numbers.
    pub fn bytes(&self) -> u64 {
        self.shape.iter().product::<u64>() * self.kind.bytes()
    }

    fn file_name(&self) -> String {
        npyz::npz::file_name_from_array_name(&self.name)
    }

    /// The NPY header.
    fn header(&self) -> io::Result<Vec<u8>> {
        let kind = self.kind.name().parse().map_err(io::Error::other)?;
        let options = npyz::WriteOptions::new_header_only().dtype(DType::Plain(kind)).shape(&self.shape);
        let mut header = Vec::new();
        options.writer(&mut header).write_header_only()?;
        Ok(header)
    }
}

/// One array on its way into the file.
struct Entry {
    name: String,
    /// Where its ZIP record begins.
    start: u64,
    /// Length of NPY header and numbers.
    size: u64,
    /// Where the next bytes go, and where the last one ends.
    next: u64,
    end: u64,
    gathered: Vec<u8>,
    checksum: Hasher,
}

/// An NPZ file being written.
pub(super) struct NpzFile {
    file: File,
    entries: Vec<Entry>,
    /// Bytes an array gathers before they are written.
    gathered: usize,
}

impl NpzFile {
    /// Begins a file of these arrays. Numbers are [added](Self::add) to each in order, and every array
    /// must be full when the file is [completed](Self::complete).
    pub fn begin(file: File, arrays: &[Array]) -> io::Result<NpzFile> {
        let gathered = (GATHERED / arrays.len().max(1)).clamp(*GATHERED_EACH.start(), *GATHERED_EACH.end());
        let mut npz = NpzFile { file, entries: Vec::with_capacity(arrays.len()), gathered };
        let mut start = 0;
        for array in arrays {
            let header = array.header()?;
            let size = header.len() as u64 + array.bytes();
            let next = start + local_header(&array.file_name(), size, 0).len() as u64;
            let end = next + size;
            let (gathered, checksum) = (Vec::new(), Hasher::new());
            npz.entries.push(Entry { name: array.file_name(), start, size, next, end, gathered, checksum });
            npz.add_bytes(npz.entries.len() - 1, &header)?;
            start = end;
        }
        Ok(npz)
    }

    /// Adds numbers to an array of [`Kind::Real`], by its index.
    pub fn add(&mut self, array: usize, numbers: &[f64]) -> io::Result<()> {
        numbers.iter().try_for_each(|number| self.add_bytes(array, &number.to_le_bytes()))
    }

    /// Adds a number to an array of [`Kind::Count`].
    pub fn add_count(&mut self, array: usize, count: u32) -> io::Result<()> {
        self.add_bytes(array, &count.to_le_bytes())
    }

    /// Adds a number to an array of [`Kind::Whole`].
    pub fn add_whole(&mut self, array: usize, number: u64) -> io::Result<()> {
        self.add_bytes(array, &number.to_le_bytes())
    }

    /// Adds a text to an array of [`Kind::Text`], in UTF-32 as NumPy has it.
    pub fn add_text(&mut self, array: usize, text: &str) -> io::Result<()> {
        text.chars().try_for_each(|character| self.add_bytes(array, &u32::from(character).to_le_bytes()))
    }

    fn add_bytes(&mut self, array: usize, bytes: &[u8]) -> io::Result<()> {
        let entry = &mut self.entries[array];
        if entry.gathered.len() + bytes.len() > self.gathered {
            entry.flush(&mut self.file)?;
        }
        entry.gathered.extend_from_slice(bytes);
        Ok(())
    }

    /// Writes what is still gathered, and the records that make the arrays an archive.
    pub fn complete(mut self) -> io::Result<()> {
        let mut directory = Vec::new();
        let mut end = 0;
        for entry in &mut self.entries {
            entry.flush(&mut self.file)?;
            if entry.next != entry.end {
                return Err(io::Error::other(format!("{} is not complete", entry.name)));
            }
            let checksum = entry.checksum.clone().finalize();
            self.file.seek(SeekFrom::Start(entry.start))?;
            self.file.write_all(&local_header(&entry.name, entry.size, checksum))?;
            directory.extend(directory_record(entry, checksum));
            end = entry.end;
        }
        self.file.seek(SeekFrom::Start(end))?;
        let directory_size = directory.len() as u64;
        directory.extend(end_records(self.entries.len() as u64, end, directory_size));
        self.file.write_all(&directory)
    }
}

impl Entry {
    fn flush(&mut self, file: &mut File) -> io::Result<()> {
        let size = self.gathered.len() as u64;
        if self.next + size > self.end {
            return Err(io::Error::other(format!("{} is longer than was said", self.name)));
        }
        self.checksum.update(&self.gathered);
        file.seek(SeekFrom::Start(self.next))?;
        file.write_all(&self.gathered)?;
        self.next += size;
        self.gathered.clear();
        Ok(())
    }
}

/// Little-endian fields in a row.
#[derive(Default)]
struct Record(Vec<u8>);

impl Record {
    fn u16s(mut self, fields: &[u16]) -> Self {
        fields.iter().for_each(|field| self.0.extend(field.to_le_bytes()));
        self
    }

    fn u32s(mut self, fields: &[u32]) -> Self {
        fields.iter().for_each(|field| self.0.extend(field.to_le_bytes()));
        self
    }

    fn u64s(mut self, fields: &[u64]) -> Self {
        fields.iter().for_each(|field| self.0.extend(field.to_le_bytes()));
        self
    }

    fn text(mut self, text: &str) -> Self {
        self.0.extend(text.as_bytes());
        self
    }
}

/// Fields that the two records of an entry share: flags, method (stored), time and date; then checksum
/// and sizes; then lengths of name and extra field.
fn common_fields(record: Record, name: &str, checksum: u32, extra_length: u16) -> Record {
    record
        .u16s(&[0, 0, 0, NO_DATE])
        .u32s(&[checksum, SEE_64, SEE_64])
        .u16s(&[name.len() as u16, extra_length])
}

/// Local file header (APPNOTE 4.3.7).
fn local_header(name: &str, size: u64, checksum: u32) -> Vec<u8> {
    let record = Record::default().u32s(&[0x0403_4b50]).u16s(&[VERSION]);
    common_fields(record, name, checksum, 20).text(name).u16s(&[EXTRA_64, 16]).u64s(&[size, size]).0
}

/// Entry of the central directory (APPNOTE 4.3.12).
fn directory_record(entry: &Entry, checksum: u32) -> Vec<u8> {
    let record = Record::default().u32s(&[0x0201_4b50]).u16s(&[VERSION, VERSION]);
    common_fields(record, &entry.name, checksum, 28)
        // Comment's length, disk, internal attributes; external attributes; place.
        .u16s(&[0, 0, 0])
        .u32s(&[0, SEE_64])
        .text(&entry.name)
        .u16s(&[EXTRA_64, 24])
        .u64s(&[entry.size, entry.size, entry.start])
        .0
}

/// End of the central directory in 64 bits, its locator, and the end in 32 bits that refers to them
/// (APPNOTE 4.3.14 to 4.3.16).
fn end_records(entries: u64, directory_start: u64, directory_size: u64) -> Vec<u8> {
    Record::default()
        .u32s(&[0x0606_4b50])
        // Length of the rest of this record.
        .u64s(&[44])
        .u16s(&[VERSION, VERSION])
        .u32s(&[0, 0])
        .u64s(&[entries, entries, directory_size, directory_start])
        .u32s(&[0x0706_4b50, 0])
        .u64s(&[directory_start + directory_size])
        .u32s(&[1])
        .u32s(&[0x0605_4b50])
        .u16s(&[0, 0, u16::MAX, u16::MAX])
        .u32s(&[SEE_64, SEE_64])
        .u16s(&[0])
        .0
}
