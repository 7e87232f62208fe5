//! One trial: a scene, perhaps with a stream of events, computed to its end and held to the promises.

use std::fmt;

use anyhow::{Context, Result};
use low_action_dsp::{Entry, Ledger, Scene, Simulation};
use toml::{Table, Value};

use super::draw::Draw;
use super::scenes;
use super::stream::{Acting, Stream};

/// How far energy may stand above what was put in, and the balance be open, as a part of all that was put in;
/// and beside that as much as the last digits of the numbers in the balance are worth.
pub const TOLERANCE: f64 = 1e-9;

/// The table of a trial's file that a scene file has not.
const STREAM: &str = "stream";

/// A trial as written in a file: a scene file with, perhaps, a `[stream]`.
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
    /// The promise that was broken.
    pub fault: Option<Fault>,
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

/// The balance of a whole trial as it goes on.
#[derive(Debug, Clone, Copy, Default)]
struct Balance {
    time_step: f64,
    /// All that was put in, what was taken out again not counted off, J. (Not the sum of what
    /// [ledgers](Ledger::put_in_gross) have booked: in a sample in which one string is given what another gives, this takes
    /// what is left, and it ends as no number where a power is none.)
    put_in: f64,
    /// What the solver took, J.
    solver: f64,
    /// How far energy stands above what was put in, as a part of that; below nothing where some was lost.
    created: f64,
    open: f64,
    rounding: f64,
}

/// The larger of two numbers, and not a number if either is none: `f64::max` would leave that one out.
fn larger(one: f64, other: f64) -> f64 {
    if one.is_nan() || one > other { one } else { other }
}

impl Balance {
    fn new(simulation: &Simulation) -> Balance {
        let put_in = simulation.ledgers().iter().map(|ledger| ledger.initial).sum();
        Balance { time_step: 1.0 / simulation.sample_rate(), put_in, ..Balance::default() }
    }

    fn see(&mut self, simulation: &Simulation, entry: &Entry) {
        self.flow(entry);
        let sum = |part: fn(&Ledger) -> f64| simulation.ledgers().iter().map(part).sum::<f64>();
        let above = sum(|ledger| ledger.energies().total() - ledger.put_in);
        self.weigh(above, sum(|ledger| ledger.residual_sum), sum(|ledger| ledger.rounding));
    }

    /// What flows in a sample.
    fn flow(&mut self, entry: &Entry) {
        self.put_in += larger(self.time_step * entry.power_in, 0.0);
        self.solver += self.time_step * entry.power_solver;
    }

    /// Compares with all that was put in: the energy above that, what the balance does not explain, and what its last digits
    /// are worth, J.
    fn weigh(&mut self, above: f64, residual: f64, rounding: f64) {
        let all = larger(self.put_in, f64::MIN_POSITIVE);
        self.created = above / all;
        self.open = residual.abs() / all;
        self.rounding = rounding / all;
    }

    fn fault(&self, total: f64, output: f64) -> Option<Fault> {
        if !(total.is_finite() && output.is_finite() && self.put_in.is_finite()) {
            return Some(Fault::NotFinite);
        }
        let allowed = TOLERANCE + self.rounding;
        // Written so that what is not a number breaks the promise.
        let (passive, closed) = (self.created <= allowed, self.open <= allowed);
        match (passive, closed) {
            (false, _) => Some(Fault::Created(self.created)),
            (true, false) => Some(Fault::Open(self.open)),
            (true, true) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A balance into which a joule has flown, and then a sample of so many watts.
    fn balance(power_in: f64) -> Balance {
        let mut balance = Balance { time_step: 1e-4, put_in: 1.0, ..Balance::default() };
        balance.flow(&Entry { power_in, ..Entry::default() });
        balance
    }

    #[test]
    fn what_is_taken_out_is_not_counted_off() {
        assert_eq!(balance(100.0).put_in, 1.01);
        assert_eq!(balance(-100.0).put_in, 1.0);
    }

    #[test]
    fn energy_above_what_was_put_in_and_an_open_balance_are_faults() {
        let fault = |above, residual, rounding| {
            let mut balance = balance(0.0);
            balance.weigh(above, residual, rounding);
            balance.fault(1.0, 0.0)
        };
        assert_eq!(fault(-0.5, 0.0, 0.0), None);
        assert_eq!(fault(0.9e-9, -0.9e-9, 0.0), None);
        assert_eq!(fault(2e-9, 0.0, 0.0), Some(Fault::Created(2e-9)));
        assert_eq!(fault(-0.5, -2e-9, 0.0), Some(Fault::Open(2e-9)));
        assert_eq!(fault(2e-9, -2e-9, 2e-9), None);
    }

    /// Wherever it comes from.
    #[test]
    fn what_is_not_a_number_is_a_fault() {
        for (power, above, residual, rounding) in [
            (f64::NAN, 0.0, 0.0, 0.0),
            (f64::INFINITY, 0.0, 0.0, 0.0),
            (0.0, f64::NAN, 0.0, 0.0),
            (0.0, 0.0, f64::NAN, 0.0),
            (0.0, 0.0, 0.0, f64::NAN),
        ] {
            let mut balance = balance(power);
            balance.weigh(above, residual, rounding);
            assert!(balance.fault(1.0, 0.0).is_some(), "{power} W, {above} J, {residual} J, {rounding} J");
        }
        assert_eq!(balance(0.0).fault(f64::NAN, 0.0), Some(Fault::NotFinite));
        assert_eq!(balance(0.0).fault(1.0, f64::NAN), Some(Fault::NotFinite));
    }
}
