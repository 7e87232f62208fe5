//! Promise: the scenes that go beyond the paper keep what docs/paper.md says of them. The ledger closes with
//! every loss and force there is; strings decay as the ones that were measured, and are as stiff; two almost equal plucks stay
//! together until the string buzzes; the bouncing triangle has its exact period.

use low_action_dsp::{Scene, Simulation};
use low_action_tests::numbers;
use low_action_tests::paper::{run, scene, shortened};
use low_action_tests::pitch::frequency_near;

/// In sum to 1e-12 of the largest energy. In a sample to 1e-14 and what the rounding of heights does: each
/// contact's energy follows from a height near a millimetre, which is known to 2.2e-19 m, before and after
/// the sample, and its force turns that into energy.
#[test]
fn the_ledger_closes_with_losses_and_forces() {
    let scene = scene("ledger");
    let mut force = 0.0f64;
    let simulation = run(&scene, |simulation, _| {
        let all: f64 = simulation.string(0).scratch.forces().map(|(_, force)| force).sum();
        force = numbers::largest([force, all]);
    });
    let ledger = &simulation.ledgers()[0];
    let (worst, sum) = (ledger.worst_residual, ledger.residual_sum.abs() / ledger.largest);
    let rounding = 2.0 * force * 2.2e-19 / ledger.largest;
    println!("worst {worst:.1e} (rounding of heights {rounding:.1e}), sum {sum:.1e}");
    assert!(ledger.put_in > 5e-3, "little happened: {} J put in", ledger.put_in);
    assert!(worst <= 1e-14 + rounding && sum <= 1e-12, "{worst:e} in a sample, {sum:e} in all");
}

/// A string of a scene by itself, let go in the shape of its partial `number`.
fn partial(scene: &Scene, string: usize, number: f64) -> Scene {
    let mut alone = Scene { duration: 0.5, ..scene.clone() };
    alone.string = vec![scene.string[string].clone()];
    let length = alone.string[0].length;
    let places: Vec<f64> = Simulation::new(&alone).expect("it can be built").string(0).places().collect();
    let shape = |x: f64| 1e-4 * (number * std::f64::consts::PI * x / length).sin();
    let inner = places.iter().map(|&x| [x, shape(x)]);
    alone.string[0].shape = Some([[0.0, 0.0]].into_iter().chain(inner).chain([[length, 0.0]]).collect());
    alone
}

/// The time in which the amplitude of partial `number` of a string alone falls by 60 dB, s: read from its energy over the run, which
/// for a single partial falls as exp(−2(σ₀ + σ₁γ²)t).
fn t60(scene: &Scene, string: usize, number: f64) -> f64 {
    let alone = partial(scene, string, number);
    // Whole periods of the loss, which comes with the velocity: the mean over the first and the last tenth.
    let (mut first, mut last, mut samples) = (0.0, 0.0, 0.0);
    run(&alone, |simulation, entry| {
        let time = simulation.steps() as f64 / alone.sample_rate;
        if time <= 0.1 {
            first += entry.energies.total();
            samples += 1.0;
        } else if time > 0.4 {
            last += entry.energies.total();
        }
    });
    assert!(samples > 1000.0);
    2.0 * 0.4 * 1000f64.ln() / f64::ln(first / last)
}

/// To 1 %: the scheme's decay is that of the string but for (γh)²/12 of its second loss, 0.5 % at partial 10
/// (`exact_partials` measures it closely); means over tenths of a second leave less than that.
#[test]
fn classical_strings_decay_as_measured() {
    let scene = scene("strings");
    let measured = [(11.9, 2.3), (15.2, 2.9), (14.7, 4.3), (22.2, 14.0), (29.1, 17.3), (22.8, 18.5)];
    for (string, (first, tenth)) in measured.into_iter().enumerate() {
        for (number, measured) in [(1.0, first), (10.0, tenth)] {
            let computed = t60(&scene, string, number);
            println!("string {}, partial {number}: {computed:.2} s, measured {measured} s", string + 1);
            assert!((computed / measured - 1.0).abs() < 0.01, "string {string}: {computed} for {measured}");
        }
    }
}

/// Their first decay is put in, to 1 % as above. (The second one is not; docs/paper.md says how far off it is.)
#[test]
fn steel_strings_decay_as_measured_where_that_is_put_in() {
    let scene = scene("strings");
    for (string, measured) in [13.0, 13.0, 16.9, 14.8, 24.7, 17.8].into_iter().enumerate() {
        let computed = t60(&scene, 6 + string, 1.0);
        println!("string {}: {computed:.2} s, measured {measured} s", 7 + string);
        assert!((computed / measured - 1.0).abs() < 0.01, "string {}: {computed} for {measured}", 7 + string);
    }
}

