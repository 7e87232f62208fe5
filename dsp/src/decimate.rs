//! From the rate at which a string is computed to the rate at which it is heard.
//!
//! A string may be stepped `ratio` times a sample of the host's. What is heard of it passes a low-pass of
//! finite length before all but every `ratio`-th value is dropped: Shannon's sinc, zero at every sample of
//! the host's but one, under Kaiser's window. Its length in time is the same for every ratio, so that all
//! strings come equally late, by [`DELAY`] samples of the host's; at ratio 1 the same formula is a pure
//! delay. Nothing but sums of products in a fixed order: the same bits in blocks of any size.

/// How late everything is heard, samples of the host's.
pub(crate) const DELAY: usize = 24;

/// Largest error of the low-pass in both its bands, dB below what passes.
const REJECTION: f64 = 100.0;

/// Sums are taken in so many lanes.
const LANES: usize = 4;

/// The low-pass of one string, and what it remembers.
#[derive(Debug, Clone)]
pub(crate) struct Decimator {
    /// Values that come in for each that goes out.
    ratio: usize,
    /// Impulse response, whole lanes, zeros first; empty at ratio 1.
    taps: Vec<f64>,
    /// Values of the past that still count.
    past: usize,
    /// The past, then what has come in since.
    values: Vec<f64>,
    /// How many of the last values were zeros, as far as they count.
    zeros: usize,
}

impl Decimator {
    /// A low-pass for so many values in for each out, and at most `run` out at a time; allocates.
    pub fn new(ratio: usize, run: usize) -> Self {
        let taps = if ratio > 1 { low_pass(ratio) } else { Vec::new() };
        let past = taps.len().checked_sub(1).unwrap_or(DELAY);
        Decimator { ratio, taps, past, values: vec![0.0; past + ratio * run], zeros: past }
    }

    /// Values that come in for each that goes out.
    pub fn ratio(&self) -> usize {
        self.ratio
    }

    /// Takes the value of index `index`, 0 for the first since the last call of [`Decimator::give`].
    #[inline]
    pub fn take(&mut self, index: usize, value: f64) {
        self.zeros = if value == 0.0 { (self.zeros + 1).min(self.past) } else { 0 };
        self.values[self.past + index] = value;
    }

    /// Gives as many values as `out` has, for `ratio` times as many that have come in.
    pub fn give(&mut self, out: &mut [f64]) {
        if self.taps.is_empty() {
            out.copy_from_slice(&self.values[..out.len()]);
        } else {
            for (i, out) in out.iter_mut().enumerate() {
                *out = product(&self.taps, &self.values[self.ratio * i..]);
            }
        }
        let came = self.ratio * out.len();
        self.values.copy_within(came..came + self.past, 0);
    }

    /// Whether all that still counts is zero.
    pub fn is_empty(&self) -> bool {
        self.zeros == self.past
    }

    /// Takes over what another one remembers: between its values lie straight lines.
    pub fn take_over(&mut self, old: &Decimator) {
        if self.ratio == old.ratio {
            self.values.copy_from_slice(&old.values);
            self.zeros = old.zeros;
            return;
        }
        let factor = old.ratio as f64 / self.ratio as f64;
        for index in 0..self.past {
            let place = old.past as f64 - factor * (self.past - index) as f64;
            let place = place.clamp(0.0, (old.past - 1) as f64);
            let first = place as usize;
            let next = old.values[(first + 1).min(old.past - 1)];
            self.values[index] = old.values[first] + (place - first as f64) * (next - old.values[first]);
        }
        self.zeros = if old.is_empty() { self.past } else { 0 };
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        self.values.fill(0.0);
        self.zeros = self.past;
    }
}

