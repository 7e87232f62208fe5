//! Promise: another set-up can be put under ringing strings. The sound goes on without a click, however far they are tuned;
//! other strings fade; and nothing is allocated.

// The allocator that keeps watch comes with the plugin.
use low_action as _;
use low_action_dsp::{Gesture, Instrument, Quality, Setup, TimedGesture};
use low_action_tests::clicks::{click, smallest_jump, with_jump};
use low_action_tests::numbers::largest;
use low_action_tests::ringing::{build, play, strike};
use low_action_tests::stage::{decibels, level, peak};
use low_action_tests::watch;
use nice_assert_no_alloc::assert_no_alloc;

/// A set-up as a player would change it, near another.
fn changed(setup: &Setup, action: f64, loss: f64, pickup: f64, tuning: f64) -> Setup {
    let mut setup = setup.clone();
    setup.neck.action *= action;
    setup.neck.nut_clearance *= action;
    setup.string.iter_mut().for_each(|string| {
        string.loss_0 *= loss;
        string.loss_1 *= loss;
    });
    if let low_action_dsp::setup::Pickup::Magnetic { position, .. } = &mut setup.pickup {
        *position += pickup;
    }
    setup.tuning += tuning;
    setup
}

/// Whenever it comes: also while a fret that was just struck still resists, which takes it five steps.
#[test]
fn the_same_setup_changes_nothing() {
    for name in ["electric", "bass"] {
        let setup = Setup::builtin(name).expect("it is built in");
        let mut handed = build(&setup);
        let successor = handed.clone();
        strike(&mut handed, &setup);
        let mut alone = handed.clone();
        let mut expected = Vec::new();
        play(&mut alone, 12_000, &mut expected);
        let most = peak(&expected);
        let mut worst = (0.0, 0);
        let mut at = 0;
        while at < 8_000 {
            // Not a part of any string's period: every phase of their motion has its turn.
            play(&mut handed, 67, &mut Vec::new());
            at += 67;
            let mut other = handed.clone();
            assert!(other.hand_over(Box::new(successor.clone())).is_ok());
            let mut found = Vec::new();
            play(&mut other, 2_000, &mut found);
            let off = largest(expected[at..].iter().zip(&found).map(|(a, b)| (a - b).abs()));
            worst = if off > worst.0 { (off, at) } else { worst };
        }
        println!("{name}: {:e} of the peak apart, at sample {}", worst.0 / most, worst.1);
        // Contacts are solved to 1e-12 m of a motion of 1e-5 m a sample; as a rule nothing at all is different.
        assert!(worst.0 <= 1e-7 * most, "{name}: {:e} of {most}, at sample {}", worst.0, worst.1);
    }
}

/// However it is asked for: where the one before has faded within a block, what follows in it is the new one to the last bit, be it
/// as much softer as doubles can tell.
#[test]
fn blocks_of_any_size_hand_over_alike() {
    let [setup, other] = ["electric", "bass"].map(|name| Setup::builtin(name).expect("it is built in"));
    let handed = |block: usize| {
        let mut instrument = build(&setup);
        strike(&mut instrument, &setup);
        let mut sound = Vec::new();
        play(&mut instrument, 2_000, &mut sound);
        assert!(instrument.hand_over(Box::new(build(&other))).is_ok());
        let pluck = Gesture::Pluck { position: 0.7, force: 1e-12, duration: 1e-3, release: 0.0 };
        let time = instrument.now() + 500;
        instrument.schedule(TimedGesture { time, string: 0, gesture: pluck }).expect("there is room");
        while sound.len() < 4_000 {
            play(&mut instrument, block.min(4_000 - sound.len()), &mut sound);
        }
        let softly = peak(&sound[3_000..]);
        assert!(softly > 0.0 && softly < 1e-9 * peak(&sound[2_000..2_100]), "{softly:e}");
        sound.iter().map(|sample| sample.to_bits()).collect::<Vec<_>>()
    };
    let one_by_one = handed(1);
    for block in [7, 64, 100, 2_000] {
        assert!(handed(block) == one_by_one, "blocks of {block}");
    }
}