/// B of the first and the twentieth partial, f_n = n f₀ √(1 + Bn²), is π²EI/(TL²) to 1 %: the bending stiffness measured for
/// classical strings, and for the bass string B itself. The stencil leaves 0.5 % of B, the frequencies read less.
#[test]
fn strings_are_as_stiff_as_measured() {
    let scene = scene("strings");
    let of_stiffness = |string: usize, bending: f64| {
        let spec = &scene.string[string];
        std::f64::consts::PI.powi(2) * bending / (spec.tension.at(0.0) * spec.length.powi(2))
    };
    let classical = [130e-6, 160e-6, 310e-6, 51e-6, 40e-6, 57e-6].into_iter().enumerate();
    let classical = classical.map(|(string, bending)| (string, of_stiffness(string, bending)));
    for (string, measured) in classical.chain([(12, 3.5e-5)]) {
        let spec = &scene.string[string];
        let fundamental = (spec.tension.at(0.0) / spec.linear_density).sqrt() / (2.0 * spec.length);
        let heard = |number: f64| {
            let mut sound = Vec::new();
            let alone = partial(&scene, string, number);
            run(&alone, |simulation, _| sound.push(simulation.output() as f32));
            let near = number * fundamental * (1.0 + measured * number * number).sqrt();
            frequency_near(&sound, alone.sample_rate, near)
        };
        let ratio = (heard(20.0) / (20.0 * heard(1.0))).powi(2);
        let computed = (ratio - 1.0) / (400.0 - ratio);
        println!("string {}: B = {computed:.3e}, measured {measured:.3e}", string + 1);
        assert!((computed / measured - 1.0).abs() < 0.01, "string {}: {computed} for {measured}", string + 1);
    }
}

/// Largest difference between two plucks one of which is stronger by 1e-14, as a part of the displacement.
fn difference(force: f64, duration: f64) -> f64 {
    let mut one = shortened(&scene("figure_2"), duration);
    one.pluck[0].force = force;
    let mut other = one.clone();
    other.pluck[0].force *= 1.0 + 1e-14;
    let build = |scene: &Scene| Simulation::new(scene).expect("the scene can be built");
    let (mut one, mut other) = (build(&one), build(&other));
    let (mut largest, mut difference) = (0.0f64, 0.0f64);
    while one.steps() < one.samples() {
        one.step();
        other.step();
        let heights = one.string(0).state.displacement();
        for (a, b) in heights.zip(other.string(0).state.displacement()) {
            largest = numbers::largest([largest, a.abs()]);
            difference = numbers::largest([difference, (a - b).abs()]);
        }
    }
    difference / largest
}

#[test]
fn only_a_buzzing_string_forgets() {
    let (free, buzzing) = (difference(0.5, 0.3), difference(2.0, 0.3));
    println!("after 0.3 s: {free:.1e} swinging free, {buzzing:.1e} after buzzing");
    // What was put in, 1e-14, and as much again of rounding along the way.
    assert!(free < 1e-13, "{free}");
    assert!(buzzing > 1e-12, "{buzzing}");
}

/// A triangle of height A over a board at −d is back after (L/c)(1 + d/A). The scheme is late by about a
/// sample per bounce, of which there are one in a period: first order (`exact_solutions` measures it).
#[test]
fn the_bouncing_triangle_comes_back_in_time() {
    let scene = scene("barrier");
    let simulation = Simulation::new(&scene).expect("the scene can be built");
    assert_eq!(simulation.string(0).model.grid.intervals, 200, "the rate is made for this grid");
    let start = simulation.string(0).state.displacement().collect::<Vec<_>>();
    let period = 0.65 / (60.0f64 / 5.25e-3).sqrt() * (1.0 + 1.0 / 3.0);
    let mut nearest = (f64::INFINITY, 0.0);
    run(&scene, |simulation, _| {
        let time = simulation.steps() as f64 / scene.sample_rate;
        if (time / period - 1.0).abs() < 0.2 {
            let pairs = simulation.string(0).state.displacement().zip(&start);
            let distance: f64 = pairs.map(|(now, then)| (now - then).powi(2)).sum();
            if distance < nearest.0 {
                nearest = (distance, time);
            }
        }
    });
    println!("back after {:.4} ms, exactly {:.4} ms", 1e3 * nearest.1, 1e3 * period);
    assert!((nearest.1 - period).abs() < 2.5 / scene.sample_rate, "{} s, not {period} s", nearest.1);
}
