//! How far a run is from the reference.

use anyhow::{Context, Result, ensure};

use super::filter::LowPass;
use super::record::{COMMON, Record, WINDOW};
use super::scenes::{DURATION, Kind, PLUCK, RINGING};
use super::settings::Law;
use super::spectrum::{log_spectral_distance, partials};

/// The reference of a scene, with everything of it that is needed again and again.
pub struct Reference {
    record: Record,
    heard: Vec<f64>,
}

/// Errors of one run, all of them finite; `None` where a scene cannot tell.
#[derive(Debug, Clone, Copy)]
pub struct Errors {
    /// Difference of the force on the bridge up to 8 kHz from the pluck until the first contact that was
    /// not there before it, at most 50 ms, as a part of the reference's: the smallest for any delay of up to 30 µs.
    pub waveform: Option<f64>,
    /// Of a note that rings.
    pub ringing: Option<Ringing>,
    /// Σ of differences of the contacts' impulses in 20 ms, as a part of Σ of the impulses.
    pub impulses: Option<f64>,
    /// The same of the level of the force on the bridge in 20 ms.
    pub level: f64,
    /// Root mean square over third-octave bands and frames, dB.
    pub spectrum: f64,
}

/// Errors of pitch, partials and decay of a note that rings.
#[derive(Debug, Clone, Copy)]
pub struct Ringing {
    /// Of the fundamental, cents.
    pub pitch: f64,
    /// The largest of a partial up to 4 kHz, cents.
    pub partials: f64,
    /// The largest of the time in which one of the first five partials decays, as a part of it.
    pub decay: f64,
    /// The time in which the fundamental decays by 60 dB, s, and the reference's.
    pub t60: [f64; 2],
}

impl Errors {
    /// The error of its [pitch](Ringing::pitch), cents, where it is a note that rings.
    pub fn pitch(&self) -> Option<f64> {
        self.ringing.map(|ringing| ringing.pitch)
    }

    /// Of its [partials](Ringing::partials), cents.
    pub fn partials(&self) -> Option<f64> {
        self.ringing.map(|ringing| ringing.partials)
    }

    /// Of its [decay](Ringing::decay), as a part of it.
    pub fn decay(&self) -> Option<f64> {
        self.ringing.map(|ringing| ringing.decay)
    }

    fn are_finite(&self) -> bool {
        let ringing = self.ringing.map(|Ringing { pitch, partials, decay, t60: [own, reference] }| {
            [pitch, partials, decay, own, reference]
        });
        let numbers = [self.waveform, self.impulses, Some(self.level), Some(self.spectrum)];
        let mut all = numbers.into_iter().flatten().chain(ringing.into_iter().flatten());
        all.all(f64::is_finite)
    }
}

/// Delays tried are this far apart at first, s, and this many on either side.
const DELAY: f64 = 2e-6;
const DELAYS: i32 = 15;
/// The longest stretch of which the waveform is compared, s.
const STRETCH: f64 = 0.05;

impl Reference {
    /// Prepares the run of the reference.
    pub fn new(record: Record, filter: &LowPass) -> Reference {
        let heard = record.heard(filter, 0.0, DURATION, 0.0);
        Reference { record, heard }
    }

    /// The reference's own run.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// How far a run under a law is from it; `pitch` is f₁ and B of a scene of one note.
    ///
    /// # Errors
    /// When a partial of the reference is not there in the run, or an error is not finite.
    pub fn errors(
        &self,
        run: &Record,
        (kind, law): (Kind, Law),
        pitch: (f64, f64),
        filter: &LowPass,
    ) -> Result<Errors> {
        let heard = run.heard(filter, 0.0, DURATION, 0.0);
        let rings = matches!(kind, Kind::Open | Kind::Pressed | Kind::EachOpen | Kind::High);
        let touches = self.record.impulses.iter().any(|impulse| *impulse > 0.0);
        let errors = Errors {
            waveform: self.plays_at_once().then(|| self.waveform(run, filter)),
            ringing: rings.then(|| self.ringing(&heard, law, pitch)).transpose()?,
            impulses: touches.then(|| difference(&run.impulses, &self.record.impulses)),
            level: difference(&levels(&heard), &levels(&self.heard)),
            spectrum: log_spectral_distance(&heard[at(PLUCK)..], &self.heard[at(PLUCK)..]),
        };
        ensure!(errors.are_finite(), "an error is not finite: {errors:?}");
        Ok(errors)
    }

