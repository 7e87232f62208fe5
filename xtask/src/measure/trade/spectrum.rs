//! Partials and bands of a sound at the common rate.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use super::record::COMMON;

/// Length of a transform, samples: 0.37 Hz apart.
const LONG: usize = 1 << 17;
/// A frame of bands, samples, and how far frames are apart.
const FRAME: usize = 1920;
const HOP: usize = 960;
/// Lowest and highest frequency of the bands, Hz.
const BANDS: [f64; 2] = [62.5, 8000.0];
/// What lies this far below the loudest band of the sound counts as silence, dB.
const FLOOR: f64 = 60.0;
/// A partial this far below the strongest is not looked for, as a factor.
const FAINT: f64 = 1e-3;

/// Magnitudes of the spectrum of a stretch under Hann's window.
fn magnitudes(stretch: &[f64], length: usize) -> Vec<f64> {
    let count = stretch.len() as f64;
    let window = |n: usize| 0.5 - 0.5 * (std::f64::consts::TAU * (n as f64 + 0.5) / count).cos();
    let mut buffer: Vec<Complex<f64>> =
        stretch.iter().enumerate().map(|(n, value)| Complex::new(value * window(n), 0.0)).collect();
    buffer.resize(length, Complex::default());
    FftPlanner::new().plan_fft_forward(length).process(&mut buffer);
    buffer[..length / 2].iter().map(|value| value.norm()).collect()
}

/// A partial: frequency, Hz, and how fast it decays, 1/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Partial {
    /// Its number, 1 for the fundamental.
    pub number: usize,
    /// Hz.
    pub frequency: f64,
    /// 1/s, of the amplitude.
    pub decay: f64,
}

/// The highest partial looked for, Hz.
pub const HIGHEST: f64 = 4000.0;

/// The partials up to [`HIGHEST`] of a note near f₁, Hz, and inharmonicity B. Each is looked for where the
/// one below says it should be: errors of a grid grow steadily.
pub fn partials(sound: &[f64], fundamental: f64, inharmonicity: f64) -> Vec<Partial> {
    let whole = magnitudes(sound, LONG);
    let middle = sound.len() / 2;
    let halves = [magnitudes(&sound[..middle], LONG), magnitudes(&sound[middle..], LONG)];
    let apart = middle as f64 / COMMON;
    let bin = COMMON / LONG as f64;
    let loudest = whole.iter().skip((0.5 * fundamental / bin) as usize).copied().fold(0.0, f64::max);
    let (mut found, mut stretch) = (Vec::new(), 0.0);
    for number in 1.. {
        let m = number as f64;
        let stiff = ((1.0 + inharmonicity * m * m) / (1.0 + inharmonicity)).sqrt();
        let expected = m * fundamental * stiff * (1.0 + stretch * m * m);
        if expected > HIGHEST {
            break;
        }
        let range = [expected - 0.3 * fundamental, expected + 0.3 * fundamental].map(|f| (f / bin) as usize);
        let Some((peak, height)) = highest(&whole, range) else { continue };
        if height < FAINT * loudest {
            continue;
        }
        let frequency = peak * bin;
        // Frequencies stray from theory by a part that grows with the square of the number.
        stretch = (frequency / (m * fundamental * stiff) - 1.0) / (m * m);
        let near = [frequency - 0.2 * fundamental, frequency + 0.2 * fundamental].map(|f| (f / bin) as usize);
        let heights =
            [&halves[0], &halves[1]].map(|half| highest(half, near).map_or(0.0, |(_, height)| height));
        found.push(Partial { number, frequency, decay: (heights[0] / heights[1]).ln() / apart });
    }
    found
}

/// The highest local peak within a range of bins, by a parabola over its logarithm: place and height.
fn highest(spectrum: &[f64], [from, to]: [usize; 2]) -> Option<(f64, f64)> {
    let inner = from.max(1)..to.min(spectrum.len() - 2);
    let peak = inner.max_by(|a, b| spectrum[*a].total_cmp(&spectrum[*b]))?;
    let [left, middle, right] = [peak - 1, peak, peak + 1].map(|bin| spectrum[bin].max(1e-300).ln());
    if left > middle || right > middle {
        return None;
    }
    let bend = left - 2.0 * middle + right;
    let shift = if bend < 0.0 { 0.5 * (left - right) / bend } else { 0.0 };
    Some((peak as f64 + shift, (middle - 0.25 * (left - right) * shift).exp()))
}

