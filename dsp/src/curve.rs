//! A quantity given as a number, as points joined by straight lines or as a parabola.

mod parabola;

use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};

use crate::digits::plain;
use crate::error::{Error, within};
pub use parabola::Parabola;

/// A number, `[[where, value], …]` joined by straight lines and constant outside, or a parabola. (No text is read as that: a
/// [board](crate::scene::BoardSpec) of three heights becomes one under each string.)
#[derive(Debug, Clone, PartialEq)]
pub enum Curve {
    /// The same everywhere.
    Constant(f64),
    /// Points in increasing order of the first number.
    Points(Vec<[f64; 2]>),
    /// Through three values.
    Parabola(Parabola),
}

impl Curve {
    /// The value at `place` (a time or a position).
    pub fn at(&self, place: f64) -> f64 {
        let points = match self {
            Curve::Constant(value) => return *value,
            Curve::Parabola(parabola) => return parabola.at(place),
            Curve::Points(points) => points,
        };
        let after = points.partition_point(|p| p[0] <= place);
        match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
            (None, Some(first)) => first[1],
            (Some(last), None) => last[1],
            (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * ((place - a[0]) / (b[0] - a[0])),
            (None, None) => 0.0,
        }
    }

    /// The mean of all values between two places, the second farther on.
    pub(crate) fn mean(&self, from: f64, to: f64) -> f64 {
        let points = match self {
            Curve::Constant(value) => return *value,
            // (Simpson's rule, which is exact here.)
            Curve::Parabola(parabola) => {
                let middle = parabola.at(0.5 * (from + to));
                return (parabola.at(from) + 4.0 * middle + parabola.at(to)) / 6.0;
            }
            Curve::Points(points) => points,
        };
        let first = points.partition_point(|p| p[0] <= from);
        let (mut sum, mut last) = (0.0, [from, self.at(from)]);
        let inner = points[first..].iter().take_while(|p| p[0] < to);
        for &point in inner.chain(&[[to, self.at(to)]]) {
            sum += 0.5 * (last[1] + point[1]) * (point[0] - last[0]);
            last = point;
        }
        sum / (to - from)
    }

    /// The largest value taken; of a parabola, between its first and its last.
    pub fn largest(&self) -> f64 {
        match self {
            Curve::Constant(value) => *value,
            Curve::Points(points) => points.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max),
            Curve::Parabola(parabola) => parabola.largest(),
        }
    }

    /// Refuses an empty or unordered list, points elsewhere than `along` has them and every value outside `[low, high]`.
    pub(crate) fn check(
        &self,
        name: &str,
        along: Along,
        low: f64,
        high: f64,
        unit: &str,
    ) -> Result<(), Error> {
        self.check_each(name, along, |name, value| within(name, value, low, high, unit))
    }

    /// The same where values are refused by `refused`, which is given the name of each.
    pub(crate) fn check_each(
        &self,
        name: &str,
        along: Along,
        refused: impl Fn(&str, f64) -> Result<f64, Error>,
    ) -> Result<(), Error> {
        let points = match self {
            Curve::Constant(value) => return refused(name, *value).map(drop),
            Curve::Parabola(parabola) => return parabola.check(name, along, refused),
            Curve::Points(points) => points,
        };
        if points.is_empty() {
            return Err(Error::range(name, "[]", "a list of points must have at least one"));
        }
        let Along { over, unit, from, to } = along;
        let mut before = f64::NEG_INFINITY;
        for (i, &[place, value]) in points.iter().enumerate() {
            let number = i + 1;
            let place_name = format!("{over} of point {number} of {name}");
            within(&place_name, place, from, to, unit)?;
            if place <= before {
                let accepted = format!("it must be above that of the point before, {} {unit}", plain(before));
                return Err(Error::range(place_name, plain(place), accepted));
            }
            before = place;
            refused(&format!("value of point {number} of {name}"), value)?;
        }
        Ok(())
    }
}

/// What the points of a curve are placed in, and where they may be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Along {
    over: &'static str,
    unit: &'static str,
    from: f64,
    to: f64,
}

