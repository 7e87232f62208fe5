//! Whole instruments, as they are played.

use low_action_dsp::{EngineSettings, Instrument, Quality, Setup};

use super::SAMPLES;
use super::chord::{fret, lowest_strings, pluck, stop};

/// `live`, but every string takes one step in a sample.
fn alike(rate: f64) -> EngineSettings {
    EngineSettings { widest_spacing: f64::INFINITY, ..Quality::Live.settings(rate) }
}

/// An instrument of these strings.
fn instrument(setup: &Setup, settings: &EngineSettings) -> Instrument {
    Instrument::new(setup, settings).expect("it can be built")
}

/// The lowest string by itself.
pub fn lowest_alone() -> Instrument {
    instrument(&lowest_strings(1), &alike(48e3))
}

/// Frets (0: none) and plucks every string, and plays on for a tenth of a second.
fn begin(setup: &Setup, instrument: &mut Instrument, rate: f64, behind: impl Fn(usize) -> usize) {
    for string in 0..instrument.string_count() {
        stop(instrument, setup, string, behind(string)).expect("there is room");
        pluck(instrument, setup, string).expect("there is room");
    }
    let samples = (0.1 * rate) as usize;
    let (mut left, mut right) = (vec![0.0f32; samples], vec![0.0; samples]);
    instrument.process(&mut left, &mut right);
}

/// The checksum (CRC-32) of what is timed of an instrument: the samples as they are on every machine, left and right.
fn checksum(mut instrument: Instrument) -> u32 {
    let (mut left, mut right) = (vec![0.0f32; SAMPLES], vec![0.0; SAMPLES]);
    instrument.process(&mut left, &mut right);
    let mut hasher = crc32fast::Hasher::new();
    left.iter().chain(&right).for_each(|sample| hasher.update(&sample.to_le_bytes()));
    hasher.finalize()
}

/// How the strings of the chord are computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Steps {
    /// As `live` has it: light strings take several steps in a sample.
    Live,
    /// One step in a sample.
    One,
}

/// Six strings fretted and ringing, and the checksum of how they go on.
pub fn chord(rate: f64, steps: Steps) -> (Instrument, u32) {
    let settings = if steps == Steps::Live { Quality::Live.settings(rate) } else { alike(rate) };
    let setup = lowest_strings(6);
    let mut instrument = instrument(&setup, &settings);
    begin(&setup, &mut instrument, rate, fret);
    let checksum = checksum(instrument.clone());
    (instrument, checksum)
}

/// So many open strings, all ringing: the lowest again and again, so that they are alike.
pub fn strings_of(count: usize) -> Instrument {
    let mut setup = lowest_strings(1);
    setup.string = vec![setup.string[0].clone(); count];
    let mut instrument = instrument(&setup, &alike(48e3));
    begin(&setup, &mut instrument, 48e3, |_| 0);
    instrument
}

/// Six strings that nobody plays.
pub fn silent() -> Instrument {
    instrument(&lowest_strings(6), &Quality::Live.settings(48e3))
}
