//! What touches a string beside the finger behind the fret: a light finger at a node, a muting one, a bar,
//! a capo, the thumb.

use low_action_dsp::Gesture;

use super::held::Down;
use super::landing::SetDown;
use super::{Fingers, lift_force, lifting};
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

impl Fingers {
    /// A light finger touches the node of partial `order` of what sounds, the one nearest to the left hand; one that is
    /// there already stays.
    pub(crate) fn touch_node(&mut self, order: u32, at: &mut Moment<impl GestureSink>) {
        if self.light.is_some() {
            return;
        }
        let stopped = self.fretting.map(|finger| finger.way.come_to(self.pressed(&finger), at.time));
        let position = self.node(order, stopped.unwrap_or_else(|| self.sounding_from()));
        self.touch_lightly(position, NODE_TOUCH, Some(order), at);
        let arrives = self.time_to_arrive(at);
        if arrives > 0.0 {
            self.stay_at_node(arrives, at);
        }
    }

    /// The node of partial `order` that is nearest to what stops the string at a place, m from the nut both. What presses it to a
    /// fret is behind that.
    fn node(&self, order: u32, stopped: f64) -> f64 {
        let on_fret = !self.string.fretless && self.fretting.map_or(self.capo[1] > 0, |finger| !finger.bar);
        let fret = if on_fret { self.stopped_at(stopped).checked_sub(1) } else { None };
        let geometry = &self.string.geometry;
        let end = fret.and_then(|fret| geometry.frets.get(fret)).copied().unwrap_or(stopped);
        end + (geometry.length - end) / f64::from(order.max(2))
    }

    /// What stops the string will have moved in so many seconds: a light finger at a node goes with it.
    pub(super) fn stay_at_node(&mut self, duration: f64, at: &mut Moment<impl GestureSink>) {
        if let (Some(finger), Some(order)) = (self.light, self.node) {
            self.touched = self.node(order, self.sounding_from());
            at.does(Gesture::Slide { finger, position: self.touched, duration });
        }
    }

    /// How far from its usual place a pluck must fall not to miss partial `order` of what sounds, m, negative
    /// towards the saddle: at the partial's antinode there.
    pub(crate) fn towards_antinode(&self, order: u32) -> f64 {
        let antinode = 0.5 * self.sounding_length() / f64::from(order.max(2));
        (antinode - self.hands.pluck_position).min(0.0)
    }

    /// Two fingers of a hand rest on the string, one over a fret, or where a hand would lie over an open string. One alone would
    /// leave the partials that have a node there.
    pub(super) fn mute(&mut self, fret: usize, at: &mut Moment<impl GestureSink>) {
        let length = self.string.geometry.length;
        let position = match fret > self.capo[1] {
            true => self.string.geometry.finger_position(fret),
            false => MUTED_OPEN * length,
        };
        self.touch_lightly(position, MUTE, None, at);
        self.rest(LIGHT, position + MUTED_BESIDE * (length - position), at);
    }

    fn touch_lightly(
        &mut self,
        position: f64,
        times: f64,
        node: Option<u32>,
        at: &mut Moment<impl GestureSink>,
    ) {
        let (touch, force) = self.field().matched(times);
        // Where another finger has just stopped the string, the next slot is the one of the finger before it, which
        // is still on its way up; the dampers are not. Behind a bar one of them rests.
        let finger = match self.fretting {
            Some(_) if self.behind_bar => LIGHT_OVER_BAR,
            Some(_) => LIGHT,
            None => self.next_slot,
        };
        self.light = Some(finger);
        (self.touched, self.node) = (position, node);
        self.departing[finger] = None;
        at.does(Gesture::Place { finger, touch, position, clearance: 0.0 });
        at.does(Gesture::Press { finger, force, duration: PALM_LANDING });
    }

    /// The light finger goes.
    pub(crate) fn leave_node(&mut self, at: &mut Moment<impl GestureSink>) {
        self.lift_light(NODE_LIFT, at);
    }

    /// Lifts a light finger, if there is one.
    pub(super) fn lift_light(&mut self, manner: Leaving, at: &mut Moment<impl GestureSink>) {
        if let Some(slot) = self.light.take() {
            self.depart(slot, self.hands.damper.touch, manner, at);
        }
    }

