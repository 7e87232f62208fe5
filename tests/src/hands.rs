//! A player's hands alone: what they do to the strings of an instrument, with nothing that sounds.

use low_action::controls::Touching;
use low_action::performance::{GestureSink, InputMode, Performance, PlayedString, PlayerEvent, Style};
use low_action_dsp::{FINGERS_PER_STRING, Gesture, Instrument, Quality, Setup, TimedGesture};

/// Hz.
pub const RATE: f64 = 48_000.0;
/// Every pluck exactly alike, and a wheel that reaches two semitones.
pub const EXACT: Style = Style { variation: 0.0, seed: 0, bend_range: 2.0 };
/// How long hands are given to leave the strings after the last event, samples.
const REST: u64 = 4 * RATE as u64;

/// An instrument as its player knows it.
pub struct Neck {
    /// The instrument.
    pub setup: Setup,
    /// Its strings.
    pub strings: Vec<PlayedString>,
}

impl Neck {
    /// Of a set-up that comes with the program; tuning it takes a moment.
    pub fn of(name: &str) -> Self {
        let setup = Setup::shipped(name).expect("it comes with the program");
        let instrument =
            Instrument::new(&setup, &Quality::Live.settings(RATE)).expect("the set-up can be built");
        let strings = strings(&setup, &instrument);
        Self { setup, strings }
    }

    /// A player who has not touched it yet.
    pub fn player(&self, style: Style) -> Performance {
        Performance::new(self.strings.clone(), &self.setup.player, style, RATE)
    }

    /// A player with plain hands, as they are after events (samples) and what follows upon them up to a sample, and whoever has been
    /// told all of it.
    pub fn after<S: GestureSink>(
        &self,
        events: &[(u64, PlayerEvent)],
        until: u64,
        mut told: S,
    ) -> (Performance, S) {
        let mut player = self.player(EXACT);
        player.touch(0, &Touching::new(0.0, 2.0), &mut told);
        for &(time, event) in events {
            player.event(time, event, &mut told);
        }
        player.advance(until, &mut told);
        (player, told)
    }

    /// What hands that act so make of events (samples), with channels taken in a mode.
    pub fn told(
        &self,
        input: InputMode,
        touching: &Touching,
        events: &[(u64, PlayerEvent)],
    ) -> Vec<TimedGesture> {
        let mut player = self.player(EXACT);
        player.set_input(input);
        player.touch(0, touching, &mut Vec::new());
        play(&mut player, events)
    }
}

/// A key goes down on a channel, 0 to 15.
pub fn note(channel: u8, key: u8) -> PlayerEvent {
    PlayerEvent::NoteOn { channel, key, velocity: 0.8 }
}

/// A controller of a channel, 0 to 127.
pub fn control(channel: u8, number: u8, value: u8) -> PlayerEvent {
    PlayerEvent::Controller { channel, number, value: f32::from(value) / 127.0 }
}

/// The wheel of a channel, −1 to 1.
pub fn wheel(channel: u8, value: f32) -> PlayerEvent {
    PlayerEvent::PitchBend { channel, value }
}

/// What a player knows of the strings of an instrument that is built from a set-up.
pub fn strings(setup: &Setup, instrument: &Instrument) -> Vec<PlayedString> {
    (0..instrument.string_count()).map(|index| PlayedString::new(setup, instrument, index)).collect()
}

/// Events that each come so many samples after the one before, and at the last everything stops.
pub fn stopped_at_last(steps: Vec<(u64, PlayerEvent)>) -> Vec<(u64, PlayerEvent)> {
    let mut time = 0;
    let timed = |(step, event)| {
        time += step;
        (time, event)
    };
    let mut events: Vec<_> = steps.into_iter().map(timed).collect();
    events.push((time, PlayerEvent::AllNotesOff));
    events
}

/// Plays events (samples) and four seconds more, until every hand is gone.
pub fn play(performance: &mut Performance, events: &[(u64, PlayerEvent)]) -> Vec<TimedGesture> {
    let mut gestures = Vec::new();
    for &(time, event) in events {
        performance.event(time, event, &mut gestures);
    }
    performance.advance(end(events), &mut gestures);
    gestures
}

/// The same with time cut into blocks of so many samples.
pub fn play_in_blocks(
    performance: &mut Performance,
    events: &[(u64, PlayerEvent)],
    block: u64,
) -> Vec<TimedGesture> {
    let mut gestures = Vec::new();
    let mut waiting = events.iter().peekable();
    let mut now = 0;
    while now < end(events) {
        now = (now + block).min(end(events));
        while let Some(&(time, event)) = waiting.next_if(|event| event.0 < now) {
            performance.event(time, event, &mut gestures);
        }
        performance.advance(now, &mut gestures);
    }
    gestures
}

fn end(events: &[(u64, PlayerEvent)]) -> u64 {
    events.last().map_or(0, |event| event.0) + REST
}

/// What is done to one string, in order of time. Hands do to each string what they do, whatever they do to others, so only the
/// order within each counts.
pub fn of_string(gestures: &[TimedGesture], string: usize) -> Vec<TimedGesture> {
    gestures.iter().filter(|gesture| gesture.string == string).copied().collect()
}

/// Sample, string and force of all plucks.
pub fn plucks(gestures: &[TimedGesture]) -> Vec<(u64, usize, f64)> {
    let pluck = |timed: &TimedGesture| match timed.gesture {
        Gesture::Pluck { force, .. } => Some((timed.time, timed.string, force)),
        _ => None,
    };
    gestures.iter().filter_map(pluck).collect()
}

/// How many those are.
pub fn count_plucks(gestures: &[TimedGesture]) -> usize {
    plucks(gestures).len()
}

/// Whether any finger is left on a string at the end.
pub fn any_left(gestures: &[TimedGesture]) -> bool {
    let mut left = Vec::new();
    for &TimedGesture { string, gesture, .. } in gestures {
        left.resize(left.len().max(string + 1), [false; FINGERS_PER_STRING]);
        match gesture {
            Gesture::Place { finger, .. } | Gesture::Throw { finger, .. } => left[string][finger] = true,
            Gesture::Lift { finger, .. } => left[string][finger] = false,
            _ => {}
        }
    }
    left.iter().flatten().any(|&there| there)
}
