//! The pitch of a note that moves.

use std::ops::Range;

/// Time between two measurements, s.
const HOP: f64 = 0.005;

/// Periods compared with those that follow them.
const PERIODS: f64 = 2.0;

/// What is smoothed away altogether, as a multiple of the highest fundamental: the second partial, about. A stiff
/// string’s partials are sharp, and left in they would pull the pitch up.
const SMOOTHED: f64 = 1.7;

/// Means over so many samples.
fn smooth(samples: &[f64], window: usize) -> Vec<f64> {
    samples.windows(window.max(1)).map(|part| part.iter().sum::<f64>() / part.len() as f64).collect()
}

/// Fundamental over time, (s, Hz), of a sound whose fundamental is in a range: the lag at which a stretch of
/// the sound differs least from the stretch that follows, as a part of the energy of both, found to a part of
/// a sample by a parabola. Where the two differ by more than a tenth there is no pitch.
pub fn course(samples: &[f64], rate: f64, range: Range<f64>) -> Vec<(f64, f64)> {
    let window = (rate / (SMOOTHED * range.end)) as usize;
    let samples = &smooth(&smooth(samples, window), window);
    let (least, most) = ((rate / range.end) as usize, (rate / range.start) as usize);
    let length = (PERIODS * most as f64) as usize;
    let mut pitches = Vec::new();
    let mut start = 0;
    while start + length + most + 1 < samples.len() {
        let first = &samples[start..start + length];
        let difference = |lag: usize| {
            let second = &samples[start + lag..start + lag + length];
            let squares = first.iter().zip(second).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            squares / first.iter().zip(second).map(|(a, b)| a * a + b * b).sum::<f64>().max(f64::MIN_POSITIVE)
        };
        let differences: Vec<_> = (least..=most).map(difference).collect();
        let inner = 1..differences.len() - 1;
        let best = inner.min_by(|a, b| differences[*a].total_cmp(&differences[*b])).unwrap_or(1);
        if differences[best] < 0.1 {
            let [left, middle, right] = [differences[best - 1], differences[best], differences[best + 1]];
            let shift = 0.5 * (left - right) / (left - 2.0 * middle + right);
            let shift = if shift.abs() <= 1.0 { shift } else { 0.0 };
            let lag = (least + best) as f64 + shift;
            // The middle of the two stretches.
            let time = ((start + window) as f64 + 0.5 * (length as f64 + lag)) / rate;
            pitches.push((time, rate / lag));
        }
        start += (HOP * rate) as usize;
    }
    pitches
}

#[cfg(test)]
mod tests {
    use super::course;

    #[test]
    fn a_steady_note_is_read_to_a_tenth_of_a_cent() {
        let rate = 88_200.0;
        let tone = |n: usize| {
            let turns = std::f64::consts::TAU * 112.34 * n as f64 / rate;
            turns.sin() + 0.5 * (2.0 * turns).cos() + 0.2 * (7.0 * turns).sin()
        };
        let samples: Vec<_> = (0..20_000).map(tone).collect();
        let pitches = course(&samples, rate, 90.0..135.0);
        assert!(pitches.len() > 10);
        for (_, pitch) in pitches {
            assert!((1200.0 * (pitch / 112.34).log2()).abs() < 0.1, "{pitch}");
        }
    }
}
