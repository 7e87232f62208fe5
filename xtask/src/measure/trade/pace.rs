//! How fast a whole instrument is at a quality: six strings fretted and ringing.

use std::time::Instant;

use anyhow::Result;
use low_action_dsp::Instrument;

use super::settings::Setting;
use crate::measure::chord;

/// Time before anything is measured, and measured, s.
const WARM_UP: f64 = 0.1;
const MEASURED: f64 = 0.3;

/// How many times faster than real time the chord is computed, filters included.
pub fn of_the_chord(setting: &Setting) -> Result<f64> {
    let setup = chord::lowest_strings(6);
    let mut instrument = Instrument::new(&setup, &setting.engine())?;
    for string in 0..instrument.string_count() {
        chord::stop(&mut instrument, &setup, string, chord::fret(string))?;
        chord::pluck(&mut instrument, &setup, string)?;
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