/// What is played from the hand-over on is for the new strings: the old ones fade as if nobody played, and the new ones sound from
/// their first sample on as they do alone.
#[test]
fn other_strings_are_played_alone() {
    let [setup, other] = ["electric", "bass"].map(|name| Setup::builtin(name).expect("it is built in"));
    let pluck = Gesture::Pluck { position: 0.7, force: 1.0, duration: 1e-3, release: 0.0 };
    let play_on = |rings: bool, strikes: bool| {
        let mut instrument = build(&setup);
        if rings {
            strike(&mut instrument, &setup);
        }
        let mut sound = Vec::new();
        play(&mut instrument, 2_000, &mut sound);
        assert!(instrument.hand_over(Box::new(build(&other))).is_ok());
        if strikes {
            let time = instrument.now();
            instrument.schedule(TimedGesture { time, string: 1, gesture: pluck }).expect("there is room");
        }
        play(&mut instrument, 2_000, &mut sound);
        sound.split_off(2_000)
    };
    let mut alone = build(&other);
    alone.schedule(TimedGesture { time: 0, string: 1, gesture: pluck }).expect("there is room");
    let mut expected = Vec::new();
    play(&mut alone, 2_000, &mut expected);
    assert!(play_on(false, true) == expected, "after silence");
    let (fades, both) = (play_on(true, false), play_on(true, true));
    let most = peak(&fades);
    let off = largest(
        both.iter().zip(fades.iter().zip(&expected)).map(|(both, (old, new))| (both - (old + new)).abs()),
    );
    assert!(off <= 1e-6 * most, "{off:e} of {most}");
}

#[test]
fn there_is_no_click() {
    let electric = Setup::builtin("electric").expect("it is built in");
    let changes = [
        ("action up", changed(&electric, 1.5, 1.0, 0.0, 0.0)),
        ("action down", changed(&electric, 0.7, 1.0, 0.0, 0.0)),
        ("more loss", changed(&electric, 1.0, 4.0, 0.0, 0.0)),
        ("pickup moved", changed(&electric, 1.0, 1.0, 0.08, 0.0)),
        ("a tone down", changed(&electric, 1.0, 1.0, 0.0, -2.0)),
        ("a fifth down", changed(&electric, 1.0, 1.0, 0.0, -7.0)),
        ("other strings", Setup::builtin("classical").expect("it is built in")),
        ("another number of strings", Setup::builtin("bass").expect("it is built in")),
    ];
    changes.iter().for_each(|(what, new)| assert_no_click(what, &electric, new));
}

fn assert_no_click(what: &str, old: &Setup, new: &Setup) {
    let mut instrument = build(old);
    strike(&mut instrument, old);
    let mut sound = Vec::new();
    play(&mut instrument, 12_000, &mut sound);
    assert!(instrument.hand_over(Box::new(build(new))).is_ok());
    play(&mut instrument, 9600, &mut sound);
    assert_eq!(click(&sound, 12_000), None, "{what}");
    // And one would be found.
    let jump = smallest_jump(&sound, 12_000);
    println!("{what}: a jump of {:.1e} of the peak is a click", jump / peak(&sound));
    assert!(click(&with_jump(&sound, 12_300, jump), 12_000).is_some(), "{what}: {jump:e}");
}

