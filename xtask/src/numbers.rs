//! What many numbers come to, for verdicts that must not overlook one that is none.

/// The largest of some numbers. It is not a number as soon as one of them is none, or if there are none at all: then
/// every comparison with a limit fails, where `f64::max` leaves out what is not a number.
pub fn largest<T: Into<f64>>(numbers: impl IntoIterator<Item = T>) -> f64 {
    let larger = |one: f64, other: f64| if one.is_nan() || one > other { one } else { other };
    numbers.into_iter().map(Into::into).reduce(larger).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::largest;

    #[test]
    fn what_is_no_number_is_not_left_out() {
        assert_eq!(largest([1.0, 3.0, 2.0]), 3.0);
        for place in 0..3 {
            let mut numbers = [1.0, 3.0, 2.0];
            numbers[place] = f64::NAN;
            assert!(largest(numbers).is_nan(), "{place}");
        }
        assert!(largest([0.0; 0]).is_nan());
    }
}
