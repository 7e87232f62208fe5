//! One string of a running scene: the forces and positions that the scene has act on it.

use super::{MOST_NUMBERS, parameters};
use crate::body::most_tension;
use crate::curve::Curve;
use crate::digits::plain;
use crate::drive::{Drive, Hand, Push};
use crate::error::Error;
use crate::gesture::pluck_push;
use crate::grid::Reading;
use crate::model::{Barrier, ContactKind, Model};
use crate::pickup::bridge_force;
use crate::scene::{ListeningPoint, PluckSpec, Scene};
use crate::solver::Convergence;
use crate::state::State;
use crate::string::Scratch;

/// One string of a running scene.
#[derive(Debug, Clone)]
pub struct SceneString {
    /// Coefficients.
    pub model: Model,
    /// State at the present sample.
    pub state: State,
    /// What the last step did.
    pub scratch: Scratch,
    /// What acted in the last step.
    pub drive: Drive,
    /// How the last step's contacts were solved.
    pub convergence: Convergence,
    plucks: Vec<ScenePluck>,
    fingers: Vec<SceneFinger>,
    pub(super) tension: Curve,
    /// The tension, N, if it stays as it is and nothing of the scene acts on the string: what most steps need not ask for.
    steady: Option<f64>,
    /// Whether anything but rest is let go of at the first sample.
    begins_held: bool,
    listening: Option<Reading>,
    fret_count: usize,
    /// The most tension that it may be given, N.
    most_tension: f64,
}

/// How a finger of a running scene is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FingerReport {
    /// Index in the scene's list, 0 for the first.
    pub number: usize,
    /// Place, m from the nut.
    pub position: f64,
    /// Height of its pad, m.
    pub height: f64,
    /// Its force on the string in the last step, N, downward.
    pub force: f64,
}

/// What a pluck of a running scene does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PluckReport {
    /// Index in the scene's list, 0 for the first.
    pub number: usize,
    /// Its force on the string in the last step, N, upward: the mean over the step of what the scene asks for.
    pub force: f64,
}

#[derive(Debug, Clone)]
struct ScenePluck {
    /// Index in the scene's list.
    number: usize,
    spec: PluckSpec,
    reading: Reading,
    /// Force in the last step, N.
    force: f64,
}

#[derive(Debug, Clone)]
struct SceneFinger {
    /// Index in the scene's list.
    number: usize,
    position: Curve,
    force: Curve,
}

/// When a step is taken.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub step: u64,
    pub sample_rate: f64,
}

impl Clock {
    /// Time so many samples after the one that the step leads from, s.
    fn at(self, later: u64) -> f64 {
        // (A signed number of steps turns into a float in one instruction.)
        (self.step + later).cast_signed() as f64 / self.sample_rate
    }
}

