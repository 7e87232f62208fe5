//! The small differences between one stroke of a hand and the next, the same ones on every run.

/// Farthest a pluck lands from its usual place at variation 1, m: about a finger's breadth.
const PLACE: f64 = 0.012;
/// Largest relative change of force at variation 1; 0.2 is about 1.7 dB.
const FORCE: f64 = 0.2;
/// Longest delay at variation 1, s. A player cannot be early, and the first sound must follow the
/// key within 3 ms, pluck included.
const DELAY: f64 = 0.001;
/// The same for a finger that hammers, pulls or slides, s: at a quarter of that as long as thin strings swing to and fro, so that
/// each meets them at another moment of it.
const LATENESS: f64 = 0.012;

/// How one note is begun otherwise than exactly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deviation {
    /// Added to the place, m.
    pub place: f64,
    /// Multiplies the force.
    pub force: f64,
    /// Added to the time of a pluck, s, 0 or more.
    pub delay: f64,
    /// How late a finger comes that sounds the note by itself, s, and how late it goes back from there to the one before.
    pub late: [f64; 2],
}

/// A seeded source of deviations.
#[derive(Debug, Clone)]
pub(crate) struct Variation {
    amount: f64,
    seed: u64,
    state: u64,
}

impl Variation {
    /// A source whose deviations grow with `amount`, 0 (none) to 1.
    pub(crate) fn new(amount: f64, seed: u64) -> Self {
        Self { amount: amount.clamp(0.0, 1.0), seed, state: seed }
    }

    /// Deviations are so large from now on, 0 to 1.
    pub(crate) fn set_amount(&mut self, amount: f64) {
        self.amount = amount.clamp(0.0, 1.0);
    }

    /// Begins another sequence with the next pluck.
    pub(crate) fn begin_take(&mut self, seed: u64) {
        (self.seed, self.state) = (seed, seed);
    }

    /// Starts the sequence again.
    pub(crate) fn reset(&mut self) {
        self.state = self.seed;
    }

    /// The deviation of the next pluck. Each pluck takes the same number of draws, so that a change
    /// of amount changes the size of the deviations and nothing else.
    pub(crate) fn next(&mut self) -> Deviation {
        // The sum of two draws is triangular: small deviations are the commoner ones.
        let place = self.unit() + self.unit() - 1.0;
        let force = self.unit() + self.unit() - 1.0;
        let delay = self.unit();
        let late = [self.unit(), self.unit()];
        Deviation {
            place: self.amount * PLACE * place,
            force: 1.0 + self.amount * FORCE * force,
            delay: self.amount * DELAY * delay,
            late: late.map(|late| self.amount * LATENESS * late),
        }
    }

    /// A number from 0 up to 1, by SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom
    /// number generators", OOPSLA 2014): a Weyl sequence through a mixing function.
    fn unit(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^= mixed >> 31;
        // The upper 53 bits fill a double exactly.
        (mixed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn none_is_exact() {
        let mut variation = Variation::new(0.0, 7);
        for _ in 0..100 {
            let deviation = variation.next();
            assert_eq!(deviation, Deviation { place: 0.0, force: 1.0, delay: 0.0, late: [0.0; 2] });
        }
    }

    #[test]
    fn stays_within_its_bounds_and_repeats() {
        let mut variation = Variation::new(1.0, 7);
        let first: Vec<Deviation> = (0..1000).map(|_| variation.next()).collect();
        for deviation in &first {
            assert!(deviation.place.abs() <= PLACE);
            assert!((deviation.force - 1.0).abs() <= FORCE);
            assert!((0.0..=DELAY).contains(&deviation.delay));
            assert!(deviation.late.iter().all(|late| (0.0..=LATENESS).contains(late)));
        }
        let mean = first.iter().map(|deviation| deviation.place).sum::<f64>() / 1000.0;
        assert!(mean.abs() < 0.1 * PLACE, "mean place {mean}");
        variation.reset();
        assert!(first.iter().all(|&deviation| deviation == variation.next()));
    }

    #[test]
    fn first_draw_of_the_published_generator() {
        // SplitMix64 from seed 0 begins with 0xe220a8397b1dcdaf.
        let expected = (0xe220_a839_7b1d_cdaf_u64 >> 11) as f64 / (1_u64 << 53) as f64;
        assert_eq!(Variation::new(1.0, 0).unit(), expected);
    }
}