/// Strings ring on however far they are tuned: a grid made for the new tension would not bear the old one from some
/// semitones down, which is no reason for silence.
///
/// The tension goes over in 20 ms, slowly beside the periods of most partials. Then the energy of each goes with its frequency, and the
/// velocity that a coil hears with the root of that: 2^(semitones/24), or 3 dB an octave. Open strings keep to it within 0.8 dB, since
/// the lowest partials are not so fast. Stopped ones do within 2 dB as far as four semitones down. Beyond, pads take more of a string
/// that is looser, whichever way it comes to that: semitone by semitone, none of which goes beyond what a grid bears, 3 to 13 dB. What
/// goes beyond that at once has fingers press less at first, until the hand has followed, which takes up to 4.4 dB more. An octave up
/// the finger no longer holds them on their frets.
#[test]
fn strings_that_are_tuned_ring_on() {
    let setup = Setup::builtin("electric").expect("it is built in");
    // Levels of all strings from a tenth of a second after the change on.
    let tuned_by = |ways: &[f64]| -> Vec<f64> {
        let mut instrument = build(&setup);
        instrument.open_ledgers();
        strike(&mut instrument, &setup);
        play(&mut instrument, 12_000, &mut Vec::new());
        let mut semitones = 0.0;
        for way in ways {
            semitones += way;
            let successor = build(&changed(&setup, 1.0, 1.0, 0.0, semitones));
            assert!(instrument.hand_over(Box::new(successor)).is_ok());
            // By then tension and frets have gone over, and the one before has faded.
            play(&mut instrument, 2400, &mut Vec::new());
            assert!(instrument.take_before().is_some());
        }
        play(&mut instrument, 2400, &mut Vec::new());
        let mut stems = vec![vec![0.0_f32; 4800]; instrument.string_count()];
        let mut slices: Vec<&mut [f32]> = stems.iter_mut().map(Vec::as_mut_slice).collect();
        instrument.process_stems(&mut slices, &mut [0.0; 4800], &mut [0.0; 4800]);
        for string in 0..instrument.string_count() {
            let worst = instrument.ledger(string).expect("it is open").worst_residual;
            assert!(worst <= 1e-14, "{semitones}, string {string}: {worst:e}");
        }
        stems.iter().map(|stem| level(stem)).collect()
    };
    let tuned = |semitones: f64| tuned_by(&[semitones]);
    let straight = tuned(0.0);
    for semitones in [-12.0, -7.0, -4.0, -3.0, 5.0, 12.0] {
        let law = decibels((semitones / 24.0_f64).exp2());
        let louder: Vec<f64> =
            tuned(semitones).iter().zip(&straight).map(|(after, straight)| after - straight).collect();
        println!("{semitones} semitones: {louder:.1?} dB louder, by the law {law:.1}");
        // Without what strings lose in that time anyway.
        let steps = semitones.abs() as usize;
        let in_steps: Vec<f64> = if semitones < -4.0 {
            let there = tuned_by(&vec![-1.0; steps]);
            there.iter().zip(tuned_by(&vec![0.0; steps])).map(|(there, straight)| there - straight).collect()
        } else {
            vec![law; louder.len()]
        };
        println!("step by step {in_steps:.1?} dB");
        for (string, louder) in louder.iter().enumerate() {
            // Every other one is stopped.
            let most = match string % 2 {
                1 => 1.0,
                _ if semitones < 12.0 => 3.0,
                _ => continue,
            };
            let least = match string % 2 {
                0 if semitones < -4.0 => in_steps[string].min(law) - 2.0,
                _ => law,
            };
            let case =
                format!("{semitones} semitones, string {string}: {louder:.1} dB, not {least:.1} to {law:.1}");
            assert!(*louder > least - most && *louder < law + most, "{case}");
        }
    }
}

/// Whoever is put under silent strings plays as if it had been there from the beginning.
#[test]
fn silent_strings_are_tuned_at_once() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let tuned = changed(&setup, 1.0, 1.0, 0.0, -2.0);
    let after = |mut instrument: Instrument, next: Option<Instrument>| {
        let mut sound = Vec::new();
        play(&mut instrument, 4800, &mut sound);
        if let Some(next) = next {
            assert!(instrument.hand_over(Box::new(next)).is_ok());
        }
        play(&mut instrument, 4800, &mut sound);
        strike(&mut instrument, &tuned);
        play(&mut instrument, 9600, &mut sound);
        sound
    };
    let expected = after(build(&tuned), None);
    assert!(peak(&expected) > 0.01, "nothing sounds");
    assert!(after(build(&setup), Some(build(&tuned))) == expected, "the old tension is heard");
}

/// One that has played already comes back in silence.
#[test]
fn an_instrument_that_comes_back_remembers_nothing() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument = build(&setup);
    strike(&mut instrument, &setup);
    let mut sound = Vec::new();
    play(&mut instrument, 4800, &mut sound);
    let silent = Box::new(build(&Setup::builtin("bass").expect("it is built in")));
    assert!(instrument.hand_over(silent).is_ok());
    play(&mut instrument, 4800, &mut sound);
    let electric = instrument.take_before().expect("it has faded");
    assert!(instrument.hand_over(electric).is_ok());
    let mut rest = Vec::new();
    play(&mut instrument, 4800, &mut rest);
    assert_eq!(peak(&rest), 0.0);
}

#[test]
fn an_instrument_of_another_rate_is_given_back() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let other = Instrument::new(&setup, &Quality::Live.settings(96_000.0)).expect("it can be built");
    let refused = build(&setup).hand_over(Box::new(other)).expect_err("it is of another rate");
    assert_eq!(refused.sample_rate(), 96_000.0);
}

