//! Whether there is time enough, in real time.

use crate::display::Health;

/// The mean load over about this time decides, s.
const MEMORY: f64 = 0.05;
/// Below this part of the time there is for [`RECOVERY`] seconds, contacts are solved exactly again: far enough under
/// [`Health::LATE`] that it does not go back and forth.
const EASY: f64 = 0.5;
const RECOVERY: f64 = 1.0;

/// Compares the time spent with the time there is.
#[derive(Debug, Clone)]
pub(super) struct Budget {
    sample_rate: f64,
    load: f64,
    relaxed: bool,
    easy_for: f64,
}

impl Budget {
    /// For a sample rate in Hz.
    pub fn new(sample_rate: f32) -> Self {
        Self { sample_rate: f64::from(sample_rate), load: 0.0, relaxed: false, easy_for: 0.0 }
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        *self = Self { sample_rate: self.sample_rate, load: 0.0, relaxed: false, easy_for: 0.0 };
    }

    /// So many seconds went into so many samples; gives back whether to be content with less.
    pub fn spent(&mut self, seconds: f64, samples: usize) -> bool {
        let available = samples as f64 / self.sample_rate;
        if available > 0.0 {
            let share = (available / MEMORY).min(1.0);
            self.load += share * (seconds / available - self.load);
            self.easy_for = if self.load < EASY { self.easy_for + available } else { 0.0 };
            self.relaxed = self.load > Health::LATE || (self.relaxed && self.easy_for < RECOVERY);
        }
        self.relaxed
    }

    /// Part of the time that was spent lately, 1 is all there is.
    pub fn load(&self) -> f64 {
        self.load
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Quality;

    #[test]
    fn relaxes_when_late_and_recovers_when_easy() {
        let mut budget = Budget::new(48_000.0);
        let block = |budget: &mut Budget, load: f64| budget.spent(load * 0.01, 480);
        assert!((0..100).all(|_| !block(&mut budget, 0.8)));
        // One late block is no reason, a row of them is.
        assert!(!block(&mut budget, 1.0));
        assert!((0..100).map(|_| block(&mut budget, 1.1)).last().expect("there are some"));
        // Half easy is not easy enough; a second of ease is.
        assert!((0..200).all(|_| block(&mut budget, 0.6)));
        let until_exact = (0..300).position(|_| !block(&mut budget, 0.1)).expect("it recovers");
        assert!((95..150).contains(&until_exact), "{until_exact} blocks of 10 ms");
    }

    /// The limits that are documented: late is more than 85 % of the time, easy is less than half of it for a second.
    #[test]
    fn late_and_easy_are_what_they_are_said_to_be() {
        // Long blocks of these loads: whether it is relaxed at the end, having been so before or not.
        let after = |load: f64, relaxed: bool| {
            let mut budget = Budget { relaxed, ..Budget::new(48_000.0) };
            (0..20).map(|_| budget.spent(load * 0.1, 4800)).last()
        };
        assert_eq!([0.84, 0.86].map(|load| after(load, false)), [Some(false), Some(true)]);
        assert_eq!([0.49, 0.51].map(|load| after(load, true)), [Some(false), Some(true)]);
        let mut budget = Budget { relaxed: true, ..Budget::new(48_000.0) };
        let blocks = [(); 9].map(|()| budget.spent(0.01, 6000));
        assert_eq!(
            blocks.iter().position(|relaxed| !relaxed),
            Some(7),
            "the eighth block of 1/8 s ends the second"
        );
        // Then contacts are solved with at most 4 iterations, to 1e-8 m.
        assert_eq!(Quality::RELAXED, (4, 1e-8));
    }

    #[test]
    fn nonsense_does_no_harm() {
        let mut budget = Budget::new(48_000.0);
        assert!(!budget.spent(1.0, 0));
        assert!(budget.load().is_finite());
    }
}
