//! Promise: what hosts and keyboards say about single notes and channels is heard on those notes and channels,
//! and on no others.

use std::collections::HashSet;

use clack_host::events::event_types::NoteExpressionType;
use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::numbers::{brightness, largest, rms, smallest};
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{amplitude, hertz};

const RATE: f64 = 48_000.0;
const LENGTH: usize = 36_000;

fn on(at: u64, channel: u8, key: u8) -> (u64, Action) {
    (at, Action::NoteOn { channel, key, velocity: 90 })
}

fn midi(at: u64, bytes: [u8; 3]) -> (u64, Action) {
    (at, Action::Midi(bytes))
}

fn express(at: u64, what: NoteExpressionType, key: u8, value: f64) -> (u64, Action) {
    (at, Action::Express { what, channel: 0, key, value })
}

/// The left channel, with plucks that are all alike.
fn play(score: Score) -> Vec<f32> {
    play_with(&[], score)
}

/// The same with parameters set before everything else.
fn play_with(settings: &[(&str, f64)], mut score: Score) -> Vec<f32> {
    let mut host = Host::new();
    let settings = [("variation", 0.0)].iter().chain(settings);
    let settings = settings.map(|&(id, value)| (0, Action::Parameter(parameter(id), value))).collect();
    host.play(RATE, &settings, 64, &[64]);
    score.sort_by_key(|&(at, _)| at);
    let [left, _] = host.play(RATE, &score, LENGTH, &[512]);
    left
}

/// How far the last half second is above a key, cents.
fn above(sound: &[f32], key: f64) -> f64 {
    cents(frequency_near(&sound[LENGTH - 24_000..], RATE, hertz(key)), hertz(key))
}

#[test]
fn tuning_and_pressure_raise_the_note() {
    let straight = above(&play(vec![on(0, 0, 48)]), 48.0);
    let tuned = play(vec![on(0, 0, 48), express(0, NoteExpressionType::Tuning, 48, 1.0)]);
    assert!((above(&tuned, 49.0) - straight).abs() < 3.0);
    let later = play(vec![on(0, 0, 48), express(6000, NoteExpressionType::Tuning, 48, -1.0)]);
    assert!((above(&later, 47.0) - straight).abs() < 3.0);
    let pressed = play(vec![on(0, 0, 48), express(6000, NoteExpressionType::Pressure, 48, 1.0)]);
    assert!(above(&pressed, 48.0) > straight + 1.0, "{} and {straight}", above(&pressed, 48.0));
    let channel = play(vec![on(0, 0, 48), midi(6000, [0xD0, 127, 0])]);
    assert!((above(&channel, 48.0) - above(&pressed, 48.0)).abs() < 0.1);
    // Somebody else's key.
    let other = play(vec![on(0, 0, 48), express(6000, NoteExpressionType::Pressure, 50, 1.0)]);
    assert_eq!(other, play(vec![on(0, 0, 48)]));
}

#[test]
fn brightness_and_controller_74_move_the_pluck() {
    let usual = play(vec![on(0, 0, 45)]);
    let bright = play(vec![on(0, 0, 45), express(0, NoteExpressionType::Brightness, 45, 1.0)]);
    let dull = play(vec![on(0, 0, 45), express(0, NoteExpressionType::Brightness, 45, 0.0)]);
    let [b, u, d] = [&bright, &usual, &dull].map(|sound| brightness(&sound[240..9600]));
    assert!(b > u && d < u, "{b}, {u}, {d}");
    // By 80 mm either way, of the parameter's −100 to 200.
    for (sound, moved) in [(&bright, -80.0), (&dull, 80.0)] {
        let there = play_with(&[("pluck_position", (moved + 100.0) / 300.0)], vec![on(0, 0, 45)]);
        assert!(*sound == there, "brightness is not heard as {moved} mm");
    }
    // For notes to come, on its own channel.
    let controlled = play(vec![midi(0, [0xB0, 74, 0]), on(0, 0, 45)]);
    assert_eq!(controlled, dull);
    assert_eq!(play(vec![midi(0, [0xB1, 74, 0]), on(0, 0, 45)]), usual);
}

