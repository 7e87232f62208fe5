//! What a whole instrument takes at a quality: six strings fretted and ringing.

use std::time::Instant;

use anyhow::{Context, Result};
use low_action_dsp::{Gesture, Instrument, Setup, TimedGesture};

use super::settings::Setting;

/// Time before anything is measured, and measured, s.
const WARM_UP: f64 = 0.1;
const MEASURED: f64 = 0.3;

/// How many times faster than real time the chord is computed, filters included.
pub fn speed(setting: &Setting) -> Result<f64> {
    let setup = Setup::builtin("electric").context("the default instrument is built in")?;
    let mut instrument = Instrument::new(&setup, &setting.engine())?;
    let fretting = setup.player.fretting;
    for string in 0..instrument.string_count() {
        let geometry = instrument.geometry(string);
        let (place, away) =
            (geometry.finger_position(3 + string % 3), geometry.length - setup.player.pluck_position);
        let force = 0.6 * setup.player.pluck_force;
        for gesture in [
            Gesture::Place { finger: 0, touch: fretting.touch, position: place, clearance: fretting.hover },
            Gesture::Press { finger: 0, force: fretting.force, duration: fretting.landing },
            Gesture::Pluck { position: away, force, duration: setup.player.pluck_duration },
        ] {
            instrument.schedule(TimedGesture { time: 0, string, gesture })?;
        }
    }
    let mut play = |seconds: f64| {
        let count = (seconds * setting.rate) as usize;
        let (mut left, mut right) = (vec![0.0; count], vec![0.0; count]);
        let started = Instant::now();
        instrument.process(&mut left, &mut right);
        std::hint::black_box((left, right));
        started.elapsed().as_secs_f64()
    };
    play(WARM_UP);
    Ok(MEASURED / play(MEASURED))
}
