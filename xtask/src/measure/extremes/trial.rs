//! One trial: a scene, perhaps with a stream of events, or playing on instruments that are exchanged, computed to its end and
//! held to the promises.

use std::fmt;

use anyhow::{Context, Result};
use low_action_dsp::{Scene, Simulation};
use serde::Deserialize;
use toml::{Table, Value};

use super::balance::{Balance, Parts};
use super::bodies;
use super::draw::Draw;
use super::exchanges::Session;
use super::scenes;
use super::stream::{Acting, Stream};

/// The tables of a trial's file that a scene file has not.
const STREAM: &str = "stream";
const PLAYING: &str = "playing";

/// A trial as written in a file: a scene file with, perhaps, a `[stream]`; or a rate, a duration and a table `[playing]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The whole file.
    pub table: Table,
}

/// How a trial broke a promise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// A number is not finite.
    NotFinite,
    /// Energy stood above what was put in, by this part of it.
    Created(f64),
    /// The balance was open by this part of what was put in.
    Open(f64),
    /// The program panicked.
    Panic,
}

impl Fault {
    /// Whether another fault is of the same kind.
    pub fn is_like(&self, other: &Fault) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Fault::NotFinite => write!(f, "not finite"),
            Fault::Created(part) => write!(f, "energy {part:.1e} above what was put in"),
            Fault::Open(part) => write!(f, "the balance is open by {part:.1e} of what was put in"),
            Fault::Panic => write!(f, "panic"),
        }
    }
}

/// What a trial came to.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Refused, for this reason.
    Refused(String),
    /// Computed.
    Computed(Record),
}

/// What was measured in a trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// The cap of the solver.
    pub cap: usize,
    /// Whether a stream of events acted.
    pub stream: bool,
    /// Grid points times samples.
    pub point_samples: u64,
    /// The most contacts at once.
    pub contacts: u32,
    /// The most that energy stood above what was put in, as a part of it.
    pub created: f64,
    /// The most that the balance was open, as a part of what was put in.
    pub open: f64,
    /// What the last digits of the numbers in the balance are worth, as a part of what was put in.
    pub rounding: f64,
    /// Energy taken by the solver as a part of all that was put in.
    pub lost: f64,
    /// Samples with contact, iterations and fallbacks in them.
    pub solved: u64,
    /// Newton iterations.
    pub iterations: u64,
    /// Attempts of the fallback.
    pub fallbacks: u64,
    /// Instruments that took over, and those of them on which strings rang on.
    pub exchanges: [u64; 2],
    /// Those that were turned away while another was still fading.
    pub turned_away: u64,
    /// Whether board or frets stood above a string at rest.
    pub raised: bool,
    /// The promise that was broken.
    pub fault: Option<Fault>,
}

impl Record {
    /// What a string's ledger comes to.
    pub fn see(&mut self, parts: Parts) {
        self.created = self.created.max(parts.created);
        self.open = self.open.max(parts.open);
        self.rounding = self.rounding.max(parts.rounding);
    }
}

impl Trial {
    /// A trial of a run.
    pub fn random(seed: u64, number: u64) -> Trial {
        let mut draw = Draw::new(seed, number);
        let mut table = scenes::scene(&mut draw);
        if draw.chance(0.4) {
            let reach = draw.over(1e-6, 0.1);
            let stream = Stream::random(&mut draw, reach);
            table.insert(STREAM.into(), Value::try_from(stream).expect("a stream is a table"));
        }
        bodies::under(&mut draw, &mut table);
        Trial { table }
    }

    /// A trial of exchanges: mostly playing on instruments that take over from one another, and of every third a scene under
    /// whose strings others' boards and frets come up.
    pub fn of_exchanges(seed: u64, number: u64) -> Trial {
        let mut draw = Draw::new(seed, number);
        if !number.is_multiple_of(3) {
            return Trial { table: Table::try_from(Session::random(&mut draw)).expect("it is a table") };
        }
        let mut table = scenes::scene(&mut draw);
        let reach = draw.over(1e-6, 0.1);
        let stream = Stream::raised(&mut draw, reach);
        table.insert(STREAM.into(), Value::try_from(stream).expect("a stream is a table"));
        bodies::under(&mut draw, &mut table);
        Trial { table }
    }

