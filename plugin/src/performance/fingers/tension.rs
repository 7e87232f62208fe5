//! What tension raises a string that is stopped, and what holds it down then.

use low_action_dsp::setup::tension_ratio;

use super::Fingers;
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment, PlayedString, Pull};

impl Fingers {
    /// The tension that raises what sounds by so many semitones, or by less where its grid bears no more. Stopping the string has added to
    /// its tension, which pulling has to outdo: as much as its fret stands nearer to the nut than equal
    /// temperament has it. A tighter string gives way less, so the addition falls about with the root of the
    /// tension (fitted to measured bends).
    pub(crate) fn pulled(&self, semitones: f64) -> Pull {
        let fret = self.stretched_at();
        let (added, most) = (self.added_tension(), self.string.geometry.highest_ratio);
        let alone = tension_ratio(semitones);
        let ratio = alone + added * (alone - 1.0 / alone.sqrt());
        if ratio <= most {
            return Pull::new(semitones, ratio, fret);
        }
        // The same backwards, where each turn leaves a hundredth of what is off.
        let reached = (0..3).fold(most, |alone, _| (most + added / alone.sqrt()) / (1.0 + added));
        Pull::new(6.0 * libm::log2(reached), most, fret)
    }

    /// The string is pulled to so many times its own tension within so many seconds, and whatever stops it holds it down.
    pub(crate) fn hold_pulled(&mut self, ratio: f64, duration: f64, at: &mut Moment<impl GestureSink>) {
        let before = [self.force(), self.capo_force()];
        self.tightened = ratio.max(1.0);
        if self.force() != before[0] {
            self.press_on(duration, at);
        }
        // Under a hand that damps it has eased off.
        if self.capo_force() != before[1] && self.resting_slots().next().is_none() {
            self.press_capo(duration, at);
        }
    }

    /// Force of a finger at a fret under which the string leaves it as it is pulled, N; 0 for the open string.
    pub(super) fn leaving_force(&self, fret: usize) -> f64 {
        self.tightened * self.string.leaving_force(fret)
    }

    /// What just holds the string down at a fret, N, of a finger or a capo that presses with no more than so much.
    pub(super) fn holding_force(&self, fret: usize, most: f64) -> f64 {
        (HOLDING * self.leaving_force(fret)).min(most)
    }

    /// What a force, N, becomes at a fret of the string as it is pulled.
    pub(super) fn held_pulled(&self, force: f64, fret: usize) -> f64 {
        self.string.held_pulled(force, fret, self.tightened)
    }

    /// The fret at which a finger or the capo stretches the string, 0 where none does.
    pub(crate) fn stretched_at(&self) -> usize {
        let finger = self.fretting.filter(|finger| !finger.bar);
        finger.map_or(self.capo[1], |finger| finger.nearest_fret())
    }

    /// What stopping the string has added to its tension, as a part of it.
    fn added_tension(&self) -> f64 {
        let PlayedString { geometry, .. } = &self.string;
        let fret = self.stretched_at();
        let crown = fret.checked_sub(1).and_then(|index| geometry.frets.get(index));
        crown.map_or(0.0, |crown| {
            let ratio = (geometry.length - crown) / geometry.length * libm::exp2(fret as f64 / 12.0);
            ratio * ratio - 1.0
        })
    }
}
