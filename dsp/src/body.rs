//! The body under one string's bridge: it gives way to the string, loses what the air and the wood take, and sounds.
//!
//! Each mode is a mass of 1 kg on a spring. The bridge is where their motions q add up, w = Σφq. The string's end goes with it: seen
//! from the straight line between its ends the string moves as one with fixed ends, so that the same passes do for it, and what
//! the line adds is a push on the few points next to the bridge and the same number the other way on the body (docs/physics.md).
//! Every string has a body of its own: strings do not hear each other.

use crate::digits::{at_least, plain};
use crate::drive::Push;
use crate::error::Error;
use crate::grid::Reading;
use crate::kernel::STILL;
use crate::model::{Model, Stiffness};
use crate::setup::Body as Description;
use crate::state::State;

/// Modes side by side.
const LANES: usize = 4;
type Row = [f64; LANES];

/// Coefficients of modes side by side; where there is none they are 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Coefficients {
    /// What is left of the motion, (1 − ε)/(1 + ε) with ε = ωk/2Q.
    kept: Row,
    /// What the spring adds to it, 4 sin²(ωk/2)/(1 + ε): of all that is true of discrete time the frequency is exact.
    spring: Row,
    /// What 1 N on the bridge adds to it, k²φ/(1 + ε).
    force: Row,
    /// φ, 1/√kg.
    bridge: Row,
    /// Sound pressure for a change of the motion, Pa/(m√kg).
    pressure: Row,
}

impl Coefficients {
    /// (4/k²) sin²(ωk/2) of a mode, 1/s²: what the spring of 1 kg has; 0 where there is no mode.
    fn own(&self, lane: usize) -> f64 {
        let phi = self.bridge[lane];
        // (k²φ/(1 + ε) over φ is k²/(1 + ε).)
        if phi == 0.0 { 0.0 } else { self.spring[lane] * phi / self.force[lane] }
    }
}

/// A body as it moves.
#[derive(Debug, Clone)]
pub(crate) struct Body {
    coefficients: Vec<Coefficients>,
    /// qⁿ and qⁿ − qⁿ⁻¹, m√kg.
    place: Vec<Row>,
    motion: Vec<Row>,
    /// How far the bridge is up, m.
    bridge: f64,
    pressure: f64,
    end: End,
    time_step: f64,
    rate: f64,
}

/// How the string pulls at the bridge while its tension is `tension`.
#[derive(Debug, Clone, Copy)]
struct End {
    tension: f64,
    /// Reads the string where the bridge's motion is felt.
    reading: Reading,
    /// Newtons on the bridge for 1 m there.
    pull: f64,
    /// Newtons on the bridge for 1 m of its own, downwards: while the string is held, and while it goes along in a straight line.
    back: f64,
    line: f64,
}

/// How much of what the grid has room for a body may take, as a part of it.
pub(crate) const ROOM: f64 = 0.02;

impl End {
    fn new(model: &Model, tension: f64) -> Self {
        let (grid, h) = (&model.grid, model.grid.spacing);
        let Stiffness { kappa_squared, kappa_6, .. } = model.stiffness(tension);
        let [bending, sixth] = [kappa_squared, kappa_6].map(|kappa| model.string.linear_density * kappa);
        // The operator's weights of neighbours one, two and three points away, N/m.
        let first = tension / h + 4.0 * bending / (h * h * h) + 15.0 * sixth / h.powi(5);
        let second = -bending / (h * h * h) - 6.0 * sixth / h.powi(5);
        let third = sixth / h.powi(5);
        // The straight line from the nut to the bridge, 1 m up, goes on beyond it, where a string with fixed ends turns oddly: 1 m at
        // the bridge and 2 m farther out.
        let near = [third, second + 2.0 * third, first + 2.0 * second + 2.0 * third];
        let pull = near[2];
        let reading = Reading::before_bridge(grid, near.map(|force| force / pull));
        let line = [3.0, 2.0, 1.0].map(|away| 1.0 - away / grid.intervals as f64);
        let bent: f64 = near.iter().zip(line).map(|(force, line)| force * line).sum();
        End { tension, reading, pull, back: bent + tension / grid.length, line: tension / grid.length }
    }
}

impl Body {
    /// The body under a string.
    ///
    /// # Errors
    /// When it is so light beside this string that the grid has no room for what both are together.
    pub fn new(description: &Description, model: &Model) -> Result<Body, Error> {
        let k = model.grid.time_step;
        let mut coefficients = Vec::new();
        let all: Vec<_> = description.modes().into_iter().filter(|mode| mode.frequency * k < 0.4).collect();
        for modes in all.chunks(LANES) {
            let mut row = Coefficients::default();
            for (lane, mode) in modes.iter().enumerate() {
                let half = std::f64::consts::PI * mode.frequency * k;
                let lost = 1.0 / (1.0 + half / mode.quality);
                let sine = libm::sin(half);
                row.kept[lane] = (1.0 - half / mode.quality) * lost;
                row.spring[lane] = 4.0 * sine * sine * lost;
                row.force[lane] = k * k * mode.bridge * lost;
                row.bridge[lane] = mode.bridge;
                row.pressure[lane] = mode.pressure / (k * k);
            }
            coefficients.push(row);
        }
        let body = Body {
            place: vec![Row::default(); coefficients.len()],
            motion: vec![Row::default(); coefficients.len()],
            coefficients,
            bridge: 0.0,
            pressure: 0.0,
            end: End::new(model, model.string.tension),
            time_step: k,
            rate: 1.0 / k,
        };
        body.check_room(description.mass, model)?;
        Ok(body)
    }

