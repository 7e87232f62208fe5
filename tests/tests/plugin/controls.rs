//! Promise: the parameters that stand for no value of a set-up are heard as they say: hands, wheel and arm, what
//! channels mean, which notes are connected and which are none, level and bypass, and what is meant for one way of rendering alone.

use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::numbers::{largest, rms};
use low_action_tests::parameters::{LENGTH, RATE, score, sounding_pitch, stopped, with};
use low_action_tests::stage::hertz;

#[test]
fn the_hands_act_as_they_are_told() {
    let ends = |id: &str, score: &Score| [0.0, 1.0].map(|end| with(&[("variation", 0.0), (id, end)], score));

    // Pressed harder, the stopped string is stretched more; a set-up made for such a finger would make up for it.
    let [light, firm] = ends("finger_force", &stopped()).map(|sound| sounding_pitch(&sound, 48.0));
    assert!(firm > light + 0.02, "finger force: {light} and {firm}");

    // Under a soft pad the string goes on moving behind the fret, and loses there what a hard one leaves it.
    let [soft, hard] = ends("finger_hardness", &stopped()).map(|sound| rms(&sound[12_000..]));
    assert!(hard > 1.05 * soft, "finger hardness: {soft} and {hard}");

    // Without a curve a soft note is as loud as a hard one; with a steep one it hardly sounds.
    let soft = vec![(0, Action::NoteOn { channel: 0, key: 45, velocity: 30 })];
    let [flat, steep] = ends("velocity_curve", &soft).map(|sound| rms(&sound[2400..]));
    let expected = (30.0 / 127.0_f64).powi(4);
    assert!((steep / flat / expected - 1.0).abs() < 0.5, "velocity curve: {steep} of {flat}");

    // If the softest pluck is as hard as the hardest, velocity means nothing, as without a curve.
    let [usual, level] = ends("pluck_softest", &soft);
    assert_eq!(usual, with(&[("variation", 0.0)], &soft));
    assert_eq!(level, with(&[("variation", 0.0), ("velocity_curve", 0.0)], &soft));
}

#[test]
fn the_tremolo_arm_bends_everything() {
    for (end, semitones) in [(0.0, -12.0), (1.0, 3.0)] {
        let mut score = stopped();
        score[0].1 = Action::NoteOn { channel: 0, key: 45, velocity: 60 };
        let sound = with(&[("tremolo_arm", end)], &score);
        let cents = 100.0 * (sounding_pitch(&sound, 45.0 + semitones) - (45.0 + semitones));
        // A slack string buzzes and is stretched more by the same pluck.
        let limit = if semitones < 0.0 { 60.0 } else { 5.0 };
        assert!(cents.abs() < limit, "{semitones} semitones: off by {cents} cents");
    }
}

#[test]
fn the_wheel_reaches_as_far_as_it_is_told() {
    let assert_bent = |settings: &[(&str, f64)], announced: bool, semitones: f64| {
        let mut score = stopped();
        if announced {
            let messages = [(101, 0), (100, 0), (6, 1)];
            score.extend(messages.map(|(number, value)| (0, Action::Midi([0xB0, number, value]))));
        }
        score.push((0, Action::Midi([0xE0, 127, 127])));
        let straight = sounding_pitch(&with(settings, &stopped()), 48.0);
        let raised = sounding_pitch(&with(settings, &score), 48.0 + semitones) - straight;
        assert!((raised - semitones).abs() < 0.06, "{settings:?}: {raised} instead of {semitones}");
    };
    assert_bent(&[("bend_range", 0.0)], false, 0.0);
    assert_bent(&[("bend_range", 3.0)], false, 3.0);
    // Past what pulling can do, the finger slides.
    assert_bent(&[("bend_range", 5.0)], false, 5.0);
    assert_bent(&[("bend_range", 96.0), ("ignore_rpn", 0.0)], true, 1.0);
    assert_bent(&[("bend_range", 3.0), ("ignore_rpn", 1.0)], true, 3.0);
}

