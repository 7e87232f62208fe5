//! Instruments whose strings ring, to be handed over.

use low_action_dsp::{Gesture, Instrument, Quality, Setup, TimedGesture};

/// The sample rate, Hz.
pub const RATE: f64 = 48_000.0;

/// A set-up at `live`.
pub fn build(setup: &Setup) -> Instrument {
    Instrument::new(setup, &Quality::Live.settings(RATE)).expect("the set-up can be built")
}

/// Presses every other string behind fret 5 and plucks them all.
pub fn strike(instrument: &mut Instrument, setup: &Setup) {
    let player = &setup.player;
    for string in 0..instrument.string_count() {
        let time = instrument.now();
        let length = instrument.geometry(string).length;
        let mut does = |time, gesture| {
            instrument.schedule(TimedGesture { time, string, gesture }).expect("there is room");
        };
        if string % 2 == 0 {
            let position = 0.22 * length;
            let (touch, force) = (player.fretting.touch, player.fretting.force);
            does(time, Gesture::Place { finger: 0, touch, position, clearance: 1e-4 });
            does(time, Gesture::Press { finger: 0, force, duration: 0.004 });
        }
        let position = length - player.pluck_position;
        let force = player.pluck_force;
        does(time + 240, Gesture::Pluck { position, force, duration: player.pluck_duration, release: 0.0 });
    }
}

/// Appends so many samples of the left channel.
pub fn play(instrument: &mut Instrument, samples: usize, sound: &mut Vec<f32>) {
    let mut block = [vec![0.0; samples], vec![0.0; samples]];
    let [left, right] = &mut block;
    instrument.process(left, right);
    sound.extend_from_slice(left);
}
