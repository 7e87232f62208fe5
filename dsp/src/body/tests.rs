use std::f64::consts::{PI, TAU};

use super::*;
use crate::curve::Curve;
use crate::drive::Drive;
use crate::energy::Ledger;
use crate::model::StringParameters;
use crate::scene::{SolverSettings, Stencil};
use crate::setup::Setup;
use crate::string::Scratch;

/// As a classical guitar may have it.
const GUITAR: Description = Description {
    frequency: 170.0,
    mass: 0.1,
    area: 0.05,
    quality: 20.0,
    spacing: 50.0,
    volume: 0.0145,
    hole: 0.0055,
};

/// The low E of nylon, without losses of its own; with room for a body.
fn low_string(stencil: Stencil) -> Model {
    let string = StringParameters {
        length: 0.65,
        linear_density: 6.24e-3,
        tension: 71.6,
        tension_limit: 71.6 * 1.06 * (1.0 + ROOM),
        youngs_modulus: 2.234e10,
        core_radius: 2.387e-4,
        loss_0: 0.0,
        loss_1: 0.0,
        tension_modulation: true,
    };
    let settings = SolverSettings { stencil, ..SolverSettings::default() };
    Model::new(string, None, 0, settings, 48_000.0).expect("it can be")
}

/// A string over a body, its ledger, and what moves with both.
struct Pair {
    model: Model,
    state: State,
    scratch: Scratch,
    drive: Drive,
    ledger: Ledger,
    body: Body,
}

impl Pair {
    fn new(model: Model, description: &Description) -> Self {
        let body = Body::new(description, &model).expect("it can be");
        let state = State::new(&model);
        let (scratch, drive) = (Scratch::new(&model), Drive::new(&model));
        let ledger = Ledger::new(&model, &state, model.string.tension);
        Pair { model, state, scratch, drive, ledger, body }
    }

    /// One step, and what string and body hold together half a step before its end, J.
    fn step(&mut self) -> f64 {
        let Pair { model, state, scratch, drive, ledger, body } = self;
        let End { reading, pull, back, .. } = body.end;
        let (before, string_before) = (body.bridge, reading.of(&state.displacement));
        let push = body.step(model, state, drive.tension);
        drive.pushes.push(push);
        state.step(model, drive, scratch);
        let entry = ledger.record(model, state, scratch, drive);
        drive.pushes.clear();
        let (after, string_after) = (body.bridge, reading.of(&state.displacement));
        let between =
            -0.5 * pull * (after * string_before + before * string_after) + 0.5 * back * before * after;
        entry.energies.total() + body.energy() + between
    }
}

/// What a string loses at a bridge that gives way the body has, to the last digits, for every stencil; what rings in wood and air
/// is lost, and nothing is ever won.
#[test]
fn nothing_is_lost_between_string_and_body() {
    for stencil in [Stencil::Paper, Stencil::Corrected, Stencil::Wide] {
        let keeping = Description { quality: 1e15, ..GUITAR };
        for (description, keeps) in [(keeping, true), (GUITAR, false)] {
            let mut pair = Pair::new(low_string(stencil), &description);
            let shape = Curve::Points(vec![[0.0, 0.0], [0.5, 3e-3], [0.65, 0.0]]);
            pair.state.set_shape(&pair.model, &shape);
            let first = pair.step();
            let (mut least, mut most, mut last) = (first, first, first);
            for _ in 0..48_000 {
                let energy = pair.step();
                assert!(keeps || energy <= last * (1.0 + 1e-12), "it grew: {last} to {energy} J");
                (least, most, last) = (least.min(energy), most.max(energy), energy);
            }
            // 48,000 roundings of sums over some 200 points and 50 modes.
            let lost = (most - least) / first;
            assert!(if keeps { lost < 1e-11 } else { last < 0.8 * first }, "{stencil:?}: {lost}");
        }
    }
}

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

/// Bodies that come with the program take a part of the room that grids leave for them.
#[test]
fn guitars_leave_room() {
    let names = Setup::BUILTIN.into_iter().chain(Setup::PRESETS);
    let mut most: f64 = 0.0;
    for setup in names.filter_map(Setup::shipped) {
        let Some(description) = &setup.body else { continue };
        for spec in &setup.string {
            let string = crate::intonation::flexible(&setup, spec);
            for rate in [22_050.0, 48_000.0, 96_000.0] {
                let model = Model::new(string, None, 0, SolverSettings::default(), rate).expect("it can be");
                let body = Body::new(description, &model).expect("there is room");
                most = most.max(body.room_taken(&model));
            }
        }
    }
    assert!(most > 0.0 && most < 0.1, "they take {most} of it");
}
