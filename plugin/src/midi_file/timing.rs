//! Exact time: ticks, tempo maps and samples in whole numbers.

use super::MidiFileError;

/// Tempo of a file that sets none, microseconds a beat: 120 beats a minute, as the standard says.
const DEFAULT_TEMPO: u32 = 500_000;

/// What a tick lasts: `units / per_second` seconds, where a beat-based file multiplies `units` by
/// its tempo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Division {
    /// Units of one tick; `None` when the tempo decides (microseconds a beat).
    units: Option<u32>,
    /// Units in a second, above 0.
    per_second: u64,
}

impl Division {
    /// Reads the header's last field.
    pub(super) fn from_header(raw: u16) -> Result<Self, MidiFileError> {
        let [high, low] = raw.to_be_bytes();
        if raw & 0x8000 == 0 {
            // Ticks a beat. Units are microseconds × ticks a beat.
            return match raw {
                0 => Err(MidiFileError::Division(raw)),
                _ => Ok(Self { units: None, per_second: u64::from(raw) * 1_000_000 }),
            };
        }
        // SMPTE: frames a second (negative), ticks a frame.
        let (units, frames) = match i8::from_be_bytes([high]) {
            -24 => (1, 24),
            -25 => (1, 25),
            // Drop-frame television: 30000/1001 frames a second.
            -29 => (1001, 30_000),
            -30 => (1, 30),
            _ => return Err(MidiFileError::Division(raw)),
        };
        match low {
            0 => Err(MidiFileError::Division(raw)),
            ticks => Ok(Self { units: Some(units), per_second: frames * u64::from(ticks) }),
        }
    }

    /// Whether the tempo decides what a tick lasts.
    pub(super) fn follows_tempo(self) -> bool {
        self.units.is_none()
    }
}

/// A moment in a song, exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SongTime {
    units: u128,
    per_second: u64,
}

impl SongTime {
    /// The start of a song.
    pub(super) fn zero(division: Division) -> Self {
        Self { units: 0, per_second: division.per_second }
    }

    /// The moment in seconds.
    pub fn seconds(self) -> f64 {
        self.units as f64 / self.per_second as f64
    }

    /// The nearest sample at a rate in Hz.
    pub fn sample(self, sample_rate: u32) -> u64 {
        let per_second = u128::from(self.per_second);
        // Largest: 2^25 events of 2^28 ticks of 2^24 µs, × 2^19 Hz: 96 bits.
        let nearest = (self.units * u128::from(sample_rate) + per_second / 2) / per_second;
        u64::try_from(nearest).unwrap_or(u64::MAX)
    }
}

/// Walks along the ticks of tracks that play together.
pub(super) struct Clock {
    division: Division,
    tempo: u32,
    tick: u64,
    now: SongTime,
}

impl Clock {
    /// A clock at tick 0, which falls on `start`.
    pub(super) fn new(division: Division, start: SongTime) -> Self {
        Self { division, tempo: DEFAULT_TEMPO, tick: 0, now: start }
    }

    /// Goes on to a tick, at or after the present one.
    pub(super) fn advance_to(&mut self, tick: u64) {
        let units = u128::from(self.division.units.unwrap_or(self.tempo));
        self.now.units += u128::from(tick.saturating_sub(self.tick)) * units;
        self.tick = tick;
    }

    /// Changes the tempo from here on, microseconds a beat.
    pub(super) fn set_tempo(&mut self, tempo: u32) {
        self.tempo = tempo;
    }

    /// The present moment.
    pub(super) fn now(&self) -> SongTime {
        self.now
    }
}
