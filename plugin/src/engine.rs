//! The whole instrument in one piece: notes in, stereo sound out.
//!
//! The plugin, the stand-alone program, the command line and the tests all play through
//! [`Engine`]. Events carry sample times and the sound depends on those alone: cutting the same
//! time into other blocks changes no bit of it.

mod handover;
mod played;
mod record;

use std::collections::VecDeque;
use std::num::NonZeroUsize;
use std::ops::RangeInclusive;

pub use low_action_dsp::Quality;
use low_action_dsp::setup::MOST_STRINGS;
use low_action_dsp::{EngineSettings, Instrument, Setup};

use crate::controls::Touching;
use crate::performance::{
    Announced, Compromises, InputMode, Performance, PlayedString, PlayerEvent, Spoken, Style,
    WIDEST_BEND_RANGE,
};
pub use handover::Replacement;
use played::Played;
pub use record::Record;

/// Samples handed from the player to the instrument at a time. It bounds how many gestures can be
/// waiting in the instrument, however large the blocks asked for.
const STEP: usize = 64;
/// Gestures that may wait when another step is prepared: an eighth of those that find room.
const MANY_GESTURES: usize = 512;
/// Events that can wait for their time; far more than any host sends for one block.
const WAITING_EVENTS: usize = 16_384;

/// A sound is over when it has stayed below this part of its peak: −72 dB.
pub const QUIET: f64 = 2.5e-4;

/// A sound below this is over in any case: −120 dBFS, under the last bit of 16.
pub const INAUDIBLE: f64 = 1e-6;
/// By so long after a hand has come to a string whatever it does there is heard, s: the slowest finger is on its fret after 51 ms, and
/// the period of a low B is 32 (docs/gestures.md).
const LONGEST_ATTACK: f64 = 0.25;

/// Everything an engine is built from.
#[derive(Debug, Clone)]
pub struct EngineOptions {
    /// The instrument and its player.
    pub setup: Setup,
    /// Sample rate, Hz, 8e3 to 1e6.
    pub sample_rate: f64,
    /// How much computing.
    pub quality: Quality,
    /// Newton iterations at most in a solution, if not as many as the quality has.
    pub iterations: Option<usize>,
    /// Size of the small differences between one pluck and the next, 0 (none) to 1.
    pub variation: f64,
    /// Which sequence of differences.
    pub seed: u64,
    /// Semitones of a full turn of the pitch wheel, until registered parameter 0 sets another. The
    /// string itself bends no farther than its set-up leaves room for.
    pub bend_range: f64,
    /// How many threads share the strings among them: 1, but where sound is rendered to a file. The bits are the same.
    pub threads: NonZeroUsize,
}

impl EngineOptions {
    /// Usual size of the differences between plucks: up to 3 mm, 5 % of force and a quarter of a
    /// millisecond; 3 ms where fingers hammer, pull or slide.
    pub const VARIATION: f64 = 0.25;
    /// Usual reach of the pitch wheel, semitones: what General MIDI files are written for.
    pub const BEND_RANGE: f64 = 2.0;
    /// Farthest it may be asked to reach, semitones.
    pub const WIDEST_BEND_RANGE: f64 = WIDEST_BEND_RANGE;
    /// Sample rates of sound that is played to a host, a device or a file, Hz.
    pub const SAMPLE_RATES: RangeInclusive<u32> = 8_000..=384_000;

    /// A set-up played at a rate (Hz) with everything else as usual.
    pub fn new(setup: Setup, sample_rate: f64) -> Self {
        Self {
            setup,
            sample_rate,
            quality: Quality::default(),
            iterations: None,
            variation: Self::VARIATION,
            seed: 0,
            bend_range: Self::BEND_RANGE,
            threads: NonZeroUsize::MIN,
        }
    }
}

impl EngineOptions {
    /// What they mean for the instrument.
    fn settings(&self) -> EngineSettings {
        settings(self.quality, self.iterations, self.sample_rate)
    }

    /// How long the open string that rings longest takes to be [`QUIET`] after its pluck, s; endless without losses.
    pub fn tail(&self) -> f64 {
        // The slowest partial is the lowest, but over a body, which takes some more than others.
        let partials = if self.setup.body.is_some() { 10 } else { 1 };
        let slowest = |string| {
            (1..=partials).map(|n| self.setup.decay(string, f64::from(n))).fold(f64::INFINITY, f64::min)
        };
        let time = |string| libm::log(1.0 / QUIET) / slowest(string);
        (0..self.setup.string.len()).map(time).fold(0.0, f64::max)
    }

    /// Builds the two halves of an engine; allocates.
    fn build(&self) -> Result<(Performance, Instrument), low_action_dsp::Error> {
        let instrument = Instrument::new(&self.setup, &self.settings())?;
        let strings = (0..instrument.string_count())
            .map(|string| PlayedString::new(&self.setup, &instrument, string))
            .collect();
        let style = Style { variation: self.variation, seed: self.seed, bend_range: self.bend_range };
        let performance = Performance::new(strings, &self.setup.player, style, self.sample_rate);
        Ok((performance, instrument))
    }
}

