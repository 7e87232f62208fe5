//! From the rate at which a string is computed to the rate at which it is heard.
//!
//! A string may be stepped more than once a sample of the host's ([`Ratio`]). What is heard of it passes a low-pass of
//! finite length at the times of the host's samples only: Shannon's sinc, zero at every sample of the host's but one,
//! under Kaiser's window. Its length in time is the same for every ratio, so that all strings come equally late, by
//! [`DELAY`] samples of the host's; at ratio 1 the same formula is a pure delay. Where two samples share a step every
//! other one lies half way between two steps, and has the same response read there. Nothing but sums of products in
//! a fixed order: the same bits in blocks of any size.

use crate::instructions::{Instructions, Pass, Vectors};
use crate::ratio::Ratio;

/// How late everything is heard, samples of the host's.
pub(crate) const DELAY: usize = 24;

/// Largest error of the low-pass in both its bands, dB below what passes.
const REJECTION: f64 = 100.0;

/// By how much more it is designed for, dB: at ratio 3/2 the foot of its response lies over that of its first mirror.
const SPARE: f64 = 0.5;

/// Sums are taken in so many lanes.
const LANES: usize = 8;

/// The low-pass of one string, and what it remembers.
#[derive(Debug, Clone)]
pub(crate) struct Decimator {
    instructions: Instructions,
    ratio: Ratio,
    /// Impulse response at samples that coincide with a step and at those half way between two, whole lanes, zeros
    /// first; both empty at ratio 1.
    taps: [Vec<f64>; 2],
    /// Values of the past that still count.
    past: usize,
    /// The past, then what has come in since.
    values: Vec<f64>,
    /// How many of the last values were zeros, as far as they count.
    zeros: usize,
    /// 1 where the next sample is the second of two that share a step.
    second: usize,
}

impl Decimator {
    /// A low-pass for so many values in for each out, and at most `run` out at a time; allocates.
    pub fn new(ratio: Ratio, run: usize) -> Self {
        let taps = [0, 1].map(|half| if ratio > Ratio::ONE { low_pass(ratio, half) } else { Vec::new() });
        let past = taps[0].len().checked_sub(1).unwrap_or(DELAY) + ratio.shared();
        let room = past + ratio.steps_before(run + 1);
        let instructions = Instructions::best();
        Decimator { instructions, ratio, taps, past, values: vec![0.0; room], zeros: past, second: 0 }
    }

    /// Values that come in for each that goes out.
    pub fn ratio(&self) -> Ratio {
        self.ratio
    }

    /// Values that must come in before the next so many samples are given.
    pub fn steps(&self, samples: usize) -> usize {
        self.ratio.steps_before(self.second + samples) - self.ratio.steps_before(self.second)
    }

    /// Takes the value of index `index`, 0 for the first since the last call of [`Decimator::give`].
    #[inline]
    pub fn take(&mut self, index: usize, value: f64) {
        self.zeros = if value == 0.0 { (self.zeros + 1).min(self.past) } else { 0 };
        self.values[self.past + index] = value;
    }

    /// Gives as many values as `out` has, for the [`Decimator::steps`] of so many that have come in.
    pub fn give(&mut self, out: &mut [f64]) {
        let instructions = self.instructions;
        instructions.run(Give { decimator: self, out });
    }

    #[inline(always)]
    fn give_into(&mut self, out: &mut [f64]) {
        let came = self.steps(out.len());
        if self.ratio == Ratio::ONE {
            out.copy_from_slice(&self.values[..out.len()]);
        } else {
            let first = self.ratio.steps_before(self.second);
            for (i, out) in out.iter_mut().enumerate() {
                let halves = self.ratio.halves() * (self.second + i);
                let taps = &self.taps[halves % 2];
                // The last value that counts is that of the sample's own time or of half a step before.
                let end = self.past + halves / 2 + 1 - first;
                *out = product(taps, &self.values[end - taps.len()..]);
            }
            self.second = (self.second + out.len()) % 2;
        }
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
            (self.zeros, self.second) = (old.zeros, old.second);
            return;
        }
        let factor = old.ratio.value() / self.ratio.value();
        // Where among the old one's steps this sample begins, and with it the first of the new one's.
        let now = old.past as f64 - 0.5 * (old.second * old.ratio.shared()) as f64;
        for index in 0..self.past {
            let place = now - factor * (self.past - index) as f64;
            let place = place.clamp(0.0, (old.past - 1) as f64);
            let first = place as usize;
            let next = old.values[(first + 1).min(old.past - 1)];
            self.values[index] = old.values[first] + (place - first as f64) * (next - old.values[first]);
        }
        self.zeros = if old.is_empty() { self.past } else { 0 };
        self.second = 0;
    }

    /// Has its next sample be the first or the second of two that share a step, whichever that of another is.
    pub fn follow(&mut self, other: &Decimator) {
        self.second = other.second;
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        self.values.fill(0.0);
        (self.zeros, self.second) = (self.past, 0);
    }
}