    /// Whether there is a stretch between pluck and first contact that can be compared.
    fn plays_at_once(&self) -> bool {
        self.record.first_touch > PLUCK + 0.004
    }

    fn waveform(&self, run: &Record, filter: &LowPass) -> f64 {
        let end = (PLUCK + STRETCH).min(self.record.first_touch);
        let reference = &self.heard[at(PLUCK)..at(end)];
        let mean = reference.iter().sum::<f64>() / reference.len() as f64;
        let power: f64 = reference.iter().map(|value| (value - mean) * (value - mean)).sum();
        let error = |delay: f64| {
            let heard = run.heard(filter, PLUCK, end, delay);
            let squares = heard.iter().zip(reference).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            squares / power
        };
        // Filters and half steps have sounds of different rates some microseconds early or late.
        let tried: Vec<f64> = (-DELAYS..=DELAYS).map(|step| error(f64::from(step) * DELAY)).collect();
        let best = (1..tried.len() - 1).min_by(|a, b| tried[*a].total_cmp(&tried[*b])).unwrap_or(1);
        let [left, middle, right] = [tried[best - 1], tried[best], tried[best + 1]];
        // Where the best lies at an end, the parabola would lead out of the range.
        let shift = (0.5 * (left - right) / (left - 2.0 * middle + right)).clamp(-1.0, 1.0);
        let delay = (best as f64 + shift - f64::from(DELAYS)) * DELAY;
        error(delay).min(middle).sqrt()
    }

    /// Errors of a note that rings; `heard` is the run at the common rate. A partial that is not there cannot be compared. The
    /// quadratised law alone is excused for it, but for the fundamental: at 192 kHz it loses the faint 25th of a stopped low E.
    fn ringing(&self, heard: &[f64], law: Law, (fundamental, inharmonicity): (f64, f64)) -> Result<Ringing> {
        let of = |sound: &[f64]| partials(&sound[at(RINGING)..], fundamental, inharmonicity);
        let (found, expected) = (of(heard), of(&self.heard));
        let (mut of_fundamental, mut worst, mut decay) = (None, 0.0f64, 0.0f64);
        for partial in &expected {
            let number = partial.number;
            let other = found.iter().find(|other| other.number == number);
            if other.is_none() && law == Law::Quadratised {
                continue;
            }
            let other = other.with_context(|| format!("partial {number} is not there"))?;
            let cents = 1200.0 * (other.frequency / partial.frequency).log2().abs();
            if number == 1 {
                of_fundamental = Some((cents, [other, partial].map(|one| 1e3f64.ln() / one.decay)));
            }
            let apart = if number <= 5 && partial.decay > 0.0 {
                (partial.decay / other.decay - 1.0).abs()
            } else {
                0.0
            };
            // (The larger of two numbers leaves out what is none.)
            ensure!(cents.is_finite() && apart.is_finite(), "partial {number}: {other:?}, not {partial:?}");
            (worst, decay) = (worst.max(cents), decay.max(apart));
        }
        let (pitch, t60) = of_fundamental.context("there is no fundamental")?;
        Ok(Ringing { pitch, partials: worst, decay, t60 })
    }
}

/// Index of a time at the common rate.
fn at(time: f64) -> usize {
    (time * COMMON).round() as usize
}

/// Σ|a − b| / Σ|b|.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let apart: f64 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
    apart / b.iter().map(|value| value.abs()).sum::<f64>().max(f64::MIN_POSITIVE)
}

/// Root mean square about the mean in each window after the pluck.
fn levels(sound: &[f64]) -> Vec<f64> {
    let window = (WINDOW * COMMON) as usize;
    let level = |part: &[f64]| {
        let mean = part.iter().sum::<f64>() / part.len() as f64;
        (part.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / part.len() as f64).sqrt()
    };
    sound[at(PLUCK)..].chunks_exact(window).map(level).collect()
}
