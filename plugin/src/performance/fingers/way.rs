//! Where a finger is that slides along the string: what it is told next counts from there, and not from where it was to be.

use super::{Finger, Fingers};
use crate::performance::{GestureSink, Moment};

/// A slide along the string, all at one speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Way {
    /// Where it begins, m from the nut,
    from: f64,
    /// at which sample,
    begins: u64,
    /// and at which it ends.
    ends: u64,
}

impl Way {
    /// From a place, m from the nut, within so many seconds.
    pub fn from(place: f64, duration: f64, at: &Moment<impl GestureSink>) -> Self {
        Self { from: place, begins: at.time, ends: at.after(duration) }
    }

    /// Where it has come to that leads to a place, m from the nut.
    pub fn come_to(&self, end: f64, time: u64) -> f64 {
        if time >= self.ends {
            return end;
        }
        let part = time.saturating_sub(self.begins) as f64 / (self.ends - self.begins) as f64;
        self.from + (end - self.from) * part
    }
}

impl Finger {
    /// Whether a slide has not got to its fret yet.
    pub(super) fn is_under_way(&self, time: u64) -> bool {
        time < self.way.ends
    }

    /// How long that takes yet, s.
    pub(super) fn time_to_arrive(&self, at: &Moment<impl GestureSink>) -> f64 {
        seconds_until(self.way.ends, at)
    }

    /// How long it takes when it is to be elsewhere after so many seconds: no wheel and no vibrato hurries one that is on
    /// its way to its note, s.
    pub(super) fn unhurried(&self, duration: f64, at: &Moment<impl GestureSink>) -> f64 {
        duration.max(seconds_until(self.at_note, at))
    }
}

impl Fingers {
    /// How many frets from that of its note a finger under way will stop the string in so many seconds; `None` once it is there.
    pub(crate) fn passes(&self, ahead: f64, at: &Moment<impl GestureSink>) -> Option<i32> {
        let finger = self.fretting.filter(|finger| finger.is_under_way(at.time))?;
        let place = finger.way.come_to(self.pressed(&finger), at.after(ahead));
        Some(self.stopped_at(place) as i32 - self.home as i32)
    }

    /// How far from the fret of its note a finger has come, semitones.
    pub(crate) fn away_by_now(&self, at: &Moment<impl GestureSink>) -> f64 {
        self.fretting.map_or(0.0, |finger| self.stands_by_now(&finger, at.time) - self.home as f64)
    }

    /// Whether a finger is on its way and not yet at its fret.
    pub(super) fn is_far(&self, finger: &Finger, time: u64) -> bool {
        !finger.is_at(self.stands_by_now(finger, time))
    }

    /// Where it stops the string, counted in frets.
    fn stands_by_now(&self, finger: &Finger, time: u64) -> f64 {
        if !finger.is_under_way(time) {
            return finger.stands();
        }
        self.frets_at(finger.way.come_to(self.pressed(finger), time), finger.bar)
    }
}

fn seconds_until(time: u64, at: &Moment<impl GestureSink>) -> f64 {
    time.saturating_sub(at.time) as f64 / at.sample_rate
}
