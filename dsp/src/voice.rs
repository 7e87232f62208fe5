//! One string of an instrument: its model, its motion, the hands on it and what is heard of it.

mod handover;
#[cfg(test)]
mod tests;

use std::ops::Range;

use crate::body::{Body, Heard, most_tension};
use crate::decimate::Decimator;
use crate::deflection::Deflection;
use crate::drive::Drive;
use crate::energy::Ledger;
use crate::error::Error;
use crate::gesture::{FINGERS_PER_STRING, Gesture};
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
    /// What the bridge stands on, if it gives way, as far as this string moves it.
    pub body: Option<Body>,
    listener: Listener,
    decimator: Decimator,
    pub geometry: StringGeometry,
    gain: f64,
    pub pan: [f64; 2],
    asleep: bool,
    /// The last samples heard: up to [`RUN`], or as many as [`Voice::make_room`] was last asked for.
    pub run: Vec<f64>,
    /// Whether `run` holds nothing but zeros, throughout, because nothing is left to be heard.
    pub silent: bool,
    settling: Settling,
    /// Room to find how far what presses the string deflects it, when another takes over.
    deflection: Deflection,
    /// What the string holds, gets and loses, if anybody wants to know.
    pub ledger: Option<Ledger>,
    /// What has happened to the string since somebody last looked.
    pub observed: Observed,
}

/// Samples of the host's that a string is stepped through at a time, at most.
pub(crate) const RUN: usize = 64;

/// A string nobody touches sleeps once its energy is below this, J, over a body once that of every string is, and what each has the
/// body do: a soft pluck holds 1e-6 J, so this is 140 dB under it.
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
        let body = setup.body.as_ref().map(|body| Body::new(body, &model));
        let idle_loss = body.is_some().then_some(setup.player.idle_loss);
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
            hands: Hands::new(&model, rate, most_tension(&model, body.is_some()), idle_loss),
            body,
            listener: Listener::new(&PickupMix::of(setup, &placed.string), &model, rate),
            decimator: Decimator::new(ratio, RUN),
            gain: setup.gain * spec.level,
            pan: [libm::cos(angle), libm::sin(angle)],
            asleep: true,
            run: vec![0.0; RUN],
            silent: true,
            settling: Settling::none(&model),
            deflection: Deflection::new(&model),
            ledger: None,
            observed: Observed::new(&model),
            model,
        })
    }

    /// Wakes the string, which may have been `at_rest`.
    pub fn wake(&mut self, at_rest: bool) {
        if at_rest {
            // It wakes with the first of two samples that may share a step: its sound does not depend on when. (While filters still
            // ring from before it fell asleep they go on, and it wakes with either.)
            self.decimator.reset();
        }
        self.asleep = false;
    }

    /// Begins a gesture; it is awake.
    pub fn begin(&mut self, gesture: Gesture) {
        if self.hands.begin(gesture, &self.model, &mut self.state) {
            self.observed.see_gesture(&gesture);
        }
    }

    /// How many steps of the string a sample of the host's has.
    pub fn ratio(&self) -> Ratio {
        self.decimator.ratio()
    }

    /// Steps that it takes in the next so many samples of the host's.
    pub fn steps(&self, samples: usize) -> usize {
        self.decimator.steps(samples)
    }

    /// Has room for so many samples in `run`.
    pub fn make_room(&mut self, samples: usize) {
        if self.run.len() < samples {
            self.run.resize(samples, 0.0);
        }
    }

    /// How far the bridge is up by this string, m.
    #[inline]
    pub fn lift(&self) -> f64 {
        self.body.as_ref().map_or(0.0, Body::lift)
    }

    /// Takes the step of index `index` since samples were last given, over a bridge that is `lift` m up. Whether it may fall
    /// asleep then: nobody could hear what is left of its motion.
    #[inline]
    pub fn step(&mut self, index: usize, lift: f64) -> bool {
        let (signal, may_rest) = self.next(lift);
        self.decimator.take(index, self.gain * signal);
        may_rest
    }

    /// Gives the samples `span` of `run`, after the steps of so many.
    pub fn give(&mut self, span: Range<usize>) {
        self.silent = false;
        self.decimator.give(&mut self.run[span]);
        self.observed.see_shape(&self.state);
    }

    /// Gives nothing but zeros.
    pub fn be_silent(&mut self) {
        if !self.silent {
            self.run.fill(0.0);
            self.silent = true;
        }
    }

    /// Whether it rests, and nothing that it has sent out is still on its way.
    pub fn is_at_rest(&mut self) -> bool {
        self.asleep
            && self.decimator.is_empty()
            && self.body.as_ref().is_none_or(Body::is_still)
            && self.listener.is_still()
    }

    /// Whether it rests.
    pub fn is_asleep(&self) -> bool {
        self.asleep
    }

    /// Whether it rests, and nothing of it is left to be heard.
    pub fn is_silent(&self) -> bool {
        self.asleep && self.silent
    }

    /// Whether nothing that its part of the body does would be heard of a string.
    pub fn has_quiet_body(&self) -> bool {
        self.body.as_ref().is_none_or(|body| body.energy() < SILENCE)
    }

    #[inline]
    fn next(&mut self, lift: f64) -> (f64, bool) {
        if self.asleep {
            let heard = self.body.as_mut().map_or(Heard::default(), |body| body.ring(lift));
            return (self.listener.hear_nothing(heard), false);
        }
        self.hands.drive(&mut self.state, &mut self.drive);
        if !self.settling.part.rests() {
            self.settle();
        } else if !self.drive.heights.is_empty() {
            self.drive.heights.clear();
        }
        let mut heard = Heard::default();
        if let Some(body) = &mut self.body {
            let tension = self.state.tension_under(&self.drive, &self.scratch);
            let (push, of_body) = body.step(&self.model, &self.state, tension, lift);
            self.drive.bridge = Some(push);
            heard = of_body;
        }
        let convergence = self.state.step(&self.model, &self.drive, &mut self.scratch);
        self.observed.see_step(&convergence, &self.scratch);
        if let Some(ledger) = &mut self.ledger {
            ledger.record(&self.model, &self.state, &self.scratch, &self.drive);
        }
        let signal = self.listener.hear(&self.model, &self.state, &self.scratch, heard);
        // (That energy is from before the step: what was pushed in it is not in it yet.)
        let is_quiet = self.scratch.string_energy() < SILENCE;
        let is_left_alone =
            is_quiet && self.hands.idle() && self.drive.pushes.is_empty() && self.settling.part.rests();
        (signal, is_left_alone)
    }

    /// Brings the string to rest; nobody could hear what is left of its motion.
    #[cold]
    pub fn fall_asleep(&mut self) {
        self.state.reset(&self.model);
        self.scratch.reset();
        self.hands.leave();
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