#[test]
fn channels_mean_what_they_are_told() {
    // On channel 2 a C3 is the string B3's only where channels are strings: there it must move up an octave.
    let score = vec![(0, Action::NoteOn { channel: 1, key: 48, velocity: 100 })];
    let [keyboard, strings] = [0.0, 2.0].map(|mode| key_heard(&with(&[("input_mode", mode)], &score)));
    assert_eq!((keyboard, strings), (48, 60));
    // Counted from the lowest string, channel 2 is the A2's, which has a C3.
    let [first, last] =
        [0.0, 1.0].map(|order| key_heard(&with(&[("input_mode", 2.0), ("string_order", order)], &score)));
    assert_eq!((first, last), (60, 48));
    // From channel 11 on, and on the last channel alone; channels without a string are silent.
    let on = |channel, key| vec![(0, Action::NoteOn { channel, key, velocity: 100 })];
    for (first, channel, key) in [(0.0, 0, 64), (10.0, 11, 60), (15.0, 15, 64)] {
        let settings = [("input_mode", 2.0), ("first_channel", first)];
        let pitch = sounding_pitch(&with(&settings, &on(channel, key)), f64::from(key));
        assert!((pitch - f64::from(key)).abs() < 0.1, "channel {channel} from {first} on: {pitch}");
        assert_eq!(rms(&with(&settings, &on(9, key))), 0.0);
    }
    // In MPE a turn of the wheel is 48 semitones of that note alone: a seventh of it a fifth.
    let mut bent = on(3, 48);
    let wheel = 8192 + 8191 * 7 / 48;
    bent.push((0, Action::Midi([0xE3, (wheel & 127) as u8, (wheel >> 7) as u8])));
    let pitch = sounding_pitch(&with(&[("input_mode", 3.0)], &bent), 55.0);
    assert!((pitch - 55.0).abs() < 0.1, "{pitch}");
}

/// The key whose fundamental is strongest among C3 and C4.
fn key_heard(sound: &[f32]) -> u8 {
    assert!(rms(&sound[4800..]) > 1e-3, "nothing is heard");
    let sound: Vec<f64> = sound[4800..].iter().map(|&x| f64::from(x)).collect();
    let size = |key: u8| {
        let frequency = hertz(f64::from(key)) * std::f64::consts::TAU / RATE;
        let sum = |wave: fn(f64) -> f64| -> f64 {
            sound.iter().enumerate().map(|(i, x)| x * wave(frequency * i as f64)).sum()
        };
        sum(f64::sin).hypot(sum(f64::cos))
    };
    if size(48) > 0.1 * size(60) { 48 } else { 60 }
}

/// What is not plucked sounds the same wherever plucks are.
#[test]
fn legato_connects_notes_from_its_sample_on() {
    let (at, again) = (9000, 16_000);
    let on = |key| Action::NoteOn { channel: 2, key, velocity: 100 };
    let set = |id, value| Action::Parameter(parameter(id), value);
    // All on the G3. The first note is held; the second is let go of before legato may be over.
    let play = |legato: [f64; 2], place: [f64; 2]| {
        let score = vec![
            (0, on(57)),
            (6000, set("legato", legato[0])),
            (8000, set("pluck_position", place[0])),
            (at as u64, on(60)),
            (14_000, set("legato", legato[1])),
            (15_000, set("pluck_position", place[1])),
            (again as u64, on(62)),
        ];
        with(&[("input_mode", 2.0)], &score)
    };
    let [connected, plucked] = [1.0, 0.0].map(|legato| play([legato; 2], [0.2; 2]));
    assert!(connected[..at] == plucked[..at], "it counts too early");
    assert!(connected == play([1.0; 2], [0.8; 2]), "a connected note is plucked");
    for sound in [&connected, &plucked] {
        // Heard from 0.1 s on.
        let pitch = sounding_pitch(&sound[at..again], 60.0);
        assert!((pitch - 60.0).abs() < 0.1, "{pitch}");
    }
    // And each of the two is plucked where it is off.
    assert!(plucked[at..again] != play([0.0; 2], [0.8, 0.2])[at..again], "the second is not plucked");
    let over = play([1.0, 0.0], [0.2; 2]);
    assert!(over[..again] == connected[..again], "it is over too early");
    assert!(over[again..] != play([1.0, 0.0], [0.2, 0.8])[again..], "the third is not plucked");
}

