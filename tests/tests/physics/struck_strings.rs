//! The promise: a string that begins with a velocity moves as formulas on paper say, and has the momentum and the energy of what
//! struck it, on whatever grid.

use std::f64::consts::PI;

use low_action_dsp::curve::Curve;
use low_action_dsp::{Scene, Simulation, State};
use low_action_tests::numbers::largest;

const LENGTH: f64 = 0.65;
const DENSITY: f64 = 5.25e-3;
const TENSION: f64 = 60.0;

/// Low E of an electric guitar, without stiffness or losses unless more says so, thrown at a velocity over places.
fn thrown(sample_rate: f64, stencil: &str, velocity: &[[f64; 2]], more: &str) -> Simulation {
    let text = format!(
        "sample_rate = {sample_rate:?}\nduration = 1.0\n[solver]\nstencil = {stencil:?}\n[[string]]\n\
         length = {LENGTH}\nlinear_density = {DENSITY}\ntension = {TENSION}\nvelocity = {velocity:?}\n{more}"
    );
    Simulation::new(&Scene::from_toml(&text).expect("the scene is valid")).expect("it can be built")
}

fn wave_speed() -> f64 {
    f64::sqrt(TENSION / DENSITY)
}

/// A rate at which the grid has so many intervals.
fn rate(intervals: usize) -> f64 {
    wave_speed() * (intervals as f64 + 0.5) / LENGTH
}

/// A hammer 6 cm wide with soft edges, m/s over m.
const HAMMER: [[f64; 2]; 4] = [[0.08, 0.0], [0.1, 1.5], [0.12, 1.5], [0.14, 0.0]];

/// ∫ of the hammer's velocity from the nut to a place, m²/s.
fn struck_up_to(place: f64) -> f64 {
    let rise = |from: f64| (place - from).clamp(0.0, 0.02);
    let [up, flat, down] = [0.08, 0.1, 0.12].map(rise);
    1.5 * (up * up / 0.04 + flat + down - down * down / 0.04)
}

/// The solution of d'Alembert, u = ∫ v dx/2c from x − ct to x + ct, with v odd about both ends.
fn exact(place: f64, time: f64) -> f64 {
    let all_from_nut = |x: f64| {
        let turned = x.rem_euclid(2.0 * LENGTH);
        struck_up_to(turned.min(2.0 * LENGTH - turned))
    };
    let way = wave_speed() * time;
    (all_from_nut(place + way) - all_from_nut(place - way)) / (2.0 * wave_speed())
}

/// Over two periods the string is where the exact solution is, four times as near on a grid of twice as many intervals.
///
/// Where a wave crosses a spacing in a step, a point is what every other point has been given between x − ct and x + ct: the
/// rule of midpoints 2h apart, which is off by bend·(2h)²/8 at most where the velocity bends, as it does four times here.
#[test]
fn a_struck_string_moves_as_in_the_exact_solution() {
    let error = |intervals: usize| {
        let mut simulation = thrown(rate(intervals), "wide", &HAMMER, "");
        let places: Vec<f64> = simulation.string(0).places().collect();
        assert_eq!(places.len() + 1, intervals);
        let samples = (4.0 * LENGTH / wave_speed() * rate(intervals)) as u64;
        largest((0..samples).map(|n| {
            let points = places.iter().zip(simulation.string(0).state.displacement());
            let off = largest(points.map(|(&x, u)| (u - exact(x, n as f64 / rate(intervals))).abs()));
            simulation.step();
            off
        }))
    };
    let grids = [60, 120, 240, 480];
    let errors = grids.map(error);
    println!("off by {errors:?} m at most");
    for (intervals, error) in grids.iter().zip(errors) {
        let spacing = LENGTH / *intervals as f64;
        let rule = 4.0 * 75.0 * (2.0 * spacing).powi(2) / 8.0 / (2.0 * wave_speed());
        assert!(error < rule, "{error} m on {intervals} intervals is more than {rule}");
    }
    assert!(errors[3] < errors[0] / 40.0, "{errors:?} is not of second order");
}

