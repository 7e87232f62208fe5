//! A scene as it runs: strings stepped by the forces and positions of the scene, one sample at a time.

mod scene_string;

use crate::digits::{at_most, plain};
use crate::energy::Ledger;
use crate::entry::Entry;
use crate::error::Error;
pub use crate::model::MOST_NUMBERS;
use crate::model::{Model, StringParameters};
use crate::scene::Scene;
use scene_string::Clock;
pub use scene_string::{FingerReport, PluckReport, SceneString};

/// A running scene.
#[derive(Debug, Clone)]
pub struct Simulation {
    strings: Vec<SceneString>,
    sample_rate: f64,
    samples: u64,
    step: u64,
    ledgers: Option<Vec<Ledger>>,
}

impl Simulation {
    /// Compiles a scene.
    ///
    /// # Errors
    /// When a value is out of range, a string too short for its grid, a contact too stiff for the rate,
    /// or the whole more than [`MOST_POINTS`], [`MOST_NUMBERS`] and [`MOST_WORK`] allow.
    pub fn new(scene: &Scene) -> Result<Simulation, Error> {
        scene.check()?;
        let points = check_size(scene)?;
        // Made one after another, and none that there is no room for.
        let mut left = MOST_NUMBERS;
        let mut strings = (0..scene.string.len())
            .map(|index| SceneString::new(scene, index, &mut left))
            .collect::<Result<Vec<_>, Error>>()?;
        let contacts = strings.iter().fold(0.0, |sum, string| sum + string.model.contact_work());
        check_work(scene, points, contacts)?;
        strings.iter_mut().for_each(SceneString::begin);
        Ok(Simulation {
            strings,
            sample_rate: scene.sample_rate,
            samples: scene.samples(),
            step: 0,
            ledgers: None,
        })
    }

    /// Opens the energy ledger; from now on [`Simulation::step`] returns its entries. The strings move
    /// exactly as they would without.
    pub fn open_ledger(&mut self) {
        let open = |string: &SceneString| Ledger::new(&string.model, &string.state, string.last_tension());
        self.ledgers = Some(self.strings.iter().map(open).collect());
    }

    /// The strings' ledgers, if they are open.
    pub fn ledgers(&self) -> &[Ledger] {
        self.ledgers.as_deref().unwrap_or_default()
    }

    /// Advances every string from sample n to n + 1. Returns the sum of the ledgers' entries.
    #[inline(always)]
    pub fn step(&mut self) -> Option<Entry> {
        self.step_under(|_, _| {})
    }

    /// The same under more than the scene describes: before each string is stepped, `act` may change what
    /// acts on it (its `drive`, as the scene has filled it) and place fingers or take them away. A tension
    /// above the model's limit is not allowed: the grid has no room for it.
    #[inline(always)]
    pub fn step_under(&mut self, mut act: impl FnMut(usize, &mut SceneString)) -> Option<Entry> {
        if self.ledgers.is_some() {
            return Some(self.step_booked(act));
        }
        let clock = self.clock();
        for (index, string) in self.strings.iter_mut().enumerate() {
            string.prepare(clock);
            act(index, string);
            string.advance();
        }
        self.step += 1;
        None
    }

    /// The same with ledgers.
    #[inline(never)]
    fn step_booked(&mut self, mut act: impl FnMut(usize, &mut SceneString)) -> Entry {
        let clock = self.clock();
        let mut sum = Entry::default();
        for (index, (string, ledger)) in
            self.strings.iter_mut().zip(self.ledgers.iter_mut().flatten()).enumerate()
        {
            string.prepare(clock);
            act(index, string);
            string.advance();
            sum += ledger.record(&string.model, &string.state, &string.scratch, &string.drive);
        }
        self.step += 1;
        sum
    }

    fn clock(&self) -> Clock {
        Clock { step: self.step, sample_rate: self.sample_rate }
    }

    /// Number of steps taken.
    pub fn steps(&self) -> u64 {
        self.step
    }

    /// Number of steps the scene lasts.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Sample rate, Hz.
    pub fn sample_rate(&self) -> f64 {
        self.sample_rate
    }

    /// The strings.
    pub fn strings(&self) -> &[SceneString] {
        &self.strings
    }

    /// One string, 0 for the first.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn string(&self, index: usize) -> &SceneString {
        &self.strings[index]
    }

    /// What is heard after the last step: the sum over strings of the velocity at the listening point
    /// (m/s) or of the force on the bridge (N).
    pub fn output(&self) -> f64 {
        self.strings.iter().map(SceneString::output).sum()
    }
}

/// All strings of a scene must have fewer grid points than this: with contacts at each, some hundred megabytes. (As many are what a
/// string gets at most that asks for more.)
pub const MOST_POINTS: usize = 1_000_000;

/// The most steps of grid points, plucks, fingers and what contacts that share grid points may take that a scene may ask for: hours
/// of computing. Contacts may take two numbers for each two of a crowd, and a third of its cube to solve for them.
pub const MOST_WORK: f64 = 1e13;

/// Refuses a scene that would fill the memory, before anything of its size is made. Returns how many grid points it has.
fn check_size(scene: &Scene) -> Result<usize, Error> {
    let mut points = 0;
    for (index, spec) in scene.string.iter().enumerate() {
        let string = StringParameters::from_spec(spec);
        let grid = Model::grid(&string, scene.solver.stencil, 1.0 / scene.sample_rate);
        points += grid.map_err(|error| error.under(&format!("string[{}]", index + 1)))?.intervals;
        if points >= MOST_POINTS {
            let accepted = format!(
                "at this rate the strings need {points} grid points or more, and fewer than {} are accepted",
                plain(MOST_POINTS as f64)
            );
            return Err(Error::range("sample_rate", plain(scene.sample_rate), accepted));
        }
    }
    Ok(points)
}

/// Refuses a scene of so many grid points that would never end, in each sample of which contacts may take so many steps.
fn check_work(scene: &Scene, points: usize, contacts: f64) -> Result<(), Error> {
    let things = (points + scene.pluck.len() + scene.finger.len()) as f64 + contacts;
    let work = things * scene.duration * scene.sample_rate;
    if work <= MOST_WORK {
        return Ok(());
    }
    let longest = MOST_WORK / (things * scene.sample_rate);
    let contacts = match contacts {
        0.0 => String::new(),
        _ => format!(" and {contacts:.2e} numbers for contacts that share some"),
    };
    let accepted = format!(
        "with {points} grid points{contacts} at {} Hz it must lie between 0 and {} s",
        plain(scene.sample_rate),
        plain(at_most(longest))
    );
    Err(Error::range("duration", plain(scene.duration), accepted))
}
