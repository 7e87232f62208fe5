//! Second-order filters: the resonance of a coil, and what keeps a signal free of a constant part.

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
    #[inline]
    pub fn next(&mut self, x: f64) -> f64 {
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
