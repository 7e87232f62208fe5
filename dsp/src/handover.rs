//! Another model under strings that ring: what one instrument hands to the next, without a click and
//! without allocating.
//!
//! The new instrument is built beforehand, elsewhere. Where its strings are much the same it takes over displacement and motion
//! of each (read between the grid points where the grids differ, but for the kinks under what presses, which are each grid's
//! own), the fingers with the depth to which they are pressed in, plucks under way and the gestures that wait; where they are
//! not it takes over nothing, what waits is dropped with the strings that it was meant for, and what is played from then on is
//! for the new ones alone. A finger or fret that was in touch stays in touch, pressed just as hard; board and frets go on from
//! there to their new places as a luthier's wrench would move them, and the tension from the old to the new. So a string that
//! is pressed and silent stays so. The step from one set of numbers to the other changes the energy that the same motion holds:
//! the [`Ledger`](crate::Ledger) books it, and all work done by what moves afterwards. For a moment both are computed and the
//! one sound fades into the other, because what a pickup at another place hears cannot be carried over.

mod hands;
mod state;
mod touching;

use std::ops::Range;

use crate::instrument::{Instrument, heard};
use crate::ramp::Ramp;
use crate::together;
pub(crate) use state::Side;

/// The time in which one sound fades into the other, s.
const FADE: f64 = 0.02;

impl Instrument {
    /// Puts `successor` in the place of this instrument. Whatever it has played before is forgotten first.
    /// If its strings are [much the same](Instrument::continues_in) the sound goes on, and so do the gestures that wait; otherwise
    /// the old sound fades away, the new instrument is silent, and the gestures that wait are dropped. Either way the sound is
    /// continuous, and nothing is allocated or given back: the old instrument stays inside until
    /// [`Instrument::take_before`] fetches it.
    ///
    /// # Errors
    /// When `successor` is built for another sample rate, and while the instrument before has not been fetched, from this one
    /// or from `successor`, which comes back unused.
    pub fn hand_over(&mut self, mut successor: Box<Instrument>) -> Result<(), Box<Instrument>> {
        // An instrument that is still inside would have to be given back here.
        let is_free = self.before.is_none() && successor.before.is_none();
        if !is_free || successor.sample_rate != self.sample_rate {
            return Err(successor);
        }
        successor.reset();
        successor.now = self.now;
        successor.level.clone_from(&self.level);
        successor.goes_on = self.continues_in(&successor);
        if successor.goes_on {
            successor.queue.take_over(&self.queue);
            let together = successor.together;
            let old = self.voices.chunks_mut(together);
            for (strings, old) in successor.voices.chunks_mut(together).zip(old) {
                together::take_over(strings, old);
            }
        }
        // Whoever looks goes on looking, at what there is now.
        successor.observe(self.voices.iter().any(|voice| voice.observed.is_looking()));
        successor.observe_anew();
        std::mem::swap(self, &mut successor);
        let samples = (FADE * self.sample_rate).round() as u64;
        self.fade = Ramp::at(0.0);
        self.fade.go(1.0, samples);
        self.before = Some(successor);
        Ok(())
    }

    /// Whether the strings of another instrument can take over the motion of this one's: as many of them,
    /// nearly as long and as heavy. The same motion of another string would be another sound, beginning with a blow. (A
    /// string tuned so far down that its grid does not bear the old tension begins with as much as it bears.)
    pub fn continues_in(&self, other: &Instrument) -> bool {
        let near = |new: f64, old: f64| (0.8..=1.25).contains(&(new / old));
        self.voices.len() == other.voices.len()
            && self.voices.iter().zip(&other.voices).all(|(old, new)| {
                let (old, new) = (&old.model.string, &new.model.string);
                near(new.linear_density, old.linear_density) && near(new.length, old.length)
            })
    }

    /// Whether the sound of the instrument before is still fading.
    pub fn is_fading(&self) -> bool {
        !self.fade.rests()
    }

    /// Samples until the instrument before has faded, 0 if there is none.
    pub fn fading_left(&self) -> u64 {
        self.fade.left()
    }

    /// The instrument this one took over from, once it has faded; to be dropped where that does no harm.
    pub fn take_before(&mut self) -> Option<Box<Instrument>> {
        if self.is_fading() { None } else { self.before.take() }
    }

    /// What is fading and is still played, if anything is: other strings are not meant by what is played now.
    pub(crate) fn fading(&mut self) -> Option<&mut Instrument> {
        if self.fade.rests() || !self.goes_on { None } else { self.before.as_deref_mut() }
    }

    /// Steps the instrument before through the samples `span` and mixes its sound into theirs.
    #[cold]
    pub(crate) fn fade_from_before(
        &mut self,
        span: Range<usize>,
        stems: &mut [&mut [f32]],
        left: &mut [f32],
        right: &mut [f32],
    ) {
        let Some(before) = &mut self.before else { return };
        let run = span.len();
        before.run(run);
        for (i, at) in span.enumerate() {
            // All that follows is the new sound to the last bit, as in runs that begin later.
            if self.fade.rests() {
                break;
            }
            let part = self.fade.value();
            self.fade.step();
            // Strings that do not go on begin in silence, and are heard whole from their first sound on.
            let goes_on = self.goes_on;
            let mix = |new: &mut f32, old: f64| {
                let now = f64::from(*new);
                *new = heard(if goes_on { old + (now - old) * part } else { now + old * (1.0 - part) });
            };
            let [l, r] = before.stereo(i);
            mix(&mut left[at], l);
            mix(&mut right[at], r);
            for (index, stem) in stems.iter_mut().enumerate() {
                mix(&mut stem[at], before.voices.get(index).map_or(0.0, |voice| voice.run[i]));
            }
        }
    }
}
