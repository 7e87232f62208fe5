//! Notes that are not played as they are written.

use serde::Serialize;

/// What the player could not do as written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Compromises {
    /// Notes moved by octaves because no string, or none that was left, gives them.
    pub moved_by_octaves: u64,
    /// Notes struck once more, on another string, because one of their chord that began a moment after them needed theirs.
    pub moved_strings: u64,
    /// Notes that came a moment late because strings did not suffice for all of their instant.
    pub arpeggiated: u64,
    /// Notes left out because more than 128 began at one instant, or waited for strings, or because all strings were held by others
    /// when they came late and their keys were up already, or because everything was to be silent before they came or were struck.
    pub left_out: u64,
    /// Notes left out because another took their string before a strum, or the finger of a tap, had got there.
    pub overtaken: u64,
    /// Notes left out because no string gives them in any octave, or their channel has no string.
    pub without_string: u64,
    /// Notes that are one with another of their channel and key that begins at the same sample.
    pub doubled: u64,
    /// Notes bent less far than asked, for their strings can be pulled, or their fingers slid, no farther.
    pub bent_short: u64,
    /// Notes plucked that were to be slid to, for the string of the note before does not have them, or only farther away than a finger
    /// slides, or was only touched.
    pub not_slid: u64,
}
