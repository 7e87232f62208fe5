//! Promise: the same gestures give the same bits, in blocks of any size, on every run and every machine, after a reset, and
//! whether or not strings are asked for by themselves or ledgers are kept.

use low_action_dsp::{Gesture, Instrument, Quality, Scene, Setup, Simulation, TimedGesture};

const RATE: f64 = 48_000.0;
const SAMPLES: usize = 48_000;

/// A string with all that a scene can have.
const SCENE: &str = "sample_rate = 48000\nduration = 0.5\n[[string]]\nlength = 0.65\nlinear_density = 5.25e-3\n\
    tension = 60.0\nyoungs_modulus = 2e11\ncore_radius = 4.3e-4\nloss_0 = 1.0\nloss_1 = 1e-4\n\
    tension_modulation = true\n[fretboard]\nstiffness = 1e12\nexponent = 1.5\nboard = -0.002\nfrets = 12\n\
    fret_top = -0.001\n[[pluck]]\nduration = 0.002\nposition = 0.5\nforce = -3.0\n[[finger]]\nmass = 5e-3\n\
    stiffness = 1e8\nexponent = 2.0\nposition = 0.2\nheight = 1e-4\nforce = 6.0\nhand_damping = 5.0\n";

fn instrument() -> Instrument {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument = Instrument::new(&setup, &Quality::Live.settings(RATE)).expect("it can be built");
    play(&mut instrument, &setup);
    instrument
}

fn play(instrument: &mut Instrument, setup: &Setup) {
    let (finger, force) = (setup.player.fretting, setup.player.pluck_force);
    for string in 0..instrument.string_count() {
        let geometry = instrument.geometry(string).clone();
        let position = geometry.finger_position(1 + 2 * string);
        let pluck =
            Gesture::Pluck { position: geometry.length - 0.12, force, duration: 1.5e-3, release: 0.0 };
        let gestures = [
            (0.001, Gesture::Place { finger: 0, touch: finger.touch, position, clearance: finger.hover }),
            (0.001, Gesture::Press { finger: 0, force: finger.force, duration: finger.landing }),
            (0.0023, pluck),
            (0.2, Gesture::Bend { tension_ratio: 1.2, duration: 0.1 }),
            (0.35, Gesture::Slide { finger: 0, position: position + 0.03, duration: 0.1 }),
            (0.5, pluck),
            (0.6, Gesture::Lift { finger: 0, force: 3.0, duration: 0.02 }),
        ];
        for (seconds, gesture) in gestures {
            let time = (seconds * RATE) as u64 + 37 * string as u64;
            instrument.schedule(TimedGesture { time, string, gesture }).expect("there is room");
        }
    }
}

fn render(instrument: &mut Instrument, block: usize) -> Vec<u32> {
    let (mut left, mut right) = (vec![0.0; SAMPLES], vec![0.0; SAMPLES]);
    for (left, right) in left.chunks_mut(block).zip(right.chunks_mut(block)) {
        instrument.process(left, right);
    }
    assert!(left.iter().any(|sample| sample.abs() > 1e-3), "nothing sounds");
    left.iter().chain(&right).map(|sample| sample.to_bits()).collect()
}

#[test]
fn blocks_of_any_size() {
    let whole = render(&mut instrument(), SAMPLES);
    for block in [1, 7, 64, 480, 1000] {
        assert!(render(&mut instrument(), block) == whole, "blocks of {block}");
    }
}

#[test]
fn every_run_and_after_a_reset() {
    let mut first = instrument();
    let bits = render(&mut first, SAMPLES);
    assert!(render(&mut instrument(), SAMPLES) == bits, "another run");
    first.reset();
    play(&mut first, &Setup::builtin("electric").expect("it is built in"));
    assert!(render(&mut first, SAMPLES) == bits, "after a reset");
}

#[test]
fn stems_do_not_change_the_mix() {
    let mut plain = instrument();
    let bits = render(&mut plain, SAMPLES);
    let mut with_stems = instrument();
    let mut stems = vec![vec![0.0f32; SAMPLES]; with_stems.string_count()];
    let mut slices: Vec<&mut [f32]> = stems.iter_mut().map(Vec::as_mut_slice).collect();
    let (mut left, mut right) = (vec![0.0; SAMPLES], vec![0.0; SAMPLES]);
    with_stems.process_stems(&mut slices, &mut left, &mut right);
    let mixed: Vec<u32> = left.iter().chain(&right).map(|sample| sample.to_bits()).collect();
    assert!(mixed == bits);
    assert!(stems.iter().all(|stem| stem.iter().any(|sample| *sample != 0.0)), "a silent stem");
}

