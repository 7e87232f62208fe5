//! What makes the string sound, as it is told for labels, and what touches the string then.

use low_action_dsp::Gesture;

use super::Fingers;
use crate::performance::right_hand::Field;
use crate::performance::{Excitation, Stopped, Technique};

impl Fingers {
    /// What makes the string sound now, and the fingers that are on it.
    pub(crate) fn excitation(&self, technique: Technique, gesture: Option<Gesture>) -> Excitation {
        let capo = self.capo[1];
        let (stop, finger) = match self.fretting {
            Some(finger) if finger.bar => (Stopped::Bar, Some(self.pressed(&finger))),
            Some(finger) => (Stopped::Finger, Some(self.pressed(&finger))),
            None if capo > 0 => (Stopped::Capo, Some(self.geometry.finger_position(capo))),
            None => (Stopped::Nut, None),
        };
        let field = Field { geometry: &self.geometry, hands: &self.hands, sounding: self.sounding_length() };
        Excitation {
            technique,
            gesture,
            stop,
            finger,
            touch: self.light.map(|_| self.touched),
            pinched: (technique == Technique::Pinch).then(|| field.pinched_partial()),
        }
    }

    /// How hard the palm rests on the string, 0 to 1.
    pub(crate) fn palm(&self) -> f64 {
        self.right.palm()
    }
}
