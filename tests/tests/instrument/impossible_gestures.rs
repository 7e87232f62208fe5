//! The promise: a gesture that no hand can make is left out, and the string goes on as if nobody had asked.

use low_action_dsp::drive::PUSHES;
use low_action_dsp::{Gesture, Instrument, Quality, Setup, TimedGesture, Touch};

const RATE: f64 = 48_000.0;
const FINGER: usize = 0;
const NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
const PAD: Touch = Touch { mass: 5e-3, stiffness: 1e7, exponent: 2.0, damping: 1.0, hand_damping: 5.0 };

/// A pressed string that is plucked, and what else is asked of it in the middle.
fn play(more: &[Gesture]) -> Vec<f32> {
    let mut setup = Setup::builtin("electric").expect("built in");
    setup.string.truncate(1);
    let mut instrument = Instrument::new(&setup, &Quality::Live.settings(RATE)).expect("it can be built");
    let place = instrument.geometry(0).finger_position(5);
    let mut at = |time, gesture| {
        instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
    };
    at(0, Gesture::Place { finger: FINGER, touch: PAD, position: place, clearance: 1e-3 });
    at(0, Gesture::Press { finger: FINGER, force: 5.0, duration: 0.002 });
    at(4800, Gesture::Pluck { position: 0.5, force: 0.8, duration: 0.003, release: 0.0 });
    more.iter().for_each(|gesture| at(7200, *gesture));
    let (mut left, mut right) = (vec![0.0; 14_400], vec![0.0; 14_400]);
    instrument.process(&mut left, &mut right);
    left
}

/// That the sound is the same with these gestures as without.
fn assert_left_out(gesture: Gesture) {
    let (alone, with) = (play(&[]), play(&[gesture]));
    assert!(alone[7200..].iter().any(|sample| sample.abs() > 1e-3), "it rings");
    let bits = |sound: &[f32]| sound.iter().map(|sample| sample.to_bits()).collect::<Vec<_>>();
    assert!(bits(&alone) == bits(&with), "{gesture:?} is heard");
}

#[test]
fn what_is_possible_is_heard() {
    let lift = Gesture::Lift { finger: FINGER, force: 1.0, duration: 0.001 };
    assert!(play(&[]) != play(&[lift]), "a lift opens the string");
    let still = Gesture::Still { loss: 100.0, duration: 0.003 };
    assert!(play(&[]) != play(&[still]), "a hand along the string brakes it");
}

#[test]
fn hands_that_brake_nothing() {
    for number in NUMBERS {
        assert_left_out(Gesture::Still { loss: number, duration: 0.003 });
        assert_left_out(Gesture::Still { loss: 100.0, duration: number });
    }
    // What drives the string is no hand, and one that is there for no time is none.
    for (loss, duration) in
        [(-1.0, 0.003), (-1e308, 0.003), (0.0, 1.0), (100.0, 0.0), (100.0, -1.0), (1e308, 1e-310)]
    {
        assert_left_out(Gesture::Still { loss, duration });
    }
}

/// However far beyond the string: it is the nearest place on it. What is no place is the middle.
#[test]
fn places_beyond_the_string_are_its_ends() {
    let length = Setup::builtin("electric").expect("built in").neck.scale_length;
    let from = |position: f64| play(&[Gesture::Slide { finger: FINGER, position, duration: 0.05 }]);
    for (beyond, same) in [(f64::INFINITY, 10.0), (f64::NEG_INFINITY, -10.0), (f64::NAN, 0.5 * length)] {
        assert!(from(beyond) == from(same), "{beyond} is not {same} m");
    }
    assert!(from(10.0) != from(0.5 * length) && from(-10.0) != from(0.5 * length), "nothing slides");
}

