//! The modes of a body and their motion, whatever pushes them.

use super::coefficients::Coefficients;
use super::swing::Swing;
use crate::field::{LANES, Row};
use crate::instructions::Instructions;
use crate::kernel::STILL;
use crate::setup::Body as Description;

/// The modes of a body, each a mass of 1 kg on a spring, and the bridge where their motions add up.
#[derive(Debug, Clone)]
pub(crate) struct Modes {
    pub(super) instructions: Instructions,
    pub(super) coefficients: Vec<Coefficients>,
    /// How many there are: the last row need not be full.
    count: usize,
    /// qⁿ and qⁿ − qⁿ⁻¹, m√kg.
    pub(super) place: Vec<Row>,
    pub(super) motion: Vec<Row>,
    /// How far the bridge is up by that, m.
    bridge: f64,
    time_step: f64,
}

impl Modes {
    /// At rest, at a time step, s.
    pub fn new(description: &Description, time_step: f64) -> Modes {
        let coefficients = Coefficients::of(description.modes(), time_step);
        let rows = coefficients.len();
        Modes {
            instructions: Instructions::best(),
            count: coefficients.iter().flat_map(|row| row.own).filter(|own| *own > 0.0).count(),
            coefficients,
            place: vec![Row::default(); rows],
            motion: vec![Row::default(); rows],
            bridge: 0.0,
            time_step,
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// How far the bridge is up, m.
    #[inline]
    pub fn lift(&self) -> f64 {
        self.bridge
    }

    /// Advances all of them under a force on the bridge, N. Returns the sound pressure, Pa.
    #[inline]
    pub fn swing(&mut self, force: f64) -> f64 {
        let Modes { coefficients, place, motion, .. } = self;
        let [bridge, pressure] = self.instructions.run(Swing { force, coefficients, place, motion });
        if force.abs() < STILL {
            // Nothing drives them, and what fades would become subnormal numbers.
            for number in self.place.iter_mut().chain(&mut self.motion).flatten() {
                *number = if number.abs() < STILL { 0.0 } else { *number };
            }
        }
        self.bridge = bridge;
        pressure
    }

    /// Begins to move at this sample, from rest, under a force on the bridge, N: d⁺ = kept·d + e, and d⁺ + d = 0, as of a string
    /// that is let go of.
    pub fn let_go(&mut self, force: f64) {
        for (row, motion) in self.coefficients.iter().zip(&mut self.motion) {
            *motion = std::array::from_fn(|lane| -row.force[lane] * force / (1.0 + row.kept[lane]));
        }
    }

    /// Energy of their motion half a step ago, J.
    pub fn energy(&self) -> f64 {
        let rate = 1.0 / self.time_step;
        let mut sum = 0.0;
        for (row, (place, motion)) in self.coefficients.iter().zip(self.place.iter().zip(&self.motion)) {
            for lane in 0..LANES {
                let speed = motion[lane] * rate;
                sum += speed * speed + row.own[lane] * place[lane] * (place[lane] - motion[lane]);
            }
        }
        0.5 * sum
    }

    /// Takes over how others move, mode by mode. Whether it did: not from more or fewer.
    pub fn take_over(&mut self, old: &Modes) -> bool {
        if old.count != self.count {
            return false;
        }
        let slower = self.time_step / old.time_step;
        self.place.copy_from_slice(&old.place);
        for (motion, old) in self.motion.iter_mut().zip(&old.motion) {
            *motion = old.map(|motion| motion * slower);
        }
        self.find_bridge();
        true
    }

    /// How far the bridge gives way to 1 N that stays, m.
    pub fn gives(&self) -> f64 {
        Coefficients::sum(&self.coefficients, |own| 1.0 / own)
    }

    /// Rests under a force that stays, N.
    pub fn rest_under(&mut self, force: f64) {
        for (row, place) in self.coefficients.iter().zip(&mut self.place) {
            let at = |lane: usize| {
                if row.own[lane] > 0.0 { row.bridge[lane] * force / row.own[lane] } else { 0.0 }
            };
            *place = std::array::from_fn(at);
        }
        self.motion.fill(Row::default());
        self.find_bridge();
    }

    fn find_bridge(&mut self) {
        self.bridge = self.sum(|phi, place, _| phi * place);
    }

    /// The sum over all of something of φ, qⁿ and qⁿ − qⁿ⁻¹.
    fn sum(&self, of: impl Fn(f64, f64, f64) -> f64) -> f64 {
        let rows = self.coefficients.iter().zip(self.place.iter().zip(&self.motion));
        let lanes = rows.flat_map(|(row, (place, motion))| {
            (0..LANES).map(|lane| of(row.bridge[lane], place[lane], motion[lane]))
        });
        lanes.sum()
    }

    /// At rest.
    pub fn be_still(&mut self) {
        self.place.fill(Row::default());
        self.motion.fill(Row::default());
        self.bridge = 0.0;
    }
}

/// What a ledger asks for.
impl Modes {
    /// How many last places the sum at the bridge may be off by, of what it would be if nothing cancelled.
    pub fn sums(&self) -> f64 {
        (self.coefficients.len() + LANES.ilog2() as usize) as f64
    }

    /// The motion to where they are, m√kg.
    pub fn motion(&self) -> &[Row] {
        &self.motion
    }

    /// How far the bridge was up a sample before, m.
    pub fn lift_before(&self) -> f64 {
        self.bridge - self.sum(|phi, _, motion| phi * motion)
    }

    /// What they have lost in the last step, J, where this was the motion before it.
    pub fn lost(&self, before: &[Row]) -> f64 {
        let rate = 1.0 / self.time_step;
        let mut sum = 0.0;
        for (row, (before, after)) in self.coefficients.iter().zip(before.iter().zip(&self.motion)) {
            for lane in 0..LANES {
                // (1 − kept is exact: however little is lost, it is what the step takes.)
                let lossy = (1.0 - row.kept[lane]) / (1.0 + row.kept[lane]);
                let speed = (after[lane] + before[lane]) * rate;
                sum += lossy * speed * speed;
            }
        }
        0.5 * sum
    }

    /// The same with energies of which nothing cancels, J, and how far the bridge would be up if nothing did, m: a unit in the last
    /// place of these is what rounding may do.
    pub fn gross(&self, before: &[Row]) -> [f64; 2] {
        let rate = 1.0 / self.time_step;
        let (mut energy, mut lift) = (0.0, 0.0);
        let states = before.iter().zip(self.place.iter().zip(&self.motion));
        for (row, (before, (place, motion))) in self.coefficients.iter().zip(states) {
            for lane in 0..LANES {
                let speed = (motion[lane].abs() + before[lane].abs()) * rate;
                let far = place[lane].abs() + motion[lane].abs() + before[lane].abs();
                energy += 0.5 * (speed * speed + row.own[lane] * far * far);
                lift += row.bridge[lane].abs() * far;
            }
        }
        [energy, lift]
    }
}