#[test]
fn keyswitches_tell_the_hands_and_make_no_sound() {
    let (key_at, note_at) = (3000, 9000);
    let on = |key| Action::NoteOn { channel: 0, key, velocity: 100 };
    // The steps of the parameter are off, then the keys from 0 on.
    let from = |first: u8| Action::Parameter(parameter("keyswitches"), f64::from(first) + 1.0);
    let note = (note_at as u64, on(48));
    let plain = with(&[], &vec![note]);
    // Rest strokes, by their controller.
    let expected = with(&[], &vec![(key_at as u64, Action::Midi([0xB0, 22, 3])), note]);
    assert!(expected[note_at..] != plain[note_at..]);
    for first in [0, 12, 108] {
        let key = first + 2;
        let press = [(key_at as u64, on(key)), (4000, Action::NoteOff { channel: 0, key })];
        let sound = with(&[], &[&[(1000, from(first))], &press[..], &[note]].concat());
        assert!(sound[..note_at].iter().all(|&sample| sample == 0.0), "a keyswitch of {first} sounds");
        assert!(sound == expected, "the third key from {first} on is no rest stroke");
        // Elsewhere, and when there are none any more, it is a note.
        let off = Action::Parameter(parameter("keyswitches"), 0.0);
        for other in [from(60), off] {
            let sound = with(&[], &[&[(1000, from(first)), (2000, other)], &press[..], &[note]].concat());
            assert!(rms(&sound[key_at..note_at]) > 1e-4, "key {key} is silent after {other:?}");
        }
    }
}

/// By bits: the parameter is what the controller is, until that says something else and again when it is put back.
#[test]
fn the_capo_is_that_of_its_controller() {
    let (at, said) = (4000, |value| Action::Midi([0xB0, 26, value]));
    let fret = |fret: u8| Action::Parameter(parameter("capo"), f64::from(fret));
    // An open string without one, a finger over the first, the second itself.
    let notes = [(at, Action::NoteOn { channel: 0, key: 50, velocity: 100 })];
    let play = |before: &[(u64, Action)]| with(&[], &[before, &notes].concat());
    let [none, third, fifth] = [0, 3, 5].map(|fret| play(&[(2000, said(fret))]));
    assert!(none != third && third != fifth && none != fifth, "a capo changes nothing");
    assert!(play(&[(2000, fret(3))]) == third, "the parameter is another capo");
    // (The hand has gone up the neck for it, and stays there.)
    let by_controller = |values: [u8; 3]| {
        let [first, second, last] = values.map(said);
        play(&[(1000, first), (1500, second), (2000, last)])
    };
    let reset = Action::Midi([0xB0, 121, 0]);
    for (told, values, what) in [
        ([fret(3), fret(3), said(5)], [3, 3, 5], "the controller does not come after it"),
        ([fret(3), fret(3), said(0)], [3, 3, 0], "the controller does not take it off"),
        ([fret(3), said(5), reset], [3, 5, 3], "it is not put back"),
        ([fret(3), said(0), reset], [3, 0, 3], "it is not put back on"),
        ([said(5), said(5), fret(3)], [5, 5, 3], "the parameter does not come after it"),
    ] {
        let [first, second, last] = told;
        assert!(play(&[(1000, first), (1500, second), (2000, last)]) == by_controller(values), "{what}");
    }
    // Set beforehand it is there from the beginning, for a rendering, too.
    assert!(with(&[("capo", 3.0)], &notes.to_vec()) == third);
}

