//! Notes of a file that no player gets: those of percussion, and those of tracks and channels that were not chosen.

use super::{DRUM_CHANNEL, SongEvent, SongTime};
use crate::performance::PlayerEvent;

/// A note-on that is left out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    /// When, counted from the start of the song.
    pub time: SongTime,
    /// Its channel, 0 to 15.
    pub channel: u8,
    /// Its key.
    pub key: u8,
    /// How hard it was struck, above 0 to 1.
    pub velocity: f32,
    /// Why it is left out.
    pub why: WhyLeftOut,
}

/// Why a note is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhyLeftOut {
    /// The channel of percussion is not played.
    Percussion,
    /// Its track or channel was not chosen.
    NotChosen,
}

/// Those of some events in order of time, of which it is known whether they are selected, where percussion is left out or not.
pub(super) fn unplayed(
    found: &[(SongEvent, bool)],
    without_percussion: bool,
) -> impl Iterator<Item = LeftOut> + '_ {
    found.iter().filter_map(move |&(SongEvent { time, event }, selected)| {
        let PlayerEvent::NoteOn { channel, key, velocity } = event else { return None };
        let why = match selected {
            false => WhyLeftOut::NotChosen,
            true if without_percussion && channel == DRUM_CHANNEL => WhyLeftOut::Percussion,
            true => return None,
        };
        Some(LeftOut { time, channel, key, velocity, why })
    })
}
