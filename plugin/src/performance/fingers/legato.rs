//! From one note to the next without the right hand: hammers, pulls and slides.

use low_action_dsp::{FingerSlot, Gesture};

use super::held::{Down, Grip};
use super::landing::Thrown;
use super::{Finger, Fingers, pulling};
use crate::performance::articulation::{Stop, Stroke};
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment, Technique};

/// The string goes on sounding, and nothing is done for it.
const CONTINUED: (Technique, Option<Gesture>) = (Technique::Continued, None);

impl Fingers {
    /// The string goes on sounding from another fret: by a slide of so many seconds if the finger can, or
    /// else by a hammer or a pull, how hard, 0 to 1. A bar is laid on an open string and not thrown. Gives back what was done,
    /// and the gesture that did it.
    pub(crate) fn change(
        &mut self,
        fret: usize,
        slide: Option<f64>,
        bar: bool,
        strength: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> (Technique, Option<Gesture>) {
        if self.capo[0] != self.capo[1] {
            // It has been told to go elsewhere, and does so before anything else stops the string.
            self.lay_capo(at);
        }
        let place = self.comes_to(fret);
        let (is_there, is_below) = match self.slidable() {
            Some(finger) => (finger.is_at(place), finger.is_below(place)),
            None => (fret == self.capo[1], fret > self.capo[1]),
        };
        match slide.filter(|_| fret > self.capo[1] && self.slidable().is_some()) {
            _ if is_there => self.go_on(fret, strength, at),
            Some(duration) => (Technique::Slide, self.slide_to(fret, duration, at)),
            None if is_below && bar => {
                self.stop(fret, Stop::Bar, Coming { strength, ..AT_ONCE }, self.letting_go(strength), at);
                (Technique::HammerOn, None)
            }
            None if is_below => (Technique::HammerOn, Some(self.hammer(fret, strength, at))),
            None => match self.pull_off(fret, strength, at) {
                None => CONTINUED,
                pull => (Technique::PullOff, pull),
            },
        }
    }

    /// The string is stopped where the next note has it, by a finger that has slid there or by none. If it sounds it goes on;
    /// if a light finger or a damper rests on it, it is plucked, how hard, 0 to 1.
    fn go_on(
        &mut self,
        fret: usize,
        strength: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> (Technique, Option<Gesture>) {
        self.home = fret;
        let place = self.comes_to(fret);
        if let Some(finger) = self.fretting.as_mut().filter(|finger| finger.is_at(place)) {
            finger.count_from(fret);
        }
        if self.light.is_none() && self.resting_slots().next().is_none() {
            return CONTINUED;
        }
        self.make_way(strength, at);
        self.lay_capo(at);
        let pluck = self.pluck(Stroke::Down, strength, 0.0, 0.0);
        if let Some(pluck) = pluck {
            at.does(pluck);
        }
        (Technique::Pluck, pluck)
    }

    /// A finger comes down so fast that the string sounds by it: how hard, 0 to 1. One that stops a lower
    /// fret stays down behind it. Gives back the throw.
    pub(crate) fn hammer(
        &mut self,
        fret: usize,
        strength: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> Gesture {
        self.make_way(strength, at);
        self.lay_capo(at);
        let before = self.take_fretting(at);
        let stopped = self.down(before.as_ref(), at);
        let place = self.comes_to(fret);
        // An anchor there was has the slot that the new finger takes.
        self.anchor = None;
        match before {
            Some(old) if old.is_below(place) && !old.bar => self.hold_behind(old, at),
            Some(old) => at.does(old.gives_way()),
            None => {}
        }
        self.come_down(fret, stopped, self.hammer_speed(place, strength), at)
    }

    /// The finger that stops the string leaves, for another to strike it at a fret, how hard, 0 to 1. Gives back in how many
    /// seconds the string is up; `None` if it can be struck at once: there is no finger, or one that stays down behind the other.
    /// What damps the string stays until then.
    pub(crate) fn let_up(
        &mut self,
        fret: usize,
        strength: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> Option<f64> {
        let place = self.comes_to(fret);
        if self.fretting.is_some_and(|finger| finger.is_below(place) && !finger.bar) {
            return None;
        }
        let manner = self.letting_go(strength);
        let leaving = [self.take_fretting(at), self.anchor.take()];
        for finger in leaving.into_iter().flatten() {
            at.does(finger.lets_go(manner));
        }
        leaving[0].map(|_| RISING + manner.turning - QUICK_LIFT.turning)
    }

    /// The finger that sounds plucks the string as it leaves, how hard, 0 to 1; one behind it, or the nut,
    /// stops the string then. Gives back the pluck, if there is a finger.
    pub(crate) fn pull_off(
        &mut self,
        fret: usize,
        strength: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> Option<Gesture> {
        self.make_way(strength, at);
        let old = self.take_fretting(at)?;
        self.home = fret;
        self.next_slot = (old.slot + 1) % FRETTING_SLOTS;
        match self.anchor.take() {
            anchor if fret > self.capo[1] => self.stop_behind(fret, old.slot, anchor, at),
            Some(anchor) => at.does(anchor.gives_way()),
            None => {}
        }
        let pluck = self.pull_off_pluck(self.pressed(&old), fret, strength);
        at.does(pluck);
        at.does(old.lets_go(self.letting_go(pulling::letting_go(strength))));
        Some(pluck)
    }

    /// A finger stops the string behind the one of a slot before that one leaves: one that is behind it already and near enough to come
    /// to the fret, or a new one. What held the string down farther off behind it goes for that, unheard; dragged over the frets, it
    /// would scrape.
    pub(super) fn stop_behind(
        &mut self,
        fret: usize,
        leaving: FingerSlot,
        anchor: Option<Finger>,
        at: &mut Moment<impl GestureSink>,
    ) {
        let place = self.comes_to(fret);
        let is_near = |anchor: &Finger| (anchor.stands() - place).abs() <= BEHIND_REACH;
        let Some(anchor) = anchor.filter(is_near) else {
            self.come_down(fret, Down::on(fret), BEHIND_SPEED, at);
            return;
        };
        let finger = anchor.slot;
        let moved =
            Finger { fret, glided: self.comes_beside(fret), free: None, grip: Grip::Presses, ..anchor };
        if anchor.stands() != moved.stands() || anchor.free.is_some() {
            let position = self.pressed(&moved);
            at.does(Gesture::Slide { finger, position, duration: BEHIND_SLIDE });
        }
        self.fretting = Some(moved);
        self.next_slot = leaving;
        self.pace.done();
        let force = self.force();
        at.does(Gesture::Press { finger, force, duration: ANCHOR_RAMP.1 });
    }

    /// A finger that stopped the string stays down behind the one that does, just hard enough.
    pub(super) fn hold_behind(&mut self, anchor: Finger, at: &mut Moment<impl GestureSink>) {
        self.anchor = Some(Finger { grip: Grip::Presses, ..anchor });
        let force = self.holding_force(anchor.nearest_fret(), self.force());
        at.does(Gesture::Press { finger: anchor.slot, force, duration: ANCHOR_RAMP.0 });
    }

    /// Throws a finger at a string that is held down somewhere, behind a fret.
    fn come_down(
        &mut self,
        fret: usize,
        stopped: Down,
        speed: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> Gesture {
        let position = self.glided_place(self.comes_to(fret), false);
        self.come_down_at(fret, stopped, position, speed, at)
    }

    /// Throws a finger at a string that is held down somewhere, at a place, m from the nut, where it stops a fret.
    pub(super) fn come_down_at(
        &mut self,
        fret: usize,
        stopped: Down,
        position: f64,
        speed: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> Gesture {
        let Thrown { touch, clearance, speed, force_at_first, rise } =
            self.throw(self.comes_to(fret), stopped, speed);
        self.home = fret;
        let finger = self.take_slot(fret, touch, false);
        let thrown = Gesture::Throw { finger, touch, position, clearance, speed };
        at.does(thrown);
        if force_at_first > 0.0 {
            at.does(Gesture::Press { finger, force: force_at_first, duration: 0.0 });
        }
        at.does(Gesture::Press { finger, force: self.force(), duration: rise });
        thrown
    }
}