/// As expression is; so a host's mixer of notes is heard, and the usual volume is none.
#[test]
fn volume_is_a_factor_of_the_force_of_the_pluck() {
    let said = |at, what, value| play(vec![on(0, 0, 45), express(at, what, 45, value)]);
    let usual = play(vec![on(0, 0, 45)]);
    assert_eq!(said(0, NoteExpressionType::Volume, 1.0), usual);
    let half = said(0, NoteExpressionType::Volume, 0.5);
    assert!(rms(&half) < 0.7 * rms(&usual));
    assert_eq!(half, said(0, NoteExpressionType::Expression, 0.5));
    assert!(rms(&said(0, NoteExpressionType::Volume, 2.0)) > 1.5 * rms(&usual));
    assert!(said(0, NoteExpressionType::Volume, 0.0).iter().all(|&sample| sample == 0.0));
    // Once it is plucked a string sounds as it does; and where it is heard the set-up says.
    assert_eq!(said(6000, NoteExpressionType::Volume, 0.5), usual);
    assert_eq!(said(0, NoteExpressionType::Pan, 1.0), usual);
}

#[test]
fn vibrato_swings() {
    let usual = play(vec![on(0, 0, 45)]);
    let swung = play(vec![on(0, 0, 45), midi(100, [0xB0, 1, 127])]);
    // At its deepest half a semitone either way: the pitch of tenths of a second differs.
    let pitches = |sound: &[f32]| -> Vec<f64> {
        sound[12_000..]
            .chunks_exact(4000)
            .map(|part| cents(frequency_near(part, RATE, 220.0), 220.0))
            .collect()
    };
    let spread = |pitches: &[f64]| largest(pitches.iter().copied()) - smallest(pitches.iter().copied());
    assert!(spread(&pitches(&usual)) < 6.0, "{:?}", pitches(&usual));
    assert!(spread(&pitches(&swung)) > 20.0, "{:?}", pitches(&swung));
}

#[test]
fn a_note_can_have_a_parameter_for_itself() {
    let two = || vec![on(0, 0, 45), on(0, 0, 62)];
    // Let go of at once: otherwise a softer stroke is not only softer.
    let at_once = [("pluck_release", 0.0)];
    let usual = play_with(&at_once, two());
    let modulated = |key: u8| {
        let modulation = Action::Modulate { parameter: parameter("pluck_force"), key, amount: -0.4 };
        play_with(&at_once, [two(), vec![(0, modulation)]].concat())
    };
    // Both notes are heard in the mix; the one that is modulated is softer, the other as it was.
    let partial = |sound: &[f32], key: u8| amplitude(&sound[4800..], RATE, hertz(f64::from(key)));
    // In the lower half of its range the parameter goes evenly from 5 to 100 %: 0.4 under the middle it is 24 %. As the force, so
    // the open string, but for its stretching, which goes with the square. A finger that sets a string down is heard beside a
    // pluck as soft: 0.014 of the usual one here.
    for (one, other, beside) in [(45, 62, 1e-3), (62, 45, 0.02)] {
        let modulated = modulated(one);
        let ratio = |key| partial(&modulated, key) / partial(&usual, key);
        assert!((ratio(one) - 0.24).abs() < beside, "{one}: {}", ratio(one));
        // What a window of 0.65 s lets through of the other's partials, 36 Hz or more away, is 90 dB down.
        assert!((ratio(other) - 1.0).abs() < 3e-5, "{one}: the other is {} times as loud", ratio(other));
    }
}

#[test]
fn mpe_bends_by_48_semitones_and_all_by_two() {
    // A keyboard announces fifteen member channels on channel 1.
    let announce = [(101, 0), (100, 6), (6, 15)].map(|(number, value)| midi(0, [0xB0, number, value]));
    let wheel = |channel: u8, at: u64, semitones: f64, reach: f64| {
        let value = (8192.0 + semitones / reach * 8192.0).round().min(16_383.0) as u16;
        midi(at, [0xE0 | channel, (value & 127) as u8, (value >> 7) as u8])
    };
    let straight = above(&play([announce.to_vec(), vec![on(10, 3, 48)]].concat()), 48.0);
    for (score, semitones) in [
        (vec![wheel(3, 10, 1.0, 48.0)], 1.0),
        (vec![wheel(0, 10, 1.0, 2.0)], 1.0),
        (vec![wheel(3, 10, 7.0, 48.0)], 7.0),
        (vec![wheel(3, 10, 1.0, 48.0), wheel(0, 10, -2.0, 2.0)], -1.0),
        (vec![wheel(5, 10, 7.0, 48.0)], 0.0),
    ] {
        let sound = play([announce.to_vec(), vec![on(10, 3, 48)], score].concat());
        let off = above(&sound, 48.0 + semitones) - straight;
        // A wheel of 14 bits over 96 semitones has steps of half a cent; slides end at the fret's own pitch.
        assert!(off.abs() < 3.0, "{semitones} semitones: {off} cents");
    }
}

