//! How numbers are read, as people write them, and how some are shown.

/// A number with its sign, which nothing has with a plus.
pub(super) fn signed(value: f32, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    // What is rounded to nothing has a sign of its own.
    if text.contains(|letter: char| ('1'..='9').contains(&letter)) { text } else { text.replace('-', "+") }
}

/// Reads numbers of such a unit.
pub(super) fn reads(unit: &'static str) -> impl Fn(&str) -> Option<f32> + Send + Sync {
    move |text| number(text, unit)
}

/// Pitches are written in either of these, of which one is a hundred of the other.
const OF_PITCH: [[&str; 2]; 2] = [["cents", "cent"], ["semitones", "semitone"]];

/// The number that a text is, with a point or a comma, and with its unit or without. Another unit is another number, which is
/// known only of pitches.
pub(in crate::params) fn number(text: &str, unit: &str) -> Option<f32> {
    let text = text.trim().replace(',', ".").replace('−', "-").to_lowercase();
    let unit = unit.trim();
    let parse = |bare: &str| bare.trim_end().parse().ok().filter(|number: &f32| number.is_finite());
    let before = |units: [&str; 2]| units.iter().find_map(|unit| text.strip_suffix(unit)).and_then(parse);
    match OF_PITCH.map(|units| units.contains(&unit)) {
        [true, _] => before(OF_PITCH[0]).or_else(|| before(OF_PITCH[1]).map(|semitones| 100.0 * semitones)),
        [_, true] => before(OF_PITCH[1]).or_else(|| before(OF_PITCH[0]).map(|cents| cents / 100.0)),
        _ => text.strip_suffix(unit.to_lowercase().as_str()).and_then(parse),
    }
    .or_else(|| parse(&text))
}

/// The same for whole numbers.
pub(super) fn whole(text: &str, unit: &str) -> Option<i32> {
    number(text, unit).filter(|number| number.fract() == 0.0).map(|number| number as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_added_has_its_sign() {
        for (value, decimals, text) in
            [(0.5, 2, "+0.50"), (-2.0, 0, "-2"), (0.0, 2, "+0.00"), (-0.0, 1, "+0.0"), (-0.004, 2, "+0.00")]
        {
            assert_eq!(signed(value, decimals), text);
        }
    }

    #[test]
    fn numbers_are_taken_as_people_write_them() {
        for (text, unit, expected) in [
            ("-3dB", " dB", -3.0),
            ("12 mm", " mm", 12.0),
            (" −0,5  MM", " mm", -0.5),
            ("+1.25", "", 1.25),
            ("90%", "%", 90.0),
            ("-0.00 ms", " ms", 0.0),
            ("7", " ms", 7.0),
            ("20 cents", " semitones", 0.2),
            ("-1 cent", " semitones", -0.01),
            ("1 semitone", " semitones", 1.0),
            ("0,5 semitones", " cents", 50.0),
        ] {
            assert_eq!(number(text, unit), Some(expected), "{text}");
        }
        for text in ["", "mm", "nan", "inf", "one", "1.2.3", "--3 mm", "1e99 mm"] {
            assert_eq!(number(text, " mm"), None, "{text}");
        }
    }

    /// What is meant by it is another number.
    #[test]
    fn numbers_of_other_units_are_not_taken() {
        for (text, unit) in [
            ("1 cm", " mm"),
            ("1 m", " mm"),
            ("1 s", " ms"),
            ("20 cents", " mm"),
            ("2 mm", "%"),
            ("3 dB", ""),
            ("3 and more", ""),
            ("20 %", " semitones"),
        ] {
            assert_eq!(number(text, unit), None, "{text}");
        }
    }
}