/// A partial that begins in the midst of its motion goes on as the sine of the frequency that the grid gives it, which its loss
/// makes shrink. Were what it begins with that of half a sample earlier it would be off by ωk/2, which is an eighth here, and by
/// σ₀k, a hundredth.
#[test]
fn a_partial_begins_at_its_moment() {
    let (rate, loss, mode) = (12_000.0, 120.0, 3.0 * PI / LENGTH);
    let flat = thrown(rate, "wide", &[[0.0, 0.0]], "");
    let places: Vec<f64> = flat.string(0).places().collect();
    let points = |height: f64| -> Vec<[f64; 2]> {
        let inner = places.iter().map(|&x| [x, height * (mode * x).sin()]);
        [[0.0, 0.0]].into_iter().chain(inner).chain([[LENGTH, 0.0]]).collect()
    };
    let more = format!("loss_0 = {loss:?}\nshape = {:?}\n", points(1e-3));
    let mut simulation = thrown(rate, "wide", &points(1.0), &more);
    let spacing = simulation.string(0).model.grid.spacing;
    let amplitude = |simulation: &Simulation| {
        let u = simulation.string(0).state.displacement();
        2.0 * spacing / LENGTH * u.zip(&places).map(|(u, &x)| u * (mode * x).sin()).sum::<f64>()
    };
    let mut found = Vec::new();
    for _ in 0..500 {
        found.push(amplitude(&simulation));
        simulation.step();
    }
    // (1 + σk)u⁺ + (1 − σk)u⁻ = 2b u is solved by rⁿ(A cos nθ + B sin nθ), and (u⁺ − u⁻)/2k is the velocity at first. What half
    // a spacing on either side of a point has of a row of straight lines is 1/8 of each neighbour's and 3/4 of its own.
    let velocity = 0.75 + 0.25 * (mode * spacing).cos();
    let left = f64::sqrt((rate - loss) / (rate + loss));
    let turn = ((found[2] + left * left * found[0]) / (2.0 * left * found[1])).acos();
    assert!(turn > 0.1, "{turn}");
    let across = (2.0 * velocity / rate - found[0] * turn.cos() * (left - 1.0 / left))
        / (turn.sin() * (left + 1.0 / left));
    for (n, u) in (0..).zip(&found) {
        let angle = f64::from(n) * turn;
        let expected = left.powi(n) * (found[0] * angle.cos() + across * angle.sin());
        assert!((u - expected).abs() < 1e-12, "{u} after {n} samples, not {expected}");
    }
}

