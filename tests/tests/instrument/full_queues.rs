//! The promise: where more waits than there is room for, what comes last is left out and counted, nothing else is touched, and
//! nothing is allocated.

use low_action::engine::{Engine, EngineOptions};
use low_action::performance::PlayerEvent;
use low_action_dsp::{Gesture, Instrument, Quality, QueueFull, Setup, TimedGesture};
use low_action_tests::stage::{on, peak};
use nice_assert_no_alloc::assert_no_alloc;

const RATE: f64 = 48_000.0;
const SAMPLES: usize = 4800;

/// Gestures and events that an instrument has room for, as their pages say.
const GESTURES: u64 = 4096;
const EVENTS: u64 = 16_384;

/// Bends to where the string is anyway fill the queue but for one place. A pluck finds it, and one of another string does not.
#[test]
fn gestures_beyond_what_may_wait() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument =
        Instrument::new(&setup, &Quality::Live.settings(RATE)).expect("the set-up can be built");
    let position = instrument.geometry(0).length - 0.1;
    let pluck = Gesture::Pluck { position, force: 1.0, duration: 0.001, release: 0.0 };
    let bend = Gesture::Bend { tension_ratio: 1.0, duration: 0.01 };
    let mut stems = vec![vec![0.0f32; SAMPLES]; instrument.string_count()];
    let (mut left, mut right) = (vec![0.0; SAMPLES], vec![0.0; SAMPLES]);
    let mut parts: Vec<&mut [f32]> = stems.iter_mut().map(Vec::as_mut_slice).collect();
    // (A failed assertion asks for memory: none is made under watch.)
    let (mut taken, mut refused, mut waited, mut left_over) = (0, 0, 0, 0);
    assert_no_alloc(|| {
        let mut schedule = |instrument: &mut Instrument, time, string, gesture| {
            let scheduled = instrument.schedule(TimedGesture { time, string, gesture });
            taken += u64::from(scheduled.is_ok());
            refused += u64::from(scheduled == Err(QueueFull));
        };
        for number in 0..GESTURES - 1 {
            // Those to come go before those that wait, too.
            schedule(&mut instrument, (number * 1031) % SAMPLES as u64, 0, bend);
        }
        schedule(&mut instrument, 100, 0, pluck);
        for time in [0, 100, 1_000_000] {
            schedule(&mut instrument, time, 1, pluck);
        }
        waited = instrument.waiting();
        instrument.process_stems(&mut parts, &mut left, &mut right);
        left_over = instrument.waiting();
    });
    assert_eq!((taken, refused, waited as u64, left_over), (GESTURES, 3, GESTURES, 0));
    assert_eq!(instrument.schedule(TimedGesture { time: 0, string: 1, gesture: pluck }), Ok(()));
    assert_eq!(QueueFull.to_string(), format!("more than {GESTURES} gestures wait at once"));
    assert!(peak(&stems[0]) > 1e-3, "the last for which there was room is played");
    assert!(stems[1..].iter().all(|stem| peak(stem) == 0.0), "what was left out sounds");
}

/// Movements of a controller that nobody heeds fill the room for events but for one. A note finds it, and others do not, but for
/// as many as are due at the present sample: those need not wait.
#[test]
fn events_beyond_what_may_wait() {
    const BEYOND: u64 = 37;
    const PRESENT: u64 = 2;
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut engine = Engine::new(&EngineOptions::new(setup, RATE)).expect("it can be built");
    let unheeded = PlayerEvent::Controller { channel: 0, number: 90, value: 0.5 };
    let (heard, lost) = (52, 64);
    let (mut left, mut right) = (vec![0.0; SAMPLES], vec![0.0; SAMPLES]);
    let mut lost_before = 0;
    assert_no_alloc(|| {
        for _ in 0..PRESENT {
            engine.event(0, unheeded);
        }
        for number in PRESENT..EVENTS - 1 {
            engine.event(1 + number as u32 % 1000, unheeded);
        }
        engine.event(1000, on(heard, 90));
        // The first find the room of what is due at once.
        for _ in 0..PRESENT {
            engine.event(1000, unheeded);
        }
        lost_before = engine.lost_events();
        for _ in 0..BEYOND {
            engine.event(1000, on(lost, 90));
        }
    });
    assert_eq!((lost_before, engine.has_room()), (0, false));
    assert_no_alloc(|| engine.process(&mut left, &mut right));
    assert_eq!(engine.lost_events(), BEYOND);
    assert!(engine.has_room(), "all that waited is played");
    assert!(engine.sounds(0, heard) && !engine.sounds(0, lost));
    assert!(peak(&left) > 1e-3);
    engine.reset();
    assert_eq!(engine.lost_events(), 0);
}
