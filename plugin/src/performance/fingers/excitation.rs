//! What makes the string sound, as it is told for labels, and what touches the string then.

use low_action_dsp::Gesture;

use super::Fingers;
use crate::performance::{Excitation, Stopped, Technique};

impl Fingers {
    /// What makes the string sound now, the partial that a thumb picks out of it, and the fingers that are on it.
    pub(crate) fn excitation(
        &self,
        technique: Technique,
        gesture: Option<Gesture>,
        pinched: Option<u32>,
    ) -> Excitation {
        let capo = self.capo[1];
        let (stop, finger) = match self.fretting {
            Some(finger) if finger.bar => (Stopped::Bar, Some(self.pressed(&finger))),
            Some(finger) => (Stopped::Finger, Some(self.pressed(&finger))),
            None if capo > 0 => (Stopped::Capo, Some(self.string.geometry.finger_position(capo))),
            None => (Stopped::Nut, None),
        };
        Excitation { technique, gesture, stop, finger, touch: self.light.map(|_| self.touched), pinched }
    }

    /// How hard the palm rests on the string, 0 to 1.
    pub(crate) fn palm(&self) -> f64 {
        self.right.palm_pressure()
    }
}