/// A stiff string with losses rings in its partials: the sum of v_p/ω_p sin ω_p t exp(−σ_p t) sin γ_p x, to the second order in the spacing
/// (which the stiffness makes shrink as the root of the time step).
#[test]
fn partials_of_a_stiff_string_have_the_strength_of_the_blow() {
    let kappa_squared = 2e11 * PI * f64::powi(4.3e-4, 4) / 4.0 / DENSITY;
    let c_squared = TENSION / DENSITY;
    let partials: Vec<_> = (1..=400)
        .map(|number| {
            let mode = f64::from(number) * PI / LENGTH;
            // 2/L ∫ v sin γx dx of straight lines that begin and end at 0: each bend by b adds −b sin γx/γ² to it.
            let bends = [[0.08, 75.0], [0.1, -75.0], [0.12, -75.0], [0.14, 75.0]];
            let strength = bends.map(|[x, bend]| -bend * (mode * x).sin()).iter().sum::<f64>();
            let loss = 1.4 + 2e-5 * mode * mode;
            let turn = (c_squared * mode.powi(2) + kappa_squared * mode.powi(4) - loss * loss).sqrt();
            (mode, loss, turn, 2.0 / LENGTH * strength / (mode * mode) / turn)
        })
        .collect();
    let error = |rate: u32| {
        let more = "youngs_modulus = 2e11\ncore_radius = 4.3e-4\nloss_0 = 1.4\nloss_1 = 2e-5\n";
        let mut simulation = thrown(f64::from(rate), "wide", &HAMMER, more);
        let places: Vec<f64> = simulation.string(0).places().collect();
        let (mut off, mut all) = (0.0, 0.0);
        // Forty looks within 10 ms.
        for n in 1..=rate / 100 {
            simulation.step();
            if n % (rate / 4_000) != 0 {
                continue;
            }
            let time = f64::from(n) / f64::from(rate);
            let now = |&(mode, loss, turn, most): &(f64, f64, f64, f64)| {
                (mode, most * (turn * time).sin() * (-loss * time).exp())
            };
            let heights: Vec<_> = partials.iter().map(now).collect();
            for (&x, u) in places.iter().zip(simulation.string(0).state.displacement()) {
                let expected: f64 = heights.iter().map(|(mode, height)| height * (mode * x).sin()).sum();
                off += (u - expected).powi(2);
                all += expected.powi(2);
            }
        }
        (f64::sqrt(off / all), simulation.string(0).model.grid.spacing)
    };
    let errors = [48_000, 96_000, 192_000, 384_000].map(error);
    println!("rms errors of the motion, and spacings: {errors:?}");
    let (most, coarsest) = errors[0];
    assert!(most < 0.01, "{errors:?}");
    for (error, spacing) in errors {
        let rule = most * (spacing / coarsest).powi(2);
        assert!(error < 1.5 * rule, "{errors:?} is not of second order");
    }
}

/// What strikes the string gives it ∫ρv dx however narrow it is and wherever grid points stand, and ∫ρv²/2 dx where it is wider
/// than they are apart.
#[test]
fn momentum_and_energy_are_those_of_the_blow() {
    for sample_rate in [8_000.0, 44_100.0, 48_000.0, 96_000.0, 1e6] {
        for width in [1e-5, 1e-3, 3e-3, 0.05] {
            let edge = 0.1 * width;
            let blow = [[0.2 - edge, 0.0], [0.2, -2.0], [0.2 + width, -2.0], [0.2 + width + edge, 0.0]];
            let mut simulation = thrown(sample_rate, "paper", &blow, "");
            let model = &simulation.string(0).model;
            let mass = DENSITY * model.grid.spacing / model.grid.time_step;
            let spacing = model.grid.spacing;
            let before: f64 = simulation.string(0).state.motion().sum();
            simulation.step();
            let after: f64 = simulation.string(0).state.motion().sum();
            let momentum = 0.5 * mass * (before + after);
            let off = momentum / (-2.0 * DENSITY * (width + edge)) - 1.0;
            assert!(off.abs() < 1e-10, "{width} m at {sample_rate} Hz: momentum off by {off:e}");
            if width < 10.0 * spacing {
                continue;
            }
            let mut simulation = thrown(sample_rate, "paper", &blow, "");
            simulation.open_ledger();
            let found = simulation.ledgers()[0].initial;
            let expected = 0.5 * DENSITY * 4.0 * (width + 2.0 / 3.0 * edge);
            // Half a spacing of each edge may count for more or less than it is.
            let allowed = spacing / width;
            let off = found / expected - 1.0;
            assert!(off.abs() < allowed, "{width} m at {sample_rate} Hz: energy off by {off:e}");
        }
    }
}

/// But for what strikes within half a spacing of an end, which the end takes: of a hammer of ever more of its width beyond that as much
/// as is beyond, and of a narrower one nothing.
#[test]
fn an_end_takes_what_strikes_beside_it() {
    let spacing = thrown(88_200.0, "paper", &HAMMER, "").string(0).model.grid.spacing;
    for part in [0.3, 0.5, 0.8, 1.7] {
        let width = part * spacing;
        let blow = [[0.0, 2.0], [width, 2.0], [width * (1.0 + 1e-12), 0.0]];
        let simulation = thrown(88_200.0, "paper", &blow, "");
        let model = &simulation.string(0).model;
        let mut state = State::new(model);
        state.set_velocity(model, &Curve::Points(blow.to_vec()));
        let momentum = state.motion().sum::<f64>() * DENSITY * spacing / model.grid.time_step;
        let expected = 2.0 * DENSITY * (width - 0.5 * spacing).max(0.0);
        assert!(
            (momentum - expected).abs() < 1e-9 * DENSITY * spacing,
            "{part}: {momentum} of {expected} N s"
        );
    }
}

