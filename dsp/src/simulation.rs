//! A scene as it runs: strings stepped by the forces and positions of the scene, one sample at a time.

mod scene_body;
mod scene_string;

use crate::body;
use crate::digits::{at_most, plain};
use crate::energy::{Account, BodyLedger, Ledger};
use crate::entry::Entry;
use crate::error::Error;
pub use crate::model::MOST_NUMBERS;
use crate::model::{Model, StringParameters};
use crate::scene::{ListeningPoint, Scene};
use scene_body::SceneBody;
use scene_string::Clock;
pub use scene_string::{FingerReport, PluckReport, SceneString};

/// A running scene.
#[derive(Debug, Clone)]
pub struct Simulation {
    strings: Vec<SceneString>,
    body: Option<SceneBody>,
    listening: ListeningPoint,
    sample_rate: f64,
    samples: u64,
    step: u64,
    ledgers: Option<Ledgers>,
}

/// What is booked of a scene.
#[derive(Debug, Clone)]
struct Ledgers {
    strings: Vec<Ledger>,
    body: Option<BodyLedger>,
}

impl Simulation {
    /// Compiles a scene.
    ///
    /// # Errors
    /// When a value is out of range, a string too short for its grid, a contact too stiff for the rate, a body too light for the
    /// strings or too fast for the rate, or the whole more than [`MOST_POINTS`], [`MOST_NUMBERS`] and [`MOST_WORK`] allow.
    pub fn new(scene: &Scene) -> Result<Simulation, Error> {
        scene.check()?;
        let points = check_size(scene)?;
        // Made one after another, and none that there is no room for.
        let mut left = MOST_NUMBERS;
        let mut strings = (0..scene.string.len())
            .map(|index| SceneString::new(scene, index, &mut left))
            .collect::<Result<Vec<_>, Error>>()?;
        let contacts = strings.iter().fold(0.0, |sum, string| sum + string.model.contact_work());
        let body = scene.body.as_ref().map(|body| SceneBody::new(body, &strings)).transpose()?;
        let modes = body.as_ref().map_or(0, SceneBody::count);
        check_work(scene, points, modes, contacts)?;
        strings.iter_mut().for_each(SceneString::begin);
        Ok(Simulation {
            strings,
            body,
            listening: scene.output.position,
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
        self.ledgers = Some(Ledgers {
            strings: self.strings.iter().map(open).collect(),
            body: self.body.as_ref().map(|body| body.open_ledger(&self.strings)),
        });
    }

    /// The strings' ledgers, if they are open.
    pub fn ledgers(&self) -> &[Ledger] {
        self.ledgers.as_ref().map_or(&[], |ledgers| &ledgers.strings)
    }

    /// The ledger of the body, if there is one and ledgers are open.
    pub fn body_ledger(&self) -> Option<&BodyLedger> {
        self.ledgers.as_ref()?.body.as_ref()
    }

    /// What has gone through the ledgers that are open: of each string, and then of the body, if there is one.
    pub fn accounts(&self) -> impl Iterator<Item = &Account> {
        let body = self.body_ledger().map(|ledger| &**ledger);
        self.ledgers().iter().map(|ledger| &**ledger).chain(body)
    }

    /// Advances every string, and the body, from sample n to n + 1. Returns the sum of the ledgers' entries.
    #[inline(always)]
    pub fn step(&mut self) -> Option<Entry> {
        self.step_under(|_, _| {})
    }

    /// The same under more than the scene describes: before each string is stepped, `act` may change what
    /// acts on it (its `drive`, as the scene has filled it) and place fingers or take them away. A tension
    /// above [the most](SceneString::most_tension) is not allowed: the grid has no room for it. (What the bridge of a body does to
    /// strings is no one else's to change.)
    #[inline(always)]
    pub fn step_under(&mut self, act: impl FnMut(usize, &mut SceneString)) -> Option<Entry> {
        if self.ledgers.is_some() {
            return Some(self.step_booked(act));
        }
        self.advance(act);
        None
    }

    #[inline(always)]
    fn advance(&mut self, mut act: impl FnMut(usize, &mut SceneString)) {
        let clock = self.clock();
        for (index, string) in self.strings.iter_mut().enumerate() {
            string.prepare(clock);
            act(index, string);
        }
        if let Some(body) = &mut self.body {
            body.step(&mut self.strings);
        }
        self.strings.iter_mut().for_each(SceneString::advance);
        self.step += 1;
    }

    /// The same with ledgers.
    #[inline(never)]
    fn step_booked(&mut self, act: impl FnMut(usize, &mut SceneString)) -> Entry {
        self.advance(act);
        let mut sum = Entry::default();
        let Some(ledgers) = &mut self.ledgers else { return sum };
        for (string, ledger) in self.strings.iter().zip(&mut ledgers.strings) {
            sum += ledger.record(&string.model, &string.state, &string.scratch, &string.drive);
        }
        if let (Some(body), Some(ledger)) = (&self.body, &mut ledgers.body) {
            sum += body.book(ledger, &self.strings, sum.inputs.bridge);
        }
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

    /// Whether there is a body under the strings.
    pub fn has_body(&self) -> bool {
        self.body.is_some()
    }

    /// How far the bridge of a body was up at the sample that the last step led from, m; 0 without a body.
    pub fn lift(&self) -> f64 {
        self.body.as_ref().map_or(0.0, |body| body.lift)
    }

    /// One string, 0 for the first.
    ///
    /// # Panics
    /// When there is no such string.
    pub fn string(&self, index: usize) -> &SceneString {
        &self.strings[index]
    }

    /// What is heard after the last step: the sum over strings of the velocity at the listening point
    /// (m/s) or of the force on the bridge (N), or the sound pressure before the body (Pa).
    pub fn output(&self) -> f64 {
        if self.listening == ListeningPoint::Air {
            return self.body.as_ref().map_or(0.0, |body| body.pressure);
        }
        let lift = self.lift();
        self.strings.iter().map(|string| string.output(lift)).sum()
    }
}

/// All strings of a scene must have fewer grid points than this: with contacts at each, some hundred megabytes. (As many are what a
/// string gets at most that asks for more.)
pub const MOST_POINTS: usize = 1_000_000;

/// The string of an index of a scene at its first moment, with the room on its grid that a body takes.
fn parameters(scene: &Scene, index: usize) -> StringParameters {
    let string = StringParameters::from_spec(&scene.string[index]);
    let tension_limit = string.tension_limit * body::room(scene.body.is_some());
    StringParameters { tension_limit, ..string }
}

/// The most steps of grid points, modes of a body, plucks, fingers and what contacts that share grid points may take that a scene
/// may ask for: hours of computing. Contacts may take two numbers for each two of a crowd, and a third of its cube to solve for
/// them.
pub const MOST_WORK: f64 = 1e13;

/// Refuses a scene that would fill the memory, before anything of its size is made. Returns how many grid points it has.
fn check_size(scene: &Scene) -> Result<usize, Error> {
    let mut points = 0;
    for index in 0..scene.string.len() {
        let grid = Model::grid(&parameters(scene, index), scene.solver.stencil, 1.0 / scene.sample_rate);
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

/// Refuses a scene of so many grid points, and modes of a body, that would never end, in each sample of which contacts may take so
/// many steps.
fn check_work(scene: &Scene, points: usize, modes: usize, contacts: f64) -> Result<(), Error> {
    let things = [
        (scene.pluck.len(), ["pluck", "plucks"]),
        (scene.finger.len(), ["finger", "fingers"]),
        (modes, ["mode of the body", "modes of the body"]),
        (points, ["grid point", "grid points"]),
    ];
    let each = things.iter().map(|(count, _)| count).sum::<usize>() as f64 + contacts;
    if each * scene.duration * scene.sample_rate <= MOST_WORK {
        return Ok(());
    }
    let longest = MOST_WORK / (each * scene.sample_rate);
    let some = things.into_iter().filter(|(count, _)| *count > 0);
    let mut terms: Vec<String> = some
        .map(|(count, [one, several])| format!("{count} {}", if count == 1 { one } else { several }))
        .collect();
    if contacts > 0.0 {
        terms.push(format!("{contacts:.2e} numbers for contacts that share some"));
    }
    let last = terms.pop().unwrap_or_default();
    let joined = if terms.is_empty() { last } else { format!("{} and {last}", terms.join(", ")) };
    let accepted = format!(
        "with {joined} at {} Hz it must lie between 0 and {} s",
        plain(scene.sample_rate),
        plain(at_most(longest))
    );
    Err(Error::range("duration", plain(scene.duration), accepted))
}
