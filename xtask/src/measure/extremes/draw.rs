//! Numbers drawn at random, spread the way extremes need it.

use fastrand::Rng;

/// A source of random numbers; the same seed gives the same numbers on every machine.
#[derive(Debug, Clone)]
pub struct Draw(Rng);

impl Draw {
    /// The source that belongs to a trial of a run.
    pub fn new(seed: u64, trial: u64) -> Draw {
        // Two numbers made one: fastrand mixes what it is given.
        Draw(Rng::with_seed(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(trial)))
    }

    /// Evenly between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }

    /// Between two numbers above 0, evenly over their powers of ten.
    pub fn over(&mut self, low: f64, high: f64) -> f64 {
        let value = low * libm::pow(high / low, self.0.f64());
        value.clamp(low, high)
    }

    /// As [`over`](Draw::over), up or down.
    pub fn either_way(&mut self, low: f64, high: f64) -> f64 {
        let value = self.over(low, high);
        if self.chance(0.5) { value } else { -value }
    }

    /// As [`over`](Draw::over), or 0 with the chance given.
    pub fn over_or_nothing(&mut self, chance: f64, low: f64, high: f64) -> f64 {
        if self.chance(chance) { 0.0 } else { self.over(low, high) }
    }

    /// Whether something of this probability happens.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.0.f64() < probability
    }

    /// A whole number from `low` to `high`, both included.
    pub fn whole(&mut self, low: usize, high: usize) -> usize {
        self.0.usize(low..=high)
    }

    /// One of several.
    pub fn one_of<T: Copy>(&mut self, things: &[T]) -> T {
        things[self.0.usize(..things.len())]
    }

    /// A seed for something else.
    pub fn seed(&mut self) -> u64 {
        self.0.u64(..)
    }
}
