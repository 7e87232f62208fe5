//! Promise: partials have the frequency and decay of the scheme's own dispersion relation and, within the error that the
//! analysis predicts, those of the differential equation.

use std::f64::consts::PI;

use low_action_dsp::{Scene, Simulation};
use low_action_tests::pitch::cents;
use low_action_tests::plain_string::{LOW_E, PlainString, STENCILS};

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
///
/// The figures of the documentation read partials by a fit of their own (`xtask/src/figures/modes.rs`): what is checked here is
/// not to lean on what is drawn there, nor the other way round.
fn measure(string: &PlainString, stencil: &str, mode: f64) -> Partial {
    let beta = mode * PI / string.length;
    fit(string, string.released(stencil, |x| 1e-3 * (beta * x).sin(), ""), beta)
}

/// The partial of wavenumber β of such a string as it is let go.
fn fit(string: &PlainString, mut simulation: Simulation, beta: f64) -> Partial {
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

            // Decay likewise.
            let slower = faster(string.loss_1, beta, decay, k, h);
            let decay_error = got.decay / decay - 1.0;
            assert!(
                (decay_error - slower).abs() < remainder / 360.0 + 1e-9,
                "{stencil}, mode {mode}: decay off by {decay_error:e}, predicted {slower:e}"
            );
            println!(
                "{stencil:9} mode {mode:2}: {:7.2} Hz, scheme's {off:8.1e}, exact {:8.4} cents (predicted {:8.4}); \
                 decay {:.4}/s, scheme's {decay_off:8.1e}, exact {decay_error:8.1e}",
                got.frequency / 2.0 / PI,
                cents(1.0 + error, 1.0),
                cents(1.0 + leading, 1.0),
                got.decay
            );
            if mode == 43.0 {
                near_4_khz.push(cents(1.0 + error, 1.0));
            }
        }
    }
    // What the three stencils are worth on a real string, 3957 Hz at a sample rate of 48 kHz.
    for (got, expected) in near_4_khz.iter().zip([-31.7, -12.2, -0.9]) {
        assert!((got - expected).abs() < 0.1, "{near_4_khz:?} cents near 4 kHz");
    }
}

/// By how much of its decay a partial decays faster than the differential equation says, to the leading order: σ₁s for σ₁β², and
/// kσ₁β² of the whole from taking σ₁ at the step before. What is left out begins with (βh)⁴/360 and, where a decay is so fast
/// that it matters, at most 4/3 of (k · decay)².
fn faster(loss_1: f64, beta: f64, decay: f64, k: f64, h: f64) -> f64 {
    loss_1 * beta * beta * (k - (beta * h).powi(2) / 12.0 / decay)
}

/// The string has both partials at once, and one between for which nothing was asked; what is found is not that the losses are
/// those that were derived, but that the string decays as it was asked to.
#[test]
fn strings_decay_as_fast_as_they_are_asked_to() {
    let string = &LOW_E;
    let k = 1.0 / string.sample_rate;
    let [low, between, high] = [2.0, 17.0, 30.0].map(|mode| mode * PI / string.length);
    let hertz = |beta| string.frequency(beta) / (2.0 * PI);
    for times in [[9.0, 2.0], [4.0, 0.1], [1.5, 1.5]] {
        let shape: Vec<[f64; 2]> = (0..=2000)
            .map(|i| string.length * f64::from(i) / 2000.0)
            .map(|x| [x, 1e-3 * [low, between, high].map(|beta| (beta * x).sin()).iter().sum::<f64>()])
            .collect();
        let scene = |stencil: &str| {
            let PlainString {
                sample_rate, length, linear_density, tension, youngs_modulus, core_radius, ..
            } = string;
            let t60 = [[hertz(low), times[0]], [hertz(high), times[1]]];
            let text = format!(
                "sample_rate = {sample_rate:?}\nduration = 1.0\n[solver]\nstencil = {stencil:?}\n[[string]]\n\
                 length = {length:?}\nlinear_density = {linear_density:?}\ntension = {tension:?}\n\
                 youngs_modulus = {youngs_modulus:?}\ncore_radius = {core_radius:?}\nt60 = {t60:?}\nshape = {shape:?}\n"
            );
            Scene::from_toml(&text).expect("the scene is valid")
        };
        let [slow, fast] = times.map(|time| 1000_f64.ln() / time);
        let loss_1 = (fast - slow) / (high * high - low * low);
        for stencil in STENCILS {
            for beta in [low, between, high] {
                let simulation = Simulation::new(&scene(stencil)).expect("the scene can be built");
                let h = simulation.string(0).model.grid.spacing;
                let decay = slow + loss_1 * (beta * beta - low * low);
                let got = fit(string, simulation, beta).decay / decay - 1.0;
                let expected = faster(loss_1, beta, decay, k, h);
                println!(
                    "{stencil:9} {:7.2} Hz: {decay:.3}/s, off by {got:8.1e} ({expected:8.1e})",
                    hertz(beta)
                );
                assert!(
                    (got - expected).abs()
                        < (beta * h).powi(4) / 360.0 + 4.0 / 3.0 * (decay * k).powi(2) + 1e-9,
                    "{stencil}, {times:?} s, {} Hz: decay off by {got:e}, predicted {expected:e}",
                    hertz(beta)
                );
            }
        }
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
