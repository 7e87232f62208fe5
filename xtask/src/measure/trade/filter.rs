//! Brings a signal of any rate to the common rate, and leaves what is compared: frequencies up to 8 kHz.

use super::record::COMMON;

/// Half the level, Hz: 8.6 kHz pass and 11.4 kHz are stopped.
const CUT: f64 = 10e3;
/// Half the length of the impulse response, s.
const HALF: f64 = 1e-3;
/// Entries of its table; between them it is a straight line, off by less than 1e-6 of its peak.
const ENTRIES: usize = 1 << 14;

/// A windowed sinc, as a function of time and so the same for every rate.
pub struct LowPass {
    table: Vec<f64>,
}

impl LowPass {
    /// The filter.
    pub fn new() -> LowPass {
        let pi = std::f64::consts::PI;
        let at = |entry: usize| {
            let x = entry as f64 / ENTRIES as f64;
            let turns = 2.0 * CUT * HALF * x;
            let sinc = if entry == 0 { 1.0 } else { (pi * turns).sin() / (pi * turns) };
            // Blackman's window.
            2.0 * CUT * sinc * (0.42 + 0.5 * (pi * x).cos() + 0.08 * (2.0 * pi * x).cos())
        };
        LowPass {
            table: (0..=ENTRIES + 1).map(|entry| if entry > ENTRIES { 0.0 } else { at(entry) }).collect(),
        }
    }

    fn response(&self, time: f64) -> f64 {
        let place = time.abs() / HALF * ENTRIES as f64;
        let entry = (place as usize).min(ENTRIES);
        self.table[entry] + (self.table[entry + 1] - self.table[entry]) * (place - entry as f64).min(1.0)
    }

    /// Samples at the common rate from one time to another, s, of a signal that is `delay` s late.
    pub fn run(&self, signal: &[f64], rate: f64, from: f64, to: f64, delay: f64) -> Vec<f64> {
        let (first, last) = ((from * COMMON).round() as usize, (to * COMMON).round() as usize);
        (first..last)
            .map(|sample| {
                let time = sample as f64 / COMMON + delay;
                let begin = ((time - HALF) * rate).ceil().max(0.0) as usize;
                let end = (((time + HALF) * rate).floor().max(0.0) as usize + 1).min(signal.len());
                let part = signal.get(begin..end).unwrap_or_default();
                let sum = (begin..).zip(part).map(|(n, value)| value * self.response(n as f64 / rate - time));
                sum.sum::<f64>() / rate
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::LowPass;

    #[test]
    fn a_tone_is_the_same_from_every_rate() {
        let filter = LowPass::new();
        let tone = |t: f64| (std::f64::consts::TAU * 3210.0 * t).sin();
        let expected: Vec<f64> = (480..960).map(|n| tone(f64::from(n) / 48e3)).collect();
        for rate in [44.1e3, 48e3, 192e3, 768e3] {
            let signal: Vec<f64> = (0..(0.04 * rate) as usize).map(|n| tone(n as f64 / rate)).collect();
            let heard = filter.run(&signal, rate, 0.01, 0.02, 0.0);
            let worst = heard.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // Blackman's side lobes are 74 dB down.
            assert!(worst < 1e-3, "{rate}: {worst}");
        }
    }
}
