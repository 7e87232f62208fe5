//! Whole instruments, as they are played.

use std::hash::{DefaultHasher, Hash, Hasher};

use low_action_dsp::{EngineSettings, Gesture, Instrument, Quality, Setup, TimedGesture};

/// `live`, but every string takes one step in a sample.
fn alike(rate: f64) -> EngineSettings {
    EngineSettings { widest_spacing: f64::INFINITY, ..Quality::Live.settings(rate) }
}

/// The default instrument with so many of its strings from the lowest on.
fn instrument(strings: usize, settings: &EngineSettings) -> (Setup, Instrument) {
    let mut setup = Setup::builtin("electric").expect("it is built in");
    setup.string.reverse();
    setup.string.truncate(strings);
    let instrument = Instrument::new(&setup, settings).expect("it can be built");
    (setup, instrument)
}

/// Frets (0: none) and plucks every string, and plays on for a tenth of a second. Returns the hash of the sound.
fn begin(setup: &Setup, instrument: &mut Instrument, rate: f64, fret: impl Fn(usize) -> usize) -> u64 {
    let player = &setup.player;
    for string in 0..instrument.string_count() {
        let geometry = instrument.geometry(string).clone();
        let (fretting, touch) = (&player.fretting, player.fretting.touch);
        let place = geometry.finger_position(fret(string));
        let away = geometry.length - player.pluck_position;
        let force = 0.6 * player.pluck_force;
        let finger = [
            Gesture::Place { finger: 0, touch, position: place, clearance: fretting.hover },
            Gesture::Press { finger: 0, force: fretting.force, duration: fretting.landing },
        ];
        let pluck = Gesture::Pluck { position: away, force, duration: player.pluck_duration };
        let fingers = if fret(string) > 0 { &finger[..] } else { &[] };
        for &gesture in fingers.iter().chain([&pluck]) {
            instrument.schedule(TimedGesture { time: 0, string, gesture }).expect("there is room");
        }
    }
    let samples = (0.1 * rate) as usize;
    let (mut left, mut right) = (vec![0.0f32; samples], vec![0.0; samples]);
    instrument.process(&mut left, &mut right);
    let mut hasher = DefaultHasher::new();
    left.iter().chain(&right).for_each(|sample| sample.to_bits().hash(&mut hasher));
    hasher.finish()
}

/// How the strings of the chord are computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Steps {
    /// As `live` has it: light strings take several steps in a sample.
    Live,
    /// One step in a sample.
    One,
}

/// Six strings fretted and ringing, and the hash of how they began.
pub fn chord(rate: f64, steps: Steps) -> (Instrument, u64) {
    let settings = if steps == Steps::Live { Quality::Live.settings(rate) } else { alike(rate) };
    let (setup, mut instrument) = instrument(6, &settings);
    let hash = begin(&setup, &mut instrument, rate, |string| 3 + string % 3);
    (instrument, hash)
}

/// So many open strings, all ringing: the lowest again and again, so that they are alike.
pub fn strings_of(count: usize) -> Instrument {
    let (mut setup, _) = instrument(1, &alike(48e3));
    setup.string = vec![setup.string[0].clone(); count];
    let mut instrument = Instrument::new(&setup, &alike(48e3)).expect("it can be built");
    begin(&setup, &mut instrument, 48e3, |_| 0);
    instrument
}

/// Six strings that nobody plays.
pub fn silent() -> Instrument {
    instrument(6, &Quality::Live.settings(48e3)).1
}
