//! How a finger sets a string down: for a note that is plucked so that it is not heard, and for one that it sounds itself so that it
//! is.
//!
//! A string that goes down at constant speed is struck twice: where it begins to move, and where the fret stops it. The first sends
//! a wave along the string that comes back from the saddle after each period of what sounds. Where the second comes just then it
//! takes up all of that again, whatever partial it is of. So fingers take a whole number of periods before a pluck.
//!
//! Those that are to be heard would be soft at just these speeds. So one that takes so long gathers speed on its way: little is heard
//! of the string's beginning to move, and the fret stops it at nearly twice its mean speed, which is nearly as loud as both strokes
//! are together where they help each other most.
//!
//! For a harmonic that is not enough: soft ones are up to 10 dB softer or louder where they are struck while the finger is on its way. So
//! the one that stops the string for it comes ahead of the stroke, under a hand that stills the string.

use low_action_dsp::setup::Fretting;
use low_action_dsp::{Gesture, Touch};

use super::Fingers;
use super::held::Down;
use crate::performance::technique::*;
use crate::performance::{GestureSink, Moment};

/// How a string is set down.
pub(super) struct SetDown {
    pub touch: Touch,
    /// Time in which it comes to press, s.
    pub rise: f64,
    /// How long it waits for a hand that stills the string, if it does, s.
    pub waits: Option<f64>,
}

/// A finger that has the string down before that is struck, under a hand that stills it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ahead {
    /// How long it takes, s.
    pub time: f64,
    /// Period of what it has sound then, s.
    pub period: f64,
}

/// A finger that comes only when a hand that stills the string for it is about to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Awaited {
    /// When that is, in samples.
    time: u64,
    /// Time in which it comes to press, s.
    rise: f64,
}

/// How a finger is thrown.
pub(super) struct Thrown {
    pub touch: Touch,
    /// Height that it comes from, m.
    pub clearance: f64,
    /// Speed at which it comes, m/s.
    pub speed: f64,
    /// What it presses with from the beginning, N.
    pub force_at_first: f64,
    /// Time in which it comes to press as it goes on pressing, s.
    pub rise: f64,
}

impl Fingers {
    /// A finger lands behind a fret of a string that is held down somewhere. Gives back whether it waits for a hand that stills the string
    /// to go.
    pub(super) fn land(
        &mut self,
        fret: usize,
        stopped: Down,
        coming: Coming,
        at: &mut Moment<impl GestureSink>,
    ) -> bool {
        let place = self.comes_to(fret);
        let SetDown { touch, rise, waits } = self.set_down(place, stopped, coming, self.force());
        self.take_slot(fret, touch, false);
        self.awaited = Some(Awaited { time: at.after(waits.unwrap_or(0.0)), rise });
        if waits.is_none() {
            self.come(at);
        }
        waits.is_some()
    }

    /// The finger that waits for a hand to go waits no longer, if there is one.
    pub(super) fn come(&mut self, at: &mut Moment<impl GestureSink>) {
        let Some(Awaited { rise, .. }) = self.awaited.take() else { return };
        let Some(finger) = self.fretting else { return };
        let (position, clearance) = (self.pressed(&finger), self.hands.fretting.hover);
        at.does(Gesture::Place { finger: finger.slot, touch: finger.touch, position, clearance });
        at.does(Gesture::Press { finger: finger.slot, force: self.force(), duration: rise });
    }

    /// When one comes that waits.
    pub(super) fn comes(&self) -> Option<u64> {
        self.awaited.map(|awaited| awaited.time)
    }

    /// How the string is set down at a place counted in frets with a force, N. What a finger does to it under a hand that stills it is
    /// lost, and could not take up what the fret does later: a finger that would be down only after such a hand has come moves the
    /// string when that goes. (And comes only then: from higher up, as high over a string that swings, it would be early or late by as
    /// much.)
    pub(super) fn set_down(
        &self,
        place: f64,
        stopped: Down,
        Coming { strength, haste, stilled, ahead }: Coming,
        force: f64,
    ) -> SetDown {
        if let Some([comes, _]) = stilled.filter(|_| ahead) {
            let (touch, rise) = (self.in_haste(place, stopped, force), HAMMER_LANDING);
            return SetDown { touch, rise, waits: (comes > 0.0).then_some(comes) };
        }
        let Fretting { mut touch, landing, .. } = self.hands.fretting;
        let SoftLanding { from, most, drowned, slowest } = SOFT_LANDING;
        let softness = (from / strength.max(f64::MIN_POSITIVE)).max(1.0);
        let slower = (softness * softness).min(if strength < drowned { f64::INFINITY } else { most });
        touch.hand_damping *= (slower / (1.0 + HASTE * haste)).min(slowest);
        let (way, pull) = self.way_down(place, stopped);
        let period = self.stopped_period(place);
        // The hand's damping is what makes the speed constant.
        let driven = driving(force, pull);
        let damping_in = |time: f64| driven * time / way;
        let [by_itself, longest] = [way * touch.hand_damping / force, MOST_DAMPING / damping_in(1.0)];
        let time = period * (by_itself.min(longest) / period).round().max(1.0);
        touch.hand_damping = damping_in(time).min(MOST_DAMPING);
        let rise = landing.min(LANDING_RISE * period);
        // Until its force has grown and it has gathered speed.
        let begins = 0.5 * rise + touch.mass / touch.hand_damping;
        let stilled = stilled.filter(|[comes, _]| *comes < time);
        let before = self.moves_after(force / touch.hand_damping, touch).min(MET_BEFORE * period);
        let waits = stilled.map(|[_, gone]| (gone - before - begins).max(0.0));
        SetDown { touch, rise, waits }
    }

