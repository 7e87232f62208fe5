//! Promise: how long a pluck takes to let go is its tone. Each partial has of it what the push has of its frequency: all of them
//! of a plectrum, the fewer high ones the longer flesh takes to slip off. Pitch stays.

use low_action::engine::{Engine, EngineOptions};
use low_action::performance::{InputMode, PlayerEvent, VELOCITY_CURVE};
use low_action_dsp::{Scene, Setup, Simulation};
use low_action_tests::numbers::{brightness, rms};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{decibels, hertz};
use std::f64::consts::PI;

const LENGTH: f64 = 0.65;
const RATE: f64 = 96_000.0;
/// How long the push grows, s.
const DURATION: f64 = 2e-3;

/// Amplitudes of the first twelve partials after a pluck of a string without losses, and how far each turns in a sample. The
/// pluck is at 7/40 of the string, where none of them has a node.
fn partials(release: f64) -> Vec<(f64, f64)> {
    let text = format!(
        "sample_rate = {RATE:?}\nduration = 1.0\n[[string]]\nlength = {LENGTH}\nlinear_density = 5.25e-3\ntension = 60.0\n\
         [[pluck]]\nposition = {:?}\nforce = 1.0\nduration = {DURATION:?}\nrelease = {release:?}\n",
        LENGTH * 7.0 / 40.0
    );
    let mut simulation =
        Simulation::new(&Scene::from_toml(&text).expect("it is valid")).expect("it can be built");
    let places: Vec<f64> = simulation.string(0).places().collect();
    let mut shapes = Vec::new();
    let over = ((DURATION + release) * RATE) as usize + 2;
    for step in 0..over + 3 {
        simulation.step();
        if step >= over {
            shapes.push(simulation.string(0).state.displacement().collect::<Vec<f64>>());
        }
    }
    let partial = |n: u32| {
        let [before, now, after] = [0, 1, 2].map(|moment: usize| {
            let parts = shapes[moment].iter().zip(&places);
            parts.map(|(u, x)| u * (f64::from(n) * PI * x / LENGTH).sin()).sum::<f64>()
        });
        // What swings as A cos(θn + φ) has, at three samples, u₋ + u₊ = 2 cos θ u.
        let turn = (0.5 * (before + after) / now).acos();
        let square = (now * now + after * after - 2.0 * now * after * turn.cos()) / turn.sin().powi(2);
        (square.sqrt(), turn)
    };
    (1..=12).map(partial).collect()
}

/// What a push has of a frequency: |∫ f e^(−iωt) dt|, by Simpson's rule in a thousand parts of each half.
fn content(release: f64, omega: f64) -> f64 {
    let growing = |time: f64| 0.5 * (1.0 - (PI * time / DURATION).cos());
    let falling = |time: f64| 0.5 * (1.0 + (PI * (time - DURATION) / release).cos());
    let integral = |from: f64, length: f64, push: &dyn Fn(f64) -> f64, wave: &dyn Fn(f64) -> f64| {
        let parts = 1000;
        let width = length / f64::from(parts);
        let weight = |i| match i {
            0 => 1.0,
            i if i == parts => 1.0,
            i if i % 2 == 1 => 4.0,
            _ => 2.0,
        };
        let at = |i: i32| from + f64::from(i) * width;
        (0..=parts).map(|i| weight(i) * push(at(i)) * wave(omega * at(i))).sum::<f64>() * width / 3.0
    };
    let parts = [f64::cos as fn(f64) -> f64, f64::sin].map(|wave| {
        let grows = integral(0.0, DURATION, &growing, &wave);
        if release > 0.0 { grows + integral(DURATION, release, &falling, &wave) } else { grows }
    });
    parts[0].hypot(parts[1])
}

#[test]
fn partials_have_of_a_pluck_what_its_push_has_of_their_frequencies() {
    let sharp = partials(0.0);
    for release in [1e-4, 5e-4, 1e-3, 2e-3] {
        for (n, ((soft, turn), (hard, _))) in partials(release).into_iter().zip(&sharp).enumerate() {
            let omega = turn * RATE;
            let (found, expected) = (soft / hard, content(release, omega) / content(0.0, omega));
            println!("{release} s, partial {}: {found:.5}, {expected:.5}", n + 1);
            // What ends at once folds back from the rate: (f/rate)² of it, 1e-4 at 1 kHz, beside pushes that have little left.
            assert!((found - expected).abs() < 5e-4, "{release} s, partial {}: {found}, {expected}", n + 1);
        }
    }
}

/// Left channel of a second of an open string, let go of so slowly.
fn note(instrument: &str, string: u8, release: f64) -> Vec<f32> {
    let mut setup = Setup::builtin(instrument).expect("it is built in");
    setup.player.pluck_release = release;
    // The hardest there is takes just that, and is no harder than velocity 89 so.
    setup.player.pluck_force *= 0.7_f64.powf(VELOCITY_CURVE);
    let key = setup.string[usize::from(string)].pitch as u8;
    let options = EngineOptions { variation: 0.0, ..EngineOptions::new(setup, 48_000.0) };
    let mut engine = Engine::new(&options).expect("it can be built");
    engine.set_input(InputMode::Strings { first: 0, from_last: false });
    engine.event(0, PlayerEvent::NoteOn { channel: string, key, velocity: 1.0 });
    let (mut left, mut right) = (vec![0.0; 48_000], vec![0.0; 48_000]);
    engine.process(&mut left, &mut right);
    left
}

#[test]
fn the_longer_it_takes_the_softer_the_tone() {
    for (instrument, string) in [("electric", 1), ("electric", 5), ("classical", 2), ("bass", 0)] {
        let mut last: Option<(f64, f64)> = None;
        for release in [0.0, 5e-4, 1e-3, 2e-3, 4e-3] {
            let sound = note(instrument, string, release);
            let setup = Setup::builtin(instrument).expect("it is built in");
            let expected = hertz(setup.string[usize::from(string)].pitch);
            let off = cents(frequency_near(&sound[9600..], 48_000.0, expected), expected);
            let (bright, level) = (brightness(&sound[960..12_000]), rms(&sound[960..12_000]));
            println!(
                "{instrument} {string}, {release} s: {bright:.4}, {:.1} dB, {off:.2} cents",
                decibels(level)
            );
            if let Some((brighter, pitch)) = last {
                assert!(bright < brighter, "{instrument} {string}, {release} s: {bright}, before {brighter}");
                assert!(
                    (off - pitch).abs() < 1.5,
                    "{instrument} {string}, {release} s: {off} cents, before {pitch}"
                );
            }
            last = Some((bright, off));
        }
    }
}
