//! How strings and bridge move one another.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::curve::Curve;
use crate::drive::Push;
use crate::instructions::Instructions;
use crate::pickup::bridge_force;

/// A partial that moves as sin(nπx/L) sends T nπ/L to the bridge, which answers with Y: it dies away at 2 f₁ Z Re Y, and is off by
/// −f₁ Z Im Y/π, both to first order in Z|Y|, here below 1e-2.
#[test]
fn partials_die_away_and_move_as_the_admittance_says() {
    let description = Description { mass: 1.0, ..GUITAR };
    let model = low_string(Stencil::Wide);
    let (tension, density, length) = (model.string.tension, model.string.linear_density, model.string.length);
    let impedance = (tension * density).sqrt();
    let fundamental = (tension / density).sqrt() / (2.0 * length);
    for partial in [1, 2, 3, 5, 8] {
        let flexible = StringParameters { youngs_modulus: 0.0, tension_modulation: false, ..model.string };
        let model = Model::new(flexible, None, 0, model.settings, 48_000.0).expect("it can be");
        let mut pair = Pair::new(model, &description);
        let wave = PI * f64::from(partial) / length;
        let points = (0..=400).map(|i| length * f64::from(i) / 400.0);
        let shape = points.map(|x| [x, 1e-6 * libm::sin(wave * x)]).collect();
        pair.state.set_shape(&pair.model, &Curve::Points(shape));
        pair.state.let_go(&pair.model, &pair.drive);
        // The partial as it turns: its displacement and its velocity over 2πf.
        let frequency = fundamental * f64::from(partial);
        let mut turned = |samples: usize| {
            (0..samples).for_each(|_| _ = pair.step());
            let sum = |values: &mut dyn Iterator<Item = f64>| {
                values
                    .enumerate()
                    .map(|(i, u)| u * libm::sin(wave * (i + 1) as f64 * pair.model.grid.spacing))
                    .sum()
            };
            let (now, motion): (f64, f64) =
                (sum(&mut pair.state.displacement()), sum(&mut pair.state.motion()));
            let half = PI * frequency * pair.model.grid.time_step;
            // Half a step ago the displacement was u − d/2 over cos, the velocity d over 2 sin.
            [(now - 0.5 * motion) / libm::cos(half), 0.5 * motion / libm::sin(half)]
        };
        let (settle, samples) = (24_000, 96_000);
        let [a, b] = turned(settle);
        let [c, d] = turned(samples);
        let seconds = samples as f64 / 48_000.0;
        let decay = -0.5 * libm::log((c * c + d * d) / (a * a + b * b)) / seconds;
        let turn = libm::atan2(-d, c) - libm::atan2(-b, a) - TAU * frequency * seconds;
        let off = (turn - TAU * (turn / TAU).round()) / seconds / TAU;
        let omega = TAU * frequency;
        let (mut real, mut imaginary) = (0.0, 0.0);
        for mode in description.modes() {
            let own = TAU * mode.frequency;
            let (x, y) = (own * own - omega * omega, omega * own / mode.quality);
            let size = omega * mode.bridge * mode.bridge / (x * x + y * y);
            (real, imaginary) = (real + size * y, imaginary + size * x);
        }
        let (lost, moved) = (2.0 * fundamental * impedance * real, -fundamental * impedance * imaginary / PI);
        assert!((decay / lost - 1.0).abs() < 0.05, "partial {partial}: {decay} and not {lost} 1/s");
        assert!(
            (off - moved).abs() < 0.05 * moved.abs() + 0.002,
            "partial {partial}: {off} and not {moved} Hz"
        );
    }
}

