//! The hands on one string: gestures become the forces, places and tension of a [`Drive`].

mod held;

use crate::drive::{Drive, PUSHES};
use crate::finger::Finger;
use crate::gesture::{FINGERS_PER_STRING, Gesture, MOST_CLEARANCE, MOST_FORCE, Touch};
use crate::model::Model;
use crate::ramp::Ramp;
use crate::roomy::Roomy;
use crate::state::State;
pub(crate) use held::Pluck;
use held::{Held, Stilling};

/// How far from the string a lifted finger must be before it is taken away, m.
const CLEAR: f64 = 1e-3;

/// Fastest slide of a finger, m/s: a hand crosses a neck in a tenth of a second. Dragging a pressed
/// string sideways puts in work without bound, so the gesture is limited and not the scheme.
const FASTEST_SLIDE: f64 = 10.0;

/// Fastest a finger is thrown, m/s: the thumb of a slapping bass player comes at some 5 m/s.
const FASTEST_THROW: f64 = 10.0;

/// Least tension a bend may leave, as a part of the string's own.
const LEAST_TENSION: f64 = 0.05;

/// A string that comes with more tension than it may have begins with no more than so much of what its grid bears. At all of it the
/// shortest wave has no stiffness left, and whatever moves a fret would make it ripple.
const CLEAR_OF_MOST: f64 = 0.98;

/// Whether a hand can have such a force, N. One that is no number, or becomes none on its way, would stay in the string for
/// ever.
fn is_possible(force: f64) -> bool {
    force.abs() <= MOST_FORCE
}

/// A time in samples of a rate in Hz, rounded.
fn samples(seconds: f64, rate: f64) -> u64 {
    // A hostile duration counts as at once; `as` saturates at the other end.
    (seconds * rate).round().max(0.0) as u64
}

/// The hands on one string.
#[derive(Debug, Clone)]
pub(crate) struct Hands {
    /// Of the string, Hz.
    pub sample_rate: f64,
    pub plucks: Roomy<Pluck>,
    pub stilling: Stilling,
    /// What hands add to the loss of a string that nobody plays, 1/s; none where the bridge stands still, and nobody hears others.
    idle_loss: Option<f64>,
    /// What they do add, 1/s: where the bridge stands still as much as on a string that it was taken over from, until it rests, so
    /// that what that has heard of others fades here, too.
    resting_loss: f64,
    /// Whether the string is played: something was plucked, or thrown at it, and no hand laid along it since has lain to its end.
    played: bool,
    pub fingers: [Option<Held>; FINGERS_PER_STRING],
    /// Tension that the string is bent to, N.
    pub bent: Ramp,
    /// By how much more than that it is pulled, while it is still on its way from the tuning of a string before; 1 afterwards.
    pub tuned: Ramp,
    /// The most that hands may bend it to, N: what its grid bears, less what that leaves for a body.
    pub most_tension: f64,
}

impl Hands {
    /// Nobody plays the string, which bears so much tension, N.
    pub fn new(model: &Model, sample_rate: f64, most_tension: f64, idle_loss: Option<f64>) -> Self {
        Hands {
            sample_rate,
            plucks: Roomy::with_capacity(PUSHES),
            stilling: Stilling::default(),
            idle_loss,
            resting_loss: idle_loss.unwrap_or(0.0),
            played: false,
            fingers: [None; FINGERS_PER_STRING],
            bent: Ramp::at(model.string.tension),
            tuned: Ramp::at(1.0),
            most_tension,
        }
    }

    /// Takes all hands away.
    pub fn reset(&mut self, model: &Model) {
        self.plucks.clear();
        self.stilling = Stilling::default();
        self.leave();
        self.fingers = [None; FINGERS_PER_STRING];
        self.bent = Ramp::at(model.string.tension);
        self.tuned = Ramp::at(1.0);
    }