/// How an instrument is computed at a quality and a sample rate, Hz: with so many Newton iterations at most in a solution, if not
/// as many as the quality has.
pub(crate) fn settings(quality: Quality, iterations: Option<usize>, sample_rate: f64) -> EngineSettings {
    let settings = quality.settings(sample_rate);
    EngineSettings { max_iterations: iterations.unwrap_or(settings.max_iterations), ..settings }
}

/// An event waiting for its sample.
#[derive(Debug, Clone, Copy)]
struct Waiting {
    time: u64,
    event: PlayerEvent,
}

/// A player and an instrument.
#[derive(Debug)]
pub struct Engine {
    performance: Performance,
    played: Played,
    waiting: VecDeque<Waiting>,
    /// How long it rings at most, s.
    tail: f64,
    threads: NonZeroUsize,
    /// What this engine was before its last change, on its way out.
    outgoing: Option<Box<Replacement>>,
}

impl Engine {
    /// How much later than it happens everything is heard, samples at any rate.
    pub const LATENCY: u32 = Instrument::LATENCY;

    /// Builds everything. Nothing is allocated afterwards, but by more [threads](EngineOptions::threads) than one, and for what
    /// the player does where that is [recorded](Record).
    ///
    /// # Errors
    /// When the set-up cannot be built at this rate; the message names the value and its range.
    pub fn new(options: &EngineOptions) -> Result<Self, low_action_dsp::Error> {
        let (performance, instrument) = options.build()?;
        let waiting = VecDeque::with_capacity(WAITING_EVENTS);
        let (tail, threads) = (options.tail(), options.threads);
        let played = Played::new(instrument);
        Ok(Self { performance, played, waiting, tail, threads, outgoing: None })
    }

    /// Has the hands act differently from the next sample on.
    pub fn touch(&mut self, touching: &Touching) {
        let now = self.played.instrument.now();
        self.performance.touch(now, touching, &mut self.played);
    }

    /// Has channels mean something else from now on.
    pub fn set_input(&mut self, input: InputMode) {
        self.performance.set_input(input);
    }

    /// Which channel speaks for which others now.
    pub(crate) fn spoken(&self) -> Spoken {
        self.performance.spoken()
    }

    /// Has contacts solved so exactly from the next sample on: Newton iterations at most, and the change of
    /// penetration, m, at which they stop, each brought into its range.
    pub fn set_effort(&mut self, max_iterations: usize, tolerance: f64) {
        self.played.instrument.set_effort(max_iterations, tolerance);
    }

    /// Whether another event finds room to wait for a later sample.
    pub fn has_room(&self) -> bool {
        self.waiting.len() < WAITING_EVENTS
    }

    /// Takes an event that happens `offset` samples after the start of the next block. Events at
    /// the same sample happen in the order they come in.
    pub fn event(&mut self, offset: u32, event: PlayerEvent) {
        let now = self.played.instrument.now();
        let time = now + u64::from(offset);
        if self.waiting.len() == WAITING_EVENTS {
            // Those of the present sample need not wait.
            self.deliver_present();
        }
        if self.waiting.len() == WAITING_EVENTS {
            self.played.lost += 1;
            return;
        }
        // Hosts send events in order, so this looks at the last one and is done.
        let after = self.waiting.iter().rev().take_while(|other| other.time > time).count();
        self.waiting.insert(self.waiting.len() - after, Waiting { time, event });
    }

    /// Has the events of the next sample happen at once, so that what hands are told from now on comes after them.
    pub fn deliver_present(&mut self) {
        self.deliver(self.played.instrument.now() + 1);
    }