#[test]
fn pedals_keep_what_they_should() {
    let off = |at| (at, Action::NoteOff { channel: 0, key: 45 });
    let sounds = |score: Score| rms(&play(score)[30_000..]) > 1e-3;
    assert!(!sounds(vec![on(0, 0, 45), off(6000)]));
    assert!(sounds(vec![midi(0, [0xB0, 64, 127]), on(0, 0, 45), off(6000)]));
    assert!(!sounds(vec![midi(0, [0xB1, 64, 127]), on(0, 0, 45), off(6000)]));
    // Sostenuto keeps what sounds when it goes down, and nothing that comes later.
    assert!(sounds(vec![on(0, 0, 45), midi(3000, [0xB0, 66, 127]), off(6000)]));
    assert!(!sounds(vec![midi(0, [0xB0, 66, 127]), on(100, 0, 45), off(6000)]));
    assert!(!sounds(vec![on(0, 0, 45), midi(3000, [0xB0, 66, 127]), off(6000), midi(9000, [0xB0, 66, 0])]));
    // These always work.
    for controller in [120, 121, 123] {
        let pedal = if controller == 123 { 0 } else { 127 };
        let score =
            vec![midi(0, [0xB0, 64, pedal]), on(0, 0, 45), off(6000), midi(9000, [0xB0, controller, 0])];
        assert!(!sounds(score), "controller {controller}");
    }
}

#[test]
fn every_message_that_ends_notes_lets_go_of_keys() {
    let with = |controller, value| play(vec![on(0, 0, 45), midi(9000, [0xB0, controller, value])]);
    let released = with(123, 0);
    assert!(rms(&released[30_000..]) < 1e-3 && rms(&play(vec![on(0, 0, 45)])[30_000..]) > 1e-3);
    // Omni off and on, mono and poly: modes that there are none of here, and what the standard says of them all.
    for (controller, value) in [(124, 0), (125, 0), (126, 1), (126, 0), (127, 0)] {
        assert!(with(controller, value) == released, "controller {controller}");
    }
    // Another channel's keys stay down.
    let elsewhere = play(vec![on(0, 0, 45), midi(9000, [0xB1, 123, 0])]);
    assert_eq!(elsewhere, play(vec![on(0, 0, 45)]));
}

#[test]
fn what_is_for_the_mixer_of_the_host_changes_nothing() {
    let usual = play(vec![on(0, 0, 45), on(9000, 0, 62)]);
    // Volume, pan, a program, a bank, reverberation and chorus, before a note and while it sounds.
    let messages = [
        [0xB0, 7, 20],
        [0xB0, 10, 0],
        [0xC0, 3, 0],
        [0xB0, 0, 1],
        [0xB0, 32, 1],
        [0xB0, 91, 127],
        [0xB0, 93, 127],
    ];
    for message in messages {
        let sound = play(vec![midi(0, message), on(0, 0, 45), midi(6000, message), on(9000, 0, 62)]);
        assert!(sound == usual, "{message:?}");
    }
}

#[test]
fn expression_is_a_factor_of_the_force() {
    let usual = rms(&play(vec![on(0, 0, 45)])[480..]);
    let half = rms(&play(vec![midi(0, [0xB0, 11, 64]), on(0, 0, 45)])[480..]);
    let quarter = rms(&play(vec![midi(0, [0xB0, 11, 64]), midi(0, [0xB0, 2, 64]), on(0, 0, 45)])[480..]);
    // Nearly: a harder pluck stretches the string and may touch a fret.
    assert!(
        (half / usual - 0.5).abs() < 0.1 && (quarter / usual - 0.25).abs() < 0.07,
        "{usual} {half} {quarter}"
    );
}

