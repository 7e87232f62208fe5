//! What fingers press with, as keys and settings have it.

use low_action_dsp::Gesture;
use low_action_dsp::setup::Player;

use super::Fingers;
use super::held::Grip;
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

impl Fingers {
    /// The hands act differently from now on; a finger on the string presses with the new force.
    pub(crate) fn set_hands(&mut self, hands: &Player, at: &mut Moment<impl GestureSink>) {
        let pressed = self.hands.fretting.force;
        self.hands = hands.clone();
        if self.hands.fretting.force != pressed {
            self.press_soon(at);
        }
    }

    /// The fretting finger presses with so many times its usual force.
    pub(crate) fn press(&mut self, pressure: f64, at: &mut Moment<impl GestureSink>) {
        if pressure != self.pressure {
            self.pressure = pressure;
            self.press_soon(at);
        }
    }

    /// The fretting finger presses as it is to, at once or in a moment.
    fn press_soon(&mut self, at: &mut Moment<impl GestureSink>) {
        if self.pace.asks(PRESSURE_RAMP, at) {
            self.press_on(PRESSURE_RAMP, at);
        }
    }

    /// When there is something that hands have yet to follow.
    pub(crate) fn due(&self) -> Option<u64> {
        [self.comes(), self.pace.due(), self.right.due()].into_iter().flatten().min()
    }

    /// They do, if it is due.
    pub(crate) fn follow(&mut self, at: &mut Moment<impl GestureSink>) {
        if self.comes() == Some(at.time) {
            self.come(at);
        }
        if self.pace.due() == Some(at.time) {
            self.press_soon(at);
        }
        let (right, field) = self.right_hand();
        right.follow(&field, at);
    }

    pub(super) fn press_on(&mut self, duration: f64, at: &mut Moment<impl GestureSink>) {
        self.pace.done();
        // One that is yet to come comes with the force that it is to have by then.
        if self.awaited.is_some() {
            return;
        }
        if let Some(finger) = self.fretting.filter(|finger| finger.grip == Grip::Presses && !finger.bar) {
            at.does(Gesture::Press { finger: finger.slot, force: self.force(), duration });
        }
    }

    /// What a finger stops the string with, N.
    pub(super) fn force(&self) -> f64 {
        let fret = self.fretting.map_or(0, |finger| finger.nearest_fret());
        self.held_pulled(self.hands.fretting.force * self.pressure, fret)
    }
}