/// Σ of products of the taps with as many values.
#[inline]
fn product(taps: &[f64], values: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (taps, values) in taps.chunks_exact(LANES).zip(values.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += taps[lane] * values[lane];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// The impulse response at `ratio` times the host's rate. Its transition is as wide as Kaiser's window of this
/// length allows, (A − 7.95)/(14.36 · 2 · DELAY) of the host's rate, and half of it lies on either side of
/// half that rate (J. F. Kaiser, "Nonrecursive digital filter design using the I₀-sinh window function", 1974).
fn low_pass(ratio: usize) -> Vec<f64> {
    let half = ratio * DELAY;
    let shape = 0.1102 * (REJECTION - 8.7);
    let response = |tap: usize| {
        let from_middle = tap as f64 - half as f64;
        let turns = from_middle / ratio as f64;
        let angle = std::f64::consts::PI * turns;
        let sinc = if tap == half { 1.0 } else { libm::sin(angle) / angle };
        let x = from_middle / half as f64;
        sinc * bessel(shape * libm::sqrt((1.0 - x * x).max(0.0)))
    };
    let count = 2 * half + 1;
    let mut taps = vec![0.0; count.next_multiple_of(LANES) - count];
    taps.extend((0..count).map(response));
    let sum: f64 = taps.iter().sum();
    taps.iter_mut().for_each(|tap| *tap /= sum);
    taps
}

/// The modified Bessel function I₀, by its series Σ ((x/2)ⁿ/n!)²; x is at most 10 here.
fn bessel(x: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for n in 1..64 {
        let factor = 0.5 * x / f64::from(n);
        term *= factor * factor;
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::{DELAY, Decimator, REJECTION};

    /// Half the width of the transition, as a part of the host's rate.
    const HALF_TRANSITION: f64 = 0.5 * (REJECTION - 7.95) / (14.36 * 2.0 * DELAY as f64);

    /// Gain at a frequency, as a part of the host's rate.
    fn gain(decimator: &Decimator, frequency: f64) -> f64 {
        let turn = std::f64::consts::TAU * frequency / decimator.ratio as f64;
        let sum = |wave: fn(f64) -> f64| -> f64 {
            decimator.taps.iter().enumerate().map(|(tap, value)| value * wave(turn * tap as f64)).sum()
        };
        sum(f64::cos).hypot(sum(f64::sin))
    }

    #[test]
    fn what_is_heard_passes_and_what_would_fold_down_is_100_db_lower() {
        for ratio in [2, 3, 4, 5, 8, 16] {
            let decimator = Decimator::new(ratio, 64);
            let (mut ripple, mut folded) = (0.0_f64, 0.0_f64);
            for step in 0..=4000 {
                let frequency = 0.5 * ratio as f64 * f64::from(step) / 4000.0;
                let gain = gain(&decimator, frequency);
                if frequency <= 0.5 - HALF_TRANSITION {
                    ripple = ripple.max((gain - 1.0).abs());
                } else if frequency >= 0.5 + HALF_TRANSITION {
                    folded = folded.max(gain);
                }
            }
            let (ripple, folded) = (20.0 * (1.0 + ripple).log10(), 20.0 * folded.log10());
            println!("{ratio}: {ripple:.1e} dB of ripple, {folded:.1} dB of what folds down");
            assert!(ripple < 2e-4, "{ratio}: {ripple} dB");
            assert!(folded < -REJECTION, "{ratio}: {folded} dB");
        }
        // At 44.1 kHz as well, all passes that most people can hear.
        const { assert!((0.5 - HALF_TRANSITION) * 44.1e3 > 19e3) };
    }

    #[test]
    fn every_ratio_is_late_by_the_same_time_and_gives_the_same_in_any_pieces() {
        let tone = |time: f64| (0.3 * time).sin();
        for ratio in [1, 2, 3, 7] {
            let play = |piece: usize| {
                let mut decimator = Decimator::new(ratio, 64);
                let mut sound = Vec::new();
                while sound.len() < 192 {
                    for index in 0..ratio * piece {
                        let step = ratio * sound.len() + index;
                        decimator.take(index, tone(step as f64 / ratio as f64));
                    }
                    let mut out = vec![0.0; piece];
                    decimator.give(&mut out);
                    sound.extend(out);
                }
                sound
            };
            let whole = play(64);
            for (n, value) in whole.iter().enumerate().skip(2 * DELAY + 1) {
                let expected = tone(n as f64 - DELAY as f64);
                assert!((value - expected).abs() < 2e-5, "{ratio}: {value} for {expected}");
            }
            assert!([1, 2, 48].iter().all(|&piece| play(piece)[..192] == whole[..192]));
        }
    }

    #[test]
    fn a_tone_goes_on_through_a_change_of_ratio() {
        let tone = |time: f64| (0.1 * time).cos();
        for (from, to) in [(1, 4), (4, 1), (2, 3), (3, 2)] {
            let (mut old, mut new) = (Decimator::new(from, 64), Decimator::new(to, 64));
            let fill = |decimator: &mut Decimator, start: f64| {
                for index in 0..decimator.ratio * 64 {
                    decimator.take(index, tone(start + index as f64 / decimator.ratio as f64));
                }
                let mut out = [0.0; 64];
                decimator.give(&mut out);
                out
            };
            fill(&mut old, 0.0);
            new.take_over(&old);
            for (n, value) in fill(&mut new, 64.0).iter().enumerate() {
                let expected = tone((64 + n) as f64 - DELAY as f64);
                // A straight line between values is off by (0.1)²/8 at most, the last value by 0.1 × 1.
                assert!((value - expected).abs() < 0.03, "{from} to {to}, {n}: {value} for {expected}");
            }
        }
    }

    #[test]
    fn silence_is_known() {
        let mut decimator = Decimator::new(3, 64);
        assert!(decimator.is_empty());
        let mut out = [0.0; 64];
        for value in [1.0, 0.0] {
            (0..192).for_each(|index| decimator.take(index, value));
            decimator.give(&mut out);
        }
        assert!(decimator.is_empty());
        (0..192).for_each(|index| decimator.take(index, 0.0));
        decimator.give(&mut out);
        assert!(out.iter().all(|value| *value == 0.0));
    }
}
