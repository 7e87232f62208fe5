//! An instrument: strings over a neck under two hands, heard through a pickup.
//!
//! Everything is allocated when it is built. Strings on a bridge that stands still do not hear each other, so each is stepped through
//! a whole run of samples at a time, at a multiple of the sample rate of its own ([`crate::settings`]); those over a body go on
//! together. Gestures cut runs at their exact samples, and so the samples are the same however they are asked for.

mod looks;

use std::ops::Range;

use crate::body;
use crate::decimate::DELAY;
use crate::error::Error;
use crate::gesture::{Gesture, TimedGesture};
use crate::intonation::{Behind, finger_position};
use crate::level::Level;
use crate::queue::Queue;
pub use crate::queue::QueueFull;
use crate::ramp::Ramp;
use crate::ratio::Ratio;
use crate::scene::SolverSettings;
use crate::settings::EngineSettings;
use crate::setup::Setup;
use crate::together;
use crate::voice::{RUN, Voice};

/// What a player needs to know of one string.
#[derive(Debug, Clone, PartialEq)]
pub struct StringGeometry {
    /// Pitch of the open string as written, a MIDI note number: it sounds higher by the set-up's
    /// [tuning](crate::Setup::tuning).
    pub open_pitch: f64,
    /// Length from nut to saddle, m.
    pub length: f64,
    /// Places of the frets, m from the nut, fret 1 first.
    pub frets: Vec<f64>,
    /// The largest tension that the set-up's `max_bend` asks for, as a multiple of the string's own. (Its grid bears as much, and
    /// half a semitone at least: up to there [`Gesture::Bend`] reaches.)
    pub highest_ratio: f64,
    /// Wave impedance √(Tρ), kg/s.
    pub wave_impedance: f64,
    pub(crate) behind: Behind,
}

impl StringGeometry {
    /// [Where a finger presses](finger_position) to stop a fret (1 for the first) of this string, m from the nut.
    pub fn finger_position(&self, fret: usize) -> f64 {
        finger_position(&self.frets, fret, self.behind)
    }
}

/// A playable instrument.
#[derive(Debug, Clone)]
pub struct Instrument {
    pub(crate) voices: Vec<Voice>,
    /// How many strings, next to each other, move together: one, or all over a body.
    pub(crate) together: usize,
    pub(crate) queue: Queue,
    pub(crate) now: u64,
    pub(crate) level: Level,
    /// Hz.
    pub(crate) sample_rate: f64,
    /// The instrument that this one has taken over from, until it is fetched.
    pub(crate) before: Option<Box<Instrument>>,
    /// How much of the instrument before is heard no more, 0 to 1.
    pub(crate) fade: Ramp,
    /// Whether the strings of that one go on in these.
    pub(crate) goes_on: bool,
}

impl Instrument {
    /// How much later than it happens everything is heard, samples: the same for all instruments, so that
    /// one can take over from another. What a sample holds happened so many samples before.
    pub const LATENCY: u32 = DELAY as u32;

    /// Builds an instrument: tunes strings, places frets, compiles models, allocates.
    ///
    /// # Errors
    /// When a value is out of range, a string cannot be [tuned](crate::intonation::intonate), a contact or a pad is too stiff for
    /// this sample rate, a wide bridge ends before the first point of a string's grid, or a body is too light for the strings or too
    /// fast for their rate.
    pub fn new(setup: &Setup, settings: &EngineSettings) -> Result<Instrument, Error> {
        setup.check()?;
        settings.check()?;
        let voices = (0..setup.string.len())
            .map(|index| Voice::new(setup, index, settings))
            .collect::<Result<Vec<_>, Error>>()?;
        if let Some(body) = &setup.body {
            body::check(body, &voices.iter().map(|voice| &voice.model).collect::<Vec<_>>())?;
        }
        Ok(Instrument {
            together: if setup.body.is_some() { voices.len() } else { 1 },
            voices,
            queue: Queue::new(),
            now: 0,
            level: Level::new(settings.sample_rate),
            sample_rate: settings.sample_rate,
            before: None,
            fade: Ramp::at(1.0),
            goes_on: false,
        })
    }

    /// Number of strings.
    pub fn string_count(&self) -> usize {
        self.voices.len()
    }