/// What begins in a shape and at a velocity moves as both added up.
#[test]
fn shape_and_velocity_add_up() {
    let more = "youngs_modulus = 2e11\ncore_radius = 4.3e-4\nloss_0 = 1.4\nloss_1 = 2e-5\n";
    let shape = "shape = [[0.0, 0.0], [0.3, 2e-3], [0.65, 0.0]]\n";
    let still = [[0.0, 0.0], [LENGTH, 0.0]];
    let mut runs = [
        thrown(44_100.0, "corrected", &HAMMER, &format!("{more}{shape}")),
        thrown(44_100.0, "corrected", &HAMMER, more),
        thrown(44_100.0, "corrected", &still, &format!("{more}{shape}")),
    ];
    for n in 0..1_000 {
        let [both, struck, plucked] = [0, 1, 2].map(|i| runs[i].string(0).state.displacement());
        for ((both, struck), plucked) in both.zip(struck).zip(plucked) {
            assert!((both - struck - plucked).abs() < 1e-14, "after {n} samples");
        }
        runs.iter_mut().for_each(|run| _ = run.step());
    }
}

/// One that does not pull itself tight says that it is not stretched, whatever plucks it and whatever it touches; of one that does
/// the numbers are what its energy has.
#[test]
fn a_string_is_stretched_only_where_that_pulls() {
    let down = HAMMER.map(|[place, velocity]| [place, -4.0 * velocity]);
    for tight in [false, true] {
        let more = format!(
            "youngs_modulus = 2e11\ncore_radius = 4.3e-4\ntension_modulation = {tight}\n[fretboard]\n\
             stiffness = 1e10\nexponent = 1.5\nboard = -0.001\n[[pluck]]\nduration = 0.01\nposition = 0.3\n\
             force = -2.0\n"
        );
        let mut simulation = thrown(88_200.0, "wide", &down, &more);
        let (mut most, mut touched) = (0.0_f64, false);
        for _ in 0..500 {
            simulation.step();
            let scratch = &simulation.string(0).scratch;
            let stretching = scratch.stretching().abs();
            assert!(stretching.is_finite(), "{stretching} m²");
            most = most.max(stretching);
            touched |= scratch.forces().count() > 0;
        }
        assert!(touched, "the string never met the board");
        assert_eq!(most > 0.0, tight, "{most} m²");
    }
}

/// The balance of a struck string that stretches and hits a board closes from its beginning on.
#[test]
fn the_balance_holds_from_the_blow_on() {
    let more = "youngs_modulus = 2e11\ncore_radius = 4.3e-4\nloss_0 = 1.4\nloss_1 = 1e-4\ntension_modulation = true\n\
                [fretboard]\nstiffness = 1e10\nexponent = 1.5\nboard = -0.001\nfrets = 12\nfret_top = -0.0005\n";
    let down = HAMMER.map(|[place, velocity]| [place, -4.0 * velocity]);
    let mut simulation = thrown(88_200.0, "paper", &down, more);
    simulation.open_ledger();
    let initial = simulation.ledgers()[0].initial;
    assert!(initial > 1e-3, "{initial} J");
    let mut touched = false;
    for n in 0..5_000 {
        let entry = simulation.step().expect("the ledger is open");
        assert!(entry.residual.abs() < 1e-12 * initial, "{} J after {n} samples", entry.residual);
        touched |= entry.energies.contact > 0.0;
    }
    assert!(touched, "the string never met the fretboard");
}
