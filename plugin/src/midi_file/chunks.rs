//! The outer shape of a MIDI file: header, tracks, and the ways they can be broken.

use super::timing::Division;
use super::{CutOff, MidiFileError};

/// The checked parts of a file.
pub(super) struct Chunks<'a> {
    /// Whether the tracks are sequences to be played one after another (format 2).
    pub sequential: bool,
    /// What a tick lasts.
    pub division: Division,
    /// The data of each track.
    pub tracks: Vec<&'a [u8]>,
    /// Tracks after those that the header announces.
    pub left_out: usize,
    /// The last track, where the file ends before it does.
    pub cut: Option<CutOff>,
}

impl<'a> Chunks<'a> {
    /// Cuts a file into its chunks.
    pub(super) fn read(bytes: &'a [u8]) -> Result<Self, MidiFileError> {
        if bytes.len() > super::LARGEST_FILE {
            return Err(MidiFileError::TooLarge);
        }
        let mut rest = without_riff(bytes);
        if rest.is_empty() || !rest.starts_with(&b"MThd"[..rest.len().min(4)]) {
            return Err(MidiFileError::NotMidi);
        }
        let (_, header) = next_chunk(&mut rest, "the header")?;
        let [f0, f1, n0, n1, d0, d1] =
            *header.first_chunk::<6>().ok_or(MidiFileError::ShortHeader(header.len()))?;
        let format = u16::from_be_bytes([f0, f1]);
        if format > 2 {
            return Err(MidiFileError::Format(format));
        }
        let division = Division::from_header(u16::from_be_bytes([d0, d1]))?;

        let announced = usize::from(u16::from_be_bytes([n0, n1]));
        let mut tracks = Vec::new();
        let mut cut = None;
        // Chunks of other kinds may stand between tracks, and anything may follow the last one.
        while tracks.len() < announced && !rest.is_empty() {
            let number = tracks.len() + 1;
            let (kind, data) = match next_chunk(&mut rest, &format!("track {number}")) {
                // Without the end of its last track it is the same music up to there. Without a whole track it is other music.
                Err(MidiFileError::Truncated { expected, .. })
                    if number == announced && rest.len() > 8 && rest.starts_with(b"MTrk") =>
                {
                    let (_, data) = std::mem::take(&mut rest).split_at(8);
                    cut = Some(CutOff { track: number, expected, found: data.len() });
                    (&b"MTrk"[..], data)
                }
                other => other?,
            };
            if kind == b"MTrk" {
                tracks.push(data);
            }
        }
        if tracks.len() < announced {
            return Err(MidiFileError::MissingTracks { expected: announced, found: tracks.len() });
        }
        let mut left_out = 0;
        while let Ok((kind, _)) = next_chunk(&mut rest, "what follows") {
            left_out += usize::from(kind == b"MTrk");
        }
        Ok(Self { sequential: format == 2, division, tracks, left_out, cut })
    }
}

/// Takes one chunk off the front.
fn next_chunk<'a>(rest: &mut &'a [u8], what: &str) -> Result<(&'a [u8], &'a [u8]), MidiFileError> {
    let truncated = |expected, found| MidiFileError::Truncated { what: what.to_owned(), expected, found };
    let begun = || MidiFileError::Begun { what: what.to_owned(), found: rest.len() };
    let (head, body) = rest.split_at_checked(8).ok_or_else(begun)?;
    let (kind, length) = head.split_at(4);
    // The second half of the head is four bytes long.
    let length = length.iter().fold(0_usize, |sum, &byte| sum << 8 | usize::from(byte));
    let (data, after) = body.split_at_checked(length).ok_or_else(|| truncated(length, body.len()))?;
    *rest = after;
    Ok((kind, data))
}

/// The MIDI file inside a RIFF wrapper of type RMID; other bytes as they are.
fn without_riff(bytes: &[u8]) -> &[u8] {
    // "RIFF", length, "RMID", then little-endian chunks, of which the "data" one is the file.
    let is_rmid = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"RMID");
    let mut rest = match bytes.get(12..) {
        Some(rest) if is_rmid => rest,
        _ => return bytes,
    };
    while let Some((head, body)) = rest.split_at_checked(8) {
        let length = head[4..].iter().rev().fold(0_usize, |sum, &byte| sum << 8 | usize::from(byte));
        let data = &body[..length.min(body.len())];
        if head.starts_with(b"data") {
            return data;
        }
        // Chunks are padded to an even length.
        rest = body.get(length + length % 2..).unwrap_or(&[]);
    }
    bytes
}
