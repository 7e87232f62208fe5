//! One number of every sample of a run, kept in a bounded number of bins.

/// The course of a number over a run. A run of no more samples than bins is kept whole; of a longer one
/// every bin keeps its smallest and its largest value, so that no peak is lost.
#[derive(Debug, Clone)]
pub struct Course {
    samples_per_bin: u64,
    samples: u64,
    bins: Vec<Bin>,
    sum: f64,
}

#[derive(Debug, Clone, Copy)]
struct Bin {
    smallest: (u64, f64),
    largest: (u64, f64),
}

/// Bins across a panel of full width, about as many as can be seen.
pub const BINS: u64 = 900;

impl Course {
    /// Room for a run of so many samples in at most so many bins.
    pub fn new(samples: u64, bins: u64) -> Course {
        let samples_per_bin = samples.div_ceil(bins.max(1)).max(1);
        Course { samples_per_bin, samples: 0, bins: Vec::new(), sum: 0.0 }
    }

    /// Adds the value of the next sample.
    pub fn add(&mut self, value: f64) {
        let here = (self.samples, value);
        if self.samples.is_multiple_of(self.samples_per_bin) {
            self.bins.push(Bin { smallest: here, largest: here });
        } else if let Some(bin) = self.bins.last_mut() {
            if value < bin.smallest.1 {
                bin.smallest = here;
            }
            if value > bin.largest.1 {
                bin.largest = here;
            }
        }
        self.samples += 1;
        self.sum += value;
    }

    /// Points (time, value·scale) in order, the time of sample n being (n + offset)·step.
    pub fn points(&self, offset: f64, step: f64, scale: f64) -> Vec<(f64, f64)> {
        let point = |(sample, value): (u64, f64)| ((sample as f64 + offset) * step, value * scale);
        let mut points = Vec::with_capacity(2 * self.bins.len());
        for bin in &self.bins {
            let (first, second) = if bin.smallest.0 <= bin.largest.0 {
                (bin.smallest, bin.largest)
            } else {
                (bin.largest, bin.smallest)
            };
            points.push(point(first));
            if second.0 != first.0 {
                points.push(point(second));
            }
        }
        points
    }

    /// The largest of every bin only, for what is judged by its peaks.
    pub fn peaks(&self, offset: f64, step: f64, scale: f64) -> Vec<(f64, f64)> {
        let peak = |bin: &Bin| ((bin.largest.0 as f64 + offset) * step, bin.largest.1 * scale);
        self.bins.iter().map(peak).collect()
    }

    /// The largest value.
    pub fn largest(&self) -> f64 {
        self.bins.iter().map(|bin| bin.largest.1).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The smallest value.
    pub fn smallest(&self) -> f64 {
        self.bins.iter().map(|bin| bin.smallest.1).fold(f64::INFINITY, f64::min)
    }

    /// The sum of all values.
    pub fn sum(&self) -> f64 {
        self.sum
    }
}

#[cfg(test)]
mod tests {
    use super::Course;

    #[test]
    fn a_short_run_is_kept_whole() {
        let mut course = Course::new(3, 10);
        [1.0, -2.0, 3.0].into_iter().for_each(|value| course.add(value));
        assert_eq!(course.points(0.5, 2.0, 10.0), [(1.0, 10.0), (3.0, -20.0), (5.0, 30.0)]);
    }

    #[test]
    fn no_peak_is_lost() {
        let mut course = Course::new(100_000, 50);
        for n in 0..100_000 {
            course.add(match n {
                12_345 => 7.0,
                12_346 => -7.0,
                _ => 0.0,
            });
        }
        let points = course.points(0.0, 1.0, 1.0);
        assert!(points.len() <= 100 && points.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert!(points.contains(&(12_345.0, 7.0)) && points.contains(&(12_346.0, -7.0)));
        assert_eq!((course.smallest(), course.largest()), (-7.0, 7.0));
        assert_eq!(course.peaks(0.0, 1.0, 1.0).len(), 50);
    }
}
