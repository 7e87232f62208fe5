//! What is said about a file: why it is refused, or what to know of one that plays.

use std::fmt;

use super::{LARGEST_FILE, SongEvent};
use crate::performance::{ChosenParameter, MPE_UPPER_MANAGER, PlayerEvent, controller};

/// A last track of which the file does not have all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CutOff {
    /// Track, counted from 1.
    pub track: usize,
    /// Bytes it announces.
    pub expected: usize,
    /// Bytes it has.
    pub found: usize,
}

impl fmt::Display for CutOff {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { track, expected, found } = self;
        write!(out, "truncated MIDI file: track {track} announces {expected} bytes, {found} are left")
    }
}

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
    /// The file ends before it has announced how long something is.
    #[error("truncated MIDI file: {what} begins with 8 bytes, {found} are left")]
    Begun {
        /// The part that is cut off.
        what: String,
        /// Bytes found.
        found: usize,
    },
    /// The header announces fewer bytes than it takes.
    #[error("impossible MIDI header: its chunk has {0} bytes, and at least 6 are needed")]
    ShortHeader(usize),
    /// The file ends before its last track does, and nobody asked for what is there.
    #[error("{0} (--allow-truncated plays what they hold)")]
    CutOff(CutOff),
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
    /// The file ends before its last track does.
    CutOff(CutOff),
    /// Volume or pan are set to something, which does nothing.
    NotFollowed {
        /// Whether controller 7 is, on a channel that has notes, to other than 100.
        volume: bool,
        /// Whether controller 10 is, to other than 64.
        pan: bool,
    },
    /// Programs are changed on channels that have notes, which does nothing.
    ProgramsNotFollowed {
        /// How often.
        changes: usize,
    },
    /// Channels are tuned by registered parameters 1 or 2, which does nothing.
    TuningNotFollowed,
    /// An upper zone of MPE is announced, which does nothing of its own.
    UpperZone,
    /// A track stops without saying so; perhaps something is missing.
    NoEndOfTrack {
        /// Track, counted from 1.
        track: usize,
    },
    /// Changes to a tempo of 0 microseconds a beat, which is none, or of too few bytes, were passed over.
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
            Self::CutOff(cut) => write!(out, "{cut}; what they hold is played"),
            Self::NotFollowed { volume, pan } => {
                let [which, instead] = match (volume, pan) {
                    (true, false) => ["controller 7 (volume) is", "11, or gain in a set-up file"],
                    (false, _) => ["controller 10 (pan) is", "pan in a set-up file"],
                    (true, true) => {
                        ["controllers 7 (volume) and 10 (pan) are", "11, or gain and pan in a set-up file"]
                    }
                };
                write!(out, "{which} passed over: use {instead}")
            }
            Self::ProgramsNotFollowed { changes } => {
                let changes = if *changes == 1 {
                    "1 program change is".to_owned()
                } else {
                    format!("{changes} program changes are")
                };
                write!(out, "{changes} passed over: use --instrument")
            }
            Self::TuningNotFollowed => write!(
                out,
                "registered parameters 1 and 2 (tuning of a channel) are passed over: use the pitch wheel, or pitches in a \
                 set-up file"
            ),
            Self::UpperZone => write!(
                out,
                "an upper zone of MPE (announced on channel 16) is passed over: its members belong to channel 1 where that \
                 announces its own, else to none"
            ),
            Self::NoEndOfTrack { track } => {
                write!(out, "track {track} has no end-of-track event: it may be incomplete")
            }
            Self::NoTempo { changes } => {
                let changes =
                    if *changes == 1 { "1 change".to_owned() } else { format!("{changes} changes") };
                write!(
                    out,
                    "a tempo must be 1 to 16777215 microseconds a beat, in three bytes: {changes} to anything else \
                     passed over, the tempo before goes on"
                )
            }
        }
    }
}

/// The channels that have notes.
fn with_notes(events: &[SongEvent]) -> [bool; 16] {
    let mut has_notes = [false; 16];
    for event in events {
        if let PlayerEvent::NoteOn { channel, .. } = event.event {
            has_notes[usize::from(channel & 15)] = true;
        }
    }
    has_notes
}

/// What program changes, counted by channel, ask for in vain: on channels that have notes.
pub(super) fn programs_not_followed(events: &[SongEvent], counts: &[usize; 16]) -> Option<SongWarning> {
    let changes = counts.iter().zip(with_notes(events)).filter(|(_, has_notes)| *has_notes);
    let changes = changes.map(|(count, _)| count).sum();
    (changes > 0).then_some(SongWarning::ProgramsNotFollowed { changes })
}

/// What tuning asks for in vain: on channels that have notes, anything but none, which is 64 in the upper half of both
/// parameters and 0 in the lower one. (The lower half of parameter 2 means nothing.)
pub(super) fn tuning_not_followed(events: &[SongEvent]) -> Option<SongWarning> {
    let has_notes = with_notes(events);
    let mut parameters = [ChosenParameter::NONE; 16];
    let mut asked = false;
    for event in events {
        let PlayerEvent::Controller { channel, number, value } = event.event else { continue };
        let channel = usize::from(channel & 15);
        let value = (127.0 * value).round() as u8;
        parameters[channel].hear(number, value);
        asked |= has_notes[channel]
            && match (number, parameters[channel].number()) {
                (
                    controller::DATA_ENTRY,
                    Some(ChosenParameter::FINE_TUNING | ChosenParameter::COARSE_TUNING),
                ) => value != 64,
                (controller::DATA_ENTRY_LOWER, Some(ChosenParameter::FINE_TUNING)) => value != 0,
                _ => false,
            };
    }
    asked.then_some(SongWarning::TuningNotFollowed)
}

/// An upper zone of MPE is announced on the last channel.
pub(super) fn upper_zone(events: &[SongEvent]) -> Option<SongWarning> {
    let mut parameter = ChosenParameter::NONE;
    let mut announced = false;
    for event in events {
        let PlayerEvent::Controller { channel: MPE_UPPER_MANAGER, number, value } = event.event else {
            continue;
        };
        parameter.hear(number, (127.0 * value).round() as u8);
        announced |= number == controller::DATA_ENTRY
            && value > 0.0
            && parameter.number() == Some(ChosenParameter::MEMBERS);
    }
    announced.then_some(SongWarning::UpperZone)
}

/// What volume and pan ask for in vain: on channels that have notes, anything but the values they begin with in General MIDI.
pub(super) fn not_followed(events: &[SongEvent]) -> Option<SongWarning> {
    let has_notes = with_notes(events);
    let asks = |asked: u8, usual: f32| {
        events.iter().any(|event| match event.event {
            PlayerEvent::Controller { channel, number, value } => {
                has_notes[usize::from(channel & 15)] && number == asked && value != usual / 127.0
            }
            _ => false,
        })
    };
    let (volume, pan) = (asks(controller::VOLUME, 100.0), asks(controller::PAN, 64.0));
    (volume || pan).then_some(SongWarning::NotFollowed { volume, pan })
}
