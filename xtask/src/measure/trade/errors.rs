//! How far a run is from the reference.

use super::filter::LowPass;
use super::record::{COMMON, Record, WINDOW};
use super::scenes::{DURATION, Kind, PLUCK, RINGING};
use super::spectrum::{log_spectral_distance, partials};

/// The reference of a scene, with everything of it that is needed again and again.
pub struct Reference {
    record: Record,
    heard: Vec<f64>,
}

/// Errors of one run. What a scene cannot tell is not a number.
#[derive(Debug, Clone, Copy)]
pub struct Errors {
    /// Difference of the force on the bridge up to 8 kHz from the pluck until the first contact that was
    /// not there before it, at most 50 ms, as a part of the reference's: the smallest for any delay of up to 30 µs.
    pub waveform: f64,
    /// Of the fundamental, cents.
    pub pitch: f64,
    /// The largest of a partial up to 4 kHz, cents.
    pub partials: f64,
    /// The largest of the time in which one of the first five partials decays, as a part of it.
    pub decay: f64,
    /// The time in which the fundamental decays by 60 dB, s, and the reference's.
    pub t60: [f64; 2],
    /// Σ of differences of the contacts' impulses in 20 ms, as a part of Σ of the impulses.
    pub impulses: f64,
    /// The same of the level of the force on the bridge in 20 ms.
    pub level: f64,
    /// Root mean square over third-octave bands and frames, dB.
    pub spectrum: f64,
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

    /// How far a run is from it; `pitch` is f₁ and B of a scene of one note.
    pub fn errors(&self, run: &Record, kind: Kind, pitch: (f64, f64), filter: &LowPass) -> Errors {
        let heard = run.heard(filter, 0.0, DURATION, 0.0);
        let missing = f64::NAN;
        let (cents, worst, decay, t60) = match kind {
            Kind::Open | Kind::Pressed | Kind::EachOpen | Kind::High => self.ringing(&heard, pitch),
            _ => (missing, missing, missing, [missing; 2]),
        };
        let touches = self.record.impulses.iter().any(|impulse| *impulse > 0.0);
        Errors {
            waveform: if self.plays_at_once() { self.waveform(run, filter) } else { missing },
            pitch: cents,
            partials: worst,
            decay,
            t60,
            impulses: if touches { difference(&run.impulses, &self.record.impulses) } else { missing },
            level: difference(&levels(&heard), &levels(&self.heard)),
            spectrum: log_spectral_distance(&heard[at(PLUCK)..], &self.heard[at(PLUCK)..]),
        }
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

    /// Errors of pitch and of partials, cents, and of decay; the times in which the fundamental decays.
    fn ringing(&self, heard: &[f64], (fundamental, inharmonicity): (f64, f64)) -> (f64, f64, f64, [f64; 2]) {
        let of = |sound: &[f64]| partials(&sound[at(RINGING)..], fundamental, inharmonicity);
        let (found, expected) = (of(heard), of(&self.heard));
        let (mut pitch, mut worst, mut decay, mut t60) = (f64::NAN, 0.0f64, 0.0f64, [f64::NAN; 2]);
        for partial in &expected {
            let Some(other) = found.iter().find(|other| other.number == partial.number) else { continue };
            let cents = 1200.0 * (other.frequency / partial.frequency).log2().abs();
            if partial.number == 1 {
                pitch = cents;
                t60 = [other, partial].map(|partial| 1e3f64.ln() / partial.decay);
            }
            worst = worst.max(cents);
            if partial.number <= 5 && partial.decay > 0.0 {
                decay = decay.max((partial.decay / other.decay - 1.0).abs());
            }
        }
        (pitch, worst, decay, t60)
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
