//! A scene in words, for captions.

use low_action_dsp::Scene;
use low_action_dsp::curve::{CountOrList, Curve, OneOrEach};
use low_action_dsp::scene::{
    BoardHeights, BoardSpec, FingerSpec, FretPlacement, FretboardSpec, PluckSpec, SolverSettings, StringSpec,
};
use low_action_dsp::setup::Body;

use crate::axis::power_of_ten;

/// The most strings, plucks or fingers that are described one by one.
const MOST: usize = 2;

/// Everything that is computed of a scene, in a few sentences: what is left out is as it is where a scene says nothing, or
/// stands on the axes, or is beyond the first two of its kind. Courses and lists are told by their least and largest value.
pub fn describe(scene: &Scene) -> String {
    let on = |number: usize| match scene.string.len() {
        1 => String::new(),
        _ => format!(", on string {number}"),
    };
    let mut sentences = Vec::new();
    sentences.extend(listed("strings", &scene.string, string));
    sentences.extend(scene.fretboard.as_ref().map(fretboard));
    sentences.extend(scene.body.as_ref().map(body));
    sentences.extend(listed("plucks", &scene.pluck, |spec| pluck(spec, &on(spec.string))));
    sentences.extend(listed("fingers", &scene.finger, |spec| finger(spec, &on(spec.string))));
    sentences.push(computed(scene));
    sentences.join(" ")
}

fn listed<T>(name: &str, things: &[T], describe: impl Fn(&T) -> String) -> Vec<String> {
    let mut sentences: Vec<_> = things.iter().take(MOST).map(describe).collect();
    if things.len() > MOST {
        sentences.push(format!("And {} more {name}.", things.len() - MOST));
    }
    sentences
}

fn computed(scene: &Scene) -> String {
    let (solver, usual) = (&scene.solver, SolverSettings::default());
    let stencil = format!("{:?}", solver.stencil).to_lowercase();
    let mut parts =
        vec![format!("Computed at {} kHz with the {stencil} stencil", number(1e-3 * scene.sample_rate))];
    if solver.max_iterations != usual.max_iterations {
        parts.push(format!("at most {} iterations", solver.max_iterations));
    }
    if solver.tolerance != usual.tolerance {
        parts.push(format!("tolerance {} m", number(solver.tolerance)));
    }
    format!("{}.", parts.join(", "))
}

fn body(spec: &Body) -> String {
    let Body { frequency, mass, area, quality, spacing, volume, hole } = *spec;
    format!(
        "Body: {} kg and {} cm² at {} Hz, Q = {}, modes {} Hz apart, {} l of air, a hole of {} cm².",
        number(mass),
        number(1e4 * area),
        number(frequency),
        number(quality),
        number(spacing),
        number(1e3 * volume),
        number(1e4 * hole)
    )
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
    parts.push(match (spec.t60, spec.losses()) {
        (Some([low, high]), _) => {
            let at = |[frequency, time]: [f64; 2]| format!("{} s at {} Hz", number(time), number(frequency));
            format!("60 dB lost in {} and {}", at(low), at(high))
        }
        (None, [0.0, 0.0]) => "no losses".into(),
        (None, [loss_0, loss_1]) => format!("σ₀ = {} /s, σ₁ = {} m²/s", number(loss_0), number(loss_1)),
    });
    if spec.tension_modulation {
        parts.push("stretching".into());
    }
    if let Some(points) = &spec.shape {
        let heights = range(points.iter().map(|point| 1e3 * point[1]));
        parts.push(format!("released from a shape of {heights} mm"));
    }
    if let Some(points) = &spec.velocity {
        parts.push(format!("thrown at {} m/s", range(points.iter().map(|point| point[1]))));
    }
    format!("String: {}.", parts.join(", "))
}

