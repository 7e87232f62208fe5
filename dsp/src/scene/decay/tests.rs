use super::*;
use crate::curve::Curve;

/// A string of 60 N that is so stiff that its partials at 5 kHz are sharp by a third.
fn string(t60: Option<[[f64; 2]; 2]>) -> StringSpec {
    StringSpec {
        length: 0.65,
        linear_density: 5.25e-3,
        tension: Curve::Points(vec![[0.0, 60.0], [1.0, 90.0]]),
        youngs_modulus: 2e11,
        core_radius: 8e-4,
        loss_0: None,
        loss_1: None,
        t60,
        tension_modulation: false,
        shape: None,
        velocity: None,
    }
}

/// The frequency, Hz, of a wave of a wavenumber, rad/m, at the tension of the beginning.
fn frequency(spec: &StringSpec, wavenumber: f64) -> f64 {
    let bending = spec.youngs_modulus * std::f64::consts::FRAC_PI_4 * spec.core_radius.powi(4);
    let square = wavenumber * wavenumber;
    ((60.0 * square + bending * square * square) / spec.linear_density).sqrt() / std::f64::consts::TAU
}

fn said(spec: &StringSpec) -> String {
    spec.check("string[1]").expect_err("it is refused").to_string()
}

/// What an error names as the least and the largest that is accepted.
fn range(error: &str) -> [f64; 2] {
    let (_, rest) = error.split_once("between ").expect("a range is named");
    let (low, rest) = rest.split_once(" and ").expect("it has two ends");
    [low, rest.split(' ').next().expect("there are words")].map(|number| number.parse().expect("a number"))
}

#[test]
fn losses_come_back_from_the_decay_that_they_make() {
    for losses in [[1.38, 1.25e-4], [0.0, 1.25e-4], [1.38, 0.0], [1e3, 1e-2], [1e-2, 1e-2]] {
        for wavenumbers in [[5.0, 50.0], [4.8, 480.0], [30.0, 31.0]] {
            let [loss_0, loss_1] = losses;
            let t60 = wavenumbers.map(|number| {
                [frequency(&string(None), number), 1000_f64.ln() / (loss_0 + loss_1 * number * number)]
            });
            let spec = string(Some(t60));
            // Where a loss is 0 the times are at an end of what is accepted, to rounding.
            if losses.iter().all(|&loss| loss > 0.0) {
                spec.check("string[1]").expect("it is accepted");
            }
            for (got, asked) in spec.losses().into_iter().zip(losses) {
                // Differences of the two rates, and of the two squares, lose the digits that these share.
                let scale = if asked > 0.0 { asked } else { loss_0 + loss_1 * wavenumbers[0].powi(2) };
                assert!((got - asked).abs() < 1e-10 * scale, "{losses:?}, {t60:?}: {:?}", spec.losses());
            }
        }
    }
}

#[test]
fn without_anything_given_nothing_is_lost() {
    assert_eq!(string(None).losses(), [0.0, 0.0]);
    let half = StringSpec { loss_1: Some(1e-4), ..string(None) };
    assert_eq!(half.losses(), [0.0, 1e-4]);
}

#[test]
fn the_times_named_as_ends_are_accepted() {
    let with =
        |pair: [f64; 2], [first, second]: [f64; 2]| string(Some([[pair[0], first], [pair[1], second]]));
    for pair in [[100.0, 1000.0], [82.4, 82.5], [1e-3, 1e6], [440.0, 440.0_f64.next_up()]] {
        for first in [1e-3, 0.7, 12.345_678_9, 1e9] {
            for wrong in [0.0, -1.0, f64::NAN, 1.001 * first] {
                let error = said(&with(pair, [first, wrong]));
                assert!(error.starts_with("time of point 2 of string[1].t60 = "), "{error}");
                let ends = range(&error);
                assert_eq!(ends[1], first, "{error}");
                for end in ends {
                    let spec = with(pair, [first, end]);
                    spec.check("string[1]").unwrap_or_else(|error| panic!("{pair:?}, {first} s: {error}"));
                    let [loss_0, loss_1] = spec.losses();
                    assert!((0.0..=1e4).contains(&loss_0), "{loss_0} /s");
                    assert!((0.0..=1e2 * (1.0 + 1e-12)).contains(&loss_1), "{loss_1} m²/s");
                }
                // A part in a thousand below nothing is.
                let shorter = with(pair, [first, 0.998 * ends[0]]);
                assert_eq!(range(&said(&shorter)), ends, "{error}");
            }
        }
    }
}

/// On a light, taut string waves are so long that σ₀ would stay positive where σ₁ is far out of its range.
#[test]
fn the_second_loss_stays_in_its_range_on_any_string() {
    let light = |time| StringSpec {
        linear_density: 1e-7,
        tension: Curve::Constant(1e6),
        ..string(Some([[1.0, 1.0], [1e5, time]]))
    };
    let [shortest, _] = range(&said(&light(0.5)));
    let spec = light(shortest);
    spec.check("string[1]").expect("it is accepted");
    let [loss_0, loss_1] = spec.losses();
    assert!(loss_0 > 6.0 && (99.0..=100.0).contains(&loss_1), "{loss_0} /s, {loss_1} m²/s");
}

#[test]
fn what_is_no_decay_is_refused() {
    let frequencies = |low, high| string(Some([[low, 10.0], [high, 5.0]]));
    for (spec, words) in [
        (
            frequencies(0.0, 1e3),
            "frequency of point 1 of string[1].t60 = 0 is refused: it must lie between 0.001 and",
        ),
        (
            frequencies(1e2, 1e7),
            "frequency of point 2 of string[1].t60 = 1e7 is refused: it must lie between 0.001 and",
        ),
        (
            frequencies(1e2, 1e2),
            "frequency of point 2 of string[1].t60 = 100 is refused: it must be above that of the point before",
        ),
        (frequencies(f64::NAN, 1e2), "frequency of point 1 of string[1].t60 = NaN is refused"),
        (
            string(Some([[1e2, 0.0], [1e3, 0.0]])),
            "time of point 1 of string[1].t60 = 0 is refused: it must lie between 0.001 and",
        ),
        (
            StringSpec { loss_1: Some(0.0), ..frequencies(1e2, 1e3) },
            "string[1].loss_1 = 0 is refused: the string has a t60",
        ),
    ] {
        let error = said(&spec);
        assert!(error.starts_with(words), "{error}");
    }
}
