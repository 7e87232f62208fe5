//! Fingers on a string that goes on under another neck: they go to where that has their places.

use low_action_dsp::Gesture;

use super::{Finger, Fingers};
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

/// How far from its place a finger is not worth moving, m: less than half a cent on any string.
const NEAR: f64 = 1e-4;
/// How long it takes to get there, s.
const MOVES: f64 = 0.03;

impl Fingers {
    /// Takes over the fingers on this string, when it has been given another model. Gives back whether what keeps them on frets is
    /// another matter now: then they count from the fret of their note anew.
    pub(crate) fn take_over(&mut self, old: &Self) -> bool {
        self.hands = old.hands.clone();
        (self.fretting, self.anchor, self.light) = (old.fretting, old.anchor, old.light);
        self.awaited = old.awaited;
        (self.touched, self.node, self.behind_bar) = (old.touched, old.node, old.behind_bar);
        (self.next_slot, self.resting, self.departing) = (old.next_slot, old.resting, old.departing);
        self.right.take_over(&old.right);
        (self.home, self.pressure, self.tightened) = (old.home, old.pressure, old.tightened);
        self.pace = old.pace;
        (self.capo, self.capo_touch) = (old.capo, old.capo_touch);
        let differs = self.string.fretless != old.string.fretless;
        if differs {
            let (fretless, home) = (self.string.fretless, self.home);
            let last = self.string.geometry.frets.len();
            let fingers = self.fretting.iter_mut().chain(&mut self.anchor);
            fingers.filter(|finger| !finger.bar).for_each(|finger| finger.count_anew(fretless, home, last));
        }
        // Where they have been carried to with their string, and where they belong.
        let scale = self.string.geometry.length / old.string.geometry.length;
        let off = |there: f64, here: f64| (there * scale - here).abs() > NEAR;
        let place = |finger: Option<&Finger>, of: &Self| finger.map_or(0.0, |finger| of.pressed(finger));
        let [capo, from] = [&*self, old].map(|of| of.string.geometry.finger_position(of.capo[1]));
        self.misplaced = off(place(old.fretting.as_ref(), old), place(self.fretting.as_ref(), self))
            || off(place(old.anchor.as_ref(), old), place(self.anchor.as_ref(), self))
            || off(from, capo);
        differs
    }

    /// They go where they belong. Gives back whether they were elsewhere.
    pub(crate) fn settle(&mut self, at: &mut Moment<impl GestureSink>) -> bool {
        if !std::mem::take(&mut self.misplaced) {
            return false;
        }
        self.come(at);
        for finger in [self.fretting, self.anchor].into_iter().flatten() {
            let duration = finger.time_to_arrive(at).max(MOVES);
            self.move_along(&finger, self.pressed(&finger), duration, at);
        }
        if self.capo[1] > 0 {
            let position = self.string.geometry.finger_position(self.capo[1]);
            at.does(Gesture::Slide { finger: CAPO, position, duration: MOVES });
        }
        self.press_on(MOVES, at);
        true
    }
}

impl Finger {
    /// Where nothing keeps it on frets it has glided there from the one of its note; on frets it is at the nearest.
    fn count_anew(&mut self, fretless: bool, home: usize, last: usize) {
        let stands = self.stands();
        self.fret = match fretless {
            true if home > 0 && self.free.is_none() => home,
            true => self.fret,
            false => self.nearest_fret().clamp(1, last.max(1)),
        };
        self.glided = if fretless { stands - self.fret as f64 } else { 0.0 };
    }
}