fn fretboard(spec: &FretboardSpec) -> String {
    let mut parts = vec![format!("K = {}, α = {}", number(spec.stiffness), number(spec.exponent))];
    match &spec.board {
        None => parts.push("no board".into()),
        Some(BoardSpec::Profile(height)) => parts.push(format!("board at {} mm", course(height, 1e3))),
        Some(BoardSpec::Parabola(BoardHeights { nut, middle, bridge })) => {
            let [nut, middle, bridge] = [nut, middle, bridge].map(|height| number(1e3 * height));
            parts.push(format!("board a parabola from {nut} over {middle} to {bridge} mm"));
        }
    }
    let (count, places) = match &spec.frets {
        CountOrList::Count(count) => (*count, String::new()),
        CountOrList::List(places) => (places.len(), format!(" at {} m", range(places.iter().copied()))),
    };
    let crowns = match &spec.fret_top {
        Some(OneOrEach::One(height)) => format!(" with crowns at {} mm", number(1e3 * height)),
        Some(OneOrEach::Each(heights)) => {
            format!(" with crowns at {} mm", range(heights.iter().map(|height| 1e3 * height)))
        }
        None => String::new(),
    };
    if count > 0 {
        parts.push(format!("{count} frets{places}{crowns}"));
    }
    match spec.fret_placement {
        FretPlacement::Exact => {}
        FretPlacement::Nearest => parts.push("frets on their nearest grid points".into()),
        FretPlacement::Kinked => parts.push("the string kinked at frets".into()),
    }
    if spec.damping > 0.0 {
        parts.push(format!("β = {} s/m", number(spec.damping)));
    }
    if let Some(spacing) = spec.board_reference_spacing {
        parts.push(format!("K of the board for a spacing of {} mm", number(1e3 * spacing)));
    }
    format!("Fretboard: {}.", parts.join(", "))
}

fn pluck(spec: &PluckSpec, on: &str) -> String {
    let (force, way) = (number(spec.force.abs()), if spec.force < 0.0 { "down" } else { "up" });
    let (place, duration) = (number(spec.position), number(1e3 * spec.duration));
    let start = if spec.start > 0.0 { format!(" from {} s on", number(spec.start)) } else { String::new() };
    let release = match spec.release {
        0.0 => String::new(),
        release => format!(" and let go over {} ms", number(1e3 * release)),
    };
    format!("Pluck: {force} N {way} at {place} m, grown over {duration} ms{release}{start}{on}.")
}

fn finger(spec: &FingerSpec, on: &str) -> String {
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
    format!("Finger: {}{on}.", parts.join(", "))
}

/// A number, or the least and the largest of a course.
fn course(curve: &Curve, scale: f64) -> String {
    match curve {
        Curve::Constant(value) => number(scale * value),
        Curve::Points(points) => range(points.iter().map(|point| scale * point[1])),
        Curve::Parabola(parabola) => range(parabola.values.iter().map(|value| scale * value)),
    }
}

