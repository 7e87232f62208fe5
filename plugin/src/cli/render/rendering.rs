//! A song on its way through the engine into files.

use std::iter::Peekable;

use anyhow::Result;

use super::files::Files;
use super::heard::{Cut, Heard};
use super::labels::{Labelled, Source};
use super::options::Tail;
use super::song_name;
use super::timeline::timeline;
use super::warnings;
use crate::cli::progress::Progress;
use crate::cli::wav::Findings;
use crate::engine::{Engine, INAUDIBLE, QUIET};
use crate::midi_file::Song;
use crate::performance::PlayerEvent;

/// Samples computed at a time: enough for threads to be worth their beginning.
const BLOCK: usize = 8192;
/// Samples of a tail computed before its end is looked for again.
const LOOK: usize = 512;
/// Shortest tail of `auto`, s: as far back as the engine's level looks, and once more.
const SHORTEST_TAIL: f64 = 0.1;

/// What came of it.
pub(super) struct Rendered {
    pub heard: Heard,
    /// What there is to warn of now.
    pub warnings: Vec<String>,
}

/// A song on its way through the engine.
pub(super) struct Rendering<'a> {
    pub engine: Engine,
    pub song: &'a Song,
    pub source: Source<'a>,
    pub files: Files,
    /// What has been warned of so far.
    pub warnings: Vec<String>,
    /// The most that a tail can last, s.
    pub longest_tail: f64,
}

impl Rendering<'_> {
    /// Plays it to its end and its tail, and lets the files appear.
    pub(super) fn play(mut self) -> Result<Rendered> {
        let labelled = self.files.labels.is_some();
        if labelled {
            self.engine.record();
        }
        let rate = self.source.arguments.sample_rate;
        let samples = |seconds: f64| (seconds * f64::from(rate)).round() as u64;
        let last = self.song.events.last().map_or(0, |event| event.time.sample(rate));
        let tail = self.source.arguments.tail;
        let longest = samples(self.longest_tail);
        // (How long a tail by itself is nobody knows before.)
        let mut progress = match self.source.arguments.quiet {
            true => Progress::unseen(),
            false => Progress::new(song_name(self.source.arguments), last + longest),
        };
        // (Labels know of each string's own sound, too, whether it is written or not.)
        let apart = if labelled { self.engine.string_count() } else { self.files.stems.len() };
        let mut buffers = Buffers::new(apart, Engine::LATENCY as usize);
        let mut peak = 0.0_f64;
        let mut events = timeline(self.song, rate).into_iter().peekable();
        loop {
            let left = last - self.engine.now();
            let frames = self.hand_over(&mut events, left.min(BLOCK as u64));
            if left == 0 {
                break;
            }
            peak = peak.max(self.block(&mut buffers, frames as usize)?);
            progress.reach(self.engine.now());
        }
        let mut end = self.engine.now();
        let cut = loop {
            progress.reach(self.engine.now());
            peak = peak.max(self.engine.level());
            if self.engine.is_behind() {
                // Notes of the last chord that wait for strings belong to the song, not to its tail.
                self.block(&mut buffers, LOOK)?;
                end = self.engine.now();
                continue;
            }
            let since = self.engine.now() - end;
            let quiet = self.engine.level() <= (QUIET * peak).max(INAUDIBLE);
            let left = longest - since;
            if tail == Tail::Auto && since >= samples(SHORTEST_TAIL) && quiet {
                break None;
            }
            if left == 0 {
                let cut = Cut { after: self.longest_tail, level: self.engine.level() / peak };
                break (!quiet).then_some(cut);
            }
            self.block(&mut buffers, left.min(LOOK as u64) as usize)?;
        };
        // What happened last is still to be heard.
        self.block(&mut buffers, Engine::LATENCY as usize)?;
        progress.end();
        self.finish(cut, buffers.findings)
    }

    /// Gives the engine the events of the next `frames` samples. Returns how many samples those are that it has all events of:
    /// fewer where more come than can wait, or a sequence ends. (Those of the present sample need not.)
    fn hand_over(
        &mut self,
        events: &mut Peekable<impl Iterator<Item = (u64, PlayerEvent)>>,
        frames: u64,
    ) -> u64 {
        let now = self.engine.now();
        while let Some(&(time, event)) = events.peek() {
            let offset = time.saturating_sub(now);
            let sequence_ends = event == PlayerEvent::AllNotesOff;
            if offset > 0 && (offset >= frames || sequence_ends || !self.engine.has_room()) {
                return offset.min(frames);
            }
            self.engine.event(offset as u32, event);
            events.next();
            if sequence_ends {
                // What no event puts back is put back between what ends and what begins at this sample.
                self.engine.deliver_present();
                self.engine.forget_reach();
            }
        }
        frames
    }

    /// Computes so many samples and writes them, but for the first, which hold what was before the song. Returns the largest
    /// size of them all, 1 is full scale.
    fn block(&mut self, buffers: &mut Buffers, frames: usize) -> Result<f64> {
        let Buffers { left, right, stems, findings, early } = buffers;
        let (left, right) = (&mut left[..frames], &mut right[..frames]);
        if stems.is_empty() {
            self.engine.process(left, right);
        } else {
            let mut parts: Vec<&mut [f32]> = stems.iter_mut().map(|stem| &mut stem[..frames]).collect();
            self.engine.process_stems(&mut parts, left, right);
        }
        let skipped = frames.min(*early);
        *early -= skipped;
        let pairs = left[skipped..].iter().zip(&right[skipped..]);
        self.files.mix.write(pairs.flat_map(|(&left, &right)| [left, right]))?;
        for (findings, stem) in findings.iter_mut().zip(&*stems) {
            stem[skipped..frames].iter().for_each(|&sample| findings.look(sample));
        }
        for (file, stem) in self.files.stems.iter_mut().zip(stems) {
            file.write(stem[skipped..frames].iter().copied())?;
        }
        Ok(left.iter().chain(&*right).fold(0.0, |most, &sample| most.max(f64::from(sample.abs()))))
    }

    fn finish(mut self, cut: Option<Cut>, strings: Vec<Findings>) -> Result<Rendered> {
        let heard = Heard {
            mix: self.files.mix.findings(),
            strings,
            compromises: self.engine.compromises(),
            lost_events: self.engine.lost_events(),
            samples: self.engine.now() - u64::from(Engine::LATENCY),
            cut,
        };
        let told = warnings::afterwards(&self.source, &heard);
        self.warnings.extend_from_slice(&told);
        let record = self.engine.take_record();
        let instrument = self.engine.instrument();
        let (left_out, warnings) = (&self.song.left_out, &self.warnings);
        let source = &self.source;
        self.files.finish(Labelled { source, instrument, record, left_out, heard: &heard, warnings })?;
        Ok(Rendered { heard, warnings: told })
    }
}

/// Room for one block.
struct Buffers {
    left: Vec<f32>,
    right: Vec<f32>,
    stems: Vec<Vec<f32>>,
    /// Of each of these.
    findings: Vec<Findings>,
    /// Samples still to come before the song's first.
    early: usize,
}

impl Buffers {
    fn new(stems: usize, early: usize) -> Self {
        let findings = vec![Findings::default(); stems];
        let stems = vec![vec![0.0; BLOCK]; stems];
        Self { left: vec![0.0; BLOCK], right: vec![0.0; BLOCK], stems, findings, early }
    }
}
