//! Axes: what is shown along one side of a panel, in which unit, and how its numbers are written.

use std::ops::Range;

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it shows, with the unit.
    pub label: String,
    /// From where to where, in that unit.
    pub range: Range<f64>,
    /// Whether equal steps are equal factors.
    pub log: bool,
    /// About how many numbers stand along it.
    pub ticks: usize,
    /// Whether numbers and label are left out, because a neighbour below carries them.
    pub bare: bool,
    /// Words that stand at 0, 1, 2, … in the place of numbers, if there are any.
    pub names: Vec<String>,
    /// Whether lines and dots may leave the range; lines run along its edge then, and dots are left out.
    pub cut: bool,
}

impl Axis {
    /// An axis of equal steps.
    pub fn linear(label: impl Into<String>, range: Range<f64>) -> Axis {
        Axis {
            label: label.into(),
            range: spread(range),
            log: false,
            ticks: 6,
            bare: false,
            names: Vec::new(),
            cut: false,
        }
    }

    /// An axis of equal factors. Both ends must be above 0.
    pub fn log(label: impl Into<String>, range: Range<f64>) -> Axis {
        Axis { log: true, ..Axis::linear(label, range) }
    }

    /// An axis of equal factors around values of which the smallest may be 0: at most `decades` below the
    /// largest.
    pub fn log_below(label: impl Into<String>, largest: f64, decades: i32) -> Axis {
        let top = if largest > 0.0 && largest.is_finite() { largest } else { 1.0 };
        let top = libm::exp10(libm::ceil(libm::log10(top)));
        Axis::log(label, top * libm::exp10(-f64::from(decades))..top)
    }

    /// The same with about so many numbers along it.
    pub fn ticks(self, ticks: usize) -> Axis {
        Axis { ticks, ..self }
    }

    /// The same without numbers and label.
    pub fn bare(self) -> Axis {
        Axis { bare: true, ..self }
    }

    /// The same with words at 0, 1, 2, … in the place of numbers.
    pub fn named(self, names: Vec<String>) -> Axis {
        Axis { ticks: names.len() + 1, names, ..self }
    }

    /// The same with lines and dots that may leave it.
    pub fn cut(self) -> Axis {
        Axis { cut: true, ..self }
    }

    /// Whether a value that a line reaches would be drawn where it is not. (Ends of equal factors are chosen for what is
    /// to be told apart; what lies beyond them is to be seen there.)
    pub fn hides(&self, value: f64) -> bool {
        let slack = 1e-9 * (self.range.end - self.range.start);
        let shown = self.range.start - slack..=self.range.end + slack;
        !self.cut && !self.log && value.is_finite() && !shown.contains(&value)
    }

    /// Whether a value lies within the range.
    pub fn shows(&self, value: f64) -> bool {
        (self.range.start..=self.range.end).contains(&value)
    }

    /// Where a value stands between the ends of [`Axis::span`]; what lies beyond the range stands on its edge.
    pub fn place(&self, value: f64) -> f64 {
        let span = self.span();
        let place = if self.log {
            if value > 0.0 { libm::log10(value) } else { f64::NEG_INFINITY }
        } else {
            value * self.factor()
        };
        place.clamp(span.start, span.end)
    }

    /// The range as drawn: of values, without the power of ten in the label, or of their logarithms.
    pub fn span(&self) -> Range<f64> {
        let drawn = |end: f64| if self.log { libm::log10(end) } else { end * self.factor() };
        drawn(self.range.start)..drawn(self.range.end)
    }

    /// How the number at a place is written.
    pub fn number(&self, place: f64) -> String {
        if self.bare {
            return String::new();
        }
        if !self.names.is_empty() {
            let is_whole = (place - place.round()).abs() < 1e-6 && place > -0.5;
            return self.names.get(place.round() as usize).filter(|_| is_whole).cloned().unwrap_or_default();
        }
        if self.log {
            let exponent = place.round();
            return if (place - exponent).abs() < 1e-6 {
                power_of_ten(exponent as i32)
            } else {
                String::new()
            };
        }
        let span = self.span();
        plain_number(place, span.end - span.start)
    }

    /// The label, with what the numbers along the axis are to be multiplied by.
    pub fn label(&self) -> String {
        match (self.power(), self.label.rsplit_once(", ")) {
            (0, _) => self.label.clone(),
            (power, Some((what, unit))) => format!("{what}, {} {unit}", power_of_ten(power)),
            (power, None) => format!("{}, {}", self.label, power_of_ten(power)),
        }
    }

    fn factor(&self) -> f64 {
        libm::exp10(-f64::from(self.power()))
    }

    /// The power of ten that stands in the label where the numbers would be mostly zeros, or as long as the label is far.
    fn power(&self) -> i32 {
        let largest = self.range.start.abs().max(self.range.end.abs());
        if self.log || !self.names.is_empty() || (1e-3..=1e5).contains(&largest) {
            return 0;
        }
        // (No smaller than what can be divided by.)
        3 * libm::floor(libm::log10(largest) / 3.0).max(-102.0) as i32
    }
}

