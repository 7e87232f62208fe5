//! How the hands act changes while they play.

use super::{GestureSink, Performance};
use crate::controls::Touching;

impl Performance {
    /// The hands act differently from sample `time` on.
    pub fn touch(&mut self, time: u64, touching: &Touching, out: &mut impl GestureSink) {
        if self.touching == *touching && !self.taken_over {
            return;
        }
        self.taken_over = false;
        let time = time.max(self.now);
        self.advance(time, out);
        if touching.keyswitches != self.touching.keyswitches {
            self.set_switches(touching.keyswitches);
        }
        if touching.hand_position != self.touching.hand_position {
            self.hand.set_home(touching.hand_position);
        }
        if touching.capo != self.touching.capo {
            // Notes of this sample have been told where they are to be without it.
            self.begin_chord(out);
            self.set_capo(touching.capo.into());
        }
        if touching.take != self.touching.take {
            self.variation.begin_take(touching.take);
        }
        let ceases = self.touching.hand_controllers && !touching.hand_controllers;
        self.touching = *touching;
        if ceases {
            self.forget_hand_controllers(out);
        }
        self.variation.set_amount(touching.variation);
        for channel in &mut self.channels {
            channel.set_range(touching.bend_range, touching.ignore_rpn);
        }
        self.follow_wheels();
        let hands = touching.hands(&self.hands, self.scale);
        for string in &mut self.strings {
            string.set_hands(time, &hands, out);
            string.set_arm(time, touching.tremolo_arm);
        }
    }
}
