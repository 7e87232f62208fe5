//! What somebody who sees the string does to it: plucks where they point, a finger where they hold.

use low_action_dsp::Gesture;

use super::{Deeds, Ending, Moment, StringPlayer, UNDER};
use crate::performance::technique::{HARDEST_POINTED, POINTED_RINGING};
use crate::performance::{Annotation, GestureSink, StringDeed};

impl StringPlayer {
    /// Something is done to the string.
    pub(crate) fn undergo(&mut self, time: u64, deed: StringDeed, out: &mut impl GestureSink) {
        let length = self.fingers.geometry().length;
        // What is no number counts as the middle.
        let on_string =
            |place: f32| if place.is_nan() { 0.5 * length } else { f64::from(place).clamp(0.0, length) };
        match deed {
            StringDeed::Pluck { position, force } => {
                let force = if force.is_nan() { 0.0 } else { f64::from(force) };
                self.take_in_hand(time, out);
                let [duration, release] = self.fingers.pluck_times();
                let mut at = self.moment(time, out);
                self.fingers.let_ring(&mut at);
                self.rest_later(time);
                self.lay_palm_for_a_while(&at);
                at.does(Gesture::Pluck {
                    position: on_string(position),
                    force: force.clamp(-HARDEST_POINTED, HARDEST_POINTED),
                    duration,
                    release,
                });
            }
            StringDeed::Press { position } => {
                // The note that sounded is no more.
                self.moment(time, out).tells(Annotation::Damped);
                (self.note, self.under, self.deeds) = (None, [None; UNDER], Deeds::default());
                self.take_in_hand(time, out);
                let mut at = self.moment(time, out);
                self.fingers.press_at(on_string(position), &mut at);
                self.lay_palm_for_a_while(&at);
            }
            StringDeed::Lift => {
                let mut at = self.moment(time, out);
                self.fingers.lift_from(&mut at);
                self.rest_later(time);
            }
            StringDeed::Damp => return self.silence(time, None),
        }
        self.bend.renew(time);
    }

    /// The string sounds on without a note of its own, and an ending that was under way is called off.
    fn take_in_hand(&mut self, time: u64, out: &mut impl GestureSink) {
        self.call_off(&mut self.moment(time, out));
        self.touched = Some(time);
        // The ending would have stopped the hand of a note that is over, and let go of its tuning.
        if self.note.is_none() {
            self.bend.set_vibrato(time, 0.0);
            self.bend.loosen(time);
        }
    }

    /// A palm that comes to the string with the hand has no note whose end it would wait for to go.
    fn lay_palm_for_a_while(&mut self, at: &Moment<impl GestureSink>) {
        if self.note.is_none() {
            self.palm_waits(at);
        }
    }

    /// No key ends what somebody plucks. What stops the string then, a capo, goes when it has rung for long: under it the
    /// string would never rest.
    fn rest_later(&mut self, time: u64) {
        if self.touched.is_some() && self.note.is_none() && self.fingers.stopped_by_nobody() {
            self.ending = Some((time + self.samples(POINTED_RINGING), Ending::Damp));
        }
    }
}
