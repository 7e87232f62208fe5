//! How long strings take.
//!
//! The chord is the measure of the whole: all six strings of the default instrument fretted and ringing. At
//! T ns a string-sample six strings run 1e9/(rate·6·T) times faster than real time. The single strings are a low
//! E at 48 kHz with one grid, from a copy of its arrays over the shortest linear string that can be written
//! to the whole model; their ratios are what other machines will find too. What the chord sounds like is checked in the same run.
//! `cargo xtask measure speed` runs all this and makes the table of docs/speed.md.

mod workloads;

use std::hint::black_box;

use criterion::{BatchSize, BenchmarkGroup, Criterion, Throughput, criterion_group};
use low_action_dsp::{Instrument, Stencil};
use workloads::{Bare, ByHand, Linear, OneString, SAMPLES, Steps, chord, over_frets, silent, strings_of};

/// Runs an instrument for [`SAMPLES`] samples.
fn play(
    group: &mut BenchmarkGroup<'_, criterion::measurement::WallTime>,
    name: &str,
    instrument: &Instrument,
) {
    group.throughput(Throughput::Elements((instrument.string_count() * SAMPLES) as u64));
    group.bench_function(name, |bencher| {
        let (mut left, mut right) = (vec![0.0f32; SAMPLES], vec![0.0f32; SAMPLES]);
        bencher.iter_batched_ref(
            || instrument.clone(),
            |instrument| instrument.process(black_box(&mut left), black_box(&mut right)),
            BatchSize::LargeInput,
        );
    });
}

/// Steps one string for [`SAMPLES`] samples.
fn step(group: &mut BenchmarkGroup<'_, criterion::measurement::WallTime>, name: &str, string: &OneString) {
    step_by(group, name, string, 1);
}

/// The same, measured by so many things a sample.
fn step_by(
    group: &mut BenchmarkGroup<'_, criterion::measurement::WallTime>,
    name: &str,
    string: &OneString,
    things: usize,
) {
    group.throughput(Throughput::Elements((things * SAMPLES) as u64));
    group.bench_function(name, |bencher| {
        bencher.iter_batched_ref(|| string.clone(), OneString::run, BatchSize::LargeInput);
    });
}

/// What is written by hand moves as the free string does, but for rounding.
fn assert_same_motion(free: &OneString, by_hand: &ByHand) {
    let (mut free, mut by_hand) = (free.clone(), by_hand.clone());
    free.run();
    by_hand.run();
    let points = free.displacement();
    let largest = points.iter().fold(0.0, |most: f64, point| most.max(point.abs()));
    for (point, by_hand) in points.iter().zip(by_hand.displacement()) {
        assert!((point - by_hand).abs() < 1e-9 * largest, "{by_hand} m by hand, and {point}");
    }
}

fn strings(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("chord");
    group.sample_size(20);
    for (name, rate, steps, expected) in [
        ("48 kHz", 48e3, Steps::Live, 0x5735_1cec),
        ("48 kHz, one step a sample", 48e3, Steps::One, 0xac27_0265),
        ("96 kHz, one step a sample", 96e3, Steps::One, 0x492e_042d),
    ] {
        let (instrument, found) = chord(rate, steps);
        // Whoever changes the physics on purpose puts in what is found.
        assert_eq!(found, expected, "chord at {name}: {found:#010x} is the checksum of another sound");
        println!("chord at {name}: its sound has the checksum {found:#010x}, as expected");
        play(&mut group, name, &instrument);
    }
    group.finish();

    let mut group = criterion.benchmark_group("string");
    group.sample_size(20);
    let free = OneString::free(48e3, Stencil::Wide);
    let fretted = OneString::fretted(48e3);
    group.throughput(Throughput::Elements(SAMPLES as u64));
    let unknowns = free.model.grid.unknowns();
    for (name, linear) in [("copy", Linear::Copied), ("bare", Linear::Stepped)] {
        let mut bare = Bare::new(unknowns);
        group.bench_function(name, |bencher| bencher.iter(|| black_box(&mut bare).run(linear)));
    }
    let by_hand = ByHand::new(&free);
    for (name, run) in
        [("linear by hand", ByHand::run_linear as fn(&mut ByHand) -> f64), ("by hand", ByHand::run)]
    {
        group.bench_function(name, |bencher| {
            bencher.iter_batched_ref(|| by_hand.clone(), run, BatchSize::LargeInput);
        });
    }
    assert_same_motion(&free, &by_hand);
    step(&mut group, "free", &free);
    step(&mut group, "free, paper stencil", &OneString::free(48e3, Stencil::Paper));
    step(&mut group, "fretted", &fretted);
    step(&mut group, "free, without vectors", &free.clone().without_vectors());
    step(&mut group, "fretted, without vectors", &fretted.without_vectors());
    group.finish();

    let mut group = criterion.benchmark_group("points");
    group.sample_size(10);
    // What is measured by its points tells `cargo xtask measure speed` how many there are.
    for khz in [48, 96, 192, 384, 768] {
        let string = OneString::free(1e3 * f64::from(khz), Stencil::Wide);
        step_by(&mut group, &format!("{khz} kHz"), &string, string.model.grid.unknowns());
    }
    group.finish();

    let mut group = criterion.benchmark_group("strings");
    group.sample_size(10);
    for count in [1, 2, 4, 6] {
        play(&mut group, &count.to_string(), &strings_of(count));
    }
    play(&mut group, "6 silent", &silent());
    group.finish();

    let mut group = criterion.benchmark_group("frets");
    group.sample_size(10);
    for count in [1, 6, 22, 100] {
        step(&mut group, &count.to_string(), &over_frets(count));
    }
    group.finish();
}

criterion_group!(benches, strings);

fn main() {
    benches();
    Criterion::default().configure_from_args().final_summary();
    println!("`cargo xtask measure speed --last` makes the table of docs/speed.md of these times");
}