impl SceneString {
    /// Compiles a string of a scene, where there are so many numbers left for its contacts' answers.
    pub(super) fn new(scene: &Scene, index: usize, left: &mut usize) -> Result<SceneString, Error> {
        let spec = &scene.string[index];
        let number = index + 1;
        let fingers: Vec<_> =
            scene.finger.iter().enumerate().filter(|(_, finger)| finger.string == number).collect();
        let barrier = scene.fretboard.as_ref().map(|b| Barrier::from_spec(b, spec.length)).transpose()?;
        let (string, slots) = (parameters(scene, index), fingers.len());
        let model = Model::of_any_crowd(string, barrier.as_ref(), slots, scene.solver, scene.sample_rate)
            .map_err(|error| error.under(&format!("string[{number}]")))?;
        let frets = barrier.as_ref().map_or(0, |barrier| barrier.frets.len());
        *left = left.checked_sub(model.numbers()).ok_or_else(|| too_crowded(number, frets, slots))?;
        let mut state = State::new(&model);
        if let Some(shape) = &spec.shape {
            state.set_shape(&model, &Curve::Points(shape.clone()));
        }
        if let Some(velocity) = &spec.velocity {
            state.set_velocity(&model, &Curve::Points(velocity.clone()));
        }
        for (slot, (finger_index, finger)) in fingers.iter().enumerate() {
            let place = finger.position.at(0.0);
            state
                .place_finger(&model, slot, finger.touch(), place, finger.height, finger.velocity)
                .map_err(|error| error.under(&format!("finger[{}]", finger_index + 1)))?;
        }
        let plucks: Vec<_> = (scene.pluck.iter().enumerate())
            .filter(|(_, pluck)| pluck.string == number)
            .map(|(number, pluck)| ScenePluck {
                number,
                spec: pluck.clone(),
                reading: model.grid.reading(pluck.position),
                force: 0.0,
            })
            .collect();
        let steady = match spec.tension {
            Curve::Constant(tension) if fingers.is_empty() && plucks.is_empty() => Some(tension),
            _ => None,
        };
        let mut drive = Drive::new(&model);
        drive.pushes.reserve(scene.pluck.len());
        for (hand, (_, finger)) in drive.hands.iter_mut().zip(&fingers) {
            *hand = Hand { position: finger.position.at(0.0), force: finger.force.at(0.0) };
        }
        Ok(SceneString {
            plucks,
            fingers: fingers
                .iter()
                .map(|(finger_index, finger)| SceneFinger {
                    number: *finger_index,
                    position: finger.position.clone(),
                    force: finger.force.clone(),
                })
                .collect(),
            tension: spec.tension.clone(),
            steady,
            begins_held: spec.shape.is_some() || spec.velocity.is_some() || !fingers.is_empty(),
            fret_count: barrier.as_ref().map_or(0, |barrier| barrier.frets.len()),
            listening: match scene.output.position {
                ListeningPoint::Bridge | ListeningPoint::Air => None,
                ListeningPoint::At(place) => Some(model.grid.reading(place)),
            },
            most_tension: most_tension(&model, scene.body.is_some()),
            scratch: Scratch::new(&model),
            drive,
            convergence: Convergence::default(),
            state,
            model,
        })
    }

    /// Lets go of how the string begins: that solves for its contacts, which may take a while.
    pub(super) fn begin(&mut self) {
        if self.begins_held {
            self.state.let_go(&self.model, &self.drive);
        }
    }

    /// Fills the drive of the next step.
    #[inline(always)]
    pub(super) fn prepare(&mut self, clock: Clock) {
        self.drive.pushes.clear();
        self.drive.heights.clear();
        self.drive.loss = 0.0;
        match self.steady {
            Some(tension) => self.drive.tension = tension,
            None => self.follow(clock),
        }
    }

    /// Fills the drive with what the scene asks for at this time: tension, plucks and hands.
    #[inline(never)]
    fn follow(&mut self, clock: Clock) {
        let (now, next) = (clock.at(0), clock.at(1));
        self.drive.tension = self.tension.at(now);
        let step = self.model.grid.time_step;
        for ScenePluck { spec, reading, force, .. } in &mut self.plucks {
            *force = spec.force * pluck_push(now - spec.start, step, spec.duration, spec.release);
            if *force != 0.0 {
                self.drive.pushes.push(Push { reading: *reading, force: *force });
            }
        }
        for (hand, finger) in self.drive.hands.iter_mut().zip(&self.fingers) {
            hand.position = finger.position.at(next);
            hand.force = finger.force.at(now);
        }
    }

    /// Takes the step.
    #[inline(always)]
    pub(super) fn advance(&mut self) {
        self.convergence = self.state.step(&self.model, &self.drive, &mut self.scratch);
    }

    /// Tension in the last step, N; before the first that at rest.
    pub(super) fn last_tension(&self) -> f64 {
        self.scratch.stiffness().tension
    }

    /// What is heard of it over a bridge that is `lift` m up.
    pub(super) fn output(&self, lift: f64) -> f64 {
        match &self.listening {
            Some(reading) => self.state.velocity_at(&self.model, reading),
            None => self.bridge_force(lift),
        }
    }

