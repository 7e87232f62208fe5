//! The promise: what is heard at the bridge is the force of the string's shape, (T + τ)·slope and what bending adds, whatever the
//! stencil, up to partials of which the grid has few points a wave.

use low_action_dsp::{Scene, Simulation};
use std::f64::consts::PI;

const LENGTH: f64 = 0.65;
const TENSION: f64 = 60.0;
/// Of a steel core of 0.43 mm, N m².
const BENDING: f64 = 2e11 * PI * 4.3e-4 * 4.3e-4 * 4.3e-4 * 4.3e-4 / 4.0;
const AMPLITUDE: f64 = 1e-4;

/// A low string held in the shape of a partial, its slope at the bridge towards it, and one step on.
struct Held {
    simulation: Simulation,
    /// Wave number γ, 1/m.
    wave_number: f64,
    /// Displacement of the last moving point before the step, m.
    last: f64,
}

fn held(rate: f64, stencil: &str, partial: f64) -> Held {
    let build = |shape: &[[f64; 2]]| {
        let text = format!(
            "sample_rate = {rate:?}\nduration = 1.0\n[solver]\nstencil = {stencil:?}\n[[string]]\nlength = {LENGTH}\n\
             linear_density = 5.25e-3\ntension = {TENSION:?}\nyoungs_modulus = 2e11\ncore_radius = 4.3e-4\n\
             shape = {shape:?}\n"
        );
        Simulation::new(&Scene::from_toml(&text).expect("the scene is valid")).expect("it can be built")
    };
    let flat = build(&[[0.0, 0.0], [LENGTH, 0.0]]);
    let wave_number = partial * PI / LENGTH;
    let shape = |x: f64| AMPLITUDE * (wave_number * (LENGTH - x)).sin();
    let inner = flat.string(0).places().map(|x| [x, shape(x)]);
    let points: Vec<_> = [[0.0, 0.0]].into_iter().chain(inner).chain([[LENGTH, 0.0]]).collect();
    let mut simulation = build(&points);
    let last = simulation.string(0).state.displacement().last().expect("points move");
    simulation.step();
    Held { simulation, wave_number, last }
}

/// A partial of amplitude A and wave number γ pushes with (Tγ + EIγ³)A. Read by four points that is known to (γh)⁸/630 of Tγ and
/// 41(γh)⁶/3024 of EIγ³, the first terms left out, and somewhat more near the grid's end.
#[test]
fn the_bridge_feels_the_shape_of_the_string() {
    for stencil in ["paper", "corrected", "wide"] {
        for partial in [1.0, 7.0, 20.0, 30.0] {
            let Held { simulation, wave_number, .. } = held(48_000.0, stencil, partial);
            let step = wave_number * simulation.string(0).model.grid.spacing;
            let (pull, bend) = (TENSION * wave_number * AMPLITUDE, BENDING * wave_number.powi(3) * AMPLITUDE);
            let allowed = 1.2 * (step.powi(8) / 630.0 * pull + 41.0 * step.powi(6) / 3024.0 * bend) + 1e-12;
            let off = simulation.output() - (pull + bend);
            assert!(
                off.abs() < allowed,
                "{stencil}, partial {partial}, γh = {step:.2}: off by {off:e} N of {allowed:e}"
            );
        }
    }
}

/// What `docs/physics.md` says of the thirtieth partial at 44.1 kHz: by these four points, and as the sums of the scheme
/// balance, by its own tension, bending and corrections of both: of a partial that is (T + ρκ₂²S + ρκ₆S²)·sin(γh)/h of its
/// amplitude, −S being its second difference.
#[test]
fn four_points_are_worth_two_decibels() {
    for (stencil, before) in [("paper", -2.07), ("corrected", -1.85), ("wide", -1.41)] {
        let Held { simulation, wave_number, last } = held(44_100.0, stencil, 30.0);
        let exact = (TENSION * wave_number + BENDING * wave_number.powi(3)) * AMPLITUDE;
        let decibels = |force: f64| 20.0 * (force / exact).log10();
        let four = decibels(simulation.output());
        let string = simulation.string(0);
        let (spacing, density) = (string.model.grid.spacing, string.model.string.linear_density);
        let stiffness = string.scratch.stiffness();
        let curved = (2.0 * (0.5 * wave_number * spacing).sin() / spacing).powi(2);
        let pull = TENSION + density * curved * (stiffness.kappa_squared + stiffness.kappa_6 * curved);
        let by_sums = decibels(pull * last / spacing);
        println!("{stencil}: {four:.3} dB, by the sums {by_sums:.2} dB");
        assert!((-0.14..0.0).contains(&four), "{stencil}: {four} dB");
        assert!((by_sums - before).abs() < 0.01, "{stencil}: {by_sums} dB by the sums");
    }
}
