//! Labels of a rendering: what was played when on which string, as one JSON object that stands alone.
//!
//! The player tells it as it plays ([`Record`]); here it is put into words and numbers. None is guessed from the sound.

mod bends;
mod gestures;
mod header;
mod lines;
mod notes;
mod source;
mod unplayed;

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use low_action_dsp::Instrument;
use serde::Serialize;
use serde_json::Serializer;

use super::heard::Heard;
use crate::cli::names::shown;
use crate::cli::one_line;
use crate::cli::output::Draft;
use crate::engine::Record;
use crate::midi_file::{LeftOut, SongTime};
use crate::performance::Compromises;
use bends::{LabelledBend, bends};
use gestures::{LabelledGesture, gestures};
use lines::Lines;
use notes::{LabelledNote, courses, notes};
pub(super) use source::Source;
use source::{About, LabelledString};
use unplayed::{LabelledUnplayed, unplayed};

/// What labels are of: a sound of so many samples.
pub(super) struct Labelled<'a> {
    pub source: &'a Source<'a>,
    pub instrument: &'a Instrument,
    pub record: Record,
    /// Notes of the song that the player has not been given.
    pub left_out: &'a [LeftOut],
    pub heard: &'a Heard,
    /// What has been warned of.
    pub warnings: &'a [String],
}

/// A file of labels. It is opened at the beginning, so that a place where nothing can be written is found out before anything
/// is computed.
pub(super) struct LabelFile {
    path: PathBuf,
    draft: Draft,
}

impl LabelFile {
    /// Begins a file that appears at `path` when it is published.
    pub(super) fn begin(path: &Path) -> Result<Self> {
        Ok(Self { path: path.to_owned(), draft: Draft::begin(path)? })
    }

    /// Writes it, to be published.
    pub(super) fn complete(self, labelled: Labelled) -> Result<Draft> {
        let tuned = labelled.source.tuned(labelled.instrument);
        let strings = labelled.source.strings(&tuned, &labelled.heard.strings)?;
        let bends = bends(&labelled.record.annotations, &tuned, labelled.clock())?;
        let written = self.draft.handle().and_then(|file| labelled.write(strings, bends, file));
        written.with_context(|| format!("cannot write {}", shown(&self.path)))?;
        Ok(self.draft)
    }
}

/// How many samples the sound has that labels which are there are of; or how they differ from those that would be made from a
/// source, in words.
pub(super) fn samples_of(path: &Path, source: &Source) -> Result<u64, String> {
    header::samples_of(path, &source.about(0))
}

/// Whether a file of labels has its end.
pub(super) fn are_whole(path: &Path) -> bool {
    let ends = || -> io::Result<bool> {
        let mut file = File::open(path)?;
        let mut last = [0; lines::END.len()];
        file.seek(SeekFrom::End(-(last.len() as i64)))?;
        file.read_exact(&mut last)?;
        Ok(last == lines::END)
    };
    ends().unwrap_or(false)
}

impl Labelled<'_> {
    fn write(mut self, strings: Vec<LabelledString>, bends: Vec<LabelledBend>, file: File) -> io::Result<()> {
        let courses = courses(&self.record.annotations, strings.len());
        let notes = notes(&courses, &strings, self.clock());
        let unplayed = unplayed(&courses, &self.record.unplayed, self.left_out, self.clock());
        // Those of equal times on one string stay in the order in which they are done.
        self.record.gestures.sort_by_key(|gesture| (gesture.time, gesture.string));
        let gestures = gestures(&self.record.gestures, self.clock());

        let Heard { mix, compromises, lost_events, samples, cut, .. } = *self.heard;
        let document = Document {
            about: self.source.about(samples),
            peak: mix.peak.into(),
            cut_off: cut.map(|cut| cut.below_peak()),
            lost_events,
            warnings: self.warnings.iter().map(|warning| one_line(warning)).collect(),
            compromises,
            strings,
            notes,
            unplayed,
            bends,
            gestures,
        };
        let mut out = BufWriter::new(file);
        document.serialize(&mut Serializer::with_formatter(&mut out, Lines::default()))?;
        out.flush()
    }

    fn clock(&self) -> Clock {
        Clock { sample_rate: self.source.arguments.sample_rate, samples: self.heard.samples }
    }
}

/// All of it, in the order of the file.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    about: About<'a>,
    /// Largest size of a sample, 1 is full scale.
    peak: f64,
    /// How far the sound was below its peak where it ends before it was quiet, dB.
    cut_off: Option<f64>,
    lost_events: u64,
    /// As they are said.
    warnings: Vec<String>,
    compromises: Compromises,
    strings: Vec<LabelledString>,
    notes: Vec<LabelledNote>,
    unplayed: Vec<LabelledUnplayed>,
    bends: Vec<LabelledBend>,
    gestures: Vec<LabelledGesture>,
}

/// The samples of the sound.
#[derive(Debug, Clone, Copy)]
struct Clock {
    /// Hz.
    sample_rate: u32,
    samples: u64,
}

impl Clock {
    /// When a sample is, s.
    fn seconds(self, sample: u64) -> f64 {
        sample as f64 / f64::from(self.sample_rate)
    }

    /// The sample nearest to a time of the song.
    fn sample(self, time: SongTime) -> u64 {
        time.sample(self.sample_rate)
    }

    /// Whether the sound has it.
    fn has(self, sample: u64) -> bool {
        sample < self.samples
    }
}
