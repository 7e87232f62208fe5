//! Promise: whoever keeps books of an instrument or looks at it finds them right after a hand-over: ledgers go on with their
//! strings, nobody's are given back on the way, and what is observed goes on from the strings as they are.

// The allocator that keeps watch comes with the plugin.
use low_action as _;
use low_action_dsp::{Gesture, Instrument, Quality, Setup, TimedGesture, Touch};
use low_action_tests::watch;
use nice_assert_no_alloc::assert_no_alloc;

const RATE: f64 = 48_000.0;

fn setup(name: &str) -> Setup {
    Setup::builtin(name).expect("it is built in")
}

fn build(setup: &Setup) -> Box<Instrument> {
    Box::new(Instrument::new(setup, &Quality::Live.settings(RATE)).expect("the set-up can be built"))
}

fn does(instrument: &mut Instrument, gesture: Gesture) {
    for string in 0..instrument.string_count() {
        let time = instrument.now();
        instrument.schedule(TimedGesture { time, string, gesture }).expect("there is room");
    }
}

const PLUCK: Gesture = Gesture::Pluck { position: 0.5, force: 1.0, duration: 1e-3, release: 0.0 };

fn play(instrument: &mut Instrument, seconds: f64) {
    let samples = (seconds * RATE) as usize;
    instrument.process(&mut vec![0.0; samples], &mut vec![0.0; samples]);
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "in a release build nobody keeps watch over allocations")]
fn the_watch_is_kept() {
    watch::assert_it_is_kept(module_path!(), "the_watch_is_kept");
}

/// The ledgers of a ringing string take the place of its successor's, which are not given back there.
#[test]
fn both_may_have_ledgers() {
    let electric = setup("electric");
    let (mut instrument, mut successor) = (build(&electric), build(&electric));
    instrument.open_ledgers();
    successor.open_ledgers();
    does(&mut instrument, PLUCK);
    play(&mut instrument, 0.1);
    let put_in = instrument.ledger(0).expect("it is open").put_in;
    assert!(put_in > 0.0 && instrument.hand_over(successor).is_ok());
    play(&mut instrument, 0.1);
    let before = instrument.take_before().expect("it has faded");
    for string in 0..instrument.string_count() {
        let ledger = instrument.ledger(string).expect("it is open");
        assert!(ledger.worst_residual <= 1e-14, "string {string}: {:e}", ledger.worst_residual);
        assert!(before.ledger(string).is_some(), "the successor's is lost");
    }
    let now = instrument.ledger(0).expect("it is open").put_in;
    assert!((now / put_in - 1.0).abs() < 1e-3, "{now} J of {put_in} J");
}

/// Where nobody measured before, the ledgers of the successor begin with what it takes over.
#[test]
fn a_successor_keeps_its_own_ledgers() {
    let electric = setup("electric");
    let (mut instrument, mut successor) = (build(&electric), build(&electric));
    successor.open_ledgers();
    does(&mut instrument, PLUCK);
    play(&mut instrument, 0.1);
    assert!(instrument.hand_over(successor).is_ok());
    let begun = instrument.ledger(0).expect("it was opened").energies().total();
    assert!(begun > 0.0, "the string rings");
    play(&mut instrument, 0.1);
    let ledger = instrument.ledger(0).expect("it was opened");
    assert!(ledger.worst_residual <= 1e-14 && ledger.energies().total() <= ledger.put_in);
}

/// Where strings do not go on their ledgers end with them.
#[test]
fn ledgers_of_other_strings_stay_behind() {
    let mut instrument = build(&setup("electric"));
    instrument.open_ledgers();
    assert!(instrument.hand_over(build(&setup("bass"))).is_ok());
    assert!(instrument.ledger(0).is_none());
    play(&mut instrument, 0.1);
    assert!(instrument.take_before().expect("it has faded").ledger(0).is_some());
}

/// One that still has an instrument inside comes back with it: there is no room for both.
#[test]
fn a_successor_with_a_predecessor_is_given_back() {
    let electric = setup("electric");
    let (mut first, mut second) = (build(&electric), build(&electric));
    assert!(second.hand_over(build(&electric)).is_ok());
    play(&mut second, 0.1);
    let mut refused = assert_no_alloc(|| first.hand_over(second)).expect_err("it still has one inside");
    assert!(refused.take_before().is_some());
    assert!(first.hand_over(refused).is_ok());
}

/// Pictures go on from the shape that the strings have.
#[test]
fn what_is_observed_begins_with_what_is_taken_over() {
    let electric = setup("electric");
    let mut instrument = build(&electric);
    instrument.observe(true);
    does(&mut instrument, PLUCK);
    play(&mut instrument, 0.05);
    assert!(instrument.hand_over(build(&electric)).is_ok());
    let (observed, state) = (instrument.observed(0), instrument.state(0));
    assert!(state.displacement().any(|u| u != 0.0), "it rings");
    let points = state.displacement().count();
    assert_eq!([observed.lowest.len(), observed.highest.len()], [points; 2]);
    for (seen, now) in observed.lowest.iter().chain(&observed.highest).zip(state.displacement().cycle()) {
        assert_eq!(*seen, now);
    }
    assert_eq!(observed.steps, 0);
}

