//! Frequency and decay of the partials of a string that nothing touches.

use std::f64::consts::PI;

use anyhow::Result;
use low_action_dsp::{Scene, Simulation};

/// A partial as it is computed.
#[derive(Debug, Clone, Copy)]
pub struct Partial {
    /// Its number, 1 for the fundamental.
    pub number: usize,
    /// Frequency, Hz.
    pub frequency: f64,
    /// Time in which it falls by 60 dB, s.
    pub t60: f64,
}

/// Lets one string of a scene go in the sum of the shapes of its partials of these numbers, for so many samples,
/// and reads every one of them by its own shape: on the grid as between the ends the partials are sines, and
/// they do not mix while nothing touches the string and it is not stretched.
pub fn partials(scene: &Scene, string: usize, numbers: &[usize], samples: usize) -> Result<Vec<Partial>> {
    let mut alone = Scene { fretboard: None, pluck: Vec::new(), finger: Vec::new(), ..scene.clone() };
    alone.string = vec![scene.string[string].clone()];
    alone.string[0].tension_modulation = false;
    let length = alone.string[0].length;
    let places: Vec<f64> = Simulation::new(&alone)?.string(0).places().collect();
    let shape = |place: f64, number: usize| libm::sin(number as f64 * PI * place / length);
    let sum = |place: f64| 1e-4 * numbers.iter().map(|&number| shape(place, number)).sum::<f64>();
    let inner = places.iter().map(|&place| [place, sum(place)]);
    alone.string[0].shape = Some([[0.0, 0.0]].into_iter().chain(inner).chain([[length, 0.0]]).collect());
    let weights: Vec<Vec<f64>> =
        numbers.iter().map(|&number| places.iter().map(|&place| shape(place, number)).collect()).collect();
    let mut courses = vec![Vec::with_capacity(samples); numbers.len()];
    let mut simulation = Simulation::new(&alone)?;
    for _ in 0..samples {
        for (course, weights) in courses.iter_mut().zip(&weights) {
            let heights = simulation.string(0).state.displacement();
            course.push(heights.zip(weights).map(|(u, w)| u * w).sum::<f64>());
        }
        simulation.step();
    }
    let read = |(course, &number): (&Vec<f64>, &usize)| fit(course, number, scene.sample_rate);
    Ok(courses.iter().zip(numbers).map(read).collect())
}

/// Fits a decaying oscillation: samples D apart obey a[n + 2D] = p a[n + D] + q a[n], with p and q by least
/// squares. D is about a quarter of a period, where the two are told apart best.
fn fit(course: &[f64], number: usize, rate: f64) -> Partial {
    let crossings = course.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count().max(1);
    let lag = (course.len() as f64 / (2.0 * crossings as f64)).round().max(1.0) as usize;
    let [mut xx, mut xy, mut yy, mut xz, mut yz] = [0.0; 5];
    for n in 0..course.len().saturating_sub(2 * lag) {
        let (x, y, z) = (course[n], course[n + lag], course[n + 2 * lag]);
        (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        (xz, yz) = (xz + x * z, yz + y * z);
    }
    let determinant = xx * yy - xy * xy;
    let p = (xx * yz - xy * xz) / determinant;
    let q = (yy * xz - xy * yz) / determinant;
    let (radius, time) = ((-q).sqrt(), lag as f64 / rate);
    let frequency = libm::acos((p / (2.0 * radius)).clamp(-1.0, 1.0)) / time / (2.0 * PI);
    Partial { number, frequency, t60: libm::log(1000.0) * time / -libm::log(radius) }
}