    /// Lays a bar over a fret, too light to touch it, and a finger behind it.
    pub(super) fn lay_bar(&mut self, fret: usize, at: &mut Moment<impl GestureSink>) {
        let force = self.string.bar_force(fret);
        let finger = self.take_slot(fret, BAR, true);
        let position = self.sounding_from();
        at.does(Gesture::Throw { finger, touch: BAR, position, clearance: 0.0, speed: BAR_SPEED });
        at.does(Gesture::Press { finger, force, duration: 0.0 });
        self.rest_behind_bar(position, at);
    }

    /// A capo at this fret on notes to come, 0 for none.
    pub(crate) fn set_capo(&mut self, fret: usize) {
        self.capo[0] = fret.min(self.string.geometry.frets.len());
    }

    /// The capo stays where it is.
    pub(crate) fn keep_capo(&mut self) {
        self.capo[0] = self.capo[1];
    }

    /// Fret of the capo on notes to come, 0 for none.
    pub(crate) fn capo(&self) -> usize {
        self.capo[0]
    }

    /// Sees to it that the capo is where it should be.
    pub(super) fn lay_capo(&mut self, at: &mut Moment<impl GestureSink>) {
        let [wanted, there] = self.capo;
        self.capo[1] = wanted;
        if wanted == 0 {
            if there > 0 {
                at.does(lifting(CAPO, self.capo_touch, QUICK_LIFT));
            }
            return;
        }
        let mut landing = self.hands.fretting.landing;
        let force = self.capo_force();
        if wanted != there {
            let SetDown { touch, rise, .. } = self.set_down(wanted as f64, Down::on(0), AT_ONCE, force);
            (self.capo_touch, landing) = (touch, rise);
            let position = self.string.geometry.finger_position(wanted);
            let clearance = self.hands.fretting.hover;
            at.does(Gesture::Place { finger: CAPO, touch: self.capo_touch, position, clearance });
        }
        self.press_capo(landing, at);
    }

    /// What it stops the string with, N.
    pub(super) fn capo_force(&self) -> f64 {
        self.held_pulled(self.hands.fretting.force, self.capo[1])
    }

    pub(super) fn press_capo(&self, duration: f64, at: &mut Moment<impl GestureSink>) {
        if self.capo[1] > 0 {
            at.does(Gesture::Press { finger: CAPO, force: self.capo_force(), duration });
        }
    }

    /// The capo of a string that is being damped holds it just so. (It goes with the fingers when the string has come to rest:
    /// nothing is computed for a string that nobody plays.)
    pub(super) fn relax_capo(&mut self, duration: f64, at: &mut Moment<impl GestureSink>) {
        if self.capo[1] > 0 {
            let force = self.holding_force(self.capo[1], self.capo_force());
            at.does(Gesture::Press { finger: CAPO, force, duration });
        }
    }

    /// It eases off until the string is free of it.
    pub(super) fn ease_capo(&mut self, manner: Leaving, at: &mut Moment<impl GestureSink>) {
        if self.capo[1] > 0 {
            let force = -lift_force(self.capo_touch, manner);
            at.does(Gesture::Press { finger: CAPO, force, duration: manner.turning });
        }
    }

    /// And goes.
    pub(super) fn lift_capo(&mut self, manner: Leaving, at: &mut Moment<impl GestureSink>) {
        if std::mem::take(&mut self.capo[1]) > 0 {
            self.depart(CAPO, self.capo_touch, manner, at);
        }
    }

    /// The thumb is thrown at the string, how hard, 0 to 1; gives back the throw.
    pub(crate) fn slap(&mut self, strength: f64, at: &mut Moment<impl GestureSink>) -> Gesture {
        let (right, field) = self.right_hand();
        right.slap(strength, &field, at)
    }

    /// It bounces off.
    pub(crate) fn bounce(&mut self, at: &mut Moment<impl GestureSink>) {
        self.right.bounce(at);
    }

    /// The thumb grazes the string beside the plectrum, at a node of this partial.
    pub(crate) fn graze(&mut self, partial: u32, at: &mut Moment<impl GestureSink>) {
        let (right, field) = self.right_hand();
        right.graze(partial, &field, at);
    }

    /// It leaves, and the palm comes back if it was there.
    pub(crate) fn leave_graze(&mut self, at: &mut Moment<impl GestureSink>) {
        let (right, field) = self.right_hand();
        right.leave_graze(&field, at);
    }

    /// The palm comes back after a slap if it was there.
    pub(crate) fn lay_palm(&mut self, at: &mut Moment<impl GestureSink>) {
        let (right, field) = self.right_hand();
        right.lay_again(&field, at);
    }
}
