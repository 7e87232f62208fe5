//! What is said about a file: why it is refused, or what to know of one that plays.

use std::fmt;

use super::LARGEST_FILE;

/// Why bytes are not a song.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MidiFileError {
    /// The bytes do not begin like a MIDI file.
    #[error("not a MIDI file: it does not begin with a MThd chunk")]
    NotMidi,
    /// There are more bytes than [`LARGEST_FILE`].
    #[error("the MIDI file is too large: at most {LARGEST_FILE} bytes are read")]
    TooLarge,
    /// The file ends before something it announced.
    #[error("truncated MIDI file: {what} announces {expected} bytes, {found} are left")]
    Truncated {
        /// The part that is cut off.
        what: String,
        /// Bytes announced.
        expected: usize,
        /// Bytes found.
        found: usize,
    },
    /// The header counts more tracks than there are.
    #[error("truncated MIDI file: the header's count of tracks is {expected}, and {found} can be found")]
    MissingTracks {
        /// Tracks announced.
        expected: usize,
        /// Tracks found.
        found: usize,
    },
    /// The format is none of the three.
    #[error("unknown MIDI file format {0}: must be 0, 1 or 2")]
    Format(u16),
    /// The time division cannot be used.
    #[error(
        "impossible MIDI time division {0:#06x}: must be 1 to 32767 ticks a beat, or 24, 25, 29 or 30 frames of 1 to 255 ticks"
    )]
    Division(u16),
    /// An event cannot be read.
    #[error("damaged MIDI file: no readable event at byte {offset} of track {track}")]
    BadEvent {
        /// Track, counted from 1.
        track: usize,
        /// Bytes from the start of the track's data.
        offset: usize,
    },
    /// The asked track is not there.
    #[error("no track {asked}: the file has {count} in all{}", choice(*count))]
    NoSuchTrack {
        /// Track asked for, counted from 1.
        asked: usize,
        /// Tracks in the file.
        count: usize,
    },
}

/// What `--track` takes where there are so many.
fn choice(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => ", so --track takes 1 only".into(),
        _ => format!(", so --track takes 1 to {count}"),
    }
}

/// Something to tell the user about a file that plays nevertheless.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SongWarning {
    /// Nothing to play.
    NoNotes,
    /// Notes of the drum channel were left out.
    DrumsSkipped {
        /// How many.
        notes: usize,
    },
    /// There are more tracks than the header announces; those were left out.
    TracksLeftOut {
        /// Tracks announced.
        announced: usize,
        /// Tracks left out.
        left_out: usize,
    },
    /// A track stops without saying so; perhaps something is missing.
    NoEndOfTrack {
        /// Track, counted from 1.
        track: usize,
    },
    /// Changes to a tempo of 0 microseconds a beat, which is none, were passed over.
    NoTempo {
        /// How many.
        changes: usize,
    },
}

impl fmt::Display for SongWarning {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoNotes => write!(out, "no notes to play: the result is silence"),
            Self::DrumsSkipped { notes } => {
                write!(
                    out,
                    "channel 10 is percussion: {notes} of its notes left out (--channel 10 plays them alone)"
                )
            }
            Self::TracksLeftOut { announced, left_out } => {
                let there = announced + left_out;
                write!(
                    out,
                    "the header announces {announced} of {there} tracks: the last {left_out} left out"
                )
            }
            Self::NoEndOfTrack { track } => {
                write!(out, "track {track} has no end-of-track event: it may be incomplete")
            }
            Self::NoTempo { changes } => {
                let changes =
                    if *changes == 1 { "1 change".to_owned() } else { format!("{changes} changes") };
                write!(
                    out,
                    "a tempo must be 1 to 16777215 microseconds a beat: {changes} to 0 passed over, the tempo \
                     before goes on"
                )
            }
        }
    }
}
