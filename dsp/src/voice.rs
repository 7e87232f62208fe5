//! One string of an instrument: its model, its motion, the hands on it and what is heard of it.

mod handover;
#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::body::{Body, Heard, most_tension};
use crate::decimate::Decimator;
use crate::drive::Drive;
use crate::energy::Ledger;
use crate::error::Error;
use crate::gesture::{FINGERS_PER_STRING, Gesture, TimedGesture};
use crate::hands::Hands;
use crate::instrument::StringGeometry;
use crate::intonation::intonate;
use crate::model::Model;
use crate::observed::Observed;
use crate::pickup::{Listener, PickupMix};
use crate::ramp::Ramp;
use crate::ratio::Ratio;
use crate::settings::EngineSettings;
use crate::setup::Setup;
use crate::state::State;
use crate::string::Scratch;
use handover::Settling;

/// One string with all that belongs to it.
#[derive(Debug, Clone)]
pub(crate) struct Voice {
    pub model: Model,
    pub state: State,
    pub scratch: Scratch,
    pub drive: Drive,
    hands: Hands,
    /// What the bridge stands on, if it gives way.
    body: Option<Body>,
    listener: Listener,
    decimator: Decimator,
    pub geometry: StringGeometry,
    gain: f64,
    pub pan: [f64; 2],
    asleep: bool,
    /// The last samples heard: up to [`RUN`], or as many as [`Voice::play`] was last asked for.
    pub run: Vec<f64>,
    /// Whether `run` holds nothing but zeros, throughout, because nothing is left to be heard.
    pub silent: bool,
    settling: Settling,
    /// What the string holds, gets and loses, if anybody wants to know.
    pub ledger: Option<Ledger>,
    /// What has happened to the string since somebody last looked.
    pub observed: Observed,
}

/// Samples of the host's that a string is stepped through at a time, at most.
pub(crate) const RUN: usize = 64;

/// A string nobody touches sleeps once its energy is below this, J: a soft pluck holds 1e-6 J, so this
/// is 140 dB under it.
const SILENCE: f64 = 1e-20;

impl Voice {
    /// Tunes the string, places its frets, compiles its model; allocates.
    pub fn new(setup: &Setup, index: usize, settings: &EngineSettings) -> Result<Voice, Error> {
        let spec = &setup.string[index];
        let name = format!("string[{}]", index + 1);
        let solver = settings.solver();
        let ratio = settings.ratio(setup, spec);
        let rate = ratio.value() * settings.sample_rate;
        let placed = intonate(setup, spec, solver.stencil, rate).map_err(|error| error.under(&name))?;
        let barrier = setup.barrier(&placed.frets)?;
        let model = Model::new(placed.string, Some(&barrier), FINGERS_PER_STRING, solver, rate)
            .map_err(|error| error.of_setup().under(&name))?;
        if let Some(bridge) = &setup.bridge {
            bridge.check_grid(&model.grid).map_err(|error| error.under(&name))?;
        }
        for (section, touch) in
            [("player.fretting", setup.player.fretting.touch), ("player.damper", setup.player.damper.touch)]
        {
            model.finger_law(&touch).map_err(|error| error.under(section).under(&name))?;
        }
        let body = setup.body.as_ref().map(|body| Body::new(body, &model)).transpose();
        let body = body.map_err(|error| error.under(&name))?;
        let angle = 0.25 * std::f64::consts::PI * (spec.pan + 1.0);
        Ok(Voice {
            geometry: StringGeometry {
                open_pitch: spec.pitch,
                length: placed.string.length,
                frets: placed.frets,
                highest_ratio: setup.highest_tension_ratio(),
                wave_impedance: (placed.string.tension * placed.string.linear_density).sqrt(),
                behind: setup.behind(),
            },
            state: State::new(&model),
            scratch: Scratch::new(&model),
            drive: Drive::new(&model),
            hands: Hands::new(&model, rate, most_tension(&model, body.is_some())),
            body,
            listener: Listener::new(&PickupMix::of(setup, &placed.string), &model, rate),
            decimator: Decimator::new(ratio, RUN),
            gain: setup.gain * spec.level,
            pan: [libm::cos(angle), libm::sin(angle)],
            asleep: true,
            run: vec![0.0; RUN],
            silent: true,
            settling: Settling::none(&model),
            ledger: None,
            observed: Observed::new(&model),
            model,
        })
    }

    /// Begins a gesture.
    pub fn begin(&mut self, gesture: Gesture) {
        if self.is_at_rest() {
            // It wakes with the first of two samples that may share a step: its sound does not depend on when. (While filters still
            // ring from before it fell asleep they go on, and it wakes with either.)
            self.decimator.reset();
        }
        self.asleep = false;
        if self.hands.begin(gesture, &self.model, &mut self.state) {
            self.observed.see_gesture(&gesture);
        }
    }

    /// How many steps of the string a sample of the host's has.
    pub fn ratio(&self) -> Ratio {
        self.decimator.ratio()
    }

