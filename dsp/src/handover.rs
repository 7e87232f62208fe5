//! Another model under strings that ring: what one instrument hands to the next, without a click and
//! without allocating.
//!
//! The new instrument is built beforehand, elsewhere. Where its strings are much the same it takes over displacement and
//! motion of each (read between the grid points where the grids differ), the fingers with the depth to which
//! they are pressed in, plucks under way and the gestures that wait; where they are not it takes over nothing, what waits is
//! dropped with the strings that it was meant for, and what is played from then on is for the new ones alone. A finger or fret
//! that was in touch stays in touch, pressed just as hard; board and frets go on from there to their new places as a luthier's
//! wrench would move them, and the tension from the old to the new. The step from one set of numbers to
//! the other changes the energy that the same motion holds: the [`Ledger`] books it, and all work done
//! by what moves afterwards. For a moment both are computed and the one sound fades into the other,
//! because what a pickup at another place hears cannot be carried over.

use std::ops::Range;

use crate::contact::ContactLaw;
use crate::finger::Inertia;
use crate::gesture::FINGERS_PER_STRING;
use crate::hands::Hands;
use crate::instrument::{Instrument, heard};
use crate::model::{Contact, ContactKind, Model};
use crate::ramp::Ramp;
use crate::state::State;
use crate::together;

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

impl State {
    /// Takes over the motion of a string on another model, and the fingers on it; one whose pad is too
    /// stiff for this model is left out. What moved in a step of the old model moves its share of that in
    /// a step of this one.
    pub(crate) fn take_over(&mut self, model: &Model, old: &State, old_model: &Model) {
        let (grid, old_grid) = (&model.grid, &old_model.grid);
        let same_grid = grid == old_grid;
        let scale = grid.length / old_grid.length;
        let share = grid.time_step / old_grid.time_step;
        if same_grid {
            self.displacement.copy_from_slice(&old.displacement);
            self.motion.copy_from_slice(&old.motion);
        } else {
            self.displacement.fill(0.0);
            self.motion.fill(0.0);
            for node in 1..grid.intervals {
                let reading = old_grid.reading(grid.place(node) / scale);
                self.displacement[grid.cell(node)] = reading.of(&old.displacement);
                self.motion[grid.cell(node)] = share * reading.of(&old.motion);
            }
        }
        self.close_shape(model);
        if same_grid {
            // (Steps sum it in another order: the last digit of it goes on, too.)
            self.squares = old.squares;
        }
        self.no_finger_from = self.fingers.len();
        for slot in 0..self.fingers.len() {
            self.fingers[slot] = old.fingers[slot].and_then(|mut finger| {
                finger.law = model.finger_law_if(&finger.touch)?;
                finger.inertia = Inertia::new(&finger.touch, grid.time_step);
                if same_grid {
                    return Some(finger);
                }
                // Under it the string reads a little differently now; the pad goes with it.
                let height_before = old.displacement_at(&finger.reading);
                let motion_before = finger.reading.of(&old.motion);
                finger.position *= scale;
                finger.reading = grid.reading(finger.position);
                finger.reading_before = finger.reading;
                finger.height += self.displacement_at(&finger.reading) - height_before;
                finger.motion *= share;
                finger.motion += finger.reading.of(&self.motion) - share * motion_before;
                Some(finger)
            });
        }
        self.finger_changes = old.finger_changes;
        self.steps = old.steps;
        self.solver_balance = old.solver_balance;
        self.energy_scale = old.energy_scale;
        self.take_over_heights(model, old, old_model, same_grid);
        self.calm.fill(0);
        self.heights_next.copy_from_slice(&self.heights);
        self.heights_rest_in = 2;
        self.look_at_all(model);
    }

