//! The promise: a string falls asleep when it is silent, and nobody hears that it ever slept.

use low_action_dsp::{EngineSettings, Gesture, Instrument, Quality, Setup, Stencil, TimedGesture, Touch};
use low_action_tests::numbers::{largest, largest_step};
use low_action_tests::stage::{at_the_bridge, peak};

const RATE: f64 = 48_000.0;
/// Energy at which a string falls asleep, J, as the documentation states it.
const SILENCE: f64 = 1e-20;
const LIVE: EngineSettings = EngineSettings {
    sample_rate: RATE,
    widest_spacing: f64::INFINITY,
    stencil: Stencil::Wide,
    max_iterations: 20,
    tolerance: 1e-12,
};
/// A finger so far above the string that it never touches it, but whose string has no time to sleep.
const HOVERING: Touch = Touch { mass: 5e-3, stiffness: 1e7, exponent: 2.0, damping: 0.0, hand_damping: 0.0 };
/// The second pluck, by when a damped string has long been silent.
const AGAIN: u64 = 6 * RATE as u64;

/// The highest string of an instrument alone, at a bridge that stands still, lossy enough to fall silent within seconds.
fn setup(name: &str) -> Setup {
    let mut setup = at_the_bridge(&Setup::builtin(name).expect("built in"));
    setup.string.truncate(1);
    setup.string[0].loss_0 = 20.0;
    setup
}

/// Two plucks; returns the sound, and whether the string was at rest just before the second.
fn play(setup: &Setup, watched: bool) -> (Vec<f32>, bool) {
    let mut instrument = Instrument::new(setup, &LIVE).expect("it can be built");
    let mut at = |time, gesture| {
        instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
    };
    if watched {
        at(0, Gesture::Place { finger: 3, touch: HOVERING, position: 0.1, clearance: 0.05 });
    }
    for time in [0, AGAIN] {
        at(time, Gesture::Pluck { position: 0.5, force: 0.5, duration: 0.003, release: 0.0 });
    }
    let length = AGAIN as usize + 24_000;
    let (mut left, mut right) = (vec![0.0; length], vec![0.0; length]);
    let (before, after) = left.split_at_mut(AGAIN as usize);
    let (right_before, right_after) = right.split_at_mut(AGAIN as usize);
    instrument.process(before, right_before);
    let still = instrument.state(0).displacement().all(|u| u == 0.0);
    instrument.process(after, right_after);
    (left, still)
}

#[test]
fn a_string_that_slept_sounds_like_one_that_never_did() {
    for name in ["electric", "classical"] {
        let setup = setup(name);
        let (slept, was_still) = play(&setup, false);
        let (awake, was_awake_still) = play(&setup, true);
        assert!(was_still && !was_awake_still, "{name}: one sleeps, the other does not");
        // What is left of the motion when it falls asleep. Its energy bounds the speed of any point by
        // √(2𝔥/(ρh)) and the force on the bridge by that times the wave impedance, twice over at a fixed end;
        // linear superposition carries it on unchanged, and h is at least 5 mm for this string.
        let string = &setup.string[0];
        let instrument = Instrument::new(&setup, &LIVE).expect("it can be built");
        let model = instrument.model(0);
        let speed = (2.0 * SILENCE / (string.linear_density * model.grid.spacing)).sqrt();
        let impedance = instrument.geometry(0).wave_impedance;
        // A coil's resonance raises it by its quality, 2.
        let signal = if name == "electric" { 2.0 * speed } else { 2.0 * impedance * speed };
        let bound = setup.gain * string.level * signal;
        let peak = peak(&awake);
        assert!(bound < 1e-6 * peak, "{name}: the bound says something: {bound} of {peak}");
        let difference = largest(slept.iter().zip(&awake).map(|(a, b)| (a - b).abs()));
        println!("{name}: at most {difference:e} apart, {bound:e} allowed, peak {peak:e}");
        assert!(difference <= bound, "{name}: {difference} apart, {bound} allowed");
    }
}

