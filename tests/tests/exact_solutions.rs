//! The string does what formulas on paper say: its partials have the frequency and decay of the scheme's own
//! dispersion relation and, within the error the analysis predicts, those of the differential equation;
//! over a flat barrier it moves as the exact solution does, closer on every finer grid; stretching adds the tension that its
//! length says.

use low_action_dsp::pickup::stretch_tension;
use low_action_dsp::{Scene, Simulation};
use std::f64::consts::PI;

/// The stencils' names in a scene.
const STENCILS: [&str; 3] = ["paper", "corrected", "wide"];

/// A string without contacts.
struct PlainString {
    sample_rate: f64,
    length: f64,
    linear_density: f64,
    tension: f64,
    youngs_modulus: f64,
    core_radius: f64,
    loss_0: f64,
    loss_1: f64,
}

/// Low E of a light electric set: 38.216e-5 lb/in (D'Addario NW046) tuned to 82.407 Hz on 25.5 in, its core
/// of steel 0.018 in thick; losses that let it ring for some seconds.
const LOW_E: PlainString = PlainString {
    sample_rate: 48_000.0,
    length: 0.6477,
    linear_density: 6.825e-3,
    tension: 77.77,
    youngs_modulus: 2.07e11,
    core_radius: 0.2286e-3,
    loss_0: 0.5,
    loss_1: 1e-4,
};

impl PlainString {
    fn scene(&self, stencil: &str, shape: &[[f64; 2]], more: &str) -> Scene {
        let text = format!(
            "sample_rate = {:?}
            duration = 10.0
            [solver]
            stencil = {stencil:?}
            [[string]]
            length = {:?}
            linear_density = {:?}
            tension = {:?}
            youngs_modulus = {:?}
            core_radius = {:?}
            loss_0 = {:?}
            loss_1 = {:?}
            shape = {shape:?}
            {more}",
            self.sample_rate,
            self.length,
            self.linear_density,
            self.tension,
            self.youngs_modulus,
            self.core_radius,
            self.loss_0,
            self.loss_1,
        );
        Scene::from_toml(&text).expect("the scene is valid")
    }

    /// The string released from the height `shape` has at each grid point.
    fn released(&self, stencil: &str, shape: impl Fn(f64) -> f64, more: &str) -> Simulation {
        let flat = self.scene(stencil, &[[0.0, 0.0], [self.length, 0.0]], more);
        let places: Vec<f64> =
            Simulation::new(&flat).expect("the scene can be built").string(0).places().collect();
        let inner = places.iter().map(|&x| [x, shape(x)]);
        let points: Vec<_> = [[0.0, 0.0]].into_iter().chain(inner).chain([[self.length, 0.0]]).collect();
        Simulation::new(&self.scene(stencil, &points, more)).expect("the scene can be built")
    }

    fn c_squared(&self) -> f64 {
        self.tension / self.linear_density
    }

    /// κ² = EI/ρ with I = πr⁴/4.
    fn kappa_squared(&self) -> f64 {
        self.youngs_modulus * PI * self.core_radius.powi(4) / 4.0 / self.linear_density
    }

    /// Undamped angular frequency at wave number β, by the differential equation.
    fn frequency(&self, beta: f64) -> f64 {
        (self.c_squared() * beta.powi(2) + self.kappa_squared() * beta.powi(4)).sqrt()
    }
}

/// Angular frequency (rad/s) and decay rate (1/s) of a partial.
#[derive(Debug)]
struct Partial {
    frequency: f64,
    decay: f64,
}

impl Partial {
    /// From z, by which an oscillation is multiplied in `time`: z² = p z + q.
    fn from_recurrence(p: f64, q: f64, time: f64) -> Self {
        let radius = (-q).sqrt();
        Self { frequency: (p / (2.0 * radius)).acos() / time, decay: -radius.ln() / time }
    }
}

