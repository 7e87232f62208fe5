//! The pitch wheel on one string: followed no faster than a hand bends, in goals at a bounded rate.

use low_action_dsp::{Gesture, StringGeometry};

use super::technique::{BEND_INTERVAL, BEND_RAMP, BEND_SPEED};
use super::{GestureSink, Moment};

/// What the wheel asks of a string and what has been done about it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Bend {
    /// Channel whose wheel bends the string: that of its last note.
    channel: Option<u8>,
    /// Bend asked for, semitones.
    asked: f64,
    /// Bend last sent, semitones.
    sent: f64,
    /// When the next goal is to be sent.
    due: Option<u64>,
    /// Earliest sample for it.
    ready: u64,
}

impl Bend {
    /// A straight string.
    pub(crate) fn new() -> Self {
        Self::default()
    }

    /// From now on another channel's wheel counts.
    pub(crate) fn follow(&mut self, channel: u8) {
        self.channel = Some(channel);
    }

    /// A channel's wheel moves; nothing happens if it is not this string's.
    pub(crate) fn ask(&mut self, time: u64, channel: u8, semitones: f64) {
        if self.channel == Some(channel) {
            self.asked = semitones;
            if self.asked != self.sent && self.due.is_none() {
                self.due = Some(time.max(self.ready));
            }
        }
    }

    /// When there is something to send.
    pub(crate) fn due(&self) -> Option<u64> {
        self.due
    }

    /// Sends what is due.
    pub(crate) fn send(&mut self, geometry: &StringGeometry, at: &mut Moment<impl GestureSink>) {
        self.due = None;
        self.ready = at.after(BEND_INTERVAL);
        let change = (self.asked - self.sent).abs();
        if change > 0.0 {
            self.sent = self.asked;
            let tension_ratio = geometry.tension_ratio(self.asked).min(geometry.highest_ratio);
            at.does(Gesture::Bend { tension_ratio, duration: (change / BEND_SPEED).max(BEND_RAMP) });
        }
    }
}
