//! Promise: strings that may hardly be bent are in tune, too, however hard fingers press and plucks pull: their grids have room
//! for what stretches them, and no wave as short as the grid's ripples.

use low_action::engine::{Engine, EngineOptions};
use low_action::performance::{InputMode, PlayerEvent};
use low_action_dsp::Setup;
use low_action_tests::numbers::rms;
use low_action_tests::pitch::{cents, frequency_near};
use low_action_tests::stage::{at_the_bridge, hertz};

const RATE: f64 = 48_000.0;

/// Two seconds of a key on the string of index `string`, left channel.
fn note(setup: &Setup, string: u8, key: u8, velocity: f32) -> Vec<f32> {
    let options = EngineOptions { variation: 0.0, ..EngineOptions::new(setup.clone(), RATE) };
    let mut engine = Engine::new(&options).expect("the set-up can be built");
    engine.set_input(InputMode::Strings { first: 0, from_last: false });
    engine.event(0, PlayerEvent::NoteOn { channel: string, key, velocity });
    let samples = (2.0 * RATE) as usize;
    let (mut left, mut right) = (vec![0.0; samples], vec![0.0; samples]);
    engine.process(&mut left, &mut right);
    left
}

/// How much of a sound is at half the sample rate and next to it, dB of the whole.
fn ripple(sound: &[f32]) -> f64 {
    let kept: Vec<f32> = sound
        .windows(9)
        .map(|part| {
            // 1 at half the rate, and almost nothing below a third of it.
            let weights = [1.0, -8.0, 28.0, -56.0, 70.0, -56.0, 28.0, -8.0, 1.0];
            part.iter().zip(weights).map(|(x, weight)| x * weight / 256.0).sum()
        })
        .collect();
    20.0 * (rms(&kept) / rms(sound)).log10()
}

/// Pitch within 2 cents (0.8 are found, of a hard pluck that has not quite rung down), and ripples of less than a thousandth of the
/// sound. Grids made for the bends alone leave strings up to 27 cents flat here, and ripples as loud as the sound.
#[test]
fn strings_that_may_hardly_be_bent_are_in_tune() {
    for (name, force) in [("electric", 13.0), ("steel", 25.0), ("classical", 13.0), ("bass", 25.0)] {
        let mut setup = at_the_bridge(&Setup::builtin(name).expect("it is built in"));
        setup.player.fretting.force = force;
        for (max_bend, string) in
            [0.0, 0.3].into_iter().flat_map(|bend| (0..setup.string.len()).map(move |string| (bend, string)))
        {
            setup.max_bend = max_bend;
            for fret in [1, 7] {
                let key = setup.string[string].pitch as u8 + fret;
                let expected = hertz(f64::from(key));
                let sound = note(&setup, string as u8, key, 1.0);
                let off = cents(frequency_near(&sound[48_000..], RATE, expected), expected);
                let ripple = ripple(&sound[24_000..]);
                println!(
                    "{name}, max_bend {max_bend}, string {string}, fret {fret}: {off:.2} cents, {ripple:.0} dB"
                );
                assert!(
                    off.abs() < 2.0,
                    "{name}, max_bend {max_bend}, string {string}, fret {fret}: {off} cents"
                );
                assert!(
                    ripple < -60.0,
                    "{name}, max_bend {max_bend}, string {string}, fret {fret}: {ripple} dB"
                );
            }
        }
    }
}