    /// The string rests: nobody plays it.
    pub fn leave(&mut self) {
        (self.played, self.resting_loss) = (false, self.idle_loss.unwrap_or(0.0));
    }

    /// Somebody plays it, and so does whoever lies along it.
    fn play(&mut self) {
        (self.played, self.stilling.is_players) = (true, true);
    }

    /// Leaves it to whom it was left before, and to what hands did then where they do nothing of their own.
    pub fn carry(&mut self, old: &Hands) {
        (self.played, self.resting_loss) = (old.played, self.idle_loss.unwrap_or(old.resting_loss));
    }

    /// Whether nothing touches or bends the string.
    pub fn idle(&self) -> bool {
        self.plucks.is_empty()
            && self.stilling.left == 0
            && self.bent.rests()
            && self.tuned.rests()
            && self.fingers.iter().all(Option::is_none)
    }

    /// Present tension of the string, N.
    pub fn tension(&self) -> f64 {
        let bent = self.bent.value();
        if self.tuned.rests() { bent } else { (bent * self.tuned.value()).min(self.most_tension) }
    }

    /// As much of a tension that is asked of it, N, as a string can begin with where it had so much before, and stretching adds `own`
    /// to it: no less than the slackest bend leaves, or than it had; and where that is more than hands may bend it to, so much that
    /// the shortest waves are [clear](CLEAR_OF_MOST) of what its grid bears.
    pub fn begins_at(&self, model: &Model, asked: f64, had: f64, own: f64) -> f64 {
        // (What is no number is none that can be asked for.)
        let asked = if asked.is_finite() { asked } else { had };
        let most = self.most_tension;
        let clear = CLEAR_OF_MOST * model.tension_borne(most) - own;
        let borne = if asked > most { most.min(clear) } else { asked };
        borne.max((LEAST_TENSION * model.string.tension).min(had)).min(most)
    }

    /// The largest tension a bend may reach, as a multiple of the string's own.
    fn highest_ratio(&self, model: &Model) -> f64 {
        self.most_tension / model.string.tension
    }

    /// A time in samples, rounded.
    pub fn samples(&self, seconds: f64) -> u64 {
        samples(seconds, self.sample_rate)
    }

    /// Begins a gesture. What cannot be done (a finger that is not there, a ninth pluck) is left out; returns whether it was
    /// begun.
    pub fn begin(&mut self, gesture: Gesture, model: &Model, state: &mut State) -> bool {
        let inside = |place: f64| {
            let end = 0.01 * model.grid.spacing;
            if place.is_nan() { 0.5 * model.grid.length } else { place.clamp(end, model.grid.length - end) }
        };
        match gesture {
            Gesture::Pluck { position, force, duration, release } => {
                let ends = duration.is_finite() && release.is_finite();
                let begins = self.plucks.len() < PUSHES && is_possible(force) && ends;
                if begins {
                    self.play();
                    let position = inside(position);
                    let reading = model.grid.reading(position);
                    let [duration, release] = [duration, release].map(|time| time.max(0.0));
                    self.plucks.push(Pluck { position, reading, force, done: 0, duration, release });
                }
                begins
            }
            Gesture::Place { finger, touch, position, clearance } => {
                self.put(finger, touch, inside(position), [clearance, 0.0], model, state)
            }
            Gesture::Throw { finger, touch, position, clearance, speed } => {
                // Anything but a number counts as at rest.
                let speed = if speed > 0.0 { speed.min(FASTEST_THROW) } else { 0.0 };
                let begins = self.put(finger, touch, inside(position), [clearance, speed], model, state);
                if begins {
                    self.play();
                }
                begins
            }
            Gesture::Press { force, .. } | Gesture::Lift { force, .. } if !is_possible(force) => false,
            Gesture::Press { finger, force, duration } => {
                let samples = self.samples(duration);
                let Some(held) = self.finger(finger) else { return false };
                held.force.go(force, samples);
                held.leaving = false;
                true
            }
            Gesture::Slide { finger, position, duration } => {
                let place = inside(position);
                let rate = self.sample_rate;
                let Some(held) = self.finger(finger) else { return false };
                // So many samples that none of its steps is longer than a hand's.
                let least = ((place - held.position.value()).abs() / FASTEST_SLIDE * rate).ceil() as u64;
                held.position.go_straight(place, samples(duration, rate).max(least));
                true
            }
            Gesture::Lift { finger, force, duration } => {
                let samples = self.samples(duration);
                let Some(held) = self.finger(finger) else { return false };
                held.force.go(-force.abs(), samples);
                held.leaving = true;
                true
            }
            Gesture::Still { loss, duration } => {
                let begins = loss >= 0.0 && loss.is_finite() && duration.is_finite();
                if begins {
                    self.stilling = Stilling { loss, left: self.samples(duration), is_players: false };
                }
                begins
            }
            Gesture::Bend { tension_ratio, duration } => {
                let most = self.highest_ratio(model);
                let ratio = if tension_ratio.is_finite() { tension_ratio } else { 1.0 };
                let samples = self.samples(duration);
                self.bent.go(model.string.tension * ratio.clamp(LEAST_TENSION, most), samples);
                true
            }
        }
    }