    /// Plays the next block. Both channels must be of one length; it may be any.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.process_stems(&mut [], left, right);
    }

    /// Plays the next block and writes each string's own sound, before it is panned, to `stems`
    /// (as many as there are strings, as long as the block). The stereo sound is the same as
    /// without.
    pub fn process_stems(&mut self, stems: &mut [&mut [f32]], left: &mut [f32], right: &mut [f32]) {
        let count = stems.len().min(MOST_STRINGS);
        let frames = left.len().min(right.len());
        let mut done = 0;
        while done < frames {
            let span = done..done + self.prepare(frames - done);
            done = span.end;
            let mut parts: [&mut [f32]; MOST_STRINGS] = std::array::from_fn(|_| Default::default());
            for (part, stem) in parts.iter_mut().zip(stems.iter_mut()) {
                *part = &mut stem[span.clone()];
            }
            let (left, right) = (&mut left[span.clone()], &mut right[span]);
            self.played.instrument.process_stems_by(self.threads, &mut parts[..count], left, right);
        }
    }

    /// Whether a string sounds a key of a channel that has not been let go of, or will as soon as one is free or its sample
    /// comes; or the key asks for a string, as long as it is down.
    pub fn sounds(&self, channel: u8, key: u8) -> bool {
        let Self { performance, .. } = self;
        performance.sounds(channel, key)
            || performance.awaits(channel, key)
            || performance.forces(channel, key)
            || self.is_to_begin(channel, key)
    }

    /// Whether a note-on of a key waits for its sample: a block that a host's event cuts short ends before it.
    fn is_to_begin(&self, channel: u8, key: u8) -> bool {
        let begins = |event| match event {
            PlayerEvent::NoteOn { channel: own, key: its, .. } => (own, its) == (channel, key),
            _ => false,
        };
        self.waiting.iter().any(|waiting| begins(waiting.event))
    }

    /// Number of strings, and so of stems.
    pub fn string_count(&self) -> usize {
        self.played.instrument.string_count()
    }

    /// What is played.
    pub fn instrument(&self) -> &Instrument {
        &self.played.instrument
    }

    /// Has what happens to the strings kept for pictures from now on, or no longer. The sound is the same bits.
    pub fn observe(&mut self, looking: bool) {
        self.played.instrument.observe(looking);
    }

    /// Forgets what has happened to the strings.
    pub fn observe_anew(&mut self) {
        self.played.instrument.observe_anew();
    }

    /// Largest size of the sound over the last 50 to 100 ms, 1 is full scale; for the end of tails.
    pub fn level(&self) -> f64 {
        self.played.instrument.level()
    }

    /// How long the string that rings longest takes to be [`QUIET`] when nobody damps it, s; endless without losses.
    pub fn tail(&self) -> f64 {
        self.tail
    }

    /// Whether nothing sounds, moves or is waiting: until the next event all samples are 0.
    pub fn is_silent(&self) -> bool {
        self.waiting.is_empty() && !self.is_behind() && self.played.instrument.is_silent()
    }

    /// Whether nothing is heard, nor will be until somebody plays, though strings may move yet: as under a finger that holds a note
    /// which has died away, under which a string never comes to rest by itself.
    pub fn is_inaudible(&self) -> bool {
        let left_alone = self.waiting.is_empty() && !self.is_behind() && !self.played.instrument.is_fading();
        let since =
            self.now().saturating_sub(self.played.touched) as f64 / self.played.instrument.sample_rate();
        self.is_silent() || left_alone && since >= LONGEST_ATTACK && self.level() < INAUDIBLE
    }

    /// Whether notes are yet to come, of chords that have more than there are strings.
    pub fn is_behind(&self) -> bool {
        self.performance.is_behind()
    }

    /// Index of the next sample since construction or reset.
    pub fn now(&self) -> u64 {
        self.played.instrument.now()
    }

    /// What could not be played as written so far.
    pub fn compromises(&self) -> Compromises {
        self.performance.compromises()
    }

    /// What was lost because too much came at once: events beyond 16,384 that wait in one block, and gestures that the
    /// instrument's queue has no room for.
    pub fn lost_events(&self) -> u64 {
        self.played.lost
    }

    /// Silence, hands off, pedals up, wheels in the middle, sample 0.
    pub fn reset(&mut self) {
        self.performance.reset();
        self.forget();
    }

    /// The same, but what those who play announce once stays as it is: capo, keyswitches, the reach of wheels, MPE.
    pub fn restart(&mut self) {
        self.performance.restart();
        self.forget();
    }

    /// The next notes are the first of the music once more, unless a key is down by then: hands go back to the beginning for them.
    pub fn begin_anew(&mut self) {
        self.performance.begin_anew();
    }

    /// What those who play have announced so far.
    pub fn announced(&self) -> Announced {
        self.performance.announced()
    }

    /// Wheels reach as far from the next sample on as before any reach was announced.
    pub fn forget_reach(&mut self) {
        self.performance.forget_reach();
    }

    /// Takes it as announced to this engine, to which nothing has been since it was built or [reset](Self::reset).
    pub fn announce(&mut self, announced: &Announced) {
        self.performance.announce(announced);
    }

    fn forget(&mut self) {
        self.played.reset();
        self.waiting.clear();
    }

    /// Has the player do all that belongs to the next samples, [`STEP`] at most, and returns how many those are. Threads
    /// have more to do at a time: as many as `frames`, as long as there is room for gestures.
    fn prepare(&mut self, frames: usize) -> usize {
        let mut prepared = 0;
        loop {
            prepared += STEP.min(frames - prepared);
            let until = self.played.instrument.now() + prepared as u64;
            self.deliver(until);
            self.performance.advance(until, &mut self.played);
            let alone = self.threads == NonZeroUsize::MIN;
            if alone || prepared == frames || self.played.instrument.waiting() > MANY_GESTURES {
                return prepared;
            }
        }
    }

    /// Hands the player all events before sample `until`.
    fn deliver(&mut self, until: u64) {
        while let Some(&Waiting { time, event }) = self.waiting.front().filter(|next| next.time < until) {
            self.waiting.pop_front();
            self.performance.event(time, event, &mut self.played);
        }
    }
}