/// What a piezo hears does not depend on the rate: the force is that of a string whose end has moved, not of one whose end is where it
/// was. (Compared in what is low enough for both grids, by its mean square under a low-pass of 2 kHz.)
#[test]
fn the_force_on_a_bridge_that_gives_way_is_known() {
    let force = |rate: f64| {
        let mut pair = Pair::new(low_string_at(Stencil::Wide, rate), &Description { mass: 0.05, ..GUITAR });
        let bump = (0..=40).map(|i| [0.2 + 0.005 * f64::from(i), 1e-4 * libm::sin(PI * f64::from(i) / 40.0)]);
        let shape = std::iter::once([0.0, 0.0]).chain(bump).chain([[0.65, 0.0]]).collect();
        pair.state.set_shape(&pair.model, &Curve::Points(shape));
        pair.state.let_go(&pair.model, &pair.drive);
        let (mut low, mut sum) = (0.0, 0.0);
        for _ in 0..(0.3 * rate) as usize {
            pair.step();
            let heard = bridge_force(&pair.model, &pair.scratch, pair.heard.lift);
            low += (heard - low) * (1.0 - libm::exp(-TAU * 2000.0 / rate));
            sum += low * low;
        }
        (sum / (0.3 * rate)).sqrt()
    };
    let [coarse, fine] = [48_000.0, 192_000.0].map(force);
    assert!((coarse / fine - 1.0).abs() < 0.01, "{coarse} and {fine} N");
}

/// A body that comes under a string that is pressed begins where the string holds it, however light it is.
#[test]
fn a_body_begins_where_the_string_holds_it() {
    for mass in [0.2, 0.012] {
        let description = Description { frequency: 30.0, mass, spacing: 1000.0, ..GUITAR };
        let mut pair = Pair::new(low_string(Stencil::Wide), &description);
        let push = Push { reading: pair.model.grid.reading(0.5), force: -1.0 };
        pair.drive.loss = 300.0;
        for _ in 0..48_000 {
            pair.drive.pushes.push(push);
            pair.state.step(&pair.model, &pair.drive, &mut pair.scratch);
            pair.drive.pushes.clear();
        }
        let tension = pair.drive.tension;
        pair.body.take_over(None, &pair.model, tension);
        let end = pair.body.end;
        pair.body.rest_under(end.force(&pair.state, 0.0) / (1.0 + pair.body.gives() * end.back));
        let begins = pair.body.lift();
        let mut farthest: f64 = 0.0;
        for _ in 0..48_000 {
            pair.drive.pushes.push(push);
            pair.step();
            pair.drive.pushes.clear();
            farthest = farthest.min(pair.body.lift());
        }
        let rests = pair.body.lift();
        assert!(begins < 0.0 && begins > rests, "{mass} kg: it begins at {begins} and rests at {rests} m");
        assert!(farthest > 2.0 * rests, "{mass} kg: it swings to {farthest} and rests at {rests} m");
    }
}

/// Every lane of a body that rings, beside each other and to itself, never holds a number that processors are slow with.
#[test]
fn a_body_that_fades_is_forgotten() {
    let mut pair = Pair::new(low_string(Stencil::Wide), &GUITAR);
    pair.state.set_shape(&pair.model, &Curve::Points(vec![[0.0, 0.0], [0.5, 3e-3], [0.65, 0.0]]));
    (0..4_800).for_each(|_| _ = pair.step());
    assert!(!pair.body.is_still());
    let mut steps = 0;
    while !pair.body.is_still() {
        pair.body.ring(pair.body.lift());
        steps += 1;
        let numbers = pair.body.modes.place.iter().chain(&pair.body.modes.motion).flatten();
        assert!(numbers.into_iter().all(|number| !number.is_subnormal()));
        assert!(steps < 96_000, "it comes to rest");
    }
    assert!(steps > 4_800, "it rings");
    assert_eq!(pair.body.ring(0.0), Heard::default());
}

/// Every instruction set has all modes swing by the same bits, driven and by themselves.
#[test]
fn every_instruction_set_gives_the_same_bits() {
    let run = |instructions: Instructions| {
        let mut modes = Modes::new(&GUITAR, 1.0 / 48_000.0);
        modes.instructions = instructions;
        let force = |step: i32| if step < 500 { libm::sin(0.03 * f64::from(step * step)) } else { 0.0 };
        let heard = (0..2_000).map(|step| [modes.swing(force(step)), modes.lift()].map(f64::to_bits));
        heard.collect::<Vec<_>>()
    };
    let expected = run(Instructions::Any);
    for instructions in Instructions::all() {
        assert!(run(instructions) == expected, "{instructions:?}");
    }
}
