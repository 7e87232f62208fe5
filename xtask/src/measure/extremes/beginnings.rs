//! How strings of random scenes begin: drawn out to a shape, struck, or both.

use low_action_dsp::gesture::FASTEST;
use toml::Value;

use super::draw::Draw;

/// A shape that a string is released from, its ends at 0; distances in the scene are of the order of `reach`, m.
pub fn shape(draw: &mut Draw, length: f64, reach: f64) -> Value {
    let height = draw.either_way(0.01 * reach, (100.0 * reach).min(1.0));
    let mut points = vec![point(0.0, 0.0)];
    points
        .extend(places(draw, length).into_iter().map(|place| point(place, height * draw.between(-1.0, 1.0))));
    points.push(point(length, 0.0));
    Value::Array(points)
}

/// The velocity of a string that has been struck: by a hammer, however narrow, or all along, with jumps at its ends.
pub fn velocity(draw: &mut Draw, length: f64) -> Value {
    let speed = draw.either_way(1e-3, FASTEST);
    if draw.chance(0.5) {
        let middle = length * draw.between(0.001, 0.999);
        let half = length * draw.over(1e-9, 1.0);
        let ends = [(middle - half).max(0.0), (middle + half).min(length)];
        return Value::Array(vec![point(ends[0], 0.0), point(middle, speed), point(ends[1], 0.0)]);
    }
    let points = places(draw, length).into_iter().map(|place| point(place, speed * draw.between(-1.0, 1.0)));
    Value::Array(points.collect())
}

/// A few places inside a string, in order, no two of them the same.
fn places(draw: &mut Draw, length: f64) -> Vec<f64> {
    let count = draw.whole(1, 4);
    let mut places: Vec<f64> = (0..count).map(|_| length * draw.between(0.001, 0.999)).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    places
}

/// A point of a course.
pub fn point(place: f64, value: f64) -> Value {
    Value::Array(vec![place.into(), value.into()])
}
