//! The trace of a scene: what moved where, what pushed, and where the energy went, as arrays.

mod booked;

use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use low_action_dsp::digits::{at_least, plain};
use low_action_dsp::pickup::stretch_tension;
use low_action_dsp::simulation::SceneString;
use low_action_dsp::{Entry, Simulation};

use super::PROGRAM as PROGRAM_NAME;
use super::names::shown;
use super::npz::{Array, Kind, NpzFile};
use super::output::Draft;
use booked::{LEDGER, WORK};

/// The largest trace written, bytes.
const LARGEST: u64 = 1_000_000_000_000;

/// Where the numbers of one string go.
struct StringArrays {
    displacement: usize,
    tension: usize,
    /// What is stored in it, where that is not all there is.
    stored: Option<usize>,
    /// Of the bridge of a body.
    bridge: Option<usize>,
    board: Option<usize>,
    /// The first of its frets' arrays; the others follow.
    frets: usize,
}

/// Where the numbers of one finger go.
struct FingerArrays {
    place: usize,
    height: usize,
    force: usize,
}

/// Where times go, and what the trace is of: the scene's text, what computed it, at which rate, and how many samples apart rows are.
const TIME: usize = 0;
const SCENE: usize = 1;
const PROGRAM: usize = 2;
const SAMPLE_RATE: usize = 3;
const EVERY: usize = 4;

/// The arrays of a trace and what fills them. Those above are the first.
struct Plan {
    arrays: Vec<Array>,
    strings: Vec<StringArrays>,
    /// The force of each pluck.
    plucks: Vec<usize>,
    fingers: Vec<FingerArrays>,
    output: usize,
    iterations: usize,
    ledger: usize,
    rows: u64,
    every: u64,
}

impl Plan {
    /// The trace of every so many-th sample of a simulation of a scene that is so written.
    fn new(text: &str, simulation: &Simulation, every: u64) -> Plan {
        let rows = simulation.samples().div_ceil(every);
        let mut arrays = Vec::new();
        let mut array = |name: String, kind: Kind, shape: &[u64]| {
            arrays.push(Array { name, kind, shape: shape.to_vec() });
            arrays.len() - 1
        };
        array("t".into(), Kind::Real, &[rows]);
        array("scene".into(), Kind::Text(text.chars().count() as u64), &[]);
        array("program".into(), Kind::Text(PROGRAM_NAME.chars().count() as u64), &[]);
        array("sample_rate".into(), Kind::Real, &[]);
        array("every".into(), Kind::Whole, &[]);
        let has_body = simulation.has_body();
        let has_others = has_body || simulation.strings().len() > 1;
        let mut strings = Vec::new();
        let mut pluck_count = 0;
        let mut finger_numbers = Vec::new();
        for (number, string) in (1..).zip(simulation.strings()) {
            let points = string.model.grid.unknowns() as u64;
            array(format!("x_{number}"), Kind::Real, &[points]);
            let displacement = array(format!("u_{number}"), Kind::Real, &[rows, points]);
            let tension = array(format!("tension_{number}"), Kind::Real, &[rows]);
            let stored = has_others.then(|| array(format!("stored_{number}"), Kind::Real, &[rows]));
            let bridge = has_body.then(|| array(format!("power_bridge_{number}"), Kind::Real, &[rows]));
            let board =
                string.has_board().then(|| array(format!("force_board_{number}"), Kind::Real, &[rows]));
            let before = [stored, bridge, board].into_iter().flatten().count();
            let frets = tension + 1 + before;
            for fret in 1..=string.fret_count() {
                array(format!("force_fret_{number}_{fret}"), Kind::Real, &[rows]);
            }
            strings.push(StringArrays { displacement, tension, stored, bridge, board, frets });
            pluck_count += string.plucks().count();
            finger_numbers.extend(string.fingers().map(|finger| finger.number));
        }
        finger_numbers.sort_unstable();
        let plucks =
            (1..=pluck_count).map(|pluck| array(format!("force_pluck_{pluck}"), Kind::Real, &[rows]));
        let plucks = plucks.collect();
        let fingers = finger_numbers.iter().map(|index| FingerArrays {
            place: array(format!("x_finger_{}", index + 1), Kind::Real, &[rows]),
            height: array(format!("u_finger_{}", index + 1), Kind::Real, &[rows]),
            force: array(format!("force_finger_{}", index + 1), Kind::Real, &[rows]),
        });
        let fingers = fingers.collect();
        let output = array("output".into(), Kind::Real, &[rows]);
        let iterations = array("iterations".into(), Kind::Count, &[rows]);
        let ledger = iterations + 1;
        for (name, _) in LEDGER.iter().chain(&WORK) {
            array((*name).into(), Kind::Real, &[rows]);
        }
        Plan { arrays, strings, plucks, fingers, output, iterations, ledger, rows, every }
    }

