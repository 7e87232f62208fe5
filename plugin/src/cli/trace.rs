//! The trace of a scene: what moved where, what pushed, and where the energy went, as arrays.

mod booked;
mod plan;

use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use low_action_dsp::digits::{at_most, plain};
use low_action_dsp::pickup::stretch_tension;
use low_action_dsp::simulation::SceneString;
use low_action_dsp::{Entry, Simulation};

use super::PROGRAM;
use super::names::shown;
use super::npz::NpzFile;
use super::output::Draft;
use super::room_left::room_left;
use booked::{LEDGER, WORK};
use plan::{OriginArrays, Plan};

/// The largest trace written, bytes.
const LARGEST: u64 = 1_000_000_000_000;
/// What the records of an array take at most beside its numbers, bytes.
const HEADERS: u64 = 512;

/// A trace being written. Row n holds the state at its sample, the forces and powers that act there, and
/// the energies half a sample later.
pub(super) struct Trace {
    path: PathBuf,
    draft: Draft,
    plan: Plan,
    npz: NpzFile,
    fret_forces: Vec<f64>,
    /// Sums of powers since the row before, in the order of [`WORK`], W.
    since: [f64; WORK.len()],
}

impl Trace {
    /// Begins the trace of every so many-th sample of a simulation, and says in it how the scene is written.
    pub fn begin(path: &Path, text: &str, simulation: &Simulation, every: u64) -> Result<Trace> {
        let plan = Plan::new(text, simulation, every);
        if plan.bytes() > LARGEST {
            let limit = format!("at most {} are accepted", plain(LARGEST as f64));
            bail!(plan.too_large(LARGEST, &limit, text, simulation));
        }
        let draft = Draft::begin(path)?;
        let left = draft.handle().ok().and_then(|file| room_left(&file));
        // (Beside its numbers an array takes some hundred bytes.)
        let left = left.map(|left| left.saturating_sub(HEADERS * plan.arrays.len() as u64));
        if let Some(left) = left.filter(|&left| plan.bytes() > left) {
            let limit = format!("there is room for {} where it goes", plain(at_most(left as f64)));
            bail!(plan.too_large(left, &limit, text, simulation));
        }
        let npz = draft.handle().and_then(|file| NpzFile::begin(file, &plan.arrays));
        let npz = npz.with_context(|| cannot_write(path))?;
        let mut trace = Trace {
            path: path.to_owned(),
            draft,
            plan,
            npz,
            fret_forces: Vec::new(),
            since: [0.0; WORK.len()],
        };
        trace.keep_origin(text, simulation).with_context(|| cannot_write(path))?;
        Ok(trace)
    }

    /// Rows of the arrays over time, and bytes of all numbers.
    pub fn size(&self) -> (u64, u64) {
        (self.plan.rows, self.plan.bytes())
    }

    /// Takes a step, and keeps what there was before and what happened in it if its sample is due.
    /// Returns the step's entry in the ledger.
    pub fn step(&mut self, simulation: &mut Simulation) -> Result<Option<Entry>> {
        let due = simulation.steps().is_multiple_of(self.plan.every);
        if due {
            self.keep_state(simulation).with_context(|| cannot_write(&self.path))?;
        }
        let entry = simulation.step();
        for (sum, (_, power)) in self.since.iter_mut().zip(WORK) {
            *sum += entry.as_ref().map_or(0.0, power);
        }
        if due {
            let entry = entry.unwrap_or_default();
            self.keep_events(simulation, &entry).with_context(|| cannot_write(&self.path))?;
        }
        Ok(entry)
    }

    /// Keeps what does not change.
    fn keep_origin(&mut self, text: &str, simulation: &Simulation) -> io::Result<()> {
        let OriginArrays { scene, program, sample_rate, every } = self.plan.origin;
        self.npz.add_text(scene, text)?;
        self.npz.add_text(program, PROGRAM)?;
        self.npz.add(sample_rate, &[simulation.sample_rate()])?;
        self.npz.add_whole(every, self.plan.every)?;
        for (arrays, string) in self.plan.strings.iter().zip(simulation.strings()) {
            string.places().try_for_each(|place| self.npz.add(arrays.places, &[place]))?;
        }
        Ok(())
    }

    /// Keeps the state that the next step leads from.
    fn keep_state(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.npz.add(self.plan.time, &[simulation.steps() as f64 / simulation.sample_rate()])?;
        for (arrays, string) in self.plan.strings.iter().zip(simulation.strings()) {
            string.state.displacement().try_for_each(|u| self.npz.add(arrays.displacement, &[u]))?;
            for finger in string.fingers() {
                let arrays = &self.plan.fingers[finger.number];
                self.npz.add(arrays.place, &[finger.position])?;
                self.npz.add(arrays.height, &[finger.height])?;
            }
        }
        Ok(())
    }

    /// Keeps what acted in the step just taken.
    fn keep_events(&mut self, simulation: &Simulation, entry: &Entry) -> io::Result<()> {
        let mut iterations = 0;
        for (index, string) in simulation.strings().iter().enumerate() {
            iterations += string.convergence.iterations;
            self.keep_forces(index, string, simulation.lift())?;
        }
        if let Some(lift) = self.plan.lift {
            self.npz.add(lift, &[simulation.lift()])?;
        }
        for (arrays, ledger) in self.plan.strings.iter().zip(simulation.ledgers()) {
            if let Some(stored) = arrays.stored {
                self.npz.add(stored, &[ledger.energies().total()])?;
            }
        }
        self.npz.add(self.plan.output, &[simulation.output()])?;
        self.npz.add_count(self.plan.iterations, iterations)?;
        for (array, (_, number)) in self.plan.ledger.into_iter().zip(LEDGER) {
            self.npz.add(array, &[number(entry)])?;
        }
        for (array, sum) in self.plan.work.into_iter().zip(&mut self.since) {
            self.npz.add(array, &[std::mem::take(sum) / simulation.sample_rate()])?;
        }
        Ok(())
    }

    fn keep_forces(&mut self, index: usize, string: &SceneString, lift: f64) -> io::Result<()> {
        let arrays = &self.plan.strings[index];
        let tension = string.scratch.stiffness().tension + stretch_tension(&string.model, &string.scratch);
        self.npz.add(arrays.tension, &[tension])?;
        self.npz.add(arrays.on_bridge, &[string.bridge_force(lift)])?;
        if let Some(bridge) = arrays.bridge {
            self.npz.add(bridge, &[string.bridge_power()])?;
        }
        if let Some(board) = arrays.board {
            self.npz.add(board, &[string.board_force()])?;
        }
        self.fret_forces.clear();
        self.fret_forces.resize(string.fret_count(), 0.0);
        for (fret, force) in string.fret_forces() {
            self.fret_forces[fret] = force;
        }
        for (&force, &array) in self.fret_forces.iter().zip(&arrays.frets) {
            self.npz.add(array, &[force])?;
        }
        for pluck in string.plucks() {
            self.npz.add(self.plan.plucks[pluck.number], &[pluck.force])?;
        }
        for finger in string.fingers() {
            self.npz.add(self.plan.fingers[finger.number].force, &[finger.force])?;
        }
        Ok(())
    }

    /// Completes the file, which then waits to be published.
    pub fn complete(self) -> Result<Draft> {
        self.npz.complete().with_context(|| cannot_write(&self.path))?;
        Ok(self.draft)
    }
}

fn cannot_write(path: &Path) -> String {
    format!("cannot write {}", shown(path))
}
