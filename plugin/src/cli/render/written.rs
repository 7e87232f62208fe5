//! The song as it is written: its bytes, from wherever they are.

use std::borrow::Cow;

use anyhow::{Context, Result};

use super::{Seed, song_name};
use crate::cli::RenderArgs;
use crate::cli::paths;
use crate::demo;
use crate::midi_file::{LARGEST_FILE, Selection, Song};
use crate::params::InputChoice;

/// The bytes of a song.
pub(super) struct Written(Cow<'static, [u8]>);

impl Written {
    /// Reads them all, but of more than are accepted one more, for which they are refused.
    pub(super) fn read(arguments: &RenderArgs) -> Result<Self> {
        let Some(path) = &arguments.song else { return Ok(Self(demo::MIDI.into())) };
        let bytes = paths::read(path, LARGEST_FILE as u64);
        Ok(Self(bytes.with_context(|| format!("cannot read {}", song_name(arguments)))?.into()))
    }

    /// The music in them.
    pub(super) fn song(&self, arguments: &RenderArgs) -> Result<Song> {
        let selection = Selection {
            track: arguments.track.map(usize::from),
            channel: arguments.channel,
            tenth: matches!(arguments.taken.input, InputChoice::Strings | InputChoice::Mpe),
            truncated: arguments.allow_truncated,
        };
        Song::from_midi(&self.0, selection).with_context(|| song_name(arguments))
    }

    /// The number of the sequence of differences that is asked for.
    pub(super) fn seed(&self, asked: Seed) -> u64 {
        match asked {
            Seed::Number(number) => number,
            Seed::Song => self.crc32().into(),
        }
    }

    /// How many there are.
    pub(super) fn bytes(&self) -> usize {
        self.0.len()
    }

    /// Their checksum, by which another song is told from this one: the CRC-32 of ZIP files.
    pub(super) fn crc32(&self) -> u32 {
        crc32fast::hash(&self.0)
    }
}
