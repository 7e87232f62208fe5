//! The hand behind a bar. What is shut in between nut and bar is driven through the bar, which gives way a little, and gives it back:
//! where it has partials of the same pitch, as over frets 12 and 19, both would throb. So who plays with a bar lets the fingers
//! behind it rest on the strings, too softly to press them anywhere: a finger that is as lossy as one that mutes.

use low_action_dsp::Gesture;

use super::{Finger, Fingers, lifting};
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

impl Fingers {
    /// A finger comes to rest behind a bar that is laid at a place, m from the nut.
    pub(super) fn rest_behind_bar(&mut self, bar: f64, at: &mut Moment<impl GestureSink>) {
        let (touch, force) = self.field().matched(MUTE);
        let (finger, position) = (BEHIND_BAR, self.behind_bar_at(bar));
        self.behind_bar = true;
        self.departing[finger] = None;
        at.does(Gesture::Place { finger, touch, position, clearance: 0.0 });
        at.does(Gesture::Press { finger, force, duration: PALM_LANDING });
    }

    /// Where a finger rests behind a bar at a place, both m from the nut.
    fn behind_bar_at(&self, bar: f64) -> f64 {
        let (reach, part) = BEHIND_BAR_REACH;
        let capo = self.string.geometry.finger_position(self.capo[1]);
        bar - reach.min(part * (bar - capo).max(0.0))
    }

    /// Moves the finger that stops the string along it to a place, m from the nut, or a bar with what rests behind it; a light one at
    /// a node goes with it. Gives back its slide.
    pub(super) fn move_along(
        &mut self,
        moved: &Finger,
        position: f64,
        duration: f64,
        at: &mut Moment<impl GestureSink>,
    ) -> Gesture {
        let slide = Gesture::Slide { finger: moved.slot, position, duration };
        at.does(slide);
        if moved.bar && self.behind_bar {
            let position = self.behind_bar_at(position);
            at.does(Gesture::Slide { finger: BEHIND_BAR, position, duration });
        }
        if self.fretting.is_some_and(|finger| finger.slot == moved.slot) {
            self.stay_at_node(duration, at);
        }
        slide
    }

    /// The finger that stops the string, or the bar, is to leave it, and is given back. What rests behind a bar goes at once.
    pub(super) fn take_fretting(&mut self, at: &mut Moment<impl GestureSink>) -> Option<Finger> {
        if std::mem::take(&mut self.behind_bar) {
            at.does(lifting(BEHIND_BAR, self.hands.damper.touch, QUICK_LIFT));
        }
        self.come(at);
        self.fretting.take()
    }

    /// What rests behind a bar leaves a string that has been damped, as dampers do.
    pub(super) fn ease_from_behind_bar(&mut self, at: &mut Moment<impl GestureSink>) {
        if std::mem::take(&mut self.behind_bar) {
            self.depart(BEHIND_BAR, self.hands.damper.touch, DAMPER_EASING, at);
        }
    }
}