impl Along {
    /// Any time.
    pub const TIME: Along = Along { over: "time", unit: "s", from: -FARTHEST, to: FARTHEST };
    /// Any place.
    pub const ANYWHERE: Along = Along { over: "place", unit: "m", from: -FARTHEST, to: FARTHEST };

    /// The places of a string of so many m, its ends among them.
    pub fn string(length: f64) -> Self {
        Along { from: 0.0, to: length, ..Self::ANYWHERE }
    }
}

/// The largest time (s) or place (m) of a point, a limit against slips of the pen.
const FARTHEST: f64 = 1e9;

impl<'de> Deserialize<'de> for Curve {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct CurveVisitor;
        impl<'de> Visitor<'de> for CurveVisitor {
            type Value = Curve;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a number or a list of pairs [[where, value], ...]")
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Curve, E> {
                Ok(Curve::Constant(value))
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Curve, E> {
                Ok(Curve::Constant(value as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Curve, A::Error> {
                let mut points = Vec::new();
                while let Some(Pair(point)) = seq.next_element()? {
                    points.push(point);
                }
                Ok(Curve::Points(points))
            }
        }
        deserializer.deserialize_any(CurveVisitor)
    }
}

/// Two numbers, no fewer and no more.
struct Pair([f64; 2]);

impl<'de> Deserialize<'de> for Pair {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let numbers = Vec::<f64>::deserialize(deserializer)?;
        let pair = <[f64; 2]>::try_from(numbers);
        pair.map(Pair).map_err(|numbers| de::Error::invalid_length(numbers.len(), &"a pair [where, value]"))
    }
}

/// Reads a list of pairs where a single number would mean nothing.
pub(crate) fn pairs<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Vec<[f64; 2]>>, D::Error> {
    let pairs = Vec::<Pair>::deserialize(deserializer)?;
    Ok(Some(pairs.into_iter().map(|Pair(pair)| pair).collect()))
}

/// The most frets a board may have.
pub(crate) const MOST_FRETS: usize = 1000;

/// The most that are counted out in equal temperament: beyond the 647th of them a fret stands on the bridge, as far as numbers tell.
pub(crate) const MOST_COUNTED: usize = 640;

/// A whole number of equal things, or the place (or value) of each.
#[derive(Debug, Clone, PartialEq)]
pub enum CountOrList {
    /// So many.
    Count(usize),
    /// Each.
    List(Vec<f64>),
}

impl<'de> Deserialize<'de> for CountOrList {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct CountVisitor;
        impl<'de> Visitor<'de> for CountVisitor {
            type Value = CountOrList;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                write!(f, "a count from 0 to {MOST_COUNTED} or a list of at most {MOST_FRETS} places in m")
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<CountOrList, E> {
                match usize::try_from(value) {
                    Ok(count) if count <= MOST_COUNTED => Ok(CountOrList::Count(count)),
                    _ => Err(E::invalid_value(de::Unexpected::Signed(value), &self)),
                }
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<CountOrList, A::Error> {
                let mut places = Vec::new();
                while let Some(place) = seq.next_element::<f64>()? {
                    places.push(place);
                    if places.len() > MOST_FRETS {
                        return Err(de::Error::invalid_length(places.len(), &self));
                    }
                }
                Ok(CountOrList::List(places))
            }
        }
        deserializer.deserialize_any(CountVisitor)
    }
}

/// One number for all, or one each.
#[derive(Debug, Clone, PartialEq)]
pub enum OneOrEach {
    /// The same for all.
    One(f64),
    /// Each its own.
    Each(Vec<f64>),
}

impl<'de> Deserialize<'de> for OneOrEach {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EachVisitor;
        impl<'de> Visitor<'de> for EachVisitor {
            type Value = OneOrEach;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a number or a list of numbers")
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<OneOrEach, E> {
                Ok(OneOrEach::One(value))
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<OneOrEach, E> {
                Ok(OneOrEach::One(value as f64))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<OneOrEach, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = seq.next_element::<f64>()? {
                    values.push(value);
                }
                Ok(OneOrEach::Each(values))
            }
        }
        deserializer.deserialize_any(EachVisitor)
    }
}
