//! A finger that goes where somebody points: between frets, on them, along the string.

use low_action_dsp::Gesture;

use super::held::{Down, Grip};
use super::{Finger, Fingers};
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

impl Fingers {
    /// Whatever keeps the string from sounding leaves, a finger that has eased off too; the capo stays or comes.
    pub(crate) fn let_ring(&mut self, at: &mut Moment<impl GestureSink>) {
        self.make_way(1.0, at);
        self.lay_capo(at);
        if self.fretting.is_some_and(|finger| finger.grip != Grip::Presses)
            && let Some(old) = self.take_fretting(at)
        {
            at.does(old.gives_way());
        }
    }

    /// A finger comes down at a place, m from the nut, so fast that the string sounds by it; one that came so before
    /// slides there.
    pub(crate) fn press_at(&mut self, position: f64, at: &mut Moment<impl GestureSink>) {
        let fret = self.stopped_at(position);
        let presses = |finger: &&mut Finger| finger.free.is_some() && finger.grip == Grip::Presses;
        if let Some(finger) = self.fretting.as_mut().filter(presses) {
            self.home = fret;
            (finger.fret, finger.glided, finger.free) = (fret, 0.0, Some(position));
            return at.does(Gesture::Slide { finger: finger.slot, position, duration: POINTING });
        }
        self.make_way(POINTED, at);
        self.lay_capo(at);
        for old in [self.anchor.take(), self.take_fretting(at)].into_iter().flatten() {
            at.does(old.gives_way());
        }
        self.expect_beside(0.0);
        let speed = self.hammer_speed(fret as f64, POINTED);
        self.come_down_at(fret, Down::on(self.capo[1]), position, speed, at);
        if let Some(finger) = &mut self.fretting {
            finger.free = Some(position);
        }
    }

    /// The finger that came so leaves.
    pub(crate) fn lift_from(&mut self, at: &mut Moment<impl GestureSink>) {
        if let Some(finger) = self.fretting.take_if(|finger| finger.free.is_some()) {
            at.does(finger.gives_way());
        }
    }

    /// Whether something stops the string that nobody holds there.
    pub(crate) fn stopped_by_nobody(&self) -> bool {
        self.stopped() && self.fretting.is_none_or(|finger| finger.free.is_none())
    }

    /// The fret that a finger at a place (m from the nut) stops.
    pub(super) fn stopped_at(&self, position: f64) -> usize {
        let behind = self.string.geometry.frets.partition_point(|fret| *fret < position);
        (behind + 1).min(self.string.geometry.frets.len())
    }
}
