//! A value that goes smoothly from where it is to where it should be.

/// A smooth ramp (3x² − 2x³), or a straight one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ramp {
    from: f64,
    to: f64,
    done: u64,
    total: u64,
    straight: bool,
}

impl Ramp {
    /// At rest at a value.
    pub fn at(value: f64) -> Self {
        Ramp { from: value, to: value, done: 0, total: 0, straight: false }
    }

    /// From the present value to another in so many samples.
    pub fn go(&mut self, to: f64, samples: u64) {
        *self = Ramp { from: self.value(), to, done: 0, total: samples, straight: false };
    }

    /// The same at constant speed.
    pub fn go_straight(&mut self, to: f64, samples: u64) {
        self.go(to, samples);
        self.straight = true;
    }

    /// The present value.
    #[inline]
    pub fn value(&self) -> f64 {
        if self.done >= self.total {
            return self.to;
        }
        let x = self.done as f64 / self.total as f64;
        let part = if self.straight { x } else { x * x * (3.0 - 2.0 * x) };
        self.from + (self.to - self.from) * part
    }

    /// One sample on; returns the new value.
    #[inline]
    pub fn step(&mut self) -> f64 {
        if self.done < self.total {
            self.done += 1;
        }
        self.value()
    }

    /// Where it goes.
    pub fn goal(&self) -> f64 {
        self.to
    }

    /// Samples until it has arrived.
    pub fn left(&self) -> u64 {
        self.total - self.done
    }

    /// The same ramp between other values.
    pub fn map(self, value: impl Fn(f64) -> f64) -> Self {
        Ramp { from: value(self.from), to: value(self.to), ..self }
    }

    /// The same ramp in samples of another length: `factor` of them for each of the old.
    pub fn resampled(self, factor: f64) -> Self {
        let samples = |count: u64| (count as f64 * factor).round() as u64;
        let total = samples(self.total);
        Ramp { done: samples(self.done).min(total), total, ..self }
    }

    /// Whether it has arrived.
    #[inline]
    pub fn rests(&self) -> bool {
        self.done >= self.total
    }
}