    /// Reads a trial's file.
    ///
    /// # Errors
    /// When it is not TOML.
    pub fn from_toml(text: &str) -> Result<Trial> {
        Ok(Trial { table: text.parse().context("a trial's file")? })
    }

    /// The file.
    pub fn to_toml(&self) -> String {
        self.table.to_string()
    }

    /// Scene and stream.
    fn parts(&self) -> Result<(Scene, Option<Stream>), String> {
        let mut table = self.table.clone();
        let stream = table.remove(STREAM).map(Value::try_into).transpose();
        let stream: Option<Stream> = stream.map_err(|error| error.to_string())?;
        let scene = Scene::from_toml(&table.to_string()).map_err(|error| error.to_string())?;
        Ok((scene, stream))
    }

    /// Computes the trial.
    pub fn run(&self) -> Outcome {
        let computed = std::panic::catch_unwind(|| self.compute());
        computed
            .unwrap_or_else(|_| Outcome::Computed(Record { fault: Some(Fault::Panic), ..Record::default() }))
    }

    fn compute(&self) -> Outcome {
        if self.table.contains_key(PLAYING) {
            let session = Session::deserialize(self.table.clone());
            return session
                .map_or_else(|error| Outcome::Refused(error.to_string()), |session| session.play());
        }
        let (scene, stream) = match self.parts() {
            Ok(parts) => parts,
            Err(reason) => return Outcome::Refused(reason),
        };
        let mut simulation = match Simulation::new(&scene) {
            Ok(simulation) => simulation,
            Err(error) => return Outcome::Refused(error.to_string()),
        };
        let points: usize = simulation.strings().iter().map(|string| string.model.grid.intervals).sum();
        if points as f64 * simulation.samples() as f64 > 2.0 * scenes::MOST_POINT_SAMPLES {
            return Outcome::Refused(
                "duration = … is refused: too many points and samples for a trial".into(),
            );
        }
        simulation.open_ledger();
        let strings = simulation.strings();
        let mut acting: Vec<_> = stream
            .iter()
            .flat_map(|stream| {
                strings.iter().enumerate().map(|(index, string)| Acting::new(stream, index, string))
            })
            .collect();
        let mut record =
            Record { cap: scene.solver.max_iterations, stream: stream.is_some(), ..Record::default() };
        let mut balance = Balance::new(&simulation);
        for _ in 0..simulation.samples() {
            let entry = simulation.step_under(|index, string| {
                if let Some(acting) = acting.get_mut(index) {
                    acting.act(string);
                }
            });
            record.point_samples += points as u64;
            for string in simulation.strings() {
                let convergence = string.convergence;
                record.solved += u64::from(convergence.active > 0);
                record.contacts = record.contacts.max(convergence.active);
                record.iterations += u64::from(convergence.iterations);
                record.fallbacks += u64::from(convergence.fallbacks);
                record.raised |= string.drive.heights.iter().any(|&height| height > 0.0);
            }
            let entry = entry.expect("the ledger is open");
            balance.see(&simulation, &entry);
            // (What is not a number leaves these as they are, and is a fault.)
            record.created = record.created.max(balance.created);
            record.open = record.open.max(balance.open);
            if let Some(fault) = balance.fault(entry.energies.total(), simulation.output()) {
                record.fault = Some(fault);
                break;
            }
        }
        record.rounding = balance.rounding;
        record.lost =
            if balance.put_in > 0.0 { (balance.solver / balance.put_in).clamp(0.0, 1.0) } else { 0.0 };
        Outcome::Computed(record)
    }
}
