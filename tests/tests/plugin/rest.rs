//! Promise: silence is free, and no sound is cut short: a plugin at rest says so, a host that asks it for nothing
//! until there are events again loses nothing, and the tail it states is what its strings need to decay.

use low_action::engine::QUIET;
use low_action_dsp::Setup;
use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::numbers::largest;
use low_action_tests::pitch::frequency_near;
use low_action_tests::stage::{amplitude, decibels, hertz};

const RATE: f64 = 48_000.0;

fn on(at: u64, key: u8) -> (u64, Action) {
    (at, Action::NoteOn { channel: 0, key, velocity: 100 })
}

fn off(at: u64, key: u8) -> (u64, Action) {
    (at, Action::NoteOff { channel: 0, key })
}

fn controller(at: u64, number: u8, value: u8) -> (u64, Action) {
    (at, Action::Midi([0xB0, number, value]))
}

/// Also one that stops processing while it sleeps.
#[test]
fn a_host_that_lets_it_sleep_loses_nothing() {
    let score: Score = vec![
        // Strings that are soon at rest.
        (0, Action::Parameter(parameter("loss_0"), 1.0)),
        // What is said of notes to come, and how far the wheel reaches.
        controller(500, 11, 90),
        controller(500, 101, 0),
        controller(500, 100, 0),
        controller(500, 6, 5),
        on(1000, 45),
        on(1200, 57),
        // A key that stays down while its note dies away.
        (1400, Action::Begin { number: 7, channel: 0, key: 64 }),
        off(9000, 45),
        off(9600, 57),
        // Long after everything has died away.
        controller(220_000, 64, 127),
        on(230_000, 52),
        (231_000, Action::Midi([0xE0, 0, 96])),
        off(236_000, 52),
        (240_000, Action::Lift { number: 7 }),
        controller(245_000, 64, 0),
    ];
    for (block, stops) in [(64, false), (64, true), (512, false), (512, true)] {
        let awake = Host::new().play(RATE, &score, 260_000, &[block]);
        let mut host = Host::new();
        (host.sleepy, host.stops) = (true, stops);
        let asleep = host.perform(RATE, &score, 260_000, &[block], 0);
        assert!(asleep.stereo == awake, "blocks of {block}, processing stopped meanwhile: {stops}");
        // It sleeps as long as nothing sounds, but for parts of blocks and for hands that leave a string that is still.
        let silent = awake[0].iter().filter(|sample| **sample == 0.0).count();
        println!("slept for {} of {silent} silent samples in blocks of {block}", asleep.slept);
        assert!(silent > 100_000, "it never comes to rest");
        assert!(10 * asleep.slept >= 9 * silent, "slept for {} of {silent} samples", asleep.slept);
    }
}

#[test]
fn nothing_subnormal_comes_out() {
    // The farthest down a sound can be: before its first wave, at its last, through the lowest level, bypassed.
    for settings in [&[][..], &[("level", 0.0)], &[("bypass", 1.0)], &[("quality", 2.0), ("loss_1", 1.0)]] {
        let mut score: Score =
            settings.iter().map(|&(id, value)| (1000, Action::Parameter(parameter(id), value))).collect();
        score.extend([on(0, 45), on(500, 57), off(9000, 45), off(9600, 57)]);
        let mut host = Host::new();
        host.choose_ports(1);
        let found = host.perform(RATE, &score, 96_000, &[512], 8);
        // (What is asked for comes after the first note has begun.)
        assert!(found.stereo[0].iter().any(|&sample| sample != 0.0), "nothing sounds: {settings:?}");
        assert_eq!(found.stems.len(), 8);
        let all = found.stereo.iter().chain(&found.stems).flatten();
        assert!(all.into_iter().all(|sample| !sample.is_subnormal()), "{settings:?}");
    }
}

#[test]
fn the_tail_is_as_long_as_the_strings_ring() {
    let expected = |name: &str, loss: f64| {
        let setup = Setup::shipped(name).expect("it comes with the program");
        // Of the first ten partials the one that lasts longest: the lowest, but over a body.
        let all = (0..setup.string.len()).flat_map(|string| (1..=10).map(move |partial| (string, partial)));
        let longest = largest(
            all.map(|(string, partial)| -QUIET.ln() / (loss * setup.decay(string, f64::from(partial)))),
        );
        (longest * RATE) as u32
    };
    let ringing = |settings: &[(&str, f64)]| {
        let mut host = Host::new();
        let mut score: Score =
            settings.iter().map(|&(id, value)| (0, Action::Parameter(parameter(id), value))).collect();
        score.push(on(2000, 45));
        let [_, sounding] = host.perform(RATE, &score, 12_000, &[512], 0).tails;
        // Who asks before the next sound may cut what is exported by it.
        let [before, silent] = host.perform(RATE, &Score::new(), 512, &[512], 0).tails;
        assert_eq!([before, silent], [sounding; 2], "{settings:?}");
        sounding
    };
    assert!(ringing(&[]).abs_diff(expected("electric", 1.0)) <= 1);
    assert!(ringing(&[("instrument", 1.0)]).abs_diff(expected("classical", 1.0)) <= 1);
    assert!(ringing(&[("loss_0", 1.0), ("loss_1", 1.0)]).abs_diff(expected("electric", 20.0)) <= 1);

    // Damped or never plucked, what is played next may ring as long. A host hears at once that there is nothing now.
    for score in [vec![on(0, 45), off(2000, 45)], Score::new()] {
        let ended = Host::new().perform(RATE, &score, 120_000, &[512], 0);
        for tail in ended.tails {
            assert!(tail.abs_diff(expected("electric", 1.0)) <= 1, "{tail} after {score:?}");
        }
    }
    // Nothing sounds at such a rate.
    assert_eq!(Host::new().perform(1000.0, &Score::new(), 512, &[512], 0).tails, [0; 2]);
}

/// By how the partial that lasts longest falls from its third second to its tenth. A body takes of it what it takes to first order, and
/// other strings a little, as they sing along.
#[test]
fn the_longest_partial_falls_as_the_tail_has_it() {
    for (number, name, near) in [(0.0, "electric", 0.005), (1.0, "classical", 0.02)] {
        let setup = Setup::builtin(name).expect("it is built in");
        let all = (0..setup.string.len()).flat_map(|string| (1..=10).map(move |partial| (string, partial)));
        let decay = |&(string, partial): &(usize, i32)| setup.decay(string, f64::from(partial));
        let (string, partial) = all.min_by(|a, b| decay(a).total_cmp(&decay(b))).expect("there are some");
        let key = setup.string[string].pitch as u8;
        let score = vec![(0, Action::Parameter(parameter("instrument"), number)), on(2_000, key)];
        let open = Host::new().perform(RATE, &score, 528_000, &[512], 0);
        let [left, _] = &open.stereo;
        let expected = f64::from(partial) * hertz(f64::from(key));
        let level = |from: usize| {
            let second = &left[from..from + 48_000];
            decibels(amplitude(second, RATE, frequency_near(second, RATE, expected)))
        };
        let (fallen, stated) = (level(144_000) - level(480_000), f64::from(open.tails[1]) / RATE);
        let needed = -20.0 * QUIET.log10() / fallen * 7.0;
        println!("{name}, string {string}, partial {partial}: {needed:.2} s of {stated:.2} s");
        assert!((needed / stated - 1.0).abs() < near, "{name}: it needs {needed} s and says {stated} s");
    }
}
