//! How a finger sets a string down for a note that is plucked, so that setting it down is not heard.
//!
//! A string that goes down at constant speed is struck twice: where it begins to move, and where the fret stops it. The first sends
//! a wave along the string that comes back from the saddle after each period of what sounds. Where the second comes just then it
//! takes up all of that again, whatever partial it is of. So fingers take a whole number of periods.

use low_action_dsp::Gesture;
use low_action_dsp::setup::Fretting;

use super::Fingers;
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

impl Fingers {
    /// A finger lands behind a fret of a string that is stopped at a lower one (0: none), for a note of some strength (0 to 1), in
    /// haste or not (1 to 0).
    pub(super) fn land(
        &mut self,
        fret: usize,
        stopped: usize,
        [strength, haste]: [f64; 2],
        at: &mut Moment<impl GestureSink>,
    ) {
        let Fretting { mut touch, hover, landing, .. } = self.hands.fretting;
        let force = self.force();
        let softness = (SOFT_LANDING / strength.max(f64::MIN_POSITIVE)).max(1.0);
        touch.hand_damping *= (softness * softness / (1.0 + HASTE * haste)).min(SOFTEST_LANDING);
        let (way, pull) = self.way_down(fret, stopped);
        let period = self.stopped_period(fret);
        // The hand's damping is what makes the speed constant; the string takes half of its pull off, on average.
        let driven = (LANDING_LAG * force - 0.5 * pull).max(0.0);
        let damping_in = |time: f64| driven * time / way;
        let [by_itself, longest] = [way * touch.hand_damping / force, MOST_DAMPING / damping_in(1.0)];
        let time = period * (by_itself.min(longest) / period).round().max(1.0);
        touch.hand_damping = damping_in(time).min(MOST_DAMPING);
        let slot = self.take_slot(fret, touch, false);
        let position = self.string.geometry.finger_position(fret);
        let rise = landing.min(LANDING_RISE * period);
        at.does(Gesture::Place { finger: slot, touch, position, clearance: hover });
        at.does(Gesture::Press { finger: slot, force, duration: rise });
    }

    /// How far a finger moves that touches a string stopped at a fret, 0 for none, until that touches a higher fret, m, and what
    /// the string pulls it back with then, N.
    fn way_down(&self, fret: usize, stopped: usize) -> (f64, f64) {
        let length = self.string.geometry.length;
        // From where it is stopped the string goes straight to the saddle.
        let slope = |fret| self.string.depth(fret) / (length - self.string.geometry.finger_position(fret));
        let beyond = length - self.string.geometry.finger_position(fret);
        let depth = (beyond * (slope(fret) - slope(stopped))).max(LEAST_WAY);
        let pull = self.string.pull(depth, stopped, fret);
        let touch = self.hands.fretting.touch;
        (depth + libm::pow(pull / touch.stiffness, 1.0 / touch.exponent), pull)
    }
}