/// [`Decimator::give`], to be compiled for each instruction set.
struct Give<'a> {
    decimator: &'a mut Decimator,
    out: &'a mut [f64],
}

impl Pass for Give<'_> {
    type Output = ();

    #[inline(always)]
    fn by<V: Vectors>(self, _: V) {
        self.decimator.give_into(self.out);
    }
}

/// Σ of products of the taps with as many values.
#[inline(always)]
fn product(taps: &[f64], values: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (taps, values) in taps.chunks_exact(LANES).zip(values.chunks_exact(LANES)) {
        for lane in 0..LANES {
            sums[lane] += taps[lane] * values[lane];
        }
    }
    ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]))
}

/// The impulse response at `ratio` times the host's rate, read `half` of a step off its middle. Its transition is as wide
/// as Kaiser's window of this length allows, (A − 7.95)/(14.36 · 2 · DELAY) of the host's rate, and half of it lies on
/// either side of half that rate (J. F. Kaiser, "Nonrecursive digital filter design using the I₀-sinh window function",
/// 1974).
fn low_pass(ratio: Ratio, half: usize) -> Vec<f64> {
    // DELAY is even, so this is a whole number of steps.
    let middle = ratio.halves() * DELAY / 2;
    let shape = 0.1102 * (REJECTION + SPARE - 8.7);
    let response = |tap: usize| {
        let from_middle = tap as f64 - middle as f64 + 0.5 * half as f64;
        let turns = from_middle / ratio.value();
        let angle = std::f64::consts::PI * turns;
        let sinc = if from_middle == 0.0 { 1.0 } else { libm::sin(angle) / angle };
        let x = from_middle / middle as f64;
        sinc * bessel(shape * libm::sqrt((1.0 - x * x).max(0.0)))
    };
    let count = 2 * middle + 1 - half;
    let mut taps = vec![0.0; (2 * middle + 1).next_multiple_of(LANES) - count];
    taps.extend((0..count).map(response));
    let sum: f64 = taps.iter().sum();
    taps.iter_mut().for_each(|tap| *tap /= sum);
    taps
}

