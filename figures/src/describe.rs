//! A scene in words, for captions.

use low_action_dsp::Scene;
use low_action_dsp::curve::{CountOrList, Curve, OneOrEach};
use low_action_dsp::scene::{FingerSpec, FretboardSpec, PluckSpec, StringSpec};

use crate::axis::power_of_ten;

/// The most strings, plucks or fingers that are described one by one.
const MOST: usize = 2;

/// Everything that a scene asks for, in a few sentences.
pub fn describe(scene: &Scene) -> String {
    let mut sentences = Vec::new();
    sentences.extend(listed("strings", &scene.string, string));
    sentences.extend(scene.fretboard.as_ref().map(fretboard));
    sentences.extend(listed("plucks", &scene.pluck, pluck));
    sentences.extend(listed("fingers", &scene.finger, finger));
    let stencil = format!("{:?}", scene.solver.stencil).to_lowercase();
    sentences
        .push(format!("Computed at {} kHz with the {stencil} stencil.", number(1e-3 * scene.sample_rate)));
    // What belongs together stays on one line.
    sentences
        .join(" ")
        .replace(" = ", "\u{a0}=\u{a0}")
        .replace(" m²/s", "\u{a0}m²/s")
        .replace(" mm", "\u{a0}mm")
}

fn listed<T>(name: &str, things: &[T], describe: fn(&T) -> String) -> Vec<String> {
    let mut sentences: Vec<_> = things.iter().take(MOST).map(describe).collect();
    if things.len() > MOST {
        sentences.push(format!("And {} more {name}.", things.len() - MOST));
    }
    sentences
}

fn string(spec: &StringSpec) -> String {
    let mut parts = vec![
        format!("{} m", number(spec.length)),
        format!("{} g/m", number(1e3 * spec.linear_density)),
        format!("{} N", course(&spec.tension, 1.0)),
    ];
    if spec.youngs_modulus > 0.0 && spec.core_radius > 0.0 {
        let (modulus, radius) = (number(1e-9 * spec.youngs_modulus), number(1e3 * spec.core_radius));
        parts.push(format!("E = {modulus} GPa, r = {radius} mm"));
    }
    parts.push(if spec.loss_0 == 0.0 && spec.loss_1 == 0.0 {
        "no losses".into()
    } else {
        format!("σ₀ = {} /s, σ₁ = {} m²/s", number(spec.loss_0), number(spec.loss_1))
    });
    if spec.tension_modulation {
        parts.push("stretching".into());
    }
    if spec.shape.is_some() {
        parts.push("released from a shape".into());
    }
    format!("String: {}.", parts.join(", "))
}

fn fretboard(spec: &FretboardSpec) -> String {
    let mut parts = vec![format!("K = {}, α = {}", number(spec.stiffness), number(spec.exponent))];
    match &spec.board {
        None => parts.push("no board".into()),
        Some(height) => parts.push(format!("board at {} mm", course(height, 1e3))),
    }
    let count = match &spec.frets {
        CountOrList::Count(count) => *count,
        CountOrList::List(places) => places.len(),
    };
    let crowns = match &spec.fret_top {
        Some(OneOrEach::One(height)) => format!(" with crowns at {} mm", number(1e3 * height)),
        Some(OneOrEach::Each(heights)) => {
            let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
            let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            format!(" with crowns at {} to {} mm", number(1e3 * high), number(1e3 * low))
        }
        None => String::new(),
    };
    if count > 0 {
        parts.push(format!("{count} frets{crowns}"));
    }
    format!("Fretboard: {}.", parts.join(", "))
}

fn pluck(spec: &PluckSpec) -> String {
    let (force, way) = (number(spec.force.abs()), if spec.force < 0.0 { "down" } else { "up" });
    let (place, duration) = (number(spec.position), number(1e3 * spec.duration));
    format!("Pluck: {force} N {way} at {place} m, grown over {duration} ms.")
}

fn finger(spec: &FingerSpec) -> String {
    let mut parts = vec![
        format!("{} g", number(1e3 * spec.mass)),
        format!("K = {}, α = {}", number(spec.stiffness), number(spec.exponent)),
    ];
    if spec.damping > 0.0 {
        parts.push(format!("β = {} s/m", number(spec.damping)));
    }
    if spec.hand_damping > 0.0 {
        parts.push(format!("hand {} N s/m", number(spec.hand_damping)));
    }
    parts.push(format!("at {} m", course(&spec.position, 1.0)));
    parts.push(format!("from {} mm", number(1e3 * spec.height)));
    if spec.velocity != 0.0 {
        parts.push(format!("at {} m/s", number(spec.velocity)));
    }
    match &spec.force {
        Curve::Constant(force) if *force == 0.0 => parts.push("no force".into()),
        force => parts.push(format!("pressed with {} N", course(force, 1.0))),
    }
    format!("Finger: {}.", parts.join(", "))
}

/// A number, or the least and the largest of a course.
fn course(curve: &Curve, scale: f64) -> String {
    let points = match curve {
        Curve::Constant(value) => return number(scale * value),
        Curve::Points(points) => points,
    };
    let least = points.iter().map(|point| scale * point[1]).fold(f64::INFINITY, f64::min);
    let largest = points.iter().map(|point| scale * point[1]).fold(f64::NEG_INFINITY, f64::max);
    if least == largest { number(least) } else { format!("{} to {}", number(least), number(largest)) }
}

/// A number to four digits: written out, or with a power of ten.
pub fn number(value: f64) -> String {
    significant(value, 4)
}

/// A number to so many digits, without zeros at its end: written out, or with a power of ten.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { format!("{value}") };
    }
    // Rounded first, so that 9.9999 is 10 and not 9.9999.
    let text = format!("{value:.*e}", digits.max(1) - 1);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let short = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    let text = if (-3..5).contains(&exponent) {
        short(&format!("{value:.*}", (digits as i32 - 1 - exponent).max(0) as usize))
    } else {
        match short(mantissa).as_str() {
            "1" => power_of_ten(exponent),
            "-1" => format!("-{}", power_of_ten(exponent)),
            mantissa => format!("{mantissa}·{}", power_of_ten(exponent)),
        }
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_easily() {
        let expected = [
            (0.65, "0.65"),
            (88.2, "88.2"),
            (1e15, "10¹⁵"),
            (1.25e-4, "1.25·10⁻⁴"),
            (-3.0, "−3"),
            (0.0, "0"),
            (9.99999, "10"),
            (12_345.6, "12346"),
        ];
        for (value, text) in expected {
            assert_eq!(number(value), text);
        }
        assert_eq!(significant(2.17e-6, 2), "2.2·10⁻⁶");
    }
}