    /// What a player needs to know of a string.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn geometry(&self, string: usize) -> &StringGeometry {
        &self.voices[string].geometry
    }

    /// How many steps of a string a sample has.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn ratio(&self, string: usize) -> Ratio {
        self.voices[string].ratio()
    }

    /// Sample rate of what is heard, Hz.
    pub fn sample_rate(&self) -> f64 {
        self.sample_rate
    }

    /// Index of the next sample.
    pub fn now(&self) -> u64 {
        self.now
    }

    /// How exactly contacts are solved from the next sample on: Newton iterations at most, and the change
    /// of penetration, m, at which they stop. Brought into their ranges in [`SolverSettings`]; what is no number counts as 0.
    /// A successor has its own.
    pub fn set_effort(&mut self, max_iterations: usize, tolerance: f64) {
        let tolerance = if tolerance > 0.0 { tolerance.min(SolverSettings::WIDEST_TOLERANCE) } else { 0.0 };
        for voice in &mut self.voices {
            voice.model.settings.max_iterations = max_iterations.min(SolverSettings::MOST_ITERATIONS);
            voice.model.settings.tolerance = tolerance;
        }
    }

    /// Puts a gesture into the queue; one whose time is past happens at the next sample, after those that wait for it already.
    /// One for a string that is not there does nothing. Never allocates.
    ///
    /// # Errors
    /// When too many gestures wait; this one is then left out.
    pub fn schedule(&mut self, gesture: TimedGesture) -> Result<(), QueueFull> {
        self.queue.push(TimedGesture { time: gesture.time.max(self.now), ..gesture })
    }

    /// How many gestures wait.
    pub fn waiting(&self) -> usize {
        self.queue.len()
    }

    /// Renders the next samples in stereo: as many as the shorter of the two slices has.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.process_stems(&mut [], left, right);
    }

    /// The same samples, and each string's own, before pan, into as many of `stems` as there are; those without a string are
    /// silent, but for what fades.
    ///
    /// # Panics
    /// When a stem is shorter than the two channels.
    pub fn process_stems(&mut self, stems: &mut [&mut [f32]], left: &mut [f32], right: &mut [f32]) {
        let count = left.len().min(right.len());
        let mut done = 0;
        while done < count {
            while let Some(due) = self.queue.pop_due(self.now) {
                self.begin(due.string, due.gesture);
                // What fades out while its strings go on is played on, so that an attack does not fade in.
                if let Some(before) = self.fading() {
                    before.begin(due.string, due.gesture);
                }
            }
            let until_gesture = self.queue.next_time().map_or(RUN as u64, |time| time - self.now);
            let run = (count - done).min(RUN).min(usize::try_from(until_gesture).unwrap_or(RUN));
            self.run(run);
            self.mix(done..done + run, stems, left, right);
            done += run;
        }
    }

    /// Begins a gesture on a string, if it is there.
    fn begin(&mut self, string: usize, gesture: Gesture) {
        if let Some(strings) = self.voices.chunks_mut(self.together).nth(string / self.together)
            && string % self.together < strings.len()
        {
            together::begin(strings, string % self.together, gesture);
        }
    }

    /// Steps all strings through so many samples, at most [`RUN`].
    pub(crate) fn run(&mut self, samples: usize) {
        self.voices.chunks_mut(self.together).for_each(|strings| together::run(strings, samples));
    }

    /// Mixes what the strings have played last into the samples `span`, and goes on to the next.
    pub(crate) fn mix(
        &mut self,
        span: Range<usize>,
        stems: &mut [&mut [f32]],
        left: &mut [f32],
        right: &mut [f32],
    ) {
        for (stem, voice) in stems.iter_mut().zip(&self.voices) {
            for (out, sample) in stem[span.clone()].iter_mut().zip(&voice.run) {
                *out = heard(*sample);
            }
        }
        for stem in stems.iter_mut().skip(self.voices.len()) {
            stem[span.clone()].fill(0.0);
        }
        for (i, at) in span.clone().enumerate() {
            let [l, r] = self.stereo(i);
            left[at] = heard(l);
            right[at] = heard(r);
        }
        if !self.fade.rests() {
            self.fade_from_before(span.clone(), stems, left, right);
        }
        self.now += span.len() as u64;
        for at in span {
            self.level.see(f64::from(left[at]), f64::from(right[at]));
        }
    }

    /// Both channels at a sample of the present run.
    #[inline]
    pub(crate) fn stereo(&self, i: usize) -> [f64; 2] {
        let (mut l, mut r) = (0.0, 0.0);
        for voice in self.voices.iter().filter(|voice| !voice.silent) {
            l += voice.pan[0] * voice.run[i];
            r += voice.pan[1] * voice.run[i];
        }
        [l, r]
    }

    /// The largest |output| of the last 50 to 100 ms.
    pub fn level(&self) -> f64 {
        self.level.value()
    }

    /// Whether nothing sounds and nothing is waiting: until the next gesture all samples are 0.
    pub fn is_silent(&self) -> bool {
        self.queue.next_time().is_none() && !self.is_fading() && self.voices.iter().all(Voice::is_silent)
    }

    /// Silence, all hands away, the queue emptied, time 0.
    pub fn reset(&mut self) {
        self.voices.iter_mut().for_each(Voice::reset);
        self.queue.clear();
        self.level.reset();
        self.fade = Ramp::at(1.0);
        self.now = 0;
    }
}

/// A sample as it leaves the instrument. One too small for a whole mantissa is 0: nobody hears −750 dB, and such
/// numbers are slow on most machines.
#[inline]
pub(crate) fn heard(sample: f64) -> f32 {
    if sample.abs() < f64::from(f32::MIN_POSITIVE) { 0.0 } else { sample as f32 }
}