/// The modified Bessel function I₀, by its series Σ ((x/2)ⁿ/n!)²; x is at most 10.2 here.
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
    use super::{DELAY, Decimator, REJECTION, SPARE};
    use crate::instructions::Instructions;
    use crate::ratio::Ratio;

    /// Half the width of the transition, as a part of the host's rate.
    const HALF_TRANSITION: f64 = 0.5 * (REJECTION + SPARE - 7.95) / (14.36 * 2.0 * DELAY as f64);

    /// Gain at a frequency, as a part of the host's rate, at samples that coincide with a step (`half` 0) and at those
    /// that lie between two.
    fn gain(decimator: &Decimator, half: usize, frequency: f64) -> f64 {
        let turn = std::f64::consts::TAU * frequency / decimator.ratio.value();
        let sum = |wave: fn(f64) -> f64| -> f64 {
            let taps = decimator.taps[half].iter().enumerate();
            taps.map(|(tap, value)| value * wave(turn * tap as f64)).sum()
        };
        sum(f64::cos).hypot(sum(f64::sin))
    }

    #[test]
    fn what_is_heard_passes_and_what_would_fold_down_is_100_db_lower() {
        for halves in [3, 4, 5, 6, 7, 8, 10, 15, 16, 32] {
            let decimator = Decimator::new(Ratio::of_halves(halves), 64);
            for half in 0..=halves % 2 {
                let (mut ripple, mut folded) = (0.0_f64, 0.0_f64);
                for step in 0..=4000 {
                    let frequency = 0.25 * halves as f64 * f64::from(step) / 4000.0;
                    let gain = gain(&decimator, half, frequency);
                    if frequency <= 0.5 - HALF_TRANSITION {
                        ripple = ripple.max((gain - 1.0).abs());
                    } else if frequency >= 0.5 + HALF_TRANSITION {
                        folded = folded.max(gain);
                    }
                }
                let (ripple, folded) = (20.0 * (1.0 + ripple).log10(), 20.0 * folded.log10());
                println!("{halves}/2, {half}: {ripple:.1e} dB of ripple, {folded:.1} dB of what folds down");
                assert!(ripple < 1.2e-4, "{halves}/2: {ripple} dB");
                assert!(folded < -REJECTION, "{halves}/2: {folded} dB");
            }
        }
        // At 44.1 kHz as well, all passes that most people can hear.
        const { assert!((0.5 - HALF_TRANSITION) * 44.1e3 > 19e3) };
    }

    /// Every instruction set sums by the same bits, at every kind of ratio.
    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        for halves in 2..=9 {
            let ratio = Ratio::of_halves(halves);
            let run = |instructions: Instructions| {
                let mut decimator = Decimator::new(ratio, 64);
                decimator.instructions = instructions;
                let mut sound = Vec::new();
                for piece in [1, 64, 7, 33] {
                    for index in 0..decimator.steps(piece) {
                        decimator.take(index, libm::sin((sound.len() + index * index) as f64));
                    }
                    let mut out = vec![0.0; piece];
                    decimator.give(&mut out);
                    sound.extend(out.into_iter().map(f64::to_bits));
                }
                sound
            };
            let expected = run(Instructions::Any);
            for instructions in Instructions::all() {
                assert!(run(instructions) == expected, "{halves}/2 by {instructions:?}");
            }
        }
    }

    /// A tone of a frequency, radians a sample, through a decimator in pieces.
    fn play(ratio: Ratio, frequency: f64, samples: usize, pieces: impl Fn(usize) -> usize) -> Vec<f64> {
        let mut decimator = Decimator::new(ratio, 64);
        let mut sound = Vec::new();
        let mut step = 0;
        while sound.len() < samples {
            let piece = pieces(sound.len());
            for index in 0..decimator.steps(piece) {
                decimator.take(index, (frequency * step as f64 / ratio.value()).sin());
                step += 1;
            }
            assert_eq!(step, ratio.steps_before(sound.len() + piece));
            let mut out = vec![0.0; piece];
            decimator.give(&mut out);
            sound.extend(out);
        }
        sound.truncate(samples);
        sound
    }

    #[test]
    fn every_ratio_is_late_by_the_same_time_and_gives_the_same_in_any_pieces() {
        for halves in [2, 3, 4, 5, 6, 7, 14] {
            let ratio = Ratio::of_halves(halves);
            let whole = play(ratio, 0.3, 192, |_| 64);
            for (n, value) in whole.iter().enumerate().skip(2 * DELAY + 1) {
                let expected = (0.3 * (n as f64 - DELAY as f64)).sin();
                assert!((value - expected).abs() < 2e-5, "{ratio}: {value} for {expected}");
            }
            assert!([1, 2, 3, 48].iter().all(|&piece| play(ratio, 0.3, 192, |_| piece) == whole));
            assert!(play(ratio, 0.3, 192, |done| 1 + done % 7) == whole);
        }
    }

    /// What two kinds of samples in turn hear must be one sound: no mirror of a tone at half the host's rate.
    #[test]
    fn shared_steps_leave_no_mirror() {
        const COUNT: usize = 4096;
        for (halves, bin) in [(3, 100.0), (3, 700.0), (5, 700.0), (7, 1300.0)] {
            let turn = std::f64::consts::TAU / COUNT as f64;
            let sound = play(Ratio::of_halves(halves), turn * bin, 2 * COUNT, |_| 64);
            let level = |bin: f64| {
                let part = |wave: fn(f64) -> f64| -> f64 {
                    let late = sound[COUNT..].iter().enumerate();
                    late.map(|(n, value)| value * wave(turn * bin * n as f64)).sum()
                };
                part(f64::cos).hypot(part(f64::sin))
            };
            let mirror = 20.0 * (level(0.5 * COUNT as f64 - bin) / level(bin)).log10();
            println!("{halves}/2, {bin}: mirror at {mirror:.1} dB");
            assert!(mirror < -110.0, "{halves}/2, {bin}: {mirror} dB");
        }
    }

    #[test]
    fn a_tone_goes_on_through_a_change_of_ratio() {
        let tone = |time: f64| (0.1 * time).cos();
        let pairs = [(2, 8), (8, 2), (4, 6), (6, 4), (3, 4), (4, 3), (2, 3), (3, 2), (3, 5)];
        // Of the first piece, so that the change comes at either of two samples that share a step.
        for ((from, to), piece) in pairs.into_iter().flat_map(|pair| [(pair, 63), (pair, 64)]) {
            let [mut old, mut new] = [from, to].map(|halves| Decimator::new(Ratio::of_halves(halves), 64));
            let fill = |decimator: &mut Decimator, start: usize, count: usize| {
                for index in 0..decimator.steps(count) {
                    decimator.take(index, tone(start as f64 + index as f64 / decimator.ratio.value()));
                }
                let mut out = vec![0.0; count];
                decimator.give(&mut out);
                out
            };
            fill(&mut old, 0, piece);
            new.take_over(&old);
            for (n, value) in fill(&mut new, piece, 64).iter().enumerate() {
                let expected = tone((piece + n) as f64 - DELAY as f64);
                // A straight line between values is off by (0.1)²/8 at most, the last value by 0.1 × 1.
                assert!((value - expected).abs() < 0.03, "{from} to {to}, {n}: {value} for {expected}");
            }
        }
    }

    #[test]
    fn silence_is_known() {
        for halves in [3, 6] {
            let mut decimator = Decimator::new(Ratio::of_halves(halves), 64);
            assert!(decimator.is_empty());
            let mut out = [0.0; 64];
            for value in [1.0, 0.0] {
                (0..decimator.steps(64)).for_each(|index| decimator.take(index, value));
                decimator.give(&mut out);
            }
            assert!(decimator.is_empty());
            (0..decimator.steps(64)).for_each(|index| decimator.take(index, 0.0));
            decimator.give(&mut out);
            assert!(out.iter().all(|value| *value == 0.0));
        }
    }
}
