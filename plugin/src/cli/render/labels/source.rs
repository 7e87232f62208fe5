//! What a sound was made from.

use std::collections::BTreeMap;

use low_action_dsp::setup::{SetupString, frequency};
use low_action_dsp::{Error, Instrument, Setup};
use nice_plug::prelude::Enum;
use serde::Serialize;

use crate::cli::render::files::stem_name;
use crate::cli::render::tuning::Tuned;
use crate::cli::render::written::Written;
use crate::cli::wav::Findings;
use crate::cli::{PROGRAM, RenderArgs};
use crate::params::{InputChoice, LegatoChoice, StringOrder};

/// What a sound is made from.
#[derive(Clone, Copy)]
pub(in crate::cli::render) struct Source<'a> {
    pub arguments: &'a RenderArgs,
    pub setup: &'a Setup,
    pub written: &'a Written,
}

/// All that is said of a sound as a whole: with the song, enough to make it again.
#[derive(Debug, Serialize)]
pub(super) struct About<'a> {
    /// Name and version.
    program: &'static str,
    /// As asked for; none for the built-in demo.
    song: Option<String>,
    song_bytes: usize,
    /// As of a ZIP file.
    song_crc32: u32,
    instrument: String,
    quality: &'static str,
    /// Hz.
    sample_rate: u32,
    samples: u64,
    /// s.
    duration: f64,
    variation: f64,
    seed: u64,
    track: Option<u16>,
    channel: Option<u8>,
    input: Option<&'static str>,
    first_channel: Option<u8>,
    string_order: Option<&'static str>,
    /// Semitones.
    bend_range: Option<f64>,
    ignore_rpn: bool,
    hand_position: Option<u8>,
    capo: Option<u8>,
    legato: Option<&'static str>,
    ignore_hand_controllers: bool,
    /// Parameters by their identifiers, as hosts show them.
    set: BTreeMap<&'a str, &'a str>,
    allow_truncated: bool,
    /// In the words of their options.
    tail: String,
    bit_depth: String,
    /// As a set-up file has it.
    setup: &'a Setup,
}

/// A string of the instrument.
#[derive(Debug, Serialize)]
pub(super) struct LabelledString {
    /// From 1.
    pub string: usize,
    pub name: String,
    /// What the file of its own sound is called, if there is one.
    pub stem: String,
    /// Of the open string, MIDI note number; and Hz.
    pub pitch: f64,
    pub frequency: f64,
    /// m.
    pub length: f64,
    /// N.
    pub tension: f64,
    /// m from the nut, fret 1 first; and what sounds where a finger stops them, Hz.
    pub frets: Vec<f64>,
    pub fret_frequencies: Vec<f64>,
    /// Largest size of a sample of its own sound, 1 is full scale.
    pub peak: f64,
}

impl Source<'_> {
    /// What is to be said of a sound of so many samples.
    pub(super) fn about(&self, samples: u64) -> About<'_> {
        let Self { arguments, setup, written } = *self;
        let taken = &arguments.taken;
        About {
            program: PROGRAM,
            song: arguments.song.as_ref().map(|song| song.to_string_lossy().into_owned()),
            song_bytes: written.bytes(),
            song_crc32: written.crc32(),
            instrument: arguments.instrument.to_string_lossy().into_owned(),
            quality: arguments.quality.name(),
            sample_rate: arguments.sample_rate,
            samples,
            duration: samples as f64 / f64::from(arguments.sample_rate),
            variation: arguments.variation,
            seed: written.seed(arguments.seed),
            track: arguments.track,
            channel: arguments.channel,
            input: id(taken.input, InputChoice::ids()),
            first_channel: taken.first_channel,
            string_order: taken.string_order.and_then(|order| id(order, StringOrder::ids())),
            bend_range: taken.bend_range,
            ignore_rpn: taken.ignore_rpn,
            hand_position: taken.hand_position(),
            capo: taken.capo(),
            legato: id(taken.legato, LegatoChoice::ids()),
            ignore_hand_controllers: taken.ignore_hand_controllers,
            set: taken.set.iter().map(|setting| (setting.id(), setting.shown())).collect(),
            allow_truncated: arguments.allow_truncated,
            tail: arguments.tail.to_string(),
            bit_depth: arguments.bit_depth.to_string(),
            setup,
        }
    }

    /// The strings as they are tuned, under fingers that press as they are told.
    pub(in crate::cli::render) fn tuned<'a>(&'a self, instrument: &'a Instrument) -> Tuned<'a> {
        let Self { arguments, setup, .. } = *self;
        let hands = arguments.taken.touching().hands(&setup.player, setup.neck.scale_length);
        Tuned::new(setup, instrument, arguments.quality, hands.fretting.force)
    }

    /// The strings of the instrument as it sounds.
    pub(super) fn strings(&self, tuned: &Tuned, heard: &[Findings]) -> Result<Vec<LabelledString>, Error> {
        let describe = |(index, string): (usize, &SetupString)| {
            let pitch = string.pitch + self.setup.tuning;
            let placed = &tuned.placed[index];
            Ok(LabelledString {
                string: index + 1,
                name: string.name.clone(),
                stem: stem_name(index, &string.name),
                pitch,
                frequency: frequency(pitch),
                length: placed.string.length,
                tension: placed.string.tension,
                frets: placed.frets.clone(),
                fret_frequencies: tuned.stopped(index)?,
                peak: heard.get(index).map_or(0.0, |findings| findings.peak.into()),
            })
        };
        self.setup.string.iter().enumerate().map(describe).collect()
    }
}

/// The identifier of a choice.
fn id<T: Enum>(choice: T, ids: Option<&'static [&'static str]>) -> Option<&'static str> {
    ids.unwrap_or_default().get(choice.to_index()).copied()
}
