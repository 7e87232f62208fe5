//! An engine at work: events in, sound out, and other engines put in its place on the way (`exchange`).

mod exchange;
#[cfg(test)]
mod tests;

use std::sync::Arc;
use std::time::Instant;

use nice_plug::prelude::*;

use super::budget::Budget;
use super::events;
use super::meters::Meters;
use super::order::{self, Order};
use super::shelf::Shelf;
use super::voices::Voices;
use super::workshop::{Finished, Workshop};
use crate::engine::{Engine, Quality};
use crate::params::LowActionParams;
use crate::performance::{Announced, PlayerEvent};
use crate::pointer::Played;

/// An engine, what it was built from, and the workshop that builds others.
pub(super) struct Playing {
    engine: Engine,
    /// What the engine was built from.
    order: Order,
    /// What could not be built when it was last asked for, if nothing else has been asked for since.
    refused: Option<Order>,
    /// What the workshop has been asked for and is not played yet.
    asked: Option<Order>,
    /// The sample at which the instrument of that was first asked for: notes since then are meant for it.
    asked_at: u64,
    /// The sample since which nothing is ordered, as a file is awaited whose values are only coming.
    awaits_since: Option<u64>,
    /// A finished engine waiting until the last one has faded.
    ready: Option<Finished>,
    workshop: Workshop,
    offline: bool,
    budget: Budget,
    relaxed: bool,
    voices: Voices,
    meters: Arc<Meters>,
}

impl Playing {
    /// Builds the engine and opens the workshop; allocates.
    ///
    /// Where the set-up cannot be built with all that was done to it, it is taken as it comes.
    pub fn new(wanted: Order, offline: bool, shelf: Shelf, meters: Arc<Meters>) -> Result<Self, String> {
        let (engine, order) = match wanted.build(&shelf, Engine::new) {
            Ok(engine) => (engine, wanted),
            Err(problem) => {
                meters.refuse();
                let engine = wanted.untouched().build(&shelf, Engine::new)?;
                shelf.tell_also(format!("{problem}; the set-up is played as it comes"));
                (engine, wanted.untouched())
            }
        };
        let workshop = Workshop::open(shelf).map_err(|error| format!("cannot start a thread: {error}"))?;
        meters.see_load(0.0, false);
        Ok(Self {
            engine,
            order,
            refused: (order != wanted).then_some(wanted),
            asked: None,
            asked_at: 0,
            awaits_since: None,
            ready: None,
            workshop,
            offline,
            budget: Budget::new(order.sample_rate),
            relaxed: false,
            voices: Voices::default(),
            meters,
        })
    }

    /// Whether this is what would be built for an order, with nothing else on its way.
    pub fn is(&self, order: &Order) -> bool {
        let best = if self.refused == Some(*order) { order.untouched() } else { *order };
        self.order == best && self.asked.is_none()
    }

    /// Silence, as if just built, but for what was announced where it has played in real time and is to go on so.
    pub fn reset(&mut self, offline: bool) {
        let has_rendered = std::mem::replace(&mut self.offline, offline);
        if has_rendered {
            // What a file has announced is for that file.
            self.engine.reset();
        }
        self.reset_sound();
        self.budget.reset();
        self.meters.see_load(0.0, false);
        self.set_effort(false);
    }

    /// Silence and the first sample again. Who plays has announced only once how far a wheel reaches; a file that is rendered
    /// says it again, and is to sound as it did.
    pub fn reset_sound(&mut self) {
        if self.offline {
            self.engine.reset();
        } else {
            self.engine.restart();
        }
        self.voices = Voices::default();
        self.asked_at = 0;
        self.awaits_since = None;
    }

    /// The host begins to process again, or asks for silence: the framework tells of both in the same way. One that lets a
    /// plugin at rest sleep begins again with every first note, and is to lose nothing by it: where nothing is heard there is
    /// nothing to silence, and pedals, wheels and keys are where they were. Says whether anything was.
    pub fn begin_again(&mut self) -> bool {
        let sounds = !self.engine.is_inaudible();
        if sounds {
            self.reset_sound();
        }
        sounds
    }

    /// Everything that sounds is damped.
    pub fn silence(&mut self) {
        self.touch(PlayerEvent::AllNotesOff);
    }

    /// What comes is the beginning of the music, or that of a part of it once more.
    pub fn begin_anew(&mut self) {
        self.engine.begin_anew();
    }

    /// What has been announced to it, where it plays in real time.
    pub fn announced(&self) -> Option<Announced> {
        (!self.offline).then(|| self.engine.announced())
    }

    /// What was announced to another that played in real time before is so to this one, if that is how it is to play.
    pub fn announce(&mut self, params: &LowActionParams, announced: &Announced) {
        if !self.offline {
            // What the parameters say of wheels and keyswitches comes before.
            self.follow(params);
            self.engine.announce(announced);
        }
    }

    /// Has the hands act as the parameters say from now on.
    pub fn follow(&mut self, params: &LowActionParams) {
        self.engine.touch(&order::touching(params));
        self.engine.set_input(order::input(params));
    }

