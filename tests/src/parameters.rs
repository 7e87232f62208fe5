//! The plugin with its parameters set, and what is heard of it.

use crate::host::{Action, Host, Score, parameter};
use crate::pitch::{cents, frequency_near};
use crate::stage::hertz;

/// Hz.
pub const RATE: f64 = 48_000.0;
/// Half a second.
pub const LENGTH: usize = 24_000;

/// Two notes, one stopped and one open, the second softer.
pub fn score() -> Score {
    vec![
        (480, Action::NoteOn { channel: 0, key: 48, velocity: 110 }),
        (6000, Action::NoteOn { channel: 0, key: 59, velocity: 60 }),
        (20_000, Action::NoteOff { channel: 0, key: 48 }),
    ]
}

/// A host that renders offline with parameters set before everything else, and the quality of real time
/// unless another is.
pub fn host_with(settings: &[(&str, f64)]) -> Host {
    let mut host = Host::new();
    let settings = [("render_quality", 0.0)].iter().chain(settings);
    let settings = settings.map(|&(id, value)| (0, Action::Parameter(parameter(id), value))).collect();
    // A first activation takes the values in; the second begins with them.
    host.play(RATE, &settings, 64, &[64]);
    host
}

/// The left channel of the plugin with parameters set before everything else.
pub fn with(settings: &[(&str, f64)], score: &Score) -> Vec<f32> {
    let [left, _] = host_with(settings).play(RATE, score, LENGTH, &[512]);
    left
}

/// One stopped note, C3 on the string A2.
pub fn stopped() -> Score {
    vec![(0, Action::NoteOn { channel: 0, key: 48, velocity: 100 })]
}

/// Pitch of a sound from 0.1 s on, as a MIDI note number within 60 cents of `near`.
pub fn sounding_pitch(sound: &[f32], near: f64) -> f64 {
    near + 0.01 * cents(frequency_near(&sound[4800..], RATE, hertz(near)), hertz(near))
}