/// A range that can be drawn: of finite ends and some width.
fn spread(range: Range<f64>) -> Range<f64> {
    if !(range.end - range.start).is_finite() {
        return 0.0..1.0;
    }
    if range.end > range.start {
        return range;
    }
    let half = if range.start == 0.0 { 1.0 } else { 0.5 * range.start.abs() };
    range.start - half..range.start + half
}

/// A number with as many digits as make sense over a range.
fn plain_number(value: f64, range: f64) -> String {
    let digits = (2.0 - libm::floor(libm::log10(range))).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.replace('-', "−") }
}

/// 10 to a whole power, written with raised digits.
pub fn power_of_ten(exponent: i32) -> String {
    let raised = |character| match character {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    "10".chars().chain(exponent.to_string().chars().map(raised)).collect()
}

/// A unit with a prefix that suits the largest value: how many of it make one, and its name.
pub fn unit_for(largest: f64, unit: &str) -> (f64, String) {
    let prefixes = [
        (1e-12, "T"),
        (1e-9, "G"),
        (1e-6, "M"),
        (1e-3, "k"),
        (1.0, ""),
        (1e3, "m"),
        (1e6, "µ"),
        (1e9, "n"),
        (1e12, "p"),
        (1e15, "f"),
    ];
    let suits = |(factor, _): &(f64, &str)| largest * factor >= 0.5;
    let (factor, prefix) = prefixes.into_iter().find(suits).unwrap_or((1.0, ""));
    (factor, format!("{prefix}{unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        let axis = Axis::linear("", 0.0..0.65);
        assert_eq!(axis.number(0.1), "0.1");
        assert_eq!(axis.number(0.0), "0");
        assert_eq!(Axis::linear("", -2.0..2.0).number(-1.5), "−1.5");
        assert_eq!(Axis::linear("", 0.0..2000.0).number(500.0), "500");
    }

    #[test]
    fn powers_are_raised_and_what_lies_between_is_not_written() {
        let axis = Axis::log("", 1e-12..1e20);
        assert_eq!(axis.number(-9.0), "10⁻⁹");
        assert_eq!(axis.number(15.0), "10¹⁵");
        assert_eq!(axis.number(4.5), "");
    }

    #[test]
    fn what_is_beyond_the_range_stands_on_its_edge() {
        let axis = Axis::log("", 1e-3..1.0);
        for value in [0.0, -1.0, 1e-30] {
            assert_eq!(axis.place(value), -3.0, "{value}");
        }
        assert_eq!(Axis::linear("", 0.0..1.0).place(1e9), 1.0);
    }

    #[test]
    fn a_range_of_no_width_is_widened() {
        assert_eq!(Axis::linear("", 0.0..0.0).range, -1.0..1.0);
        assert_eq!(Axis::linear("", 2.0..2.0).range, 1.0..3.0);
        assert_eq!(Axis::linear("", 0.0..f64::INFINITY).range, 0.0..1.0);
        assert_eq!(Axis::log_below("", f64::NAN, 3).range, 1e-3..1.0);
    }

    #[test]
    fn numbers_along_an_axis_differ_and_leave_room_for_the_label() {
        use plotters::coord::ranged1d::{BoldPoints, Ranged};
        use plotters::coord::types::RangedCoordf64;
        for power in -290..=290 {
            for (start, end) in [(0.0, 1.08), (0.0, 3.0), (-0.7, 9.0), (0.0, 5.4)] {
                let unit = libm::exp10(f64::from(power));
                let axis = Axis::linear("energy, J", start * unit..end * unit);
                let points = RangedCoordf64::from(axis.span()).key_points(BoldPoints(axis.ticks));
                let numbers: Vec<_> = points.iter().map(|place| axis.number(*place)).collect();
                let different: std::collections::BTreeSet<_> = numbers.iter().collect();
                assert!(numbers.len() > 2 && different.len() == numbers.len(), "{axis:?}: {numbers:?}");
                assert!(numbers.iter().all(|number| number.chars().count() <= 6), "{axis:?}: {numbers:?}");
            }
        }
    }

    #[test]
    fn what_many_zeros_would_say_stands_in_the_label() {
        for (end, label, number) in
            [(2e-13, "energy, 10⁻¹⁵ J", "100"), (3e6, "energy, 10⁶ J", "2"), (0.02, "energy, J", "0.01")]
        {
            let axis = Axis::linear("energy, J", 0.0..end);
            assert_eq!(axis.label(), label);
            let place = if end > 1.0 { 2e6 } else { 0.5 * end };
            assert_eq!(axis.number(axis.place(place)), number);
        }
        assert_eq!(Axis::linear("iterations", 0.0..2e6).label(), "iterations, 10⁶");
        assert_eq!(Axis::log("energy, J", 1e-12..1e-9).label(), "energy, J");
    }

    #[test]
    fn units_suit_their_values() {
        assert_eq!(unit_for(4e-10, "J"), (1e12, "pJ".into()));
        assert_eq!(unit_for(2.5e6, "N"), (1e-6, "MN".into()));
        assert_eq!(unit_for(0.0225, "J"), (1e3, "mJ".into()));
        assert_eq!(unit_for(30.0, "N"), (1.0, "N".into()));
        assert_eq!(unit_for(0.0, "N"), (1.0, "N".into()));
    }
}