    /// Takes an event of the host's.
    pub fn event(&mut self, event: NoteEvent<()>, params: &LowActionParams) {
        let engine = &mut self.engine;
        let spoken = engine.spoken();
        events::translate(event, params, spoken, &mut self.voices, |offset, event| {
            engine.event(offset, event)
        });
    }

    /// Plays what was done with the editor's strings. A rendering has only what the host plays, and is the same every time:
    /// there it is forgotten.
    pub fn take_up(&mut self, played: &Played) {
        if self.offline {
            return played.clear();
        }
        while let Some(event) = played.next() {
            self.touch(event);
        }
    }

    /// Plays something at once.
    pub fn touch(&mut self, event: PlayerEvent) {
        if event == PlayerEvent::AllNotesOff {
            self.voices.lift_all();
        }
        self.engine.event(0, event);
    }

    /// What plays, for whoever looks at it.
    pub fn engine(&mut self) -> &mut Engine {
        &mut self.engine
    }

    /// Plays a block, and the strings by themselves into as many of `stems` as there are.
    pub fn play(
        &mut self,
        params: &LowActionParams,
        left: &mut [f32],
        right: &mut [f32],
        stems: &mut [&mut [f32]],
    ) {
        self.look_at(&params.shelf);
        let wanted = Order::of(params, self.order.sample_rate, self.offline);
        let mut done = 0;
        while done < left.len() {
            self.retire();
            let left_over = (left.len() - done) as u64;
            let before = self.order;
            let run = self.exchange(wanted).map_or(left_over, |until| until.min(left_over)) as usize;
            if self.order != before {
                // Hands that go on with strings of theirs act as the new set-up's from this very sample on.
                self.follow(params);
            }
            let span = done..done + run;
            let count = stems.len().min(super::STRING_OUTPUTS);
            let mut parts: [&mut [f32]; super::STRING_OUTPUTS] = std::array::from_fn(|_| Default::default());
            for (part, stem) in parts.iter_mut().zip(stems.iter_mut()) {
                *part = &mut stem[span.clone()];
            }
            let (left, right) = (&mut left[span.clone()], &mut right[span]);
            self.engine.process_stems(&mut parts[..count], left, right);
            done += run;
        }
    }

    /// Tells the host which of its notes have ended in a block of so many samples; `send` says whether it took that in.
    pub fn end_voices(&mut self, samples: usize, mut send: impl FnMut(NoteEvent<()>) -> bool) {
        let engine = &self.engine;
        let last = samples.saturating_sub(1) as u32;
        self.voices.end(last, |channel, key| engine.sounds(channel, key), &mut send);
    }

    /// Number of strings.
    pub fn string_count(&self) -> u32 {
        self.engine.string_count() as u32
    }

    /// Begins to measure a block, in real time.
    pub fn start_clock(&self) -> Option<Instant> {
        (!self.offline).then(Instant::now)
    }

    /// Ends it; if the time is too short contacts are solved less exactly from now on.
    pub fn stop_clock(&mut self, started: Option<Instant>, samples: usize, may_relax: bool) {
        if let Some(started) = started {
            self.spend(started.elapsed().as_secs_f64(), samples, may_relax);
        }
    }

    /// So many seconds went into so many samples.
    fn spend(&mut self, seconds: f64, samples: usize, may_relax: bool) {
        let relaxed = self.budget.spent(seconds, samples) && may_relax;
        self.meters.see_load(self.budget.load(), relaxed);
        if relaxed != self.relaxed {
            self.set_effort(relaxed);
        }
    }

    /// Solves contacts as exactly as was ordered, or less so.
    fn set_effort(&mut self, relaxed: bool) {
        self.relaxed = relaxed;
        let settings = self.order.luthier.settings(f64::from(self.order.sample_rate));
        let iterations = settings.max_iterations;
        let least = Quality::RELAXED;
        if relaxed {
            self.engine.set_effort(iterations.min(least.0), settings.tolerance.max(least.1));
        } else {
            self.engine.set_effort(iterations, settings.tolerance);
        }
    }

    /// What to tell the host: for how long the strings can ring on, or that nothing sounds and nothing will by itself.
    pub fn status(&self, looked_at: bool) -> ProcessStatus {
        if self.engine.is_silent() && looked_at && !self.offline {
            // What is done in the editor comes in only while the host goes on.
            ProcessStatus::KeepAlive
        } else if self.engine.is_silent() && (self.offline || self.asked.is_none() && !self.awaits()) {
            ProcessStatus::Normal
        } else {
            // Also while nobody hears the strings, as long as they move: no tail would mean in VST3 that the host need not go on. And
            // while another instrument or its file is on its way, which comes in only if it does, and is to be there before the next note.
            ProcessStatus::Tail(self.tail())
        }
    }

    /// For how long strings can ring on, samples.
    pub fn tail(&self) -> u32 {
        // An endless tail becomes the largest number, by which hosts mean just that.
        (self.engine.tail() * f64::from(self.order.sample_rate)) as u32
    }
}