/// Releases the string in the shape of mode m and fits a decaying oscillation to the mode's amplitude:
/// samples D apart obey a[n + 2D] = p a[n + D] + q a[n], with p and q by least squares. D is a quarter of a
/// period, where the two are told apart best.
fn measure(string: &PlainString, stencil: &str, mode: f64) -> Partial {
    let beta = mode * PI / string.length;
    let mut simulation = string.released(stencil, |x| 1e-3 * (beta * x).sin(), "");
    let weights: Vec<f64> = simulation.string(0).places().map(|x| (beta * x).sin()).collect();
    let amplitudes: Vec<f64> = (0..8_000)
        .map(|_| {
            let points = simulation.string(0).state.displacement();
            let amplitude = points.zip(&weights).map(|(u, w)| u * w).sum();
            simulation.step();
            amplitude
        })
        .collect();
    let lag = (0.5 * PI / string.frequency(beta) * string.sample_rate).round().max(1.0) as usize;
    let [mut xx, mut xy, mut yy, mut xz, mut yz] = [0.0; 5];
    for n in 0..amplitudes.len() - 2 * lag {
        let (x, y, z) = (amplitudes[n], amplitudes[n + lag], amplitudes[n + 2 * lag]);
        (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        (xz, yz) = (xz + x * z, yz + y * z);
    }
    let determinant = xx * yy - xy * xy;
    let p = (xx * yz - xy * xz) / determinant;
    let q = (yy * xz - xy * yz) / determinant;
    Partial::from_recurrence(p, q, lag as f64 / string.sample_rate)
}

/// κ₂² and κ₆ of a stencil at spacing h.
fn stiffness(string: &PlainString, stencil: &str, h: f64) -> (f64, f64) {
    let (c2, kappa2) = (string.c_squared(), string.kappa_squared());
    let courant2 = c2 / (string.sample_rate * h).powi(2);
    let corrected = kappa2 + c2 * h * h / 12.0 * (1.0 - courant2);
    match stencil {
        "paper" => (kappa2, 0.0),
        "corrected" => (corrected, 0.0),
        _ => (corrected, (1.0 - courant2) * h * h * (c2 * h * h * (4.0 - courant2) / 360.0 + kappa2 / 6.0)),
    }
}

/// The partial of the scheme itself: with the eigenvalue −s of D_xx, s = (4/h²) sin²(βh/2), the update reads
/// (1 + σ₀k) z² = (2 − k²(c²s + κ₂²s² + κ₆s³) − 2σ₁ks) z − (1 − σ₀k − 2σ₁ks).
fn discrete(string: &PlainString, stencil: &str, beta: f64, h: f64) -> Partial {
    let k = 1.0 / string.sample_rate;
    let (fourth, sixth) = stiffness(string, stencil, h);
    let s = (2.0 / h * (beta * h / 2.0).sin()).powi(2);
    let stiffness = string.c_squared() * s + fourth * s * s + sixth * s * s * s;
    let loss = 2.0 * string.loss_1 * k * s;
    let scale = 1.0 + string.loss_0 * k;
    let p = (2.0 - k * k * stiffness - loss) / scale;
    Partial::from_recurrence(p, -(1.0 - string.loss_0 * k - loss) / scale, k)
}

fn cents(ratio: f64) -> f64 {
    1200.0 * ratio.log2()
}

#[test]
fn partials_of_a_stiff_lossy_string() {
    let string = &LOW_E;
    let k = 1.0 / string.sample_rate;
    let mut near_4_khz = Vec::new();
    for stencil in STENCILS {
        let h = string.released(stencil, |_| 0.0, "").string(0).model.grid.spacing;
        for mode in [1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 43.0] {
            let beta = mode * PI / string.length;
            let got = measure(string, stencil, mode);

            // The scheme's own partials: only rounding and the fit are between them.
            let scheme = discrete(string, stencil, beta, h);
            let (off, decay_off) = (got.frequency / scheme.frequency - 1.0, got.decay / scheme.decay - 1.0);
            assert!(off.abs() < 1e-10, "{stencil}, mode {mode}: {got:?} instead of {scheme:?}");
            assert!(decay_off.abs() < 1e-9, "{stencil}, mode {mode}: {got:?} instead of {scheme:?}");

            // Those of the differential equation, with the leading errors predicted: s = β²(1 − (βh)²/12 + …)
            // and (2/k²)(1 − cos ωk) = ω²(1 − (ωk)²/12 + …). What is left out begins with terms in
            // (βh)⁴: 1/360 in s and at most 1/72 from κ₂² s², and half of that in ω.
            let omega = string.frequency(beta);
            let decay = string.loss_0 + string.loss_1 * beta * beta;
            let exact = (omega * omega - decay * decay).sqrt();
            let (fourth, sixth) = stiffness(string, stencil, h);
            let (c2, kappa2) = (string.c_squared(), string.kappa_squared());
            let leading = (omega.powi(4) * k * k / 12.0
                - (c2 * beta.powi(4) / 12.0 + kappa2 * beta.powi(6) / 6.0) * h * h
                + (fourth - kappa2) * beta.powi(4)
                + sixth * beta.powi(6))
                / (2.0 * omega * omega)
                + 0.5 * k * string.loss_1 * beta * beta;
            let remainder = (beta * h).powi(4);
            let error = got.frequency / exact - 1.0;
            assert!(
                (error - leading).abs() < remainder / 120.0 + 1e-9,
                "{stencil}, mode {mode}: off by {error:e}, predicted {leading:e}"
            );

            // Decay likewise: σ₁s for σ₁β², and kσ₁β² of the whole from taking σ₁ at the step before.
            let slower = string.loss_1 * beta * beta * (k - (beta * h).powi(2) / 12.0 / decay);
            let decay_error = got.decay / decay - 1.0;
            assert!(
                (decay_error - slower).abs() < remainder / 360.0 + 1e-9,
                "{stencil}, mode {mode}: decay off by {decay_error:e}, predicted {slower:e}"
            );
            println!(
                "{stencil:9} mode {mode:2}: {:7.2} Hz, scheme's {off:8.1e}, exact {:8.4} cents (predicted {:8.4}); \
                 decay {:.4}/s, scheme's {decay_off:8.1e}, exact {decay_error:8.1e}",
                got.frequency / 2.0 / PI,
                cents(1.0 + error),
                cents(1.0 + leading),
                got.decay
            );
            if mode == 43.0 {
                near_4_khz.push(cents(1.0 + error));
            }
        }
    }
    // What the three stencils are worth on a real string, 3957 Hz at a sample rate of 48 kHz.
    for (got, expected) in near_4_khz.iter().zip([-31.7, -12.2, -0.9]) {
        assert!((got - expected).abs() < 0.1, "{near_4_khz:?} cents near 4 kHz");
    }
}

/// What `docs/formats.md` says of the decay of high partials, which no stencil mends: the string of its example at 44.1 kHz.
#[test]
fn high_partials_ring_longer_than_their_losses_say() {
    let string = PlainString {
        sample_rate: 44_100.0,
        length: 0.65,
        linear_density: 5.25e-3,
        tension: 60.0,
        youngs_modulus: 2e11,
        core_radius: 4.3e-4,
        loss_0: 1.38,
        loss_1: 1.25e-4,
    };
    // (The grid of the last is coarser.)
    for (stencil, percent) in STENCILS.into_iter().zip([[2.1, 6.4, 18.3], [2.1, 6.4, 18.3], [2.6, 8.1, 23.6]])
    {
        for (hertz, longer) in [2.3e3, 4.3e3, 8.7e3].into_iter().zip(percent) {
            // The partial next to that frequency.
            let mode = (1..)
                .map(f64::from)
                .find(|mode| string.frequency(mode * PI / string.length) > 2.0 * PI * hertz)
                .expect("frequencies rise for ever");
            let beta = mode * PI / string.length;
            let got = measure(&string, stencil, mode);
            let found = 100.0 * ((string.loss_0 + string.loss_1 * beta * beta) / got.decay - 1.0);
            println!("{stencil:9} {hertz} Hz: {found:.2} % longer");
            assert!((found - longer).abs() < 0.06, "{stencil}, {hertz} Hz: {found} % and not {longer} %");
        }
    }
}

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