    /// Refuses one that is too light.
    fn check_room(&self, mass: f64, model: &Model) -> Result<(), Error> {
        let taken = self.room_taken(model);
        if taken <= 1.0 {
            return Ok(());
        }
        let accepted = format!("it must be at least {} kg", plain(at_least(mass * taken)));
        Err(Error::range("body.mass", plain(mass), accepted))
    }

    /// How much it takes of half of the [`ROOM`] that the grid leaves (the other half is for what tension has no part in).
    ///
    /// The largest eigenvalue of a string on its grid is Λ = 4/k² at most, those of the body are lower; what couples each mode to the
    /// string, b = φ·pull·|weights|/√(ρh), moves the largest up by no more than Σ b²/(Λ − ω²).
    fn room_taken(&self, model: &Model) -> f64 {
        let most = End::new(model, model.string.tension_limit);
        let weights = most.reading.weights.iter().map(|weight| weight * weight).sum::<f64>();
        let k2 = self.time_step * self.time_step;
        let string = 4.0 / k2;
        let of_modes = self.coefficients.iter().flat_map(|row| (0..LANES).map(move |lane| (row, lane)));
        let moved = of_modes.map(|(row, lane)| {
            let phi = row.bridge[lane];
            phi * phi / (string - row.own(lane))
        });
        let coupling = most.pull * most.pull * weights / (model.string.linear_density * model.grid.spacing);
        coupling * moved.sum::<f64>() / (0.5 * ROOM * string)
    }

    /// What the bridge does to the string in the step to come, and the body's own step by what the string does to it. To be asked
    /// before the string moves.
    #[inline]
    pub fn step(&mut self, model: &Model, state: &State, tension: f64) -> Push {
        if tension != self.end.tension {
            self.end = End::new(model, tension);
        }
        let End { reading, pull, back, .. } = self.end;
        let push = Push { reading, force: pull * self.bridge };
        self.swing(pull * reading.of(&state.displacement) - back * self.bridge);
        push
    }

    /// Goes on by itself, under a string at rest; the sound pressure, Pa.
    pub fn ring(&mut self) -> f64 {
        self.swing(-self.end.line * self.bridge);
        self.pressure
    }

    /// The sound pressure of the last step, Pa.
    pub fn pressure(&self) -> f64 {
        self.pressure
    }

    /// Advances all modes under a force on the bridge, N.
    #[inline]
    fn swing(&mut self, force: f64) {
        let (mut bridge, mut pressure) = (Row::default(), Row::default());
        let rows = self.coefficients.iter().zip(self.place.iter_mut().zip(&mut self.motion));
        for (row, (place, motion)) in rows {
            for lane in 0..LANES {
                let old = motion[lane];
                let new = row.kept[lane] * old + (row.force[lane] * force - row.spring[lane] * place[lane]);
                let new = if new.abs() < STILL { 0.0 } else { new };
                let now = place[lane] + new;
                let now = if now.abs() < STILL { 0.0 } else { now };
                (place[lane], motion[lane]) = (now, new);
                bridge[lane] += row.bridge[lane] * now;
                pressure[lane] += row.pressure[lane] * (new - old);
            }
        }
        let sum = |row: Row| (row[0] + row[1]) + (row[2] + row[3]);
        (self.bridge, self.pressure) = (sum(bridge), sum(pressure));
    }

    /// Energy of its motion half a step ago and of what moves with the bridge, J. Beside the string's own, what both have together
    /// less what pushes have put into the string is lost to air and wood and never grows.
    pub fn energy(&self) -> f64 {
        let mut sum = 0.0;
        for (row, (place, motion)) in self.coefficients.iter().zip(self.place.iter().zip(&self.motion)) {
            for lane in 0..LANES {
                sum += motion[lane] * motion[lane] * self.rate * self.rate
                    + row.own(lane) * place[lane] * (place[lane] - motion[lane]);
            }
        }
        0.5 * sum
    }

    /// Whether nothing is left to be heard of it, and of what is not it is rid then.
    pub fn is_still(&mut self) -> bool {
        let still = self.energy() < STILLNESS;
        if still {
            self.reset();
        }
        still
    }

    /// Takes over how another body moves, mode by mode; one that has other modes, or none, begins where the string holds it.
    pub fn take_over(&mut self, old: Option<&Body>, model: &Model, state: &State, tension: f64) {
        self.end = End::new(model, tension);
        match old.filter(|old| old.place.len() == self.place.len()) {
            Some(old) => {
                let slower = self.time_step / old.time_step;
                self.place.copy_from_slice(&old.place);
                for (motion, old) in self.motion.iter_mut().zip(&old.motion) {
                    *motion = old.map(|motion| motion * slower);
                }
            }
            None => {
                let force = self.end.pull * self.end.reading.of(&state.displacement);
                for (row, place) in self.coefficients.iter().zip(&mut self.place) {
                    *place = std::array::from_fn(|lane| {
                        let spring = row.spring[lane];
                        if spring == 0.0 { 0.0 } else { row.force[lane] * force / spring }
                    });
                }
                self.motion.fill(Row::default());
            }
        }
        let rows = self.coefficients.iter().zip(&self.place);
        self.bridge =
            rows.map(|(row, place)| (0..LANES).map(|lane| row.bridge[lane] * place[lane]).sum::<f64>()).sum();
        self.pressure = 0.0;
    }

    /// At rest.
    pub fn reset(&mut self) {
        self.place.fill(Row::default());
        self.motion.fill(Row::default());
        (self.bridge, self.pressure) = (0.0, 0.0);
    }
}

/// Below this energy nothing is heard of a body, J: a soft pluck has 1e-6 J, of which a part reaches it.
const STILLNESS: f64 = 1e-25;

#[cfg(test)]
mod tests;
