//! Promise: the string does what formulas on paper say: over a flat barrier it moves as the exact solution does, closer on
//! every finer grid; stretching adds the tension that its length says.

use std::f64::consts::PI;

use low_action_dsp::pickup::stretch_tension;
use low_action_tests::plain_string::{LOW_E, PlainString};

/// An ideal string without losses, as the exact solutions want it, on a grid of so many intervals.
fn ideal(intervals: f64) -> PlainString {
    let (length, linear_density, tension) = (0.65, 5.25e-3, 60.0_f64);
    PlainString {
        // The grid is the finest with h ≥ ck.
        sample_rate: (tension / linear_density).sqrt() * (intervals + 0.5) / length,
        length,
        linear_density,
        tension,
        youngs_modulus: 0.0,
        core_radius: 0.0,
        loss_0: 0.0,
        loss_1: 0.0,
    }
}

/// Height at the middle of the shapes the string is released in, m.
const HEIGHT: f64 = 3e-3;

/// A stiff flat board over the whole length. Its points are in contact for much less than a sample, so its
/// stiffness, 1e9 N/m on each, hardly matters: at 1 m/s it yields by less than a micrometre.
fn board(depth: f64) -> String {
    format!("[fretboard]\nstiffness = 1e9\nexponent = 1.0\nboard = {:?}", -depth)
}

/// Over two periods, the root of the mean square difference from `exact(x, t)`, in heights of the shape.
fn error_over_board(intervals: f64, depth: f64, period: f64, exact: impl Fn(f64, f64) -> f64) -> f64 {
    let string = ideal(intervals);
    let mut simulation = string.released("paper", |x| exact(x, 0.0), &board(depth));
    assert_eq!(simulation.string(0).model.grid.intervals as f64, intervals);
    let places: Vec<f64> = simulation.string(0).places().collect();
    let (mut sum, mut count) = (0.0, 0.0);
    for n in 0..(2.0 * period * string.sample_rate) as usize {
        let time = n as f64 / string.sample_rate;
        for (&x, u) in places.iter().zip(simulation.string(0).state.displacement()) {
            sum += ((u - exact(x, time)) / HEIGHT).powi(2);
            count += 1.0;
        }
        simulation.step();
    }
    f64::sqrt(sum / count)
}

/// On grids of 50 to 800 intervals: a bounce takes up to two samples longer than no time, so the error falls with
/// the first power of the spacing, by 16 over four doublings (not quite evenly, as bounces fall anywhere between samples).
///
/// Over the two periods there are two bounces: half of the time the motion is late by one, a quarter by both, which is 1.22 times
/// one in the mean of squares. No shape here is faster than the arch, whose velocity is πc/(2L) heights in that mean, or
/// π/2N in a sample.
#[track_caller]
fn assert_first_order(name: &str, depth: f64, period: f64, exact: impl Fn(f64, f64) -> f64) {
    let errors = [50.0, 100.0, 200.0, 400.0, 800.0].map(|n| error_over_board(n, depth, period, &exact));
    println!("{name}: rms error {:.2?} % of the height", errors.map(|error| 100.0 * error));
    for pair in errors.windows(2) {
        assert!(pair[1] < pair[0] / 1.5, "{name}: {errors:?} does not fall at every doubling");
    }
    assert!(errors[4] < errors[0] / 13.0, "{name}: {errors:?} is not of first order");
    for (error, intervals) in errors.iter().zip([50.0, 100.0, 200.0, 400.0, 800.0]) {
        let late = 2.0 * 1.22 * PI / (2.0 * intervals);
        assert!(*error < late, "{name}: {error} on {intervals} intervals is more than {late}");
    }
}

/// A triangle released over a board at −d: its flat top falls, all of it hits the board at once and
/// comes back. With T, ρ and c = √(T/ρ) the motion has the period (L/c)(1 + d/A), A the height of the shape.
#[test]
fn triangle_over_a_flat_barrier() {
    let string = ideal(100.0);
    let (length, c, depth) = (string.length, string.c_squared().sqrt(), 1e-3);
    let period = length / c * (1.0 + depth / HEIGHT);
    assert_first_order("triangle", depth, period, |x, t| {
        let since_turn = (t % period).min(period - t % period);
        let top = HEIGHT * (1.0 - 2.0 * c * since_turn / length);
        let start = HEIGHT * (1.0 - (2.0 * x / length - 1.0).abs());
        if top >= 0.0 { start.min(top) } else { top.max(-start) }
    });
}

/// A symmetric shape that rises to the middle, released over a board at 0: the free motion, folded up.
#[test]
fn arch_over_a_barrier_at_rest_height() {
    let string = ideal(100.0);
    let (length, c) = (string.length, string.c_squared().sqrt());
    assert_first_order("arch", 0.0, length / c, |x, t| {
        HEIGHT * ((PI * x / length).sin() * (PI * c * t / length).cos()).abs()
    });
}

/// Stretching adds EA/(2L)·∫(∂ₓu)² dx to the tension. The step has it from the samples around n as well, which is another
/// number by a part of ½(ωk)².
#[test]
fn stretching_adds_what_the_length_says() {
    let string = LOW_E;
    let (amplitude, beta) = (2e-3, PI / string.length);
    let shape = |x: f64| amplitude * (beta * x).sin();
    let mut simulation = string.released("wide", shape, "tension_modulation = true");
    let axial_stiffness = string.youngs_modulus * PI * string.core_radius.powi(2);
    let spacing = simulation.string(0).model.grid.spacing;
    let largest = axial_stiffness * (amplitude * beta).powi(2) / 4.0;
    let step = string.frequency(beta) / string.sample_rate;
    // At a largest tension of 1 % more the string is half a per cent higher.
    let apart = 0.51 * step * step * largest;
    for n in 0..2_000 {
        let u: Vec<f64> = simulation.string(0).state.displacement().collect();
        let slopes = [u[0], u[u.len() - 1]].into_iter().chain(u.windows(2).map(|pair| pair[1] - pair[0]));
        let squares: f64 = slopes.map(|slope| slope * slope).sum();
        let expected = axial_stiffness / (2.0 * string.length * spacing) * squares;
        simulation.step();
        let found = stretch_tension(&simulation.string(0).model, &simulation.string(0).scratch);
        assert!((found - expected).abs() <= apart, "{found} N after {n} samples, not {expected}");
        if n == 0 {
            // Differences between neighbours are smaller than slopes by (βh)²/24.
            let coarse = (beta * spacing).powi(2) / 12.0;
            assert!((expected / largest - 1.0).abs() <= coarse, "{expected} N at first, not {largest}");
        }
    }
}
