//! How a note ends: step by step, and so gently that only the string's own silence is heard.

use low_action_dsp::Gesture;

use super::deeds::Deeds;
use super::{StringPlayer, UNDER};
use crate::performance::technique::*;
use crate::performance::{Annotation, GestureSink, Moment};

/// The steps by which a note is ended, in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ending {
    /// The dampers come to rest on the string.
    Damp,
    /// So does the one behind the fretting finger, where another finger was still leaving; the next step is at that sample.
    DampBehind(u64),
    /// The string is quiet: fretting finger and capo ease off.
    EaseOff,
    /// They go, and the dampers ease off.
    Leave,
    /// The dampers have gone too; a hand lies along the string, and takes what nobody hears.
    Gone,
    /// It is off the string.
    Over,
}

impl StringPlayer {
    /// The note is over: it is damped now, or once it has been heard.
    pub(super) fn end(&mut self, time: u64) {
        self.under = [None; UNDER];
        self.touched = None;
        let heard = self.note.take().map_or(0, |note| note.since.max(note.met) + self.samples(SHORTEST_NOTE));
        self.ending = Some((time.max(heard), Ending::Damp));
    }

    /// Takes one step of an ending and plans the next.
    pub(super) fn end_by(&mut self, step: Ending, mut at: Moment<impl GestureSink>) {
        self.ending = match step {
            Ending::Damp => {
                (self.deeds, self.touched) = (Deeds::default(), None);
                self.fingers.damp(self.parting, &mut at);
                self.damped = at.time;
                at.tells(Annotation::Damped);
                let next = self.quiet_by(at.after(self.parting.relaxing));
                let behind = self.fingers.waits_behind(at.time).filter(|&clear| clear < next.0);
                Some(behind.map_or(next, |clear| (clear, Ending::DampBehind(next.0))))
            }
            Ending::DampBehind(quiet) => {
                self.fingers.damp_behind(&mut at);
                Some(self.quiet_by(quiet))
            }
            Ending::EaseOff => {
                self.fingers.ease_off(self.parting, &mut at);
                Some((at.after(self.parting.easing.turning), Ending::Leave))
            }
            Ending::Leave => {
                self.fingers.leave(self.parting, &mut at);
                // A hand that went on swinging would never let the string rest.
                self.bend.set_vibrato(at.time, 0.0);
                self.palm_waits(&at);
                Some((at.after(DAMPER_EASING.turning), Ending::Gone))
            }
            Ending::Gone => {
                self.fingers.gone();
                let (loss, duration) = LAID_ALONG;
                at.does(Gesture::Still { loss, duration });
                Some((at.after(duration), Ending::Over))
            }
            Ending::Over => None,
        };
    }

    /// The ending is called off. A hand that lies along the string is off it: what begins now is to ring.
    pub(super) fn call_off(&mut self, at: &mut Moment<impl GestureSink>) {
        if let Some((_, Ending::Over)) = self.ending.take() {
            at.does(Gesture::Still { loss: 0.0, duration: 0.0 });
        }
    }

    /// What is done as soon as the string is quiet.
    fn quiet_by(&self, time: u64) -> (u64, Ending) {
        (time, if self.fingers.stopped() { Ending::EaseOff } else { Ending::Leave })
    }
}
