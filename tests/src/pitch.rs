//! Measuring the frequency of one partial of a sound.

use std::f64::consts::TAU;

use crate::hands::RATE;
use crate::stage::hertz;

/// Part of the samples that one window covers; the rest is how far the second window lies behind.
const WINDOW: f64 = 0.64;

/// How far around the expected frequency to look, as a part of it: a little more than a quarter tone.
const REACH: f64 = 0.035;

/// The frequency, Hz, of the strongest partial within 60 cents of `near`, over all of `samples`.
///
/// Two windows, one behind the other, see the same decaying partial with the same amplitude but for its
/// decay; how far its phase has turned between them gives the frequency. A decay cancels exactly, and the
/// windows (Blackman and Harris, side lobes 92 dB down) keep other partials out.
pub fn frequency_near(samples: &[f32], rate: f64, near: f64) -> f64 {
    let length = (samples.len() as f64 * WINDOW) as usize;
    let hop = samples.len() - length;
    let window: Vec<f64> = (0..length)
        .map(|n| {
            let t = TAU * (n as f64 + 0.5) / length as f64;
            0.35875 - 0.48829 * t.cos() + 0.14128 * (2.0 * t).cos() - 0.01168 * (3.0 * t).cos()
        })
        .collect();
    let look =
        |start: usize, frequency: f64| spectrum(&samples[start..start + length], &window, frequency / rate);
    // The main lobe is four bins to each side: steps of one bin cannot miss it.
    let bin = rate / length as f64;
    let steps = (REACH * near / bin).ceil() as i32;
    let strength = |step: &i32| look(0, near + f64::from(*step) * bin).power();
    let strongest = (-steps..=steps).max_by(|a, b| strength(a).total_cmp(&strength(b)));
    let mut frequency = near + f64::from(strongest.unwrap_or(0)) * bin;
    // From short to long delays: each narrows what the next may misread by a whole turn.
    for delay in [hop / 64, hop / 16, hop / 4, hop, hop] {
        let expected = TAU * frequency * delay as f64 / rate;
        let turned = look(delay, frequency).angle() - look(0, frequency).angle() - expected;
        let turned = turned - TAU * (turned / TAU).round();
        frequency += turned * rate / (TAU * delay as f64);
    }
    frequency
}

/// How far `frequency` is above `target`, cents.
pub fn cents(frequency: f64, target: f64) -> f64 {
    1200.0 * (frequency / target).log2()
}

/// How far a sound at 48 kHz is above a MIDI key, cents.
pub fn off_key(sound: &[f32], key: f64) -> f64 {
    cents(frequency_near(sound, RATE, hertz(key)), hertz(key))
}

/// A complex amplitude.
struct Amplitude(f64, f64);

impl Amplitude {
    fn power(&self) -> f64 {
        self.0 * self.0 + self.1 * self.1
    }

    fn angle(&self) -> f64 {
        self.1.atan2(self.0)
    }
}

/// Σ window·sample·exp(−2πi·turns·n), the phasor turned step by step.
fn spectrum(samples: &[f32], window: &[f64], turns: f64) -> Amplitude {
    let (sin, cos) = (-TAU * turns).sin_cos();
    let (mut re, mut im) = (1.0, 0.0);
    let mut sum = Amplitude(0.0, 0.0);
    for (sample, weight) in samples.iter().zip(window) {
        let value = f64::from(*sample) * weight;
        sum.0 += value * re;
        sum.1 += value * im;
        (re, im) = (re * cos - im * sin, re * sin + im * cos);
    }
    sum
}
