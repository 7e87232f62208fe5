//! Promise: a song sounds the same everywhere, to the last bit: in a file that the command line writes, from a host that
//! renders offline, and from the engine alone; but that a file begins where the song does, and a host knows how late it is.

use hound::WavReader;
use low_action::engine::{Engine, EngineOptions, Quality};
use low_action::midi_file::{Selection, Song};
use low_action_dsp::Setup;
use low_action_tests::command::Workplace;
use low_action_tests::host::{Action, Host, Score, parameter};
use low_action_tests::midi::{file, track};
use low_action_tests::stage::peak;

const RATE: u32 = 48_000;
/// A tick: at 120 beats a minute, of 96 ticks each.
const TICK: u64 = 250;
const LENGTH: usize = 48_000;

/// Ticks and messages: a chord, a bend, a note under the pedal and releases.
const MESSAGES: [(u32, [u8; 3]); 16] = [
    (0, [0x90, 45, 100]),
    (0, [0x90, 52, 90]),
    (3, [0xB0, 22, 1]),
    (5, [0x90, 64, 64]),
    (9, [0xE0, 0, 80]),
    (11, [0xE0, 127, 127]),
    (20, [0xE0, 0, 64]),
    (24, [0xB0, 64, 127]),
    (32, [0x80, 52, 0]),
    (40, [0xB0, 64, 0]),
    (41, [0xB0, 1, 90]),
    (60, [0x80, 45, 0]),
    (60, [0x80, 64, 0]),
    (62, [0x90, 57, 110]),
    (62, [0x90, 61, 30]),
    (90, [0x80, 57, 0]),
];

/// The song as a MIDI file.
fn song() -> Vec<u8> {
    let mut before = 0;
    let events: Vec<(u32, &[u8])> = MESSAGES
        .iter()
        .map(|(tick, message)| (tick - std::mem::replace(&mut before, *tick), &message[..]))
        .collect();
    file(0, 96, &[track(&events)])
}

/// Both channels of the file that the command line makes of it.
fn rendered(options: &[&str]) -> [Vec<f32>; 2] {
    let place = Workplace::new(env!("CARGO_BIN_EXE_low-action-command"));
    place.write("song.mid", song());
    // A second after its end at a tick of 90.
    let arguments = ["render", "song.mid", "-o", "out.wav", "-b", "32f", "-q", "studio", "--tail", "1"];
    let done = place.run(&[&arguments[..], options].concat());
    assert_eq!(done.code, 0, "{}", done.error);
    let samples: Vec<f32> = WavReader::open(place.path("out.wav"))
        .expect("it is a WAV file")
        .into_samples()
        .map(|sample| sample.expect("it is whole"))
        .collect();
    [0, 1].map(|side| samples.iter().skip(side).step_by(2).copied().collect())
}

/// Both channels of the engine alone, everything in one go.
fn played() -> [Vec<f32>; 2] {
    let setup = Setup::builtin("electric").expect("it is built in");
    let options = EngineOptions { quality: Quality::Studio, ..EngineOptions::new(setup, f64::from(RATE)) };
    let mut engine = Engine::new(&options).expect("it can be built");
    for event in Song::from_midi(&song(), Selection::default()).expect("it is a song").events {
        engine.event(event.time.sample(RATE) as u32, event.event);
    }
    let mut output = [vec![0.0; LENGTH], vec![0.0; LENGTH]];
    let [left, right] = &mut output;
    engine.process(left, right);
    output
}

/// Both channels of the plugin in a host.
fn hosted(settings: &[(&str, f64)]) -> [Vec<f32>; 2] {
    let mut host = Host::new();
    let set = settings.iter().map(|&(id, value)| (0, Action::Parameter(parameter(id), value))).collect();
    // A first activation takes the values in; the second begins with them.
    host.play(f64::from(RATE), &set, 64, &[64]);
    let score: Score =
        MESSAGES.iter().map(|(tick, message)| (TICK * u64::from(*tick), Action::Midi(*message))).collect();
    host.play(f64::from(RATE), &score, LENGTH, &[480, 1, 960])
}

/// Fails at the first sample that is not the same bits.
fn assert_same_bits(expected: &[f32], found: &[f32], what: &str) {
    assert_eq!(expected.len(), found.len(), "{what}");
    if let Some(at) = expected.iter().zip(found).position(|(e, f)| e.to_bits() != f.to_bits()) {
        panic!("{what}: sample {at} is {:e} and {:e}", expected[at], found[at]);
    }
}

/// Options of a command, and what a host sets for them, 0 to 1 or by steps.
type Told = (&'static [&'static str], &'static [(&'static str, f64)]);

/// What can be told of hands and strings.
const TOLD: [Told; 8] = [
    (&["--seed", "7"], &[("take", 7.0)]),
    (&["--capo", "2"], &[("capo", 2.0)]),
    (&["--legato", "always", "--input", "strings"], &[("legato", 1.0), ("input_mode", 2.0)]),
    (&["--ignore-hand-controllers"], &[("hand_controllers", 0.0)]),
    (&["--set", "velocity_curve=2.5"], &[("velocity_curve", 0.625)]),
    (&["--set", "keyswitches=45"], &[("keyswitches", 46.0)]),
    (
        &["--set", "pluck_position=20 mm", "--set", "pluck_softest=25"],
        &[("pluck_position", 0.4), ("pluck_softest", 0.25)],
    ),
    (
        &["--set", "string_tuning_6=-2", "--set", "tension_modulation=off"],
        &[("string_tuning_6", 10.0 / 19.0), ("tension_modulation", 0.0)],
    ),
];

#[test]
fn what_a_command_is_told_is_what_a_host_sets() {
    let usual = hosted(&[]);
    let late = Engine::LATENCY as usize;
    for (options, settings) in TOLD {
        let (rendered, hosted) = (rendered(options), hosted(settings));
        assert!(hosted != usual, "{options:?} changes nothing");
        for side in [0, 1] {
            let common = (LENGTH - late).min(rendered[side].len());
            assert!(common > LENGTH / 2, "{options:?}: the file has {common} samples");
            assert_same_bits(
                &hosted[side][late..][..common],
                &rendered[side][..common],
                &format!("{options:?}"),
            );
        }
    }
}

#[test]
fn a_song_sounds_the_same_as_a_file_in_a_host_and_alone() {
    let (rendered, played, hosted) = (rendered(&[]), played(), hosted(&[]));
    let late = Engine::LATENCY as usize;
    assert!(late > 0);
    for side in [0, 1] {
        assert!(peak(&played[side]) > 0.01, "nothing sounds");
        assert_same_bits(&played[side], &hosted[side], "host");
        let common = LENGTH - late;
        assert!(rendered[side].len() >= common, "the file has {} samples", rendered[side].len());
        assert_same_bits(&played[side][late..], &rendered[side][..common], "file");
    }
}
