//! Second-order filters: the resonance of a coil, and what keeps a signal free of a constant part.

use crate::kernel::STILL;

/// A second-order filter in transposed direct form II.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Biquad {
    b: [f64; 3],
    a: [f64; 2],
    state: [f64; 2],
}

impl Biquad {
    /// Lets everything through.
    pub fn through() -> Self {
        Biquad { b: [1.0, 0.0, 0.0], a: [0.0, 0.0], state: [0.0; 2] }
    }

    /// A resonant low-pass, 1/(1 + s/(Qω₀) + s²/ω₀²) with the bilinear transform that meets the analogue
    /// filter at ω₀; everything passes where ω₀ is too near half the sample rate to be met.
    pub fn resonance(frequency: f64, quality: f64, sample_rate: f64) -> Self {
        if frequency >= 0.45 * sample_rate {
            return Biquad::through();
        }
        let t = libm::tan(std::f64::consts::PI * frequency / sample_rate);
        let norm = 1.0 / (1.0 + t / quality + t * t);
        let b = t * t * norm;
        let a = [2.0 * (t * t - 1.0) * norm, (1.0 - t / quality + t * t) * norm];
        Biquad { b: [b, 2.0 * b, b], a, state: [0.0; 2] }
    }

    /// A maximally flat high-pass of second order.
    pub fn high_pass(frequency: f64, sample_rate: f64) -> Self {
        let t = libm::tan(std::f64::consts::PI * (frequency / sample_rate).min(0.4));
        let root = std::f64::consts::SQRT_2;
        let norm = 1.0 / (1.0 + root * t + t * t);
        let a = [2.0 * (t * t - 1.0) * norm, (1.0 - root * t + t * t) * norm];
        Biquad { b: [norm, -2.0 * norm, norm], a, state: [0.0; 2] }
    }

    /// The next sample.
    ///
    /// What a filter remembers of a sound fades by a factor a sample, and would become a subnormal number. Once all that counts is
    /// below what counts as motion, it is forgotten. (Nothing that is not, by then, can come out of larger numbers: their last digits
    /// are far above. That is seen to in every sample, so that it does not depend on the pieces in which they come.)
    #[inline]
    pub fn next(&mut self, x: f64) -> f64 {
        if self.state[0].abs() < STILL && self.state[1].abs() < STILL && x.abs() < STILL {
            self.reset();
            return 0.0;
        }
        let y = self.b[0] * x + self.state[0];
        self.state[0] = (self.b[1] * x - self.a[0] * y) + self.state[1];
        self.state[1] = self.b[2] * x - self.a[1] * y;
        y
    }

    /// Whether what is left of the past is below 1e-15 and so far below any sample format; it is then
    /// forgotten, long before it could become a subnormal number.
    pub fn is_still(&mut self) -> bool {
        let still = self.state.iter().all(|state| state.abs() < 1e-15);
        if still {
            self.reset();
        }
        still
    }

    /// Whether it remembers a number that processors are slow with, and flush to zero or not as they are told.
    #[cfg(test)]
    pub fn holds_subnormal(&self) -> bool {
        self.state.iter().any(|state| state.is_subnormal())
    }

    /// As if a high-pass had heard this for ever: it gives nothing.
    pub fn settle(&mut self, x: f64) {
        self.state = [-self.b[0] * x, self.b[2] * x];
    }

    /// Takes over another filter's past.
    pub fn take_over(&mut self, other: &Biquad) {
        self.state = other.state;
    }

    /// Forgets the past.
    pub fn reset(&mut self) {
        self.state = [0.0; 2];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same without anything forgotten.
    fn plain(filter: &mut Biquad, x: f64) -> f64 {
        let Biquad { b, a, state } = filter;
        let y = b[0] * x + state[0];
        *state = [(b[1] * x - a[0] * y) + state[1], b[2] * x - a[1] * y];
        y
    }

    /// What is forgotten changes no bit of a sound, from the front of a wave on, until it is far below what anybody could keep.
    #[test]
    fn what_sounds_is_the_same_bits_and_what_has_faded_is_zero() {
        for filter in [Biquad::high_pass(18.0, 48e3), Biquad::resonance(4500.0, 2.0, 72e3), Biquad::through()]
        {
            let (mut own, mut other) = (filter, filter);
            let sound = |n: i32| match n {
                // It comes out of nothing, rings, passes through zero, and is gone.
                ..40 => 0.0,
                40..440 => libm::pow(10.0, 0.3 * f64::from(n - 440)) * libm::sin(f64::from(n)),
                440..20_000 => libm::exp(-1e-3 * f64::from(n)) * libm::sin(0.3 * f64::from(n)),
                _ => 0.0,
            };
            let (mut largest, mut faded) = (0.0_f64, false);
            for n in 0..2_000_000 {
                let (x, [y, z]) = (sound(n), [own.next(sound(n)), plain(&mut other, sound(n))]);
                largest = largest.max(y.abs());
                assert!(y.to_bits() == z.to_bits() || (y - z).abs() < 1e-118, "{n}: {y} and {z} of {x}");
                // (From where single precision can tell it from nothing.)
                assert!(y.to_bits() == z.to_bits() || z.abs() < 1e-60, "{n}: {y} and {z}");
                assert!(!own.holds_subnormal() && !y.is_subnormal());
                faded |= n > 20_000 && own.state == [0.0; 2] && y == 0.0;
            }
            assert!(largest > 0.1 && faded);
        }
    }
}
