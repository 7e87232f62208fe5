//! What many numbers come to: extremes, for limits that are to hold for all of them, the mean size, and what it says of
//! partials.

pub use xtask::numbers::largest;

/// The smallest, in the same way.
pub fn smallest<T: Into<f64>>(numbers: impl IntoIterator<Item = T>) -> f64 {
    -largest(numbers.into_iter().map(|number| -number.into()))
}

/// The largest difference between two neighbours.
pub fn largest_step(sound: &[f32]) -> f64 {
    largest(sound.windows(2).map(|pair| (pair[1] - pair[0]).abs()))
}

/// The mean size of a sound: root mean square.
pub fn rms(sound: &[f32]) -> f64 {
    (sound.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>() / sound.len() as f64).sqrt()
}

/// How far differences are from none: root mean square.
pub fn root_mean_square(differences: &[f64]) -> f64 {
    (differences.iter().map(|x| x * x).sum::<f64>() / differences.len() as f64).sqrt()
}

/// Size of a sound's differences beside the sound itself: grows with the share of high partials.
pub fn brightness(sound: &[f32]) -> f64 {
    let differences: Vec<f32> = sound.windows(2).map(|pair| pair[1] - pair[0]).collect();
    rms(&differences) / rms(sound)
}
