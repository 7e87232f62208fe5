//! Which finger of a string's each part of the hands is.

use low_action_dsp::FingerSlot;

/// Slots the fretting fingers take in turn: a new finger lands in one while the last is being lifted
/// from the other, and the free one damps behind the finger when the note ends.
pub(crate) const FRETTING_SLOTS: usize = 2;
/// Slots of the edge of the hand that damps, and how far from the saddle each part of it rests, as
/// part of the set-up's damper position. One point alone would leave the partials ringing that have
/// a node there; a hand is wide, and a partial with nodes at both places is high and dies by itself.
pub(crate) const DAMPERS: [(FingerSlot, f64); 2] = [(2, 1.0), (3, 0.37)];
/// Slot of a light finger on a string that another one stops: a damper's.
pub(crate) const LIGHT: FingerSlot = DAMPERS[1].0;
/// And on one that a bar stops, behind which that damper rests: a capo's, which such strings have none of.
pub(crate) const LIGHT_OVER_BAR: FingerSlot = CAPO;
/// Slot of the palm, or the thumb, of the hand that plucks.
pub(crate) const RIGHT_HAND: FingerSlot = 4;
/// Slot of a capo.
pub(crate) const CAPO: FingerSlot = 5;
/// Slots of the parts of a palm, how far from the saddle each rests as a part of how far the palm reaches, and its part of the palm's
/// force. One part alone would leave the partials ringing that have a node there, high ones and for seconds: there the second is
/// three fifths of a half wave from the saddle, or as far from a node. Both together brake the lowest partials as one with all
/// of the force would: 0.735 · (1² + 0.6²) = 1.
pub(crate) const PALM: [(FingerSlot, f64, f64); 2] = [(RIGHT_HAND, 1.0, 0.735), (6, 0.6, 0.735)];