    /// Steps the string through so many samples of the host's into `run`.
    pub fn run(&mut self, samples: usize) {
        if self.is_at_rest() {
            if !self.silent {
                self.run.fill(0.0);
                self.silent = true;
            }
            return;
        }
        self.silent = false;
        self.sound(0..samples);
    }

    /// Plays a stretch from sample `now` on into `run`, with its gestures in order of time: the same samples as those of
    /// one [`Voice::run`] after another. Allocates where the stretch is longer than any before.
    pub fn play<'a>(&mut self, now: u64, gestures: impl Iterator<Item = &'a TimedGesture>, samples: usize) {
        if self.run.len() < samples {
            self.run.resize(samples, 0.0);
        }
        let mut gestures = gestures.peekable();
        let (mut done, mut sounded) = (0, false);
        while done < samples {
            let time = now + done as u64;
            while let Some(due) = gestures.next_if(|next| next.time <= time) {
                self.begin(due.gesture);
            }
            let until_gesture = gestures.peek().map_or(u64::MAX, |next| next.time - time);
            let run = (samples - done).min(RUN).min(usize::try_from(until_gesture).unwrap_or(RUN));
            let span = done..done + run;
            if self.is_at_rest() {
                self.run[span].fill(0.0);
            } else {
                sounded = true;
                self.sound(span);
            }
            done += run;
        }
        self.silent = !sounded;
        if self.silent {
            self.run.fill(0.0);
        }
    }

    /// Steps the string through the samples `span` of `run`, at most [`RUN`].
    fn sound(&mut self, span: Range<usize>) {
        for index in 0..self.decimator.steps(span.len()) {
            let value = self.gain * self.next();
            self.decimator.take(index, value);
        }
        self.decimator.give(&mut self.run[span]);
        self.observed.see_shape(&self.state);
    }

    /// Whether it rests, and nothing that it has sent out is still on its way.
    fn is_at_rest(&mut self) -> bool {
        self.asleep
            && self.decimator.is_empty()
            && self.body.as_ref().is_none_or(Body::is_still)
            && self.listener.is_still()
    }

    /// Whether it rests, and nothing of it is left to be heard.
    pub fn is_silent(&self) -> bool {
        self.asleep && self.silent
    }

    #[inline]
    fn next(&mut self) -> f64 {
        if self.asleep {
            let heard = self.body.as_mut().map_or(Heard::default(), Body::ring);
            return self.listener.hear_nothing(heard);
        }
        self.hands.drive(&mut self.state, &mut self.drive);
        if !self.settling.part.rests() {
            self.settle();
        } else if !self.drive.heights.is_empty() {
            self.drive.heights.clear();
        }
        // (What the bridge does is nothing that is done to the string from outside.)
        let pushed = !self.drive.pushes.is_empty();
        let mut heard = Heard::default();
        if let Some(body) = &mut self.body {
            let (push, of_body) = body.step(&self.model, &self.state, self.drive.tension);
            self.drive.pushes.push(push);
            heard = of_body;
        }
        let convergence = self.state.step(&self.model, &self.drive, &mut self.scratch);
        self.observed.see_step(&convergence, &self.scratch);
        if let Some(ledger) = &mut self.ledger {
            ledger.record(&self.model, &self.state, &self.scratch, &self.drive);
        }
        let signal = self.listener.hear(&self.model, &self.state, &self.scratch, heard);
        // (That energy is from before the step: what was pushed in it is not in it yet.)
        let is_left_alone = self.hands.idle() && !pushed;
        if is_left_alone && self.settling.part.rests() && self.scratch.string_energy() < SILENCE {
            self.fall_asleep();
        }
        signal
    }

    /// Brings the string to rest; nobody could hear what is left of its motion.
    #[cold]
    fn fall_asleep(&mut self) {
        self.state.reset(&self.model);
        self.scratch.reset();
        self.asleep = true;
        self.rebook();
    }

    /// Has the ledger, if there is one, book what was done to the string beside its steps.
    fn rebook(&mut self) {
        if let Some(ledger) = &mut self.ledger {
            ledger.rebook(&self.model, &self.state, self.hands.tension());
        }
    }

    /// Opens the ledger of the string in its present state; allocates.
    pub fn open_ledger(&mut self) {
        self.ledger = Some(Ledger::new(&self.model, &self.state, self.hands.tension()));
    }

    /// Silence, with nobody near.
    pub fn reset(&mut self) {
        self.state.reset(&self.model);
        self.scratch.reset();
        self.hands.reset(&self.model);
        if let Some(body) = &mut self.body {
            body.reset();
        }
        self.listener.reset();
        self.decimator.reset();
        self.settling.part = Ramp::at(1.0);
        self.drive.heights.clear();
        self.asleep = true;
        self.run.fill(0.0);
        self.silent = true;
        self.observed.begin_anew(&self.state);
        self.rebook();
    }
}