    /// Puts a finger over the string at a place, m from the nut: so high above it, m, and on its way to it
    /// at a speed, m/s. Returns whether there can be such a finger.
    fn put(
        &mut self,
        slot: usize,
        touch: Touch,
        place: f64,
        [clearance, speed]: [f64; 2],
        model: &Model,
        state: &mut State,
    ) -> bool {
        let is_near = clearance <= MOST_CLEARANCE;
        if slot >= FINGERS_PER_STRING || !touch.is_possible() || !is_near {
            return false;
        }
        // A finger that cannot be leaves the one that is there.
        let Some(law) = model.finger_law_if(&touch) else { return false };
        let reading = model.grid.reading(place);
        let now = state.displacement_at(&reading);
        // Touching nothing a step ago either: a string that comes from above would be inside it.
        let before = now - state.velocity_at(model, &reading) * model.grid.time_step;
        let height = (now + clearance.max(0.0)).max(before - speed * model.grid.time_step).max(now);
        state.put_finger(slot, Finger::over(model, touch, law, place, height, 0.0 - speed));
        self.fingers[slot] = Some(Held { force: Ramp::at(0.0), position: Ramp::at(place), leaving: false });
        true
    }

    fn finger(&mut self, finger: usize) -> Option<&mut Held> {
        self.fingers.get_mut(finger)?.as_mut()
    }

    fn take_away(&mut self, finger: usize, state: &mut State) {
        self.fingers[finger] = None;
        state.remove_finger(finger);
    }

    /// Fills the drive of the next step, and takes lifted fingers away.
    pub fn drive(&mut self, state: &mut State, drive: &mut Drive) {
        drive.tension = self.tension();
        self.bent.step();
        self.tuned.step();
        self.played &= !self.stilling.leaves();
        let idle = if self.played { 0.0 } else { self.resting_loss };
        drive.loss = self.stilling.step().max(idle);
        drive.pushes.clear();
        let rate = self.sample_rate;
        self.plucks.retain_mut(|pluck| {
            drive.pushes.push(pluck.push(rate));
            pluck.done += 1;
            // Half a step of the next sample's push may still be its.
            (pluck.done as f64 - 0.5) / rate < pluck.duration + pluck.release
        });
        // (Where the string has no finger there is none to drive.)
        for slot in 0..state.no_finger_from {
            let Some(held) = &mut self.fingers[slot] else { continue };
            let hand = &mut drive.hands[slot];
            hand.force = held.force.value();
            held.force.step();
            hand.position = held.position.step();
            if held.leaving
                && let Some(finger) = &state.fingers()[slot]
                && finger.height - state.displacement_at(&finger.reading) > CLEAR
            {
                self.take_away(slot, state);
            }
        }
    }
}