/// However near it is and at once: a slide of little more than a sample of a hand's way takes two.
#[test]
fn no_slide_is_faster_than_a_hand() {
    let mut setup = Setup::builtin("electric").expect("built in");
    setup.string.truncate(1);
    for rate in [44_100.0, 48_000.0] {
        // One step a sample.
        let mut instrument =
            Instrument::new(&setup, &Quality::Draft.settings(rate)).expect("it can be built");
        for samples in [0.4, 0.6, 1.1, 1.49, 1.51, 2.3, 7.49, 100.2] {
            instrument.reset();
            let (from, to) = (0.3, 0.3 + 10.0 * samples / rate);
            let mut at = |time, gesture| {
                instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
            };
            at(0, Gesture::Place { finger: FINGER, touch: PAD, position: from, clearance: 1e-3 });
            at(10, Gesture::Slide { finger: FINGER, position: to, duration: 0.0 });
            let mut places = Vec::new();
            for _ in 0..130 {
                instrument.process(&mut [0.0], &mut [0.0]);
                places.push(instrument.state(0).fingers()[FINGER].expect("it is there").position);
            }
            let fastest = places.windows(2).map(|pair| (pair[1] - pair[0]).abs() * rate).fold(0.0, f64::max);
            assert!(fastest <= 10.0 * (1.0 + 1e-9), "{samples} samples at {rate} Hz: {fastest} m/s");
            // Nor slower than it must be: by a sample.
            assert!(
                fastest > 10.0 * samples / (samples + 1.0) * (1.0 - 1e-9),
                "{samples} samples: {fastest} m/s"
            );
            assert!((places[129] - to).abs() < 1e-15, "{samples} samples: {} m, {to} m", places[129]);
        }
    }
}

/// It can take no more than all of the motion that a step begins with. Under that the string creeps back, partials p at c²γ²/(2σ₀)
/// with σ₀ = 1/k, 20 p² a second, and does not ring at 2800 p: it moves 40 dB more slowly, or 26 with several partials together.
#[test]
fn hands_that_brake_beyond_all_measure() {
    let ringing = play(&[])[6000..7200].iter().fold(0.0f32, |most, sample| most.max(sample.abs()));
    for (loss, duration) in [(1e308, 0.01), (1e7, f64::MAX)] {
        let sound = play(&[Gesture::Still { loss, duration }]);
        assert!(sound.iter().all(|sample| sample.abs() < 1.0), "{loss:e} 1/s drive the string");
        let most = sound[7500..7600].iter().fold(0.0f32, |most, sample| most.max(sample.abs()));
        assert!(most < 0.05 * ringing, "{loss:e} 1/s leave {most} of {ringing}");
    }
}

#[test]
fn forces_that_are_no_numbers() {
    for force in NUMBERS {
        assert_left_out(Gesture::Press { finger: FINGER, force, duration: 0.01 });
        assert_left_out(Gesture::Lift { finger: FINGER, force, duration: 0.01 });
        assert_left_out(Gesture::Pluck { position: 0.3, force, duration: 0.01, release: 0.0 });
        assert_left_out(Gesture::Pluck { position: 0.3, force: 1.0, duration: force, release: 0.0 });
        assert_left_out(Gesture::Pluck { position: 0.3, force: 1.0, duration: 0.01, release: force });
    }
}

/// No number on its own, but a difference of two such forces is none.
#[test]
fn forces_beyond_all_hands() {
    for force in [1e7, 1e308, -1e308] {
        assert_left_out(Gesture::Press { finger: FINGER, force, duration: 0.01 });
        assert_left_out(Gesture::Lift { finger: FINGER, force, duration: 0.01 });
        assert_left_out(Gesture::Pluck { position: 0.3, force, duration: 0.01, release: 0.0 });
    }
    // And so is a push of less than any time.
    assert_left_out(Gesture::Pluck { position: 0.3, force: 1.0, duration: 1e-310, release: 0.0 });
}

#[test]
fn fingers_that_would_never_arrive() {
    for clearance in [f64::NAN, f64::INFINITY, 1e3] {
        assert_left_out(Gesture::Place { finger: FINGER, touch: PAD, position: 0.3, clearance });
        let thrown = Gesture::Throw { finger: FINGER, touch: PAD, position: 0.3, clearance, speed: 2.0 };
        assert_left_out(thrown);
    }
}

/// Nor do idle hands let go of a string over a body for it: what sings along fades as before.
#[test]
fn what_cannot_be_thrown_does_not_play() {
    let mut setup = Setup::builtin("classical").expect("built in");
    setup.string = [0, 5].map(|string| setup.string[string].clone()).into();
    let sound = |clearance: Option<f64>| {
        let mut instrument = Instrument::new(&setup, &Quality::Live.settings(RATE)).expect("it can be built");
        let mut at = |time, string, gesture| {
            instrument.schedule(TimedGesture { time, string, gesture }).expect("there is room");
        };
        at(0, 0, Gesture::Pluck { position: 0.5, force: 1.0, duration: 0.003, release: 0.0 });
        if let Some(clearance) = clearance {
            let thrown = Gesture::Throw { finger: FINGER, touch: PAD, position: 0.3, clearance, speed: 0.0 };
            at(2_400, 1, thrown);
        }
        let (mut left, mut right) = (vec![0.0; 9_600], vec![0.0; 9_600]);
        instrument.process(&mut left, &mut right);
        left
    };
    let alone = sound(None);
    assert!(alone == sound(Some(f64::NAN)), "one that cannot be plays");
    // One that hangs in the air far above touches nothing, and that it is there is heard all the same.
    assert!(alone != sound(Some(1.0)), "one that can be does not");
}

