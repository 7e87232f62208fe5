//! What many numbers come to: extremes, for limits that are to hold for all of them, the mean size, and what it says of
//! partials.

/// The largest of some numbers. It is not a number as soon as one of them is none, or if there are none at all: then
/// every comparison with a limit fails, where `f64::max` leaves out what is not a number.
pub fn largest<T: Into<f64>>(numbers: impl IntoIterator<Item = T>) -> f64 {
    let larger = |one: f64, other: f64| if one.is_nan() || one > other { one } else { other };
    numbers.into_iter().map(Into::into).reduce(larger).unwrap_or(f64::NAN)
}

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

/// Size of a sound's differences beside the sound itself: grows with the share of high partials.
pub fn brightness(sound: &[f32]) -> f64 {
    let differences: Vec<f32> = sound.windows(2).map(|pair| pair[1] - pair[0]).collect();
    rms(&differences) / rms(sound)
}