#[test]
fn hosts_hear_when_a_note_has_ended() {
    let score = vec![
        on(0, 0, 45),
        on(100, 0, 62),
        (6000, Action::NoteOff { channel: 0, key: 45 }),
        // Struck again while it sounds: the same string, and so the same note goes on until both presses have been let go of.
        on(12_000, 0, 62),
        (15_000, Action::NoteOff { channel: 0, key: 62 }),
        (18_000, Action::NoteOff { channel: 0, key: 62 }),
    ];
    let ended = Host::new().perform(RATE, &score, LENGTH, &[512], 0).ended;
    let times = |key| ended.iter().filter(|(_, other)| *other == key).map(|(at, _)| *at).collect::<Vec<_>>();
    assert_eq!(times(45), [6144]);
    assert!(times(62).last().is_some_and(|&at| at == 18_432), "{:?}", times(62));
}

#[test]
fn a_note_struck_again_under_another_number_ends_with_both() {
    let begin = |at, number| (at, Action::Begin { number, channel: 0, key: 62 });
    let lift = |at, number| (at, Action::Lift { number });
    let strikes = [begin(0, 1), begin(6000, 2)];
    let performed = |lifts: &[(u64, Action)]| {
        let score = [&strikes[..], lifts].concat();
        let performed = Host::new().perform(RATE, &score, LENGTH, &[512], 0);
        (rms(&performed.stereo[0][30_000..]), performed.ended)
    };
    for lifts in [[lift(12_000, 1), lift(18_000, 2)], [lift(12_000, 2), lift(18_000, 1)]] {
        let (rest, ended) = performed(&lifts);
        assert!(rest < 1e-3, "{rest}");
        // Each number once: the first when the other came.
        assert_eq!(ended, [(6144, 62), (18_432, 62)]);
        assert!(performed(&lifts[..1]).0 > 1e-3, "one press is left");
    }
}

/// A parameter that is set cuts the block, and what comes at the same sample before it is of the part that ends there.
#[test]
fn a_note_that_begins_where_a_parameter_is_set_has_not_ended() {
    let score = vec![
        (100, Action::Begin { number: 1, channel: 0, key: 62 }),
        (100, Action::Parameter(parameter("pluck_force"), 0.4)),
        (6000, Action::Lift { number: 1 }),
    ];
    let performed = Host::new().perform(RATE, &score, LENGTH, &[512], 0);
    assert_eq!(performed.ended, [(6144, 62)]);
    // Its number is still known, so that it is let go of.
    assert!(rms(&performed.stereo[0][480..6000]) > 1e-3, "it never sounds");
    assert!(rms(&performed.stereo[0][30_000..]) < 1e-3, "it is not let go of");
}

/// However often its key went down, and whether it sounds or lies under another.
#[test]
fn a_choke_ends_a_note() {
    let score = vec![on(0, 0, 62), on(3000, 0, 62), (6000, Action::Choke { channel: 0, key: 62 })];
    let ended = Host::new().perform(RATE, &score, LENGTH, &[512], 0).ended;
    assert_eq!(ended.last(), Some(&(6144, 62)));
    // With a note-off in its place the other press keeps it.
    let score = vec![on(0, 0, 62), on(3000, 0, 62), (6000, Action::NoteOff { channel: 0, key: 62 })];
    let performed = Host::new().perform(RATE, &score, 12_000, &[512], 0);
    assert!(performed.ended.iter().all(|&(at, _)| at < 6000), "{:?}", performed.ended);
    assert!(rms(&performed.stereo[0][10_000..]) > 1e-3, "it does not sound any more");
}

#[test]
fn a_note_that_comes_late_has_not_ended() {
    // Two more than there are strings: 70 and 140 ms later they take those of others.
    let keys = [40, 47, 52, 55, 59, 64, 67, 71];
    let mut score: Score = keys.iter().map(|&key| on(0, 0, key)).collect();
    score.extend(keys.iter().map(|&key| (12_000, Action::NoteOff { channel: 0, key })));
    let mut ended = Host::new().perform(RATE, &score, 24_000, &[512], 0).ended;
    ended.sort_unstable_by_key(|(at, _)| *at);
    let times: Vec<u64> = ended.iter().map(|(at, _)| *at).collect();
    assert_eq!(times, [vec![3584, 7168], vec![12_288; 6]].concat());
    assert_eq!(ended.iter().map(|(_, key)| *key).collect::<HashSet<_>>(), HashSet::from(keys));
}