/// With fewer strings the outputs of those that are gone fade like the rest, and are silent then.
#[test]
fn outputs_of_strings_that_are_gone_fade() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument = build(&setup);
    strike(&mut instrument, &setup);
    let mut sound = Vec::new();
    play(&mut instrument, 12_000, &mut sound);
    assert!(instrument.hand_over(Box::new(build(&Setup::builtin("bass").expect("it is built in")))).is_ok());
    let mut stems = vec![vec![1.0_f32; 2400]; 8];
    let (mut left, mut right) = (vec![0.0; 2400], vec![0.0; 2400]);
    let mut slices: Vec<&mut [f32]> = stems.iter_mut().map(Vec::as_mut_slice).collect();
    instrument.process_stems(&mut slices, &mut left, &mut right);
    for stem in [4, 5] {
        assert!(peak(&stems[stem][..480]) > 1e-4, "string {stem} is cut off");
    }
    for (index, stem) in stems.iter().enumerate() {
        assert_eq!(peak(&stem[960..]), 0.0, "string {index}");
    }
}

/// A pickup that comes in over pressed strings hears their force as what has been there all along.
#[test]
fn a_bridge_that_is_blended_in_does_not_thump() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let blended = Setup { blend: 1.0, ..setup.clone() };
    let mut instrument = build(&setup);
    for string in 0..instrument.string_count() {
        let position = instrument.geometry(string).finger_position(12);
        let touch = setup.player.fretting.touch;
        for gesture in [
            Gesture::Place { finger: 0, touch, position, clearance: 1e-4 },
            Gesture::Press { finger: 0, force: setup.player.fretting.force, duration: 0.004 },
        ] {
            instrument.schedule(TimedGesture { time: 0, string, gesture }).expect("there is room");
        }
    }
    let mut before = Vec::new();
    // Until what the fingers have set off has died away.
    play(&mut instrument, 480_000, &mut before);
    assert!(instrument.hand_over(Box::new(build(&blended))).is_ok());
    let mut after = Vec::new();
    play(&mut instrument, 9600, &mut after);
    println!("{:.1e} of full scale", peak(&after));
    // The constant force itself would be 0.2 at fret 12 of a high E, its thump a tenth of that.
    assert!(peak(&after) < 1e-3, "{:e}", peak(&after));
}

#[test]
fn another_instrument_begins_in_silence() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument = build(&setup);
    strike(&mut instrument, &setup);
    let mut sound = Vec::new();
    play(&mut instrument, 4_800, &mut sound);
    assert!(instrument.hand_over(Box::new(build(&Setup::builtin("bass").expect("it is built in")))).is_ok());
    let left = instrument.fading_left() as usize;
    assert!(instrument.take_before().is_none(), "it still sounds");
    play(&mut instrument, left, &mut sound);
    let mut rest = Vec::new();
    play(&mut instrument, 4_800, &mut rest);
    assert_eq!(peak(&rest), 0.0);
    assert_eq!(instrument.take_before().expect("it has faded").string_count(), 6);
}

/// The sound goes on where no string is more than a quarter longer or heavier, whichever of the two comes first.
#[test]
fn strings_that_differ_by_more_than_a_quarter_are_other_strings() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let old = build(&setup);
    let longer = |factor: f64| {
        let mut setup = setup.clone();
        setup.neck.scale_length *= factor;
        build(&setup)
    };
    // One string alone is enough.
    let heavier = |factor: f64| {
        let mut setup = setup.clone();
        setup.string[3].linear_density *= factor;
        build(&setup)
    };
    // (What makes up for a fretted string's stretch makes lengths differ by a few parts in a thousand less.)
    for (factor, goes_on) in [(1.0 / 1.26, false), (1.0 / 1.24, true), (1.24, true), (1.26, false)] {
        for other in [longer(factor), heavier(factor)] {
            assert_eq!(old.continues_in(&other), goes_on, "{factor}");
            assert_eq!(other.continues_in(&old), goes_on, "from {factor}");
        }
    }
    assert!(!old.continues_in(&build(&Setup::builtin("bass").expect("it is built in"))));
}

#[test]
#[cfg_attr(not(debug_assertions), ignore = "in a release build nobody keeps watch over allocations")]
fn the_watch_over_allocations_is_kept() {
    watch::assert_it_is_kept(module_path!(), "the_watch_over_allocations_is_kept");
}

#[test]
fn nothing_is_allocated() {
    let setup = Setup::builtin("electric").expect("it is built in");
    let mut instrument = build(&setup);
    strike(&mut instrument, &setup);
    let new = Box::new(build(&changed(&setup, 0.8, 2.0, 0.01, 0.3)));
    let (mut left, mut right) = (vec![0.0; 2400], vec![0.0; 2400]);
    let before = assert_no_alloc(|| {
        instrument.process(&mut left, &mut right);
        let refused = instrument.hand_over(new);
        instrument.process(&mut left, &mut right);
        (refused, instrument.take_before())
    });
    assert!(before.0.is_ok() && before.1.is_some());
}