    /// The force of the string on a bridge that is `lift` m up, N, upward, at the sample that the last step led from.
    pub fn bridge_force(&self, lift: f64) -> f64 {
        bridge_force(&self.model, &self.scratch, lift)
    }

    /// The most tension that may be asked for, N: what the grid bears, less what a body takes of it.
    pub fn most_tension(&self) -> f64 {
        self.most_tension
    }

    /// What the bridge of a body has put into the string in the last step, W: below 0 where the string has moved the bridge.
    pub fn bridge_power(&self) -> f64 {
        let (before, after) = (&self.scratch.motion, &self.state.motion);
        self.drive.bridge.map_or(0.0, |push| push.power(before, after, self.model.grid.time_step))
    }

    /// Place of each interior point, m from the nut.
    pub fn places(&self) -> impl Iterator<Item = f64> + '_ {
        (1..self.model.grid.intervals).map(|node| self.model.grid.place(node))
    }

    /// The plucks of this string.
    pub fn plucks(&self) -> impl Iterator<Item = PluckReport> + '_ {
        self.plucks.iter().map(|pluck| PluckReport { number: pluck.number, force: pluck.force })
    }

    /// The fingers over this string.
    pub fn fingers(&self) -> impl Iterator<Item = FingerReport> + '_ {
        let contacts = self.model.contacts.len();
        self.fingers.iter().enumerate().map(move |(slot, finger)| {
            let (position, height) = self.state.fingers()[slot]
                .map_or((f64::NAN, f64::NAN), |finger| (finger.position, finger.height));
            let force = self.scratch.forces().find(|(index, _)| *index == contacts + slot);
            FingerReport {
                number: finger.number,
                position,
                height,
                force: force.map_or(0.0, |(_, force)| force),
            }
        })
    }

    /// Sum of the board's forces on the string in the last step, N.
    pub fn board_force(&self) -> f64 {
        let contact = |index: usize| self.model.contacts.get(index).map(|contact| contact.kind);
        let board = |index| matches!(contact(index), Some(ContactKind::Board { .. }));
        // Not `sum`, which makes nothing a negative zero.
        self.scratch.forces().filter(|(index, _)| board(*index)).fold(0.0, |sum, (_, force)| sum + force)
    }

    /// Force of each fret on the string in the last step, N: (fret of the barrier's list, force), for
    /// those in contact.
    pub fn fret_forces(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.scratch.forces().filter_map(|(index, force)| {
            match self.model.contacts.get(index).map(|contact| contact.kind) {
                Some(ContactKind::Fret { index: fret }) => Some((fret, force)),
                _ => None,
            }
        })
    }

    /// Number of frets under the string, those that share a point with a higher one included.
    pub fn fret_count(&self) -> usize {
        self.fret_count
    }

    /// Whether there is a back board under the string.
    pub fn has_board(&self) -> bool {
        self.model.contacts.iter().any(|contact| matches!(contact.kind, ContactKind::Board { .. }))
    }

    /// How far board and frets are pressed in where they are most after the last step, m; 0 where the string
    /// touches nothing.
    pub fn penetration(&self) -> f64 {
        let fixed = self.scratch.forces().filter_map(|(index, _)| {
            let contact = self.model.contacts.get(index)?;
            let penetration = self.state.heights()[index] - self.state.displacement_at(&contact.reading);
            Some(contact.pressed_in(penetration))
        });
        fixed.fold(0.0, f64::max)
    }
}

/// Refuses contacts of a string, over so many frets and under so many fingers, that share so many grid points that what they are to
/// each other fills the memory.
fn too_crowded(number: usize, frets: usize, fingers: usize) -> Error {
    let accepted = format!(
        "contacts that share grid points are too many, in string[{number}] and those before: how each answers each may take {} \
         numbers in all",
        plain(MOST_NUMBERS as f64)
    );
    let (name, count) =
        if frets > 0 { ("number of fretboard.frets", frets) } else { ("number of fingers", fingers) };
    Error::range(name, count, accepted)
}
