//! Traces as read by libraries that share no code with the writer.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use npyz::NpyFile;
use zip::ZipArchive;

/// An array of numbers.
#[derive(Debug)]
pub struct Array {
    /// Its lengths, the one that changes most slowly first.
    pub shape: Vec<u64>,
    /// What is in it, in that order.
    pub numbers: Vec<f64>,
}

fn open(path: &Path) -> ZipArchive<File> {
    ZipArchive::new(File::open(path).unwrap()).unwrap()
}

/// All arrays of numbers of a trace, by name.
pub fn arrays(path: &Path) -> BTreeMap<String, Array> {
    let mut archive = open(path);
    let mut arrays = BTreeMap::new();
    for index in 0..archive.len() {
        // Reading to the end compares the checksum.
        let entry = archive.by_index(index).unwrap();
        let name = entry.name().unwrap().strip_suffix(".npy").unwrap().to_owned();
        if name == "scene" || name == "program" {
            continue;
        }
        let array = NpyFile::new(entry).unwrap();
        let shape = array.shape().to_vec();
        let numbers = match name.as_str() {
            "iterations" => array.into_vec::<u32>().unwrap().into_iter().map(f64::from).collect(),
            "every" => array.into_vec::<u64>().unwrap().into_iter().map(|number| number as f64).collect(),
            _ => array.into_vec::<f64>().unwrap(),
        };
        assert_eq!(numbers.len() as u64, shape.iter().product::<u64>(), "{name}");
        arrays.insert(name, Array { shape, numbers });
    }
    arrays
}

/// The single text of an array, by the description of NumPy's format (version 1): a mark of 8 bytes, the length of the header in
/// two, the header, and characters of four bytes.
pub fn text(path: &Path, name: &str) -> String {
    let mut bytes = Vec::new();
    open(path).by_name(&format!("{name}.npy")).unwrap().read_to_end(&mut bytes).unwrap();
    let (mark, rest) = bytes.split_at(8);
    assert_eq!(mark, b"\x93NUMPY\x01\x00");
    let (header, body) = rest[2..].split_at(usize::from(u16::from_le_bytes([rest[0], rest[1]])));
    let characters = body.len() / 4;
    let header = String::from_utf8(header.to_vec()).unwrap();
    assert!(header.contains(&format!("'descr': '<U{characters}'")), "{header}");
    assert!(header.contains("'shape': ()"), "{header}");
    let character = |bytes: &[u8]| char::from_u32(u32::from_le_bytes(bytes.try_into().unwrap())).unwrap();
    body.chunks(4).map(character).collect()
}