    /// Puts every contact that was in touch where it is pressed just as hard, and every other one under
    /// the string.
    fn take_over_heights(&mut self, model: &Model, old: &State, old_model: &Model, same_grid: bool) {
        let has_partners = |contact: &Contact| match contact.kind {
            ContactKind::Fret { .. } => true,
            ContactKind::Board { .. } => same_grid,
        };
        // Where steps grow longer the depth before is not guessed at: it might be far deeper than anything was.
        let share = (model.grid.time_step / old_model.grid.time_step).min(1.0);
        let count = old_model.contacts.len();
        // Both lists are in order of place, so the partner of a contact follows that of the one before.
        let mut next = 0;
        for (index, contact) in model.contacts.iter().enumerate() {
            let now = contact.reading.of(&self.displacement);
            let before = now - contact.reading.of(&self.motion);
            // (No point of a board has a partner on another grid. To look for one takes time that an audio thread has not.)
            let looked_at = if has_partners(contact) { count } else { 0 };
            let partner = (0..looked_at)
                .map(|step| (next + step) % count)
                .find(|&candidate| contact.kind == old_model.contacts[candidate].kind);
            let (mut depth, mut depth_before) = (0.0, 0.0);
            if let Some(partner) = partner {
                next = partner + 1;
                let reading = &old_model.contacts[partner].reading;
                let string = reading.of(&old.displacement);
                depth = old.heights[partner] - string;
                depth_before = old.heights_before[partner] - (string - reading.of(&old.motion));
                if share < 1.0 {
                    depth_before = depth + share * (depth_before - depth);
                }
                // On another grid a string gives way otherwise: as deep as the same force presses it.
                let (law, old_law) = (&contact.law, &old_model.contacts[partner].law);
                if law != old_law {
                    depth = same_force(law, old_law, depth);
                    depth_before = same_force(law, old_law, depth_before);
                }
            }
            if depth.max(depth_before) > 0.0 {
                self.heights[index] = now + depth;
                self.heights_before[index] = before + depth_before;
            } else {
                let free = contact.height.min(now).min(before);
                self.heights[index] = free;
                self.heights_before[index] = free;
            }
        }
    }
}

/// How deep a contact of one law is pressed by the force that pressed one of another to `depth`, m; that itself where
/// nothing touches.
fn same_force(law: &ContactLaw, other: &ContactLaw, depth: f64) -> f64 {
    if depth > 0.0 { law.penetration_at(other.force(depth)) } else { depth }
}

impl Hands {
    /// Takes over what the hands on another string are doing.
    pub(crate) fn take_over(&mut self, old: &Hands, model: &Model, old_model: &Model) {
        let scale = model.grid.length / old_model.grid.length;
        let factor = self.sample_rate / old.sample_rate;
        self.plucks.clear();
        for pluck in &old.plucks {
            let position = pluck.position * scale;
            let reading = model.grid.reading(position);
            self.plucks.push(crate::hands::Pluck { position, reading, ..pluck.resampled(factor) });
        }
        self.stilling = old.stilling.resampled(factor);
        self.carry(old);
        for (held, before) in self.fingers.iter_mut().zip(&old.fingers) {
            *held = before.map(|before| before.carried(scale, factor));
        }
        // The same bend of this string goes on in its own time; from the tension there is, as far as this string bears it, to its
        // own tuning is a way besides.
        let (tension, most) = (model.string.tension, self.most_tension);
        let same_bend = |bent: f64| (tension * (bent / old_model.string.tension)).min(most);
        self.bent = old.bent.map(same_bend).resampled(factor);
        self.tuned = Ramp::at(old.tension().min(most) / self.bent.value());
        if self.tuned.value() != 1.0 {
            self.tuned.go(1.0, self.samples(FADE));
        }
    }

    /// Has the tension at the end of its way.
    pub(crate) fn arrive(&mut self) {
        self.bent = Ramp::at(self.bent.goal());
        self.tuned = Ramp::at(1.0);
    }

    /// Lets go of fingers that the string's state has not.
    pub(crate) fn keep_only(&mut self, state: &State) {
        for slot in 0..FINGERS_PER_STRING {
            if state.fingers()[slot].is_none() {
                self.fingers[slot] = None;
            }
        }
    }
}
