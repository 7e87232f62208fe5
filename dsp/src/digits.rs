//! Numbers in messages: as one would write them, and limits in few digits that are limits still.

/// The digits of a limit that was computed: enough to tell it from what is refused, and few enough to read.
const DIGITS: usize = 4;

/// A number as one would write it: no row of zeros. What was given is shown so, to its last digit.
pub fn plain(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() || (1e-3..1e6).contains(&size) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// The least number of four digits that is not below a computed one: what must be at least that much may be this.
pub fn at_least(value: f64) -> f64 {
    let [low, high] = beside(value);
    if low >= value { low } else { high }
}

/// The largest number of four digits that is not above a computed one: what must be at most that much may be this.
pub fn at_most(value: f64) -> f64 {
    let [low, high] = beside(value);
    if high <= value { high } else { low }
}

/// A computed number rounded to fifteen digits: if it has so few, what rounding errors put behind them is gone.
pub(crate) fn cleared(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

/// The numbers of few digits on both sides of one, the lower first; of one that has few digits itself either may be it. What
/// is not finite has no digits, and is its own.
fn beside(value: f64) -> [f64; 2] {
    // Every digit, so that none is rounded off.
    let text = format!("{:.1100e}", value.abs());
    let parts = text.split_once('e').and_then(|(digits, exponent)| {
        let digits: u64 = digits.replace('.', "").get(..DIGITS)?.parse().ok()?;
        Some((digits, exponent.parse::<i64>().ok()? - (DIGITS as i64 - 1)))
    });
    let Some((digits, exponent)) = parts else { return [value, value] };
    // Read as they will be by whoever gives them.
    let [near, far] =
        [digits, digits + 1].map(|digits| format!("{digits}e{exponent}").parse().unwrap_or(value));
    if value < 0.0 { [-far, -near] } else { [near, far] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_have_few_digits_and_stay_limits() {
        for (value, least, most) in [
            (0.173_754_667_172_495_21, "0.1738", "0.1737"),
            (1.163_636, "1.164", "1.163"),
            (0.65, "0.65", "0.65"),
            (9.999_9, "10", "9.999"),
            (1.000_000_1e-7, "1.001e-7", "1e-7"),
            (123_456.0, "123500", "123400"),
            (2.345_678e12, "2.346e12", "2.345e12"),
            (-0.173_754, "-0.1737", "-0.1738"),
            (0.0, "0", "0"),
            (f64::INFINITY, "inf", "inf"),
            (f64::NAN, "NaN", "NaN"),
        ] {
            assert_eq!([plain(at_least(value)), plain(at_most(value))], [least, most], "{value}");
        }
        // Whatever is tried: as shown and read again they are on their side, and near.
        let mut value = 3.1e-9;
        while value < 1e12 {
            let read = |limit: f64| plain(limit).parse::<f64>().unwrap();
            let (least, most) = (read(at_least(value)), read(at_most(value)));
            assert!(most <= value && value <= least && least - most < 1.001e-3 * value, "{value}");
            assert_eq!([at_least(least), at_most(most)], [least, most], "{value}");
            value *= 1.000_37;
        }
    }

    #[test]
    fn what_was_given_comes_back_from_its_reciprocal() {
        for rate in (1..400_000).map(f64::from) {
            assert_eq!(cleared(1.0 / (1.0 / rate)), rate);
        }
        assert_eq!(cleared(1.0 / (1.0 / 44_100.57)), 44_100.57);
    }
}
