//! Promise: gain is fixed by the set-up, so that a chord of all strings at velocity 100, open or fretted in one of the usual
//! ways, peaks between −12 and −3 dBFS; nothing is normalised or limited, and the constant part is less than a thousandth of
//! the peak.

use low_action::engine::{Engine, EngineOptions};
use low_action::performance::PlayerEvent;
use low_action_dsp::Setup;
use low_action_tests::numbers::largest;

const RATE: f64 = 48_000.0;

/// E, G, A minor, F and C at the fifth fret, and the open strings.
const GUITAR: [[u8; 6]; 6] = [
    [40, 47, 52, 56, 59, 64],
    [43, 47, 50, 55, 59, 67],
    [45, 52, 57, 60, 64, 69],
    [41, 48, 53, 57, 60, 65],
    [48, 55, 60, 64, 67, 72],
    [40, 45, 50, 55, 59, 64],
];

/// E, G, A minor and E at the twelfth fret, and the open strings.
const BASS: [[u8; 4]; 5] =
    [[28, 35, 40, 44], [31, 38, 43, 47], [33, 36, 40, 45], [40, 45, 50, 55], [28, 33, 38, 43]];

/// Left and right of a chord that rings for some seconds.
fn chord(setup: &Setup, keys: &[u8], velocity: u8, variation: f64, seconds: f64) -> [Vec<f32>; 2] {
    let options = EngineOptions { variation, ..EngineOptions::new(setup.clone(), RATE) };
    let mut engine = Engine::new(&options).unwrap();
    for &key in keys {
        let velocity = f32::from(velocity) / 127.0;
        engine.event(0, PlayerEvent::NoteOn { channel: 0, key, velocity });
    }
    let [mut left, mut right] = [(); 2].map(|()| vec![0.0; (seconds * RATE) as usize]);
    engine.process(&mut left, &mut right);
    [left, right]
}

fn peak(sound: &[Vec<f32>; 2]) -> f64 {
    largest(sound.iter().flatten().map(|sample| sample.abs()))
}

/// Mean under a Hann window, which the lowest note, 20 periods long, passes by less than 1/(20³ π) = 4e-5 of
/// its amplitude; under none it would pass 1/(20 π).
fn constant_part(sound: &[f32]) -> f64 {
    let count = sound.len() as f64;
    let hann = |i: usize| 1.0 - (std::f64::consts::TAU * (i as f64 + 0.5) / count).cos();
    sound.iter().enumerate().map(|(i, &sample)| hann(i) * f64::from(sample)).sum::<f64>() / count
}

fn check(name: &str, chords: &[&[u8]]) {
    let setup = Setup::builtin(name).unwrap();
    for keys in chords {
        for variation in [0.0, EngineOptions::VARIATION] {
            let sound = chord(&setup, keys, 100, variation, 0.5);
            let peak = peak(&sound);
            let decibels = 20.0 * peak.log10();
            println!("{name} {keys:?}, variation {variation}: peak {decibels:.1} dBFS");
            assert!((-12.0..=-3.0).contains(&decibels), "{name} {keys:?}: {decibels:.1} dBFS");
            for channel in &sound {
                let mean = constant_part(channel);
                println!("    constant part {mean:.1e}");
                assert!(mean.abs() < 1e-3 * peak, "{name} {keys:?}: constant part {mean:e}, peak {peak}");
            }
        }
    }
}

#[test]
fn guitar_chords_are_loud_enough_and_never_clip() {
    let chords: Vec<&[u8]> = GUITAR.iter().map(|chord| chord.as_slice()).collect();
    for name in ["electric", "classical", "steel"] {
        check(name, &chords);
    }
}

#[test]
fn bass_chords_are_loud_enough_and_never_clip() {
    let chords: Vec<&[u8]> = BASS.iter().map(|chord| chord.as_slice()).collect();
    check("bass", &chords);
}

/// From velocity 60 to 100 force grows by 6.7 dB, as velocity's power of 1.5, and so does the peak: within 2 dB, for hard plucks hit
/// frets, which takes some of it, and slip off faster, which makes edges sharper.
#[test]
fn velocity_is_heard() {
    let law = 30.0 * (100.0_f64 / 60.0).log10();
    for name in Setup::BUILTIN {
        let setup = Setup::builtin(name).unwrap();
        let keys: &[u8] = if name == "bass" { &BASS[0] } else { &GUITAR[0] };
        let [soft, loud] = [60, 100].map(|velocity| peak(&chord(&setup, keys, velocity, 0.0, 0.5)));
        let rise = 20.0 * (loud / soft).log10();
        println!("{name}: {rise:.1} dB");
        assert!((rise - law).abs() < 2.0, "{name}: {rise:.1} dB and not {law:.1}");
    }
}

/// Twice the gain is twice every sample, far over full scale too: no limiter, no normalisation.
#[test]
fn gain_is_only_a_factor() {
    let setup = Setup::builtin("electric").unwrap();
    let louder = Setup { gain: 16.0 * setup.gain, ..setup.clone() };
    let [plain, louder] = [&setup, &louder].map(|setup| chord(setup, &GUITAR[0], 100, 0.0, 0.2));
    assert!(peak(&louder) > 1.0);
    let same = |(plain, louder): (&f32, &f32)| 16.0 * plain == *louder;
    assert!(plain.iter().flatten().zip(louder.iter().flatten()).all(same));
}
