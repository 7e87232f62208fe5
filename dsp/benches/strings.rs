//! How long strings take, as time per sample of one string.
//!
//! The chord is the measure of the whole: all six strings of the default instrument fretted and ringing,
//! `live` at 48 kHz. At T ns a string-sample six strings run 1e9/(48000·6·T) times faster than real time.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use low_action_dsp::drive::Push;
use low_action_dsp::{
    Drive, EngineSettings, Gesture, Instrument, Model, Scratch, Setup, SolverSettings, State, Stencil,
    StringParameters, TimedGesture,
};

const RATE: f64 = 48_000.0;
/// `live`, as the renderer and the plugin have it.
const LIVE: EngineSettings =
    EngineSettings { sample_rate: RATE, stencil: Stencil::Wide, max_iterations: 20, tolerance: 1e-12 };
/// Samples of one measurement: a tenth of a second.
const SAMPLES: usize = 4800;

/// Six strings fretted and plucked, as they ring from 0.1 s on.
fn chord() -> Instrument {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument = Instrument::new(&setup, &LIVE).expect("it can be built");
    let player = &setup.player;
    for string in 0..instrument.string_count() {
        let geometry = instrument.geometry(string).clone();
        let position = geometry.finger_position(3 + string % 3);
        let touch = player.fretting.touch;
        let away = geometry.length - player.pluck_position;
        let force = 0.6 * player.pluck_force;
        for gesture in [
            Gesture::Place { finger: 0, touch, position, clearance: player.fretting.hover },
            Gesture::Press { finger: 0, force: player.fretting.force, duration: player.fretting.landing },
            Gesture::Pluck { position: away, force, duration: player.pluck_duration },
        ] {
            instrument.schedule(TimedGesture { time: 0, string, gesture }).expect("there is room");
        }
    }
    let (mut left, mut right) = (vec![0.0; SAMPLES], vec![0.0; SAMPLES]);
    instrument.process(&mut left, &mut right);
    instrument
}

/// A low E string alone, plucked, with nothing to touch.
fn free_string(stencil: Stencil, tension_modulation: bool) -> (Model, State, Scratch, Drive) {
    let string = StringParameters {
        length: 0.6477,
        linear_density: 6.8246e-3,
        tension: 77.8,
        tension_limit: 110.0,
        youngs_modulus: 2.07e11,
        core_radius: 2.286e-4,
        loss_0: 0.285,
        loss_1: 5.38e-4,
        tension_modulation,
    };
    let settings = SolverSettings { stencil, ..SolverSettings::default() };
    let model = Model::new(string, None, 0, settings, RATE).expect("it can be built");
    let (mut state, mut scratch, mut drive) = (State::new(&model), Scratch::new(&model), Drive::new(&model));
    drive.pushes.push(Push { reading: model.grid.reading(0.5), force: 1.0 });
    for _ in 0..70 {
        state.step(&model, &drive, &mut scratch);
    }
    drive.pushes.clear();
    (model, state, scratch, drive)
}

fn strings(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("string-sample");
    group.sample_size(20);
    group.throughput(Throughput::Elements(6 * SAMPLES as u64));
    let ringing = chord();
    group.bench_function("chord: six fretted strings ringing, live, 48 kHz", |bencher| {
        let (mut left, mut right) = (vec![0.0f32; SAMPLES], vec![0.0f32; SAMPLES]);
        bencher.iter_batched_ref(
            || ringing.clone(),
            |instrument| instrument.process(black_box(&mut left), black_box(&mut right)),
            criterion::BatchSize::LargeInput,
        );
    });
    group.throughput(Throughput::Elements(SAMPLES as u64));
    for (name, stencil, stretch) in [
        ("free low E, wide, tension modulation", Stencil::Wide, true),
        ("free low E, wide", Stencil::Wide, false),
        ("free low E, paper", Stencil::Paper, false),
    ] {
        let start = free_string(stencil, stretch);
        group.bench_function(name, |bencher| {
            bencher.iter_batched_ref(
                || start.clone(),
                |(model, state, scratch, drive)| {
                    for _ in 0..SAMPLES {
                        state.step(model, drive, scratch);
                    }
                    black_box(state.displacement()[0])
                },
                criterion::BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, strings);
criterion_main!(benches);