/// The least and the largest of some numbers.
fn range(values: impl Iterator<Item = f64> + Clone) -> String {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let largest = values.fold(f64::NEG_INFINITY, f64::max);
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
    fn scenes_that_differ_in_one_key_have_different_captions() {
        let string = "[[string]]\nlength = 0.65\nlinear_density = 5e-3\ntension = 60.0\nyoungs_modulus = 2e11\n\
                      core_radius = 4e-4\nloss_0 = 1.0\nloss_1 = 1e-4\ntension_modulation = true\n\
                      shape = [[0.0, 0.0], [0.3, 1e-3], [0.65, 0.0]]\nvelocity = [[0.0, 0.0], [0.1, 1.0], [0.2, 0.0]]\n";
        let text = format!(
            "sample_rate = 44100\nduration = 0.1\n[solver]\nmax_iterations = 50\ntolerance = 1e-15\n\
             stencil = \"paper\"\n{string}{string}[fretboard]\nstiffness = 1e10\nexponent = 1.5\ndamping = 0\n\
             board = [[0.0, -0.002], [0.65, -0.0021]]\nfrets = [0.2, 0.4]\nfret_top = [-0.001, -0.0011]\n\
             fret_placement = \"exact\"\n[[pluck]]\nstring = 1\nstart = 0\nduration = 2e-3\nrelease = 1e-4\nposition = 0.5\nforce = 1\n\
             [[finger]]\nstring = 1\nmass = 5e-3\nstiffness = 1e8\nexponent = 2\ndamping = 0\nhand_damping = 0\n\
             position = 0.25\nheight = 5e-4\nvelocity = -2\nforce = 0\n[body]\nfrequency = 171\nmass = 0.2\narea = 0.06\n\
             quality = 21\nspacing = 55\nvolume = 0.0145\nhole = 0.0057\n"
        );
        let caption = |text: &str| describe(&Scene::from_toml(text).unwrap());
        let (first, halfway) = (caption(&text), text.find("[fretboard]").unwrap());
        assert!(
            caption(&text.replace("damping = 0\nboard", "board_reference_spacing = 5e-3\nboard")) != first
        );
        for (from, there, to) in [
            (0, "44100", "48000"),
            (0, "iterations = 50", "iterations = 49"),
            (0, "1e-15", "1e-14"),
            (0, "paper", "wide"),
            (0, "5e-3", "6e-3"),
            (0, "60.0", "[[0.0, 60.0], [0.1, 70.0]]"),
            (0, "2e11", "1e11"),
            (0, "core_radius = 4e-4", "core_radius = 3e-4"),
            (0, "loss_0 = 1.0", "loss_0 = 2.0"),
            (0, "loss_1 = 1e-4", "loss_1 = 2e-4"),
            (0, "loss_0 = 1.0\nloss_1 = 1e-4", "t60 = [[100, 5], [1000, 4]]"),
            (0, "true", "false"),
            (0, "1e-3]", "2e-3]"),
            (0, "[0.1, 1.0]", "[0.1, 2.0]"),
            (halfway, "1e10", "1e11"),
            (halfway, "1.5", "1.6"),
            (halfway, "damping = 0", "damping = 0.3"),
            (halfway, "-0.0021", "-0.0022"),
            (
                halfway,
                "[[0.0, -0.002], [0.65, -0.0021]]",
                "{ nut = -0.002, middle = -0.002, bridge = -0.0021 }",
            ),
            (halfway, "0.4]", "0.41]"),
            (halfway, "-0.0011", "-0.0012"),
            (halfway, "exact", "nearest"),
            (halfway, "exact", "kinked"),
            (halfway, "string = 1\nstart", "string = 2\nstart"),
            (halfway, "start = 0", "start = 0.01"),
            (halfway, "duration = 2e-3", "duration = 3e-3"),
            (halfway, "release = 1e-4", "release = 0"),
            (halfway, "position = 0.5", "position = 0.4"),
            (halfway, "force = 1", "force = -1"),
            (halfway, "string = 1\nmass", "string = 2\nmass"),
            (halfway, "5e-3", "6e-3"),
            (halfway, "1e8", "1e9"),
            (halfway, "exponent = 2", "exponent = 3"),
            (halfway, "damping = 0\nhand", "damping = 1\nhand"),
            (halfway, "hand_damping = 0", "hand_damping = 1"),
            (halfway, "0.25", "0.26"),
            (halfway, "5e-4", "6e-4"),
            (halfway, "velocity = -2", "velocity = -3"),
            (halfway, "force = 0", "force = 2"),
            (halfway, "171", "172"),
            (halfway, "mass = 0.2", "mass = 0.3"),
            (halfway, "0.06", "0.07"),
            (halfway, "quality = 21", "quality = 22"),
            (halfway, "spacing = 55", "spacing = 56"),
            (halfway, "0.0145", "0.0146"),
            (halfway, "0.0057", "0.0058"),
        ] {
            let at = from + text[from..].find(there).unwrap_or_else(|| panic!("{there} is in the scene"));
            let other = format!("{}{to}{}", &text[..at], &text[at + there.len()..]);
            let second = caption(&other);
            assert!(second != first, "{there} to {to}: {second}");
        }
    }

    #[test]
    fn decay_times_and_three_heights_are_all_told() {
        let text = "sample_rate = 44100\nduration = 0.1\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\ntension = 60.0\n\
                    t60 = [[82.4, 20], [2000, 3]]\n[fretboard]\nstiffness = 1e10\nexponent = 1.5\n\
                    board = { nut = -0.001, middle = -0.0015, bridge = -0.0018 }\n";
        let caption = describe(&Scene::from_toml(text).unwrap());
        for words in
            ["60 dB lost in 20 s at 82.4 Hz and 3 s at 2000 Hz", "a parabola from −1 over −1.5 to −1.8 mm"]
        {
            assert!(caption.contains(words), "{words} is not in: {caption}");
        }
    }

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