    /// How many samples apart rows must be for all numbers to take at most so many bytes.
    fn least_every(text: &str, simulation: &Simulation, most: u64) -> u64 {
        let samples = simulation.samples();
        let bytes = |rows: u64| Plan::new(text, simulation, samples.div_ceil(rows).max(1)).bytes();
        let (one, row) = (bytes(1), bytes(2).saturating_sub(bytes(1)).max(1));
        let rows = (most + row).saturating_sub(one) / row;
        samples.div_ceil(rows.max(1))
    }

    /// Bytes of all numbers.
    fn bytes(&self) -> u64 {
        self.arrays.iter().map(Array::bytes).sum()
    }
}

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
            let (bytes, limit) = (plain(at_least(plan.bytes() as f64)), plain(LARGEST as f64));
            let least = Plan::least_every(text, simulation, LARGEST);
            bail!(
                "--every {every} is refused: the trace would take {bytes} bytes, and at most {limit} are accepted: it must \
                 be at least {least}"
            );
        }
        let draft = Draft::begin(path)?;
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
        self.npz.add_text(SCENE, text)?;
        self.npz.add_text(PROGRAM, PROGRAM_NAME)?;
        self.npz.add(SAMPLE_RATE, &[simulation.sample_rate()])?;
        self.npz.add_whole(EVERY, self.plan.every)?;
        for (arrays, string) in self.plan.strings.iter().zip(simulation.strings()) {
            // Places stand just before displacements.
            string.places().try_for_each(|place| self.npz.add(arrays.displacement - 1, &[place]))?;
        }
        Ok(())
    }

    /// Keeps the state that the next step leads from.
    fn keep_state(&mut self, simulation: &Simulation) -> io::Result<()> {
        self.npz.add(TIME, &[simulation.steps() as f64 / simulation.sample_rate()])?;
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
            self.keep_forces(index, string)?;
        }
        for (arrays, ledger) in self.plan.strings.iter().zip(simulation.ledgers()) {
            if let Some(stored) = arrays.stored {
                self.npz.add(stored, &[ledger.energies().total()])?;
            }
        }
        self.npz.add(self.plan.output, &[simulation.output()])?;
        self.npz.add_count(self.plan.iterations, iterations)?;
        for (array, (_, number)) in (self.plan.ledger..).zip(LEDGER) {
            self.npz.add(array, &[number(entry)])?;
        }
        for (array, sum) in (self.plan.ledger + LEDGER.len()..).zip(&mut self.since) {
            self.npz.add(array, &[std::mem::take(sum) / simulation.sample_rate()])?;
        }
        Ok(())
    }

    fn keep_forces(&mut self, index: usize, string: &SceneString) -> io::Result<()> {
        let arrays = &self.plan.strings[index];
        let tension = string.scratch.stiffness().tension + stretch_tension(&string.model, &string.scratch);
        self.npz.add(arrays.tension, &[tension])?;
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
        for (&force, array) in self.fret_forces.iter().zip(arrays.frets..) {
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

#[cfg(test)]
mod tests {
    use low_action_dsp::Scene;

    use super::*;

    #[test]
    fn the_least_that_is_named_for_every_is_enough_and_no_less_is() {
        let text = "sample_rate = 44100\nduration = 0.1\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                    tension = 60.0\n";
        let simulation = Simulation::new(&Scene::from_toml(text).unwrap()).unwrap();
        let bytes = |every| Plan::new(text, &simulation, every).bytes();
        for most in [bytes(4410), bytes(4410) + 1, 10_000, 100_000, 123_456, bytes(2), bytes(2) - 1] {
            let least = Plan::least_every(text, &simulation, most);
            assert!(bytes(least) <= most && bytes(least - 1) > most, "{most}: {least}");
        }
    }
}
