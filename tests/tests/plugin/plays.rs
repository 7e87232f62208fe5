//! The promise: a host that loads the plugin gets what the engine plays, bit for bit, whatever the size
//! of its blocks.
//!
//! In builds with debug assertions the plugin framework aborts the test as soon as memory is allocated
//! while processing.

use low_action::engine::{Engine, EngineOptions, Quality};
use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;
use low_action_tests::host::{Action, Host, Score};
use low_action_tests::numbers::rms;

const RATE: f64 = 48_000.0;

/// The identifiers under which hosts save the plugin's parameters. They never change.
const INSTRUMENT: u32 = 1_395_483_623;
const VARIATION: u32 = 2_065_539_603;
const LEVEL: u32 = 102_865_796;

/// A chord, a bend, a note under the pedal and releases, at odd samples.
fn score() -> Score {
    let mut score = vec![
        (0, Action::NoteOn { channel: 0, key: 45, velocity: 100 }),
        (1, Action::NoteOn { channel: 0, key: 52, velocity: 90 }),
        (1234, Action::NoteOn { channel: 0, key: 64, velocity: 64 }),
        (6001, Action::Midi([0xB0, 64, 127])),
        (7999, Action::NoteOff { channel: 0, key: 52 }),
        (9600, Action::Midi([0xB0, 64, 0])),
        (15_000, Action::NoteOff { channel: 0, key: 45 }),
        (15_000, Action::NoteOff { channel: 0, key: 64 }),
        (15_333, Action::Midi([0x90, 57, 110])),
        (20_000, Action::Midi([0x80, 57, 0])),
    ];
    score.extend((0..40).map(|step: u16| {
        let bend = 8192 + step * 100;
        (2000 + 50 * u64::from(step), Action::Midi([0xE0, (bend & 127) as u8, (bend >> 7) as u8]))
    }));
    score.push((5000, Action::Midi([0xE0, 0, 64])));
    score.sort_by_key(|&(at, _)| at);
    score
}

/// The same actions as the engine takes them; MIDI's numbers are scaled as the command line scales them.
fn player_event(action: Action) -> PlayerEvent {
    let unit = |byte: u8| f32::from(byte) / 127.0;
    match action {
        Action::NoteOn { channel, key, velocity } => {
            // In a host's terms a velocity of 0 is a soft note.
            PlayerEvent::NoteOn { channel, key, velocity: unit(velocity.max(1)) }
        }
        Action::NoteOff { channel, key } => PlayerEvent::NoteOff { channel, key },
        Action::Choke { channel, key } => PlayerEvent::NoteEnd { channel, key },
        Action::ChokeAll => PlayerEvent::AllNotesOff,
        Action::Midi([status, first, second]) => {
            let channel = status & 15;
            match status >> 4 {
                0x8 => PlayerEvent::NoteOff { channel, key: first },
                0x9 => PlayerEvent::NoteOn { channel, key: first, velocity: unit(second) },
                0xB => PlayerEvent::Controller { channel, number: first, value: unit(second) },
                0xE => {
                    let steps = f32::from(i16::from(first) + 128 * i16::from(second) - 8192);
                    let value = if steps < 0.0 { steps / 8192.0 } else { steps / 8191.0 };
                    PlayerEvent::PitchBend { channel, value }
                }
                other => panic!("the score has no status {other:x}"),
            }
        }
        other => panic!("the engine does not know {other:?}"),
    }
}

/// The engine on its own, rendering everything in one go.
fn engine_alone(options: &EngineOptions, score: &Score, length: usize) -> [Vec<f32>; 2] {
    let mut engine = Engine::new(options).expect("the built-in set-up is sound");
    for &(at, action) in score {
        engine.event(at as u32, player_event(action));
    }
    let mut output = [vec![0.0; length], vec![0.0; length]];
    let [left, right] = &mut output;
    engine.process(left, right);
    output
}

/// What the plugin is expected to build its engine from when its host renders offline.
fn options(instrument: &str, sample_rate: f64) -> EngineOptions {
    let setup = Setup::builtin(instrument).expect("a built-in set-up");
    EngineOptions { quality: Quality::Studio, ..EngineOptions::new(setup, sample_rate) }
}

/// Fails at the first sample that is not the same bits.
fn assert_same_bits(expected: &[Vec<f32>; 2], found: &[Vec<f32>; 2], what: &str) {
    for (side, (expected, found)) in expected.iter().zip(found).enumerate() {
        assert_eq!(expected.len(), found.len());
        let first = expected.iter().zip(found).position(|(e, f)| e.to_bits() != f.to_bits());
        if let Some(at) = first {
            panic!("{what}: channel {side} differs at sample {at}: {:e} and {:e}", expected[at], found[at]);
        }
    }
}

#[test]
fn a_note_sounds() {
    let score = vec![(100, Action::NoteOn { channel: 0, key: 57, velocity: 100 })];
    let output = Host::new().play(RATE, &score, 24_000, &[512]);
    for channel in &output {
        assert!(channel.iter().all(|sample| sample.is_finite()));
        assert!(channel[..100].iter().all(|&sample| sample == 0.0), "sound before the note");
        assert!(rms(&channel[2400..]) > 1e-3, "no sound: {}", rms(&channel[2400..]));
    }
}

