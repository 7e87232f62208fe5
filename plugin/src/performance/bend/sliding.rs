//! Where a wheel past the reach of pulling has the finger slide, and what pulling does on the way.

use super::Bend;
use crate::performance::fingers::Fingers;
use crate::performance::technique::{BEND_INTERVAL, BEND_RAMP, FOLLOWED, OUT_OF_TUNE, SLID_STAYS};
use crate::performance::{GestureSink, Moment};

impl Bend {
    /// What the string is pulled by while a finger slides, semitones, which is to be pulled by so much once it is there. Where it has
    /// followed the wheel so far the pitch stays with that, whichever fret the finger is over.
    pub(super) fn meanwhile(
        &mut self,
        asked: f64,
        tension: f64,
        most: f64,
        fingers: &Fingers,
        at: &Moment<impl GestureSink>,
    ) -> f64 {
        self.makes_up &= fingers.passes(0.0, at).is_some();
        let passes = fingers.passes(0.5 * (BEND_RAMP + BEND_INTERVAL), at).filter(|_| self.makes_up);
        let Some(passes) = passes else { return tension };
        self.due = Some(at.after(BEND_INTERVAL));
        // A string that is let down by more would lie on the frets.
        (asked - f64::from(passes)).clamp(tension.min(-FOLLOWED).max(-most), most)
    }

    /// By how many frets the finger slides for wheel and tuning that ask for so much, where pulling reaches so far, semitones. What
    /// is past that by less than anybody hears is pulled, and a finger that has slid stays for a while: a wheel that swings
    /// across a limit would have it go back and forth over the frets, which clatter. Then it goes to the nearest fret, and so it comes
    /// home: over several at once, while pulling takes their place, the pitch would go astray.
    pub(super) fn frets_to_slide(&self, asked: f64, most: f64) -> i32 {
        let from_there = (asked - f64::from(self.slid)).abs();
        if self.slid != 0 && from_there <= SLID_STAYS.min(most) {
            self.slid
        } else if self.slid != 0 || asked.abs() > most + OUT_OF_TUNE {
            asked.round() as i32
        } else {
            0
        }
    }
}