/// Whoever looks goes on looking, and nobody else begins to.
#[test]
fn other_strings_are_observed_as_those_before() {
    for looking in [true, false] {
        let (mut instrument, mut successor) = (build(&setup("electric")), build(&setup("bass")));
        instrument.observe(looking);
        successor.observe(!looking);
        assert!(instrument.hand_over(successor).is_ok());
        does(&mut instrument, PLUCK);
        play(&mut instrument, 0.05);
        assert_eq!(instrument.observed(0).steps > 0, looking);
        assert_eq!(instrument.observed(0).pluck.is_some(), looking);
    }
}

/// The tuning is there after 20 ms, a bend under way goes on in its own time.
#[test]
fn a_long_bend_does_not_hold_up_the_tuning() {
    let electric = setup("electric");
    for semitones in [-2.0, 0.0, 1.0] {
        let tuned = Setup { tuning: semitones, ..electric.clone() };
        let mut instrument = build(&electric);
        does(&mut instrument, PLUCK);
        does(&mut instrument, Gesture::Bend { tension_ratio: 1.2, duration: 10.0 });
        play(&mut instrument, 4.0);
        let mut alone = instrument.clone();
        let successor = build(&tuned);
        let ratio = successor.model(0).string.tension / instrument.model(0).string.tension;
        let before = instrument.drive(0).tension;
        assert!(instrument.hand_over(successor).is_ok());
        instrument.process(&mut [0.0], &mut [0.0]);
        let step = (instrument.drive(0).tension / before - 1.0).abs();
        assert!(step < 1e-4, "{semitones} semitones: {step:e} in a step");
        for seconds in [0.025, 3.0, 4.0] {
            play(&mut instrument, seconds);
            play(&mut alone, seconds);
            let off = instrument.drive(0).tension / (ratio * alone.drive(0).tension) - 1.0;
            // They are a sample apart.
            assert!(off.abs() < 1e-5, "{semitones} semitones, {seconds} s: off by {off:e}");
        }
    }
}

/// A hand laid along the string stays there as long as it was to stay, whatever the steps of the new string are.
#[test]
fn a_hand_that_stills_a_string_goes_on() {
    let electric = setup("electric");
    for semitones in [-2.0, 0.0, 1.0] {
        let mut instrument = build(&electric);
        does(&mut instrument, PLUCK);
        does(&mut instrument, Gesture::Still { loss: 1.0, duration: 1.0 });
        play(&mut instrument, 0.4);
        assert_eq!(instrument.drive(0).loss, 1.0);
        let tuned = Setup { tuning: semitones, ..electric.clone() };
        assert!(instrument.hand_over(build(&tuned)).is_ok());
        for (seconds, loss) in [(0.1, 1.0), (0.49, 1.0), (0.02, 0.0)] {
            play(&mut instrument, seconds);
            assert_eq!(instrument.drive(0).loss, loss, "{semitones} semitones");
        }
    }
}

/// However short what is left of it is beside the new steps, it ends, and the hands that lie on strings nobody plays come back.
#[test]
fn a_hand_that_is_about_to_leave_leaves() {
    let mut steel = setup("steel");
    steel.string.truncate(1);
    steel.player.idle_loss = 30.0;
    let at = |quality: Quality| Instrument::new(&steel, &quality.settings(RATE)).expect("it can be built");
    let rates = [Quality::Studio, Quality::Live].map(|quality| at(quality).ratio(0).value() * RATE);
    assert!(rates[0] >= 2.5 * rates[1], "no step of the one is lost in one of the other: {rates:?}");
    for steps in 0..6 {
        let mut instrument = at(Quality::Studio);
        let mut does = |time, gesture| {
            instrument.schedule(TimedGesture { time, string: 0, gesture }).expect("there is room");
        };
        does(0, PLUCK);
        // So many steps of the string are left at sample 2000.
        let duration = 1000.0 / RATE + f64::from(steps) / rates[0];
        does(1000, Gesture::Still { loss: 0.5, duration });
        play(&mut instrument, 2000.0 / RATE);
        let loud = instrument.state(0).motion().fold(0.0, |most: f64, motion| most.max(motion.abs()));
        assert!(loud > 0.0 && instrument.hand_over(Box::new(at(Quality::Live))).is_ok());
        play(&mut instrument, 1.0);
        let left = instrument.state(0).motion().fold(0.0, |most: f64, motion| most.max(motion.abs()));
        // e⁻³⁰ of the velocity, and steps are three times as long; by itself the string would keep a third.
        println!("{steps} steps: {:e}", left / loud);
        assert!(left < 1e-9 * loud, "{steps} steps: {:e} of the motion is left", left / loud);
    }
}

/// A finger whose hand brakes it far more than its mass weighs brings energy that is gone within the step: the balance is held
/// against it all the same.
#[test]
fn what_a_finger_brings_counts_as_there() {
    let mut instrument = {
        let mut setup = Setup::shipped("drop-d").expect("it comes with the program");
        setup.string.truncate(1);
        build(&setup)
    };
    instrument.open_ledgers();
    let touch = Touch { mass: 1.29e-6, stiffness: 1021.0, exponent: 3.0, damping: 10.0, hand_damping: 1e5 };
    does(&mut instrument, Gesture::Throw { finger: 0, touch, position: 0.3, clearance: 1e-4, speed: 10.0 });
    play(&mut instrument, 0.1);
    let ledger = instrument.ledger(0).expect("it is open");
    // It moves with M̃ = Rk/2, 1 kg and not a milligram.
    assert!(ledger.largest > 1.0, "{} J", ledger.largest);
    assert!(ledger.worst_residual <= 1e-14, "{:e}", ledger.worst_residual);
}
