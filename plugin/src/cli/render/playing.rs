//! A song on its way through the engine into files.

use anyhow::Result;

use super::files::Files;
use super::labels::{Labelled, Source};
use super::options::Tail;
use crate::cli::progress::Progress;
use crate::cli::wav::Findings;
use crate::engine::{Engine, INAUDIBLE, QUIET};
use crate::midi_file::Song;
use crate::performance::Compromises;

/// Samples computed at a time.
const BLOCK: usize = 512;
/// Shortest tail of `auto`, s: as far back as the engine's level looks, and once more.
const SHORTEST_TAIL: f64 = 0.1;

/// What came of it.
pub(super) struct Rendered {
    /// Of the stereo file.
    pub mix: Findings,
    /// Of the strings' own files.
    pub stems: Findings,
    pub compromises: Compromises,
    pub lost_events: u64,
    pub seconds: f64,
}

/// A song on its way through the engine.
pub(super) struct Playing<'a> {
    pub engine: Engine,
    pub song: &'a Song,
    pub source: Source<'a>,
    pub files: Files,
}

impl Playing<'_> {
    /// Plays it to its end and its tail, and lets the files appear.
    pub(super) fn play(mut self) -> Result<Rendered> {
        if self.files.labels.is_some() {
            self.engine.record();
        }
        let rate = self.source.arguments.sample_rate;
        let mut progress = Progress::new((self.song.duration() * f64::from(rate)) as u64);
        let mut buffers = Buffers::new(self.files.stems.len(), Engine::LATENCY as usize);
        let mut peak = 0.0_f64;
        let mut events =
            self.song.events.iter().map(|event| (event.time.sample(rate), event.event)).peekable();
        // Blocks end at events, so that any number of them may share a sample.
        loop {
            while let Some((_, event)) = events.next_if(|&(time, _)| time <= self.engine.now()) {
                self.engine.event(0, event);
            }
            let Some(&(next, _)) = events.peek() else { break };
            let frames = (next - self.engine.now()).min(BLOCK as u64);
            self.block(&mut buffers, frames as usize)?;
            peak = peak.max(self.engine.level());
            progress.reach(self.engine.now());
        }
        let samples = |seconds: f64| (seconds * f64::from(rate)).round() as u64;
        let tail = self.source.arguments.tail;
        let mut end = self.engine.now();
        loop {
            peak = peak.max(self.engine.level());
            if self.engine.is_behind() {
                // Notes of the last chord that wait for strings belong to the song, not to its tail.
                self.block(&mut buffers, BLOCK)?;
                end = self.engine.now();
                continue;
            }
            let since = self.engine.now() - end;
            let quiet = self.engine.level() <= (QUIET * peak).max(INAUDIBLE);
            let left = samples(tail.longest()) - since;
            if left == 0 || (tail == Tail::Auto && since >= samples(SHORTEST_TAIL) && quiet) {
                break;
            }
            self.block(&mut buffers, left.min(BLOCK as u64) as usize)?;
        }
        // What happened last is still to be heard.
        self.block(&mut buffers, Engine::LATENCY as usize)?;
        progress.end();
        self.finish()
    }

    /// Computes so many samples and writes them, but for the first, which hold what was before the song.
    fn block(&mut self, buffers: &mut Buffers, frames: usize) -> Result<()> {
        let Buffers { left, right, stems, early } = buffers;
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
        for (file, stem) in self.files.stems.iter_mut().zip(stems) {
            file.write(stem[skipped..frames].iter().copied())?;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<Rendered> {
        let samples = self.engine.now() - u64::from(Engine::LATENCY);
        let record = self.engine.take_record();
        let compromises = self.engine.compromises();
        let instrument = self.engine.instrument();
        let labelled = Labelled { source: &self.source, instrument, record, compromises, samples };
        let [mix, stems] = self.files.finish(labelled)?;
        Ok(Rendered {
            mix,
            stems,
            compromises,
            lost_events: self.engine.lost_events(),
            seconds: samples as f64 / f64::from(self.source.arguments.sample_rate),
        })
    }
}

/// Room for one block.
struct Buffers {
    left: Vec<f32>,
    right: Vec<f32>,
    stems: Vec<Vec<f32>>,
    /// Samples still to come before the song's first.
    early: usize,
}

impl Buffers {
    fn new(stems: usize, early: usize) -> Self {
        let stems = vec![vec![0.0; BLOCK]; stems];
        Self { left: vec![0.0; BLOCK], right: vec![0.0; BLOCK], stems, early }
    }
}