/// One whose time is past happens at the next sample, behind those that wait for it.
#[test]
fn late_gestures_keep_their_order() {
    let setup = Setup::builtin("electric").expect("built in");
    let settings = Quality::Live.settings(RATE);
    let heard = |late: u64| {
        let mut instrument = Instrument::new(&setup, &settings).expect("it can be built");
        let (mut left, mut right) = (vec![0.0; 4800], vec![0.0; 4800]);
        instrument.process(&mut left, &mut right);
        let now = instrument.now();
        let position = instrument.geometry(0).finger_position(5);
        let gestures = [
            (now, Gesture::Place { finger: FINGER, touch: PAD, position, clearance: 1e-4 }),
            (late, Gesture::Press { finger: FINGER, force: 5.0, duration: 0.002 }),
            (now + 480, Gesture::Pluck { position: 0.5, force: 0.8, duration: 0.003, release: 0.0 }),
        ];
        for (time, gesture) in gestures {
            instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
        }
        instrument.process(&mut left, &mut right);
        left
    };
    assert!(heard(4800).iter().any(|sample| sample.abs() > 1e-3), "nothing sounds");
    assert!(heard(4800) == heard(0), "the late press is lost");
}

#[test]
fn fingers_that_cannot_be() {
    let wrong = NUMBERS.into_iter().chain([0.0, -1.0]);
    let masses = wrong.clone().chain([1e-9, 1e4, 1e300]).map(|mass| Touch { mass, ..PAD });
    // The last is a pad that could be, and is too stiff for the string's grid.
    let pads = wrong.chain([1e29]).map(|stiffness| Touch { stiffness, ..PAD });
    let losses = NUMBERS.into_iter().chain([-1.0, 1e6]);
    let damped = losses.clone().map(|damping| Touch { damping, ..PAD });
    let braked = losses.map(|hand_damping| Touch { hand_damping, ..PAD });
    let bent = NUMBERS.into_iter().chain([0.5]).map(|exponent| Touch { exponent, ..PAD });
    for touch in masses.chain(pads).chain(damped).chain(braked).chain(bent) {
        for finger in [FINGER, 1] {
            let held = Gesture::Place { finger, touch, position: 0.3, clearance: 0.0 };
            let thrown = Gesture::Throw { finger, touch, position: 0.3, clearance: 1e-4, speed: 2.0 };
            assert_left_out(held);
            assert_left_out(thrown);
        }
    }
}

#[test]
fn fingers_that_are_not_there() {
    for finger in [1, 99, usize::MAX] {
        assert_left_out(Gesture::Press { finger, force: 5.0, duration: 0.01 });
        assert_left_out(Gesture::Lift { finger, force: 5.0, duration: 0.01 });
        assert_left_out(Gesture::Slide { finger, position: 0.4, duration: 0.1 });
    }
    assert_left_out(Gesture::Place { finger: usize::MAX, touch: PAD, position: 0.3, clearance: 0.0 });
}

/// What is left out is not shown either.
#[test]
fn plucks_that_are_left_out_are_not_seen() {
    let mut setup = Setup::builtin("electric").expect("built in");
    setup.string.truncate(1);
    let mut instrument = Instrument::new(&setup, &Quality::Live.settings(RATE)).expect("it can be built");
    instrument.observe(true);
    let mut seen_after = |position, force| {
        let gesture = Gesture::Pluck { position, force, duration: 0.1, release: 0.0 };
        let time = instrument.now();
        instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
        instrument.process(&mut [0.0], &mut [0.0]);
        instrument.observed(0).pluck.map(|pluck| pluck.position)
    };
    assert_eq!(seen_after(0.1, f64::NAN), None);
    for _ in 0..PUSHES {
        assert_eq!(seen_after(0.2, 0.1), Some(0.2));
    }
    assert_eq!(seen_after(0.3, 0.1), Some(0.2), "it is one more than there may be");
}
