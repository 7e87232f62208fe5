//! A player with an instrument in hand and nothing between them, so that what hands do, what strings do and
//! what is heard can be seen together.

use low_action::performance::{Performance, PlayerEvent};
use low_action_dsp::setup::Pickup;
use low_action_dsp::{Instrument, Quality, Setup, TimedGesture};

use crate::hands::{EXACT, RATE, strings};
use crate::numbers::{largest, rms};

/// Samples between two looks of an observer.
pub const LOOK: u64 = 16;

/// A player with an instrument in hand.
pub struct Stage {
    /// Who plays.
    pub performance: Performance,
    /// What is played.
    pub instrument: Instrument,
    /// Hz.
    pub rate: f64,
}

/// What came of it.
pub struct Played {
    /// What the hands did.
    pub gestures: Vec<TimedGesture>,
    /// The sound of each string.
    pub strings: Vec<Vec<f32>>,
}

impl Stage {
    /// A set-up at 48 kHz, every pluck exactly alike, [heard at its bridge](at_the_bridge).
    pub fn new(setup: &Setup) -> Self {
        Self::over_body(&at_the_bridge(setup))
    }

    /// The same as it is.
    pub fn over_body(setup: &Setup) -> Self {
        let instrument =
            Instrument::new(setup, &Quality::Live.settings(RATE)).expect("the set-up can be built");
        let performance = Performance::new(strings(setup, &instrument), &setup.player, EXACT, RATE);
        Self { performance, instrument, rate: RATE }
    }

    /// One string of a set-up that comes with the program, so that every note is played on it.
    pub fn alone(setup: &str, string: usize) -> Self {
        Self::alone_in(Setup::shipped(setup).expect("it comes with the program"), string)
    }

    /// The same, plucked by what lets go of it at once, however softly: what is held against the edge of a pluck.
    pub fn plucked_at_once(setup: &str, string: usize) -> Self {
        let mut setup = Setup::shipped(setup).expect("it comes with the program");
        setup.player.pluck_release = 0.0;
        Self::alone_in(setup, string)
    }

    fn alone_in(setup: Setup, string: usize) -> Self {
        let spec = setup.string[string].clone();
        Self::new(&Setup { string: vec![spec], ..setup })
    }

    /// Plays events (seconds, in order) for so many seconds from the start.
    pub fn play(&mut self, events: &[(f64, PlayerEvent)], seconds: f64) -> Played {
        self.watch(events, seconds, |_, _| {})
    }

    /// The same, with somebody who looks at time (s) and instrument every [`LOOK`] samples.
    pub fn watch(
        &mut self,
        events: &[(f64, PlayerEvent)],
        seconds: f64,
        mut look: impl FnMut(f64, &Instrument),
    ) -> Played {
        self.performance.reset();
        self.instrument.reset();
        let count = self.instrument.string_count();
        let end = (seconds * self.rate).round() as u64;
        let mut played = Played { gestures: Vec::new(), strings: vec![Vec::new(); count] };
        let mut waiting =
            events.iter().map(|&(time, event)| ((time * self.rate).round() as u64, event)).peekable();
        let mut now = 0;
        while now < end {
            let until = (now + LOOK).min(end);
            let first = played.gestures.len();
            while let Some((time, event)) = waiting.next_if(|event| event.0 < until) {
                self.performance.event(time, event, &mut played.gestures);
            }
            self.performance.advance(until, &mut played.gestures);
            for &gesture in &played.gestures[first..] {
                self.instrument.schedule(gesture).expect("there is room");
            }
            let frames = (until - now) as usize;
            let mut stems = vec![vec![0.0; frames]; count];
            let mut slices: Vec<&mut [f32]> = stems.iter_mut().map(Vec::as_mut_slice).collect();
            let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
            self.instrument.process_stems(&mut slices, &mut left, &mut right);
            for (string, stem) in played.strings.iter_mut().zip(stems) {
                string.extend(stem);
            }
            now = until;
            look(now as f64 / self.rate, &self.instrument);
        }
        played
    }
}

/// The same strings under the same hands at a bridge that does not give way: what hands do is looked for where no body makes some
/// notes louder and others shorter.
pub fn at_the_bridge(setup: &Setup) -> Setup {
    let Some(body) = &setup.body else { return setup.clone() };
    let pickup = if setup.pickup == (Pickup::Microphone {}) { Pickup::Bridge {} } else { setup.pickup };
    Setup { body: None, pickup, gain: setup.gain * body.pascals_per_newton(), ..setup.clone() }
}

/// So many samples are so many seconds.
pub fn at(seconds: f64) -> usize {
    (seconds * RATE) as usize
}

/// A key goes down on channel 1; velocity 0 to 127.
pub fn on(key: u8, velocity: u8) -> PlayerEvent {
    PlayerEvent::NoteOn { channel: 0, key, velocity: f32::from(velocity) / 127.0 }
}

/// It goes up.
pub fn off(key: u8) -> PlayerEvent {
    PlayerEvent::NoteOff { channel: 0, key }
}

/// A controller of channel 1, 0 to 127.
pub fn cc(number: u8, value: u8) -> PlayerEvent {
    PlayerEvent::Controller { channel: 0, number, value: f32::from(value) / 127.0 }
}

/// The pitch wheel of channel 1 is announced to reach an octave.
pub fn octave() -> [(f64, PlayerEvent); 3] {
    [cc(101, 0), cc(100, 0), cc(6, 12)].map(|event| (0.0, event))
}

/// It is turned by so many semitones of that.
pub fn wheel(semitones: f64) -> PlayerEvent {
    PlayerEvent::PitchBend { channel: 0, value: (semitones / 12.0) as f32 }
}

/// Amplitude of one frequency (Hz) in a sound under a Hann window: 1 for a sine of amplitude 1.
pub fn amplitude<T: Copy + Into<f64>>(sound: &[T], rate: f64, frequency: f64) -> f64 {
    let count = sound.len() as f64;
    let turn = std::f64::consts::TAU;
    let (mut re, mut im) = (0.0, 0.0);
    for (n, &sample) in sound.iter().enumerate() {
        let hann = 1.0 - (turn * (n as f64 + 0.5) / count).cos();
        let phase = turn * frequency * n as f64 / rate;
        re += hann * sample.into() * phase.cos();
        im -= hann * sample.into() * phase.sin();
    }
    2.0 * re.hypot(im) / count
}

/// The frequency of a MIDI key, Hz.
pub fn hertz(key: f64) -> f64 {
    440.0 * ((key - 69.0) / 12.0).exp2()
}

/// The largest |sample|.
pub fn peak(sound: &[f32]) -> f64 {
    largest(sound.iter().map(|sample| sample.abs()))
}

/// A ratio of sizes, dB.
pub fn decibels(ratio: f64) -> f64 {
    20.0 * largest([ratio, 1e-15]).log10()
}

/// The mean size of a sound, dB.
pub fn level(sound: &[f32]) -> f64 {
    decibels(rms(sound))
}