/// By bits, of each of them: while they are not heard it is as if they had not been sent, and once they are heard no more as if
/// they had been put back.
#[test]
fn controllers_of_hands_are_heard_or_not() {
    let heard = |at: u64, on: f64| (at, Action::Parameter(parameter("hand_controllers"), on));
    let said = |at: u64, number: u8, value: u8| (at, Action::Midi([0xB0, number, value]));
    // Two notes at once, as strums need, one of them on an open string, as capos do, and both once more.
    let notes = [(4000, 43), (4000, 50), (12_000, 43), (12_000, 55)];
    let notes = notes.map(|(at, key)| (at, Action::NoteOn { channel: 0, key, velocity: 100 }));
    let play = |before: &[(u64, Action)]| with(&[], &[before, &notes].concat());
    let plain = play(&[]);
    // What is said by a value, and what takes it back. From key 43 on the lowest note is a keyswitch.
    let told: [(u8, u8, u8); 9] = [
        (20, 90, 0),
        (21, 90, 0),
        (22, 4, 0),
        (23, 2, 0),
        (24, 127, 64),
        (25, 90, 0),
        (26, 3, 0),
        (27, 43, 0),
        (28, 7, 0),
    ];
    for (number, value, usual) in told {
        // (A strum for an accent to be one of.)
        let strum = |at: u64, value: u8| (number == 24).then_some(said(at, 21, value));
        let tell = |at: u64, value: u8, wide: u8| -> Score {
            strum(at, wide).into_iter().chain([said(at, number, value)]).collect()
        };
        let first = tell(1000, value, 90);
        assert!(play(&first) != plain, "CC {number} changes nothing");
        assert!(play(&[&[heard(500, 0.0)], &first[..]].concat()) == plain, "CC {number} is heard");
        let back = play(&[&first[..], &tell(2000, usual, 0)].concat());
        assert!(play(&[&first[..], &[heard(2000, 0.0)]].concat()) == back, "CC {number} is not put back");
        // Heard again, they are what is said from then on.
        let again = [&first[..], &[heard(2000, 0.0), heard(2500, 1.0)]].concat();
        assert!(play(&again) == back, "CC {number} comes back");
        assert!(play(&[&again[..], &tell(3000, value, 90)].concat()) != back, "CC {number} stays unheard");
    }
    // Others are none of theirs.
    let swung = said(1000, 1, 127);
    assert!(play(&[swung]) != plain && play(&[heard(500, 0.0), swung]) == play(&[swung]));
}

#[test]
fn level_and_bypass_act_on_the_output_alone() {
    let usual = with(&[], &score());
    for (value, decibels) in [(0.0, -60.0), (1.0, 12.0)] {
        let gain = 10_f64.powf(decibels / 20.0);
        let found = with(&[("level", value)], &score());
        let off = usual.iter().zip(&found).map(|(a, b)| (f64::from(*a) * gain - f64::from(*b)).abs());
        assert!(largest(off) <= 1e-6 * gain, "level at {decibels} dB");
    }
    assert_eq!(with(&[("bypass", 0.0)], &score()), usual);
    assert!(with(&[("bypass", 1.0)], &score()).iter().all(|&sample| sample == 0.0));
}

/// Of a change in the middle of a sound, at the samples that are loud enough to tell: the time since then, s, and how much
/// of the sound is left.
fn left_after(id: &str, value: f64) -> Vec<(f64, f64)> {
    let at = 12_000;
    let usual = with(&[], &score());
    let mut changed = score();
    changed.push((at as u64, Action::Parameter(parameter(id), value)));
    changed.sort_by_key(|(time, _)| *time);
    let found = with(&[], &changed);
    assert!(found[..at] == usual[..at], "{id} counts too early");
    let parts =
        usual.iter().zip(&found).enumerate().skip(at).take(4800).filter(|(_, (usual, _))| usual.abs() > 1e-4);
    let left =
        |(n, (usual, found)): (usize, (&f32, &f32))| ((n - at) as f64 / RATE, f64::from(found / usual));
    let left: Vec<_> = parts.map(left).collect();
    assert!(left.len() > 2000, "too soft to tell");
    left
}

#[test]
fn level_and_bypass_are_spread_over_20_milliseconds() {
    // The level goes down by 60 dB at an even rate, the bypass takes away the sound at an even rate; a step may count at its
    // sample or at the next, which is a 960th of the way.
    let step = 1.0 / (0.02 * RATE);
    for (time, left) in left_after("level", 0.0) {
        let way = (time / 0.02).min(1.0);
        let off = 20.0 * left.log10() + 60.0 * way;
        assert!(off.abs() <= 60.0 * step + 1e-3, "level {time} s after: {off} dB off");
    }
    for (time, left) in left_after("bypass", 1.0) {
        let off = left - (1.0 - time / 0.02).max(0.0);
        assert!(off.abs() <= step + 1e-5, "bypass {time} s after: {off} off");
    }
}

#[test]
fn the_offline_quality_is_for_offline_alone() {
    let mut host = Host::in_real_time();
    let settings = [("render_quality", 4.0), ("relax", 0.0)];
    let settings = settings.map(|(id, value)| (0, Action::Parameter(parameter(id), value))).to_vec();
    host.play(RATE, &settings, 64, &[64]);
    let [left, _] = host.play(RATE, &score(), LENGTH, &[512]);
    assert!(left == with(&[], &score()));
}