/// A push so short that the step in which it wakes the string is also its last moves it nevertheless.
#[test]
fn a_pluck_of_a_microsecond_wakes_a_silent_string() {
    let pluck = Gesture::Pluck { position: 0.5, force: 10.0, duration: 1e-6, release: 0.0 };
    for name in ["electric", "classical"] {
        let [asleep, awake] = [false, true].map(|watched| {
            let mut instrument = Instrument::new(&setup(name), &LIVE).expect("it can be built");
            let hovering = Gesture::Place { finger: 3, touch: HOVERING, position: 0.1, clearance: 0.05 };
            for gesture in [watched.then_some(hovering), Some(pluck)].into_iter().flatten() {
                let event = TimedGesture { time: 0, string: 0, gesture };
                instrument.schedule(event).expect("there is room");
            }
            let (mut left, mut right) = (vec![0.0; 4800], vec![0.0; 4800]);
            instrument.process(&mut left, &mut right);
            left
        });
        let peak = peak(&awake);
        assert!(peak > 0.0, "{name}: it sounds under a finger that hovers");
        let difference = largest(asleep.iter().zip(&awake).map(|(a, b)| (a - b).abs()));
        println!("{name}: at most {difference:e} apart, peak {peak:e}");
        assert!(difference <= 1e-6 * peak, "{name}: {difference} apart, peak {peak}");
    }
}

#[test]
fn what_is_reset_is_silent() {
    let mut instrument = Instrument::new(&setup("electric"), &LIVE).expect("it can be built");
    assert!(instrument.is_silent(), "nobody has played yet");
    let pluck = Gesture::Pluck { position: 0.5, force: 0.5, duration: 0.003, release: 0.0 };
    for time in [0, 10_000] {
        instrument.schedule(TimedGesture { time, string: 0, gesture: pluck }).expect("there is room");
    }
    assert!(!instrument.is_silent(), "a pluck is to come");
    let (mut left, mut right) = (vec![0.0; 4800], vec![0.0; 4800]);
    instrument.process(&mut left, &mut right);
    assert!(!instrument.is_silent(), "it rings");
    instrument.reset();
    assert!(instrument.is_silent(), "it has been reset");
    instrument.process(&mut left, &mut right);
    assert!(left.iter().chain(&right).all(|sample| *sample == 0.0), "nothing of it is left");
}

#[test]
fn asleep_is_silent_and_wakes_at_the_gesture() {
    let (sound, _) = play(&setup("electric"), false);
    let before = &sound[AGAIN as usize - 4800..AGAIN as usize];
    assert!(before.iter().all(|sample| *sample == 0.0), "it sleeps without a sound");
    // The pluck grows as a raised cosine: no click where it begins.
    let first = largest_step(&sound[AGAIN as usize - 1..AGAIN as usize + 24]);
    let later = largest_step(&sound[AGAIN as usize..AGAIN as usize + 4800]);
    assert!(first < 0.2 * later, "{first} at first, {later} later");
}

/// Strings over a body, three steps in two samples: all sleep once the last is quiet, and the sound of the next pluck is that of an
/// instrument that has never been played, whichever of two samples it comes with.
#[test]
fn strings_over_a_body_sleep_and_wake_together() {
    let mut setup = Setup::builtin("steel").expect("built in");
    setup.string.iter_mut().for_each(|string| string.loss_0 = 20.0);
    let settings = Quality::Live.settings(RATE);
    let pluck = Gesture::Pluck { position: 0.5, force: 0.5, duration: 0.003, release: 0.0 };
    let play = |instrument: &mut Instrument, string: usize, wait: u64, samples: usize| {
        let time = instrument.now() + wait;
        instrument.schedule(TimedGesture { time, string, gesture: pluck }).expect("there is room");
        let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
        instrument.process(&mut left, &mut right);
        left
    };
    // (They come to rest after whole runs of samples: an odd number before these has them do so between the two of a pair.)
    for (samples, wait) in [(12_000, 0), (12_001, 0), (12_000, 1), (12_001, 1)] {
        let mut instrument = Instrument::new(&setup, &settings).expect("it can be built");
        assert_eq!(instrument.ratio(5).halves(), 3, "it has three steps in two samples");
        play(&mut instrument, 5, 0, samples);
        let moves = |string| instrument.state(string).motion().any(|motion| motion != 0.0);
        assert!((0..6).all(moves), "all hear the lowest");
        play(&mut instrument, 0, 0, 4 * 48_000);
        assert!(instrument.is_silent(), "all sleep");
        let mut other = Instrument::new(&setup, &settings).expect("it can be built");
        let [slept, fresh] = [&mut instrument, &mut other].map(|it| play(it, 3, wait, 9_600));
        assert!(peak(&slept) > 1e-3 && slept == fresh, "{samples} samples, {wait}");
    }
}