    /// The finger that sets the string down at a place with a force, N, as fast as a hand in haste does, however soft the note: under a
    /// hand that stills the string all the while whole periods take up nothing, and nothing has to be taken up.
    fn in_haste(&self, place: f64, stopped: Down, force: f64) -> Touch {
        let touch = self.hands.fretting.touch;
        let speed = force * (1.0 + HASTE) / touch.hand_damping;
        let (_, pull) = self.way_down(place, stopped);
        Touch { hand_damping: (driving(force, pull) / speed).min(MOST_DAMPING), ..touch }
    }

    /// How a finger lands that is to have the string down at a fret before it is struck; `None` where it has not to come down there.
    pub(crate) fn lands_ahead(&self, fret: usize, at: &Moment<impl GestureSink>) -> Option<Ahead> {
        let (place, stopped) = (self.comes_to(fret), self.down(self.fretting.as_ref(), at));
        if fret <= self.capo[0] || self.string.barred || !self.is_over(place, stopped) {
            return None;
        }
        let force = self.force();
        let touch = self.in_haste(place, stopped, force);
        let (way, pull) = self.way_down(place, stopped);
        // Its force grows and it gathers speed first.
        let begins = 0.5 * HAMMER_LANDING + touch.mass / touch.hand_damping;
        let goes = (self.hands.fretting.hover + way) * touch.hand_damping / driving(force, pull);
        Some(Ahead { time: begins + goes + SET_DOWN, period: self.stopped_period(place) })
    }

    /// How long a finger that comes at a speed, m/s, takes until the string goes with it, s: over the height from which it
    /// comes, and until its pad is pressed in so far that it drives the string both ways as fast.
    fn moves_after(&self, speed: f64, touch: Touch) -> f64 {
        // Waves that run to both sides ask for twice the impedance.
        let force = 2.0 * self.string.geometry.wave_impedance * speed;
        let pressed_in = libm::pow(force / touch.stiffness, 1.0 / touch.exponent);
        (self.hands.fretting.hover + pressed_in) / speed
    }

    /// How a finger comes down so fast that the string sounds by it, at a speed, m/s, at a place counted in frets of a string that is
    /// held down somewhere: thrown if it takes a small part of a period, slowly at first if it takes more than half of one, and
    /// something of both in between.
    pub(super) fn throw(&self, place: f64, stopped: Down, speed: f64) -> Thrown {
        let Fretting { mut touch, hover, .. } = self.hands.fretting;
        let force = self.force();
        touch.hand_damping = touch.hand_damping.min(force / (HAMMER_GRIP * speed));
        let (way, pull) = self.way_down(place, stopped);
        let time = way * touch.hand_damping / driving(force, pull);
        let Gathering { from, to, most } = GATHERING;
        let gathered = most * ((time / self.stopped_period(place) - from) / (to - from)).clamp(0.0, 1.0);
        let thrown = 1.0 - gathered;
        // Of a force that grows all the while, the mean of its beginning and its end.
        touch.hand_damping *= 0.5 * (thrown + 1.0);
        let (force_at_first, rise) =
            if gathered > 0.0 { (thrown * force, time) } else { (0.0, HAMMER_LANDING) };
        Thrown { touch, clearance: thrown * hover, speed: thrown * speed, force_at_first, rise }
    }

    /// How far a finger moves that touches a string held down somewhere until that touches the neck at a place counted in frets, m, and
    /// what the string pulls it back with then, N.
    fn way_down(&self, place: f64, down: Down) -> (f64, f64) {
        let position = self.glided_place(place, false);
        let beyond = self.string.geometry.length - position;
        let depth = (beyond * (self.slope_on(place) - self.slope(down))).max(LEAST_WAY);
        // A finger that lets the string up supports it no more.
        let support = if down.part < 1.0 { self.capo[1] } else { down.fret };
        let near = position - self.string.geometry.finger_position(support);
        if near <= 0.0 {
            return (LEAST_WAY, 0.0);
        }
        let pull = self.string.stiffness(near, beyond) * depth;
        let touch = self.hands.fretting.touch;
        (depth + libm::pow(pull / touch.stiffness, 1.0 / touch.exponent), pull)
    }

    /// How steeply the string goes from where it is held down straight to the saddle.
    fn slope(&self, down: Down) -> f64 {
        let [without, on] = [self.capo[1], down.fret].map(|fret| self.slope_on(fret as f64));
        without + down.part * (on - without)
    }

    /// How steeply from where it is held down on the neck, at a place counted in frets.
    fn slope_on(&self, place: f64) -> f64 {
        let (below, part) = (place.floor() as usize, place - place.floor());
        let [depth, next] = [below, below + 1].map(|fret| self.string.depth(fret));
        (depth + part * (next - depth)) / (self.string.geometry.length - self.glided_place(place, false))
    }

    /// Whether a string that is held down somewhere has some way to go to the neck, at a place counted in frets.
    pub(super) fn is_over(&self, place: f64, down: Down) -> bool {
        self.slope_on(place) > self.slope(down)
    }
}

/// What moves a finger of such a force on its way to where the string pulls it back so hard, on average, N. A string that
/// pulls harder than the finger stops it before.
fn driving(force: f64, pull: f64) -> f64 {
    (LANDING_LAG * force - 0.5 * pull.min(force)).max(f64::MIN_POSITIVE)
}
