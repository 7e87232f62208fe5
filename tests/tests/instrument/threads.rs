//! Promise: strings that are shared out among threads give the same bits as by one, in stretches of any length, with gestures
//! anywhere in them, and string by string.

use std::num::NonZeroUsize;

use low_action::engine::{Engine, EngineOptions};
use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;

const RATE: f64 = 48_000.0;
const SAMPLES: usize = 72_000;

/// Stereo sound and stems of a few chords, bends and rests, by so many threads in blocks of this size.
fn play(name: &str, threads: usize, block: usize) -> Vec<u32> {
    let setup = Setup::builtin(name).expect("it is built in");
    let threads = NonZeroUsize::new(threads).expect("there is one");
    let options = EngineOptions { threads, ..EngineOptions::new(setup, RATE) };
    let mut engine = Engine::new(&options).expect("it can be built");
    let strings = engine.string_count();
    let mut sounds = vec![vec![0.0f32; SAMPLES]; strings + 2];
    let mut events = score().into_iter().peekable();
    let mut done = 0;
    while done < SAMPLES {
        let span = done..(done + block).min(SAMPLES);
        while let Some((time, event)) = events.next_if(|&(time, _)| time < span.end) {
            engine.event((time - done) as u32, event);
        }
        let mut parts: Vec<&mut [f32]> = sounds.iter_mut().map(|sound| &mut sound[span.clone()]).collect();
        let (stems, sides) = parts.split_at_mut(strings);
        let (left, right) = sides.split_at_mut(1);
        engine.process_stems(stems, left[0], right[0]);
        done = span.end;
    }
    assert_eq!(engine.lost_events(), 0, "nothing is lost");
    for (index, sound) in sounds.iter().enumerate() {
        assert!(sound.iter().any(|sample| sample.abs() > 1e-3), "sound {index} is none");
    }
    sounds.iter().flatten().map(|sample| sample.to_bits()).collect()
}

/// Chords on all strings, one of them with a bend at each sample for a while, and a string that is silent for a time.
fn score() -> Vec<(usize, PlayerEvent)> {
    let mut score = Vec::new();
    for (beat, keys) in [[40, 47, 52, 56, 59, 64], [43, 47, 50, 55, 59, 67]].into_iter().enumerate() {
        for (index, key) in keys.into_iter().enumerate() {
            let time = 311 + 24_000 * beat + 997 * index;
            score.push((time, PlayerEvent::NoteOn { channel: 0, key, velocity: 0.8 }));
            score.push((time + 15_000, PlayerEvent::NoteOff { channel: 0, key }));
        }
    }
    for sample in 0..3_000 {
        let value = 1e-3 * (sample % 900) as f32;
        score.push((9_000 + sample, PlayerEvent::PitchBend { channel: 0, value }));
    }
    score.sort_by_key(|&(time, _)| time);
    score
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let expected = play("electric", 1, 512);
    for (threads, block) in [(2, 8_192), (2, 100), (3, SAMPLES), (64, 5_000)] {
        assert!(play("electric", threads, block) == expected, "{threads} threads in blocks of {block}");
    }
}

/// They hear each other: whoever asks for threads has one play them all.
#[test]
fn strings_over_a_body_are_one_threads_work() {
    let expected = play("steel", 1, 512);
    for (threads, block) in [(2, 8_192), (6, SAMPLES)] {
        assert!(play("steel", threads, block) == expected, "{threads} threads in blocks of {block}");
    }
}