#[test]
fn the_plugin_plays_what_the_engine_plays() {
    let expected = engine_alone(&options("electric", RATE), &score(), 24_000);
    assert!(rms(&expected[0]) > 1e-3);
    let mut host = Host::new();
    for blocks in [&[24_000][..], &[480], &[64], &[1], &[17, 1, 960, 33, 256]] {
        let found = host.play(RATE, &score(), 24_000, blocks);
        assert_same_bits(&expected, &found, &format!("blocks of {blocks:?}"));
    }
    assert!(!host.take_restart_request());
}

#[test]
fn hosts_can_cut_everything_and_play_softest() {
    let score = vec![
        (0, Action::Midi([0xB3, 64, 127])),
        (10, Action::NoteOn { channel: 3, key: 50, velocity: 100 }),
        (20, Action::NoteOn { channel: 5, key: 59, velocity: 100 }),
        (6000, Action::ChokeAll),
        (24_000, Action::NoteOn { channel: 0, key: 57, velocity: 0 }),
    ];
    let expected = engine_alone(&options("electric", RATE), &score, 36_000);
    let found = Host::new().play(RATE, &score, 36_000, &[512]);
    assert_same_bits(&expected, &found, "chokes and velocity 0");
    assert!(rms(&found[0][22_000..24_000]) < 0.02 * rms(&found[0][4000..6000]), "the choke left sound");
    assert!(rms(&found[0][26_000..]) > rms(&found[0][22_000..24_000]), "the softest note is not heard");
}

#[test]
fn the_level_scales_and_nothing_else() {
    let expected = engine_alone(&options("electric", RATE), &score(), 24_000);
    let mut host = Host::new();
    let mut louder = score();
    louder.insert(0, (0, Action::Parameter(LEVEL, (6.0 + 60.0) / 72.0)));
    let found = host.play(RATE, &louder, 24_000, &[480]);
    // Past the ramp of 20 ms.
    let gain = 10_f32.powf(6.0 / 20.0);
    for (quiet, loud) in expected[0].iter().zip(&found[0]).skip(1000) {
        assert!((loud - quiet * gain).abs() <= 1e-6 * loud.abs(), "{quiet} became {loud}");
    }
    // Set back to 0 dB through the host's 0 to 1, the samples are untouched again.
    let back = vec![(0, Action::Parameter(LEVEL, 60.0 / 72.0))];
    host.play(RATE, &back, 2000, &[480]);
    assert_same_bits(&expected, &host.play(RATE, &score(), 24_000, &[480]), "back at 0 dB");
}

#[test]
fn another_instrument_plays_at_once() {
    let mut host = Host::new();
    let mut changed = score();
    changed.insert(0, (0, Action::Parameter(INSTRUMENT, 3.0)));
    let found = host.play(RATE, &changed, 24_000, &[480]);
    let expected = engine_alone(&options("bass", RATE), &score(), 24_000);
    // Past the fade from an instrument that was silent.
    assert_same_bits(
        &[expected[0][960..].to_vec(), expected[1][960..].to_vec()],
        &[found[0][960..].to_vec(), found[1][960..].to_vec()],
        "bass",
    );
    // From the next activation on there is no other instrument to fade from.
    assert_same_bits(&expected, &host.play(RATE, &score(), 24_000, &[480]), "bass again");
    assert!(!host.take_restart_request());
}

#[test]
fn no_variation_is_exact() {
    let mut host = Host::new();
    host.play(RATE, &vec![(0, Action::Parameter(VARIATION, 0.0))], 480, &[480]);
    let expected =
        engine_alone(&EngineOptions { variation: 0.0, ..options("electric", RATE) }, &score(), 24_000);
    assert_same_bits(&expected, &host.play(RATE, &score(), 24_000, &[480]), "without variation");
}

#[test]
fn strings_have_outputs_of_their_own() {
    let mut host = Host::new();
    host.choose_ports(1);
    let found = host.perform(RATE, &score(), 24_000, &[480, 33], 8);
    let mut engine = Engine::new(&options("electric", RATE)).expect("the built-in set-up is sound");
    for (at, action) in score() {
        engine.event(at as u32, player_event(action));
    }
    let mut stems = vec![vec![0.0; 24_000]; engine.string_count()];
    let mut parts: Vec<&mut [f32]> = stems.iter_mut().map(|stem| &mut stem[..]).collect();
    let mut stereo = [vec![0.0; 24_000], vec![0.0; 24_000]];
    let [left, right] = &mut stereo;
    engine.process_stems(&mut parts, left, right);
    assert_same_bits(&stereo, &found.stereo, "with outputs for strings");
    assert!(stems == found.stems[..6], "the strings' own outputs differ");
    assert!(stems.iter().filter(|stem| rms(stem) > 1e-3).count() >= 3);
    // There is no seventh string.
    assert!(found.stems[6..].iter().flatten().all(|&sample| sample == 0.0));
}

#[test]
fn silence_is_silence() {
    let [left, right] = Host::new().play(RATE, &Score::new(), 48_000, &[512]);
    assert!(left.iter().chain(&right).all(|&sample| sample == 0.0));
}

#[test]
fn other_sample_rates_play_too() {
    let score = vec![(0, Action::NoteOn { channel: 0, key: 57, velocity: 100 })];
    for rate in [8000.0, 44_100.0, 96_000.0, 192_000.0] {
        let length = (0.2 * rate) as usize;
        let found = Host::new().play(rate, &score, length, &[256]);
        let expected = engine_alone(&options("electric", rate), &score, length);
        assert_same_bits(&expected, &found, &format!("{rate} Hz"));
        assert!(rms(&found[0]) > 1e-3, "silent at {rate} Hz");
    }
}