#[test]
fn with_and_without_the_ledger() {
    let scene = Scene::from_toml(SCENE).expect("the scene is valid");
    let run = |measured: bool| {
        let mut simulation = Simulation::new(&scene).expect("the scene can be built");
        if measured {
            simulation.open_ledger();
        }
        let mut bits = Vec::new();
        for _ in 0..simulation.samples() {
            simulation.step();
            bits.push(simulation.output().to_bits());
            bits.extend(simulation.string(0).state.displacement().map(f64::to_bits));
        }
        bits
    };
    assert!(run(true) == run(false));
    // The same of an instrument.
    let mut measured = instrument();
    measured.open_ledgers();
    assert!(render(&mut measured, 480) == render(&mut instrument(), 480));
    let closed = |string| measured.ledger(string).is_some_and(|ledger| ledger.put_in > 0.0);
    assert!((0..measured.string_count()).all(closed), "a ledger without an entry");
}

/// Numbers that were found once and are compared with since. Another compiler or processor must give the same; whoever
/// changes the physics puts new ones here.
#[test]
fn on_every_machine() {
    let scene = Scene::from_toml(SCENE).expect("the scene is valid");
    let mut simulation = Simulation::new(&scene).expect("the scene can be built");
    let mut moved = Vec::new();
    for _ in 0..simulation.samples() {
        simulation.step();
        moved.push(simulation.output().to_bits());
        moved.extend(simulation.string(0).state.displacement().map(f64::to_bits));
    }
    assert_eq!(format!("{:016x}", digest(moved)), "1231fbdd5f7163d6");
    let heard = render(&mut instrument(), SAMPLES).into_iter().map(u64::from);
    assert_eq!(format!("{:016x}", digest(heard)), "a719a8d28fa92be3");
}

/// A number that stands for many: FNV-1a, by words.
fn digest(words: impl IntoIterator<Item = u64>) -> u64 {
    words.into_iter().fold(0xCBF2_9CE4_8422_2325, |hash, word| (hash ^ word).wrapping_mul(0x0100_0000_01B3))
}

/// Hosts may flush subnormal numbers to zero; there are none to flush, so that the bits do not depend on it.
#[test]
fn no_subnormal_numbers() {
    let mut instrument = instrument();
    let mut sample = [0.0];
    let mut other = [0.0];
    let mut moved = false;
    for _ in 0..2000 {
        instrument.process(&mut sample, &mut other);
        for string in 0..instrument.string_count() {
            let state = instrument.state(string);
            for value in state.motion().chain(state.displacement()) {
                assert!(value == 0.0 || value.is_normal(), "{value:e} on string {string}");
            }
            moved |= state.motion().any(|value| value != 0.0);
        }
        assert!(sample[0] == 0.0 || sample[0].is_normal());
    }
    assert!(moved, "nothing moves");
}

/// Nor is there one in a finger that its hand brakes in the air.
#[test]
fn a_finger_comes_to_rest() {
    let mut setup = Setup::builtin("electric").expect("it is built in");
    setup.string.truncate(1);
    let mut instrument = Instrument::new(&setup, &Quality::Live.settings(RATE)).expect("it can be built");
    let touch = setup.player.fretting.touch;
    let gesture = Gesture::Throw { finger: 0, touch, position: 0.2, clearance: 1.0, speed: 1.0 };
    instrument.schedule(TimedGesture { time: 0, string: 0, gesture }).expect("there is room");
    let motion = |instrument: &Instrument| instrument.state(0).fingers()[0].expect("it is there").motion;
    let (mut sample, mut other) = ([0.0], [0.0]);
    instrument.process(&mut sample, &mut other);
    assert!(motion(&instrument) < 0.0, "it does not move");
    for _ in 0..2 * SAMPLES {
        instrument.process(&mut sample, &mut other);
        let motion = motion(&instrument);
        assert!(motion == 0.0 || motion.is_normal(), "{motion:e} m");
    }
    assert_eq!(motion(&instrument), 0.0);
}