/// Root mean square difference, dB, of the levels of third-octave bands in frames of 40 ms.
pub fn log_spectral_distance(sound: &[f64], reference: &[f64]) -> f64 {
    let (sound, reference) = (bands(sound), bands(reference));
    let loudest = reference.iter().flatten().copied().fold(f64::MIN_POSITIVE, f64::max);
    let level = |power: f64| (10.0 * (power / loudest).max(f64::MIN_POSITIVE).log10()).max(-FLOOR);
    let pairs = sound.iter().flatten().zip(reference.iter().flatten());
    // Where both are silent nothing can be heard, and nothing is counted.
    let (mut sum, mut count) = (0.0, 0u32);
    for (a, b) in pairs.map(|(a, b)| (level(*a), level(*b))).filter(|(a, b)| a.max(*b) > -FLOOR) {
        sum += (a - b) * (a - b);
        count += 1;
    }
    (sum / f64::from(count.max(1))).sqrt()
}

/// Power in third-octave bands, frame by frame.
fn bands(sound: &[f64]) -> Vec<Vec<f64>> {
    let third = 2f64.powf(1.0 / 3.0);
    let count = ((BANDS[1] / BANDS[0]).log2() * 3.0).round() as i32;
    let edges: Vec<f64> = (0..=count).map(|edge| BANDS[0] * third.powi(edge)).collect();
    // Padded, so that the lowest band holds some bins.
    let length = 4 * FRAME;
    let starts = (0..sound.len().saturating_sub(FRAME)).step_by(HOP);
    starts
        .map(|start| {
            let spectrum = magnitudes(&sound[start..start + FRAME], length);
            let bin = |frequency: f64| (frequency * length as f64 / COMMON) as usize;
            let power = |pair: &[f64]| spectrum[bin(pair[0])..bin(pair[1])].iter().map(|m| m * m).sum();
            edges.windows(2).map(power).collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_synthetic_string_is_read_to_a_tenth_of_a_cent_and_a_hundredth_of_its_decay() {
        let (fundamental, inharmonicity) = (82.4, 1.3e-4);
        let place = |m: f64| m * fundamental * ((1.0 + inharmonicity * m * m) / (1.0 + inharmonicity)).sqrt();
        let decay = |m: f64| 0.3 + 0.01 * m * m;
        let sample = |n: usize| {
            let t = n as f64 / COMMON;
            (1..=30)
                .map(|m| {
                    let m = f64::from(m);
                    (-decay(m) * t).exp() / m * (std::f64::consts::TAU * place(m) * t + m).sin()
                })
                .sum::<f64>()
        };
        let sound: Vec<f64> = (0..26_400).map(sample).collect();
        let found = partials(&sound, fundamental, inharmonicity);
        assert!(found.len() >= 30, "{}", found.len());
        for partial in &found[..30] {
            let m = partial.number as f64;
            let cents = 1200.0 * (partial.frequency / place(m)).log2();
            assert!(cents.abs() < 0.1, "partial {m}: {cents} cents");
            assert!((partial.decay / decay(m) - 1.0).abs() < 0.01, "partial {m}: {}", partial.decay);
        }
    }

    #[test]
    fn twice_as_loud_is_six_decibels() {
        let sound: Vec<f64> =
            (0..9600).map(|n| (0.1 * f64::from(n)).sin() + (0.031 * f64::from(n)).sin()).collect();
        let louder: Vec<f64> = sound.iter().map(|value| 2.0 * value).collect();
        assert_eq!(log_spectral_distance(&sound, &sound), 0.0);
        // Bands near silence are cut off at the floor, so a little less than 6.02 dB.
        let distance = log_spectral_distance(&louder, &sound);
        assert!((5.0..6.03).contains(&distance), "{distance}");
    }
}
