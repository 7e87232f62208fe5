//! The rival: the same string, board, frets and finger with contacts that need no iteration.
//!
//! The energy Φ of each contact is carried as a square, ½ψ² = Φ, by a number ψ of its own: with
//! g = φ/√(2Φ) at n, ψ⁺ = ψ + g r/2 and f = g(ψ⁺ + ψ)/2 = gψ + (g²/4)r, where r = ηⁿ⁺¹ − ηⁿ⁻¹. The force is
//! linear in the motion, and what is stored is conserved whatever g is (Ducceschi, Bilbao, Willemsen and Serafin,
//! "Linearly-implicit schemes for collisions in musical acoustics based on energy quadratisation", JASA 149,
//! 2021, from whom the choice of g out of contact comes too). What it does not do is to hold ½ψ² at Φ(η). For
//! comparison only: the instruments are computed by Newton's method.

mod contacts;
#[cfg(test)]
mod tests;

use anyhow::{Context, Result, ensure};
use low_action_dsp::contact::ContactLaw;
use low_action_dsp::curve::Curve;
use low_action_dsp::gesture::pluck_push;
use low_action_dsp::grid::Reading;
use low_action_dsp::model::{ContactKind, Stiffness};
use low_action_dsp::pickup::end_shape;
use low_action_dsp::scene::PluckSpec;
use low_action_dsp::{Barrier, Model, Scene, StringParameters};

use contacts::Row;

/// One string of a scene.
pub struct Rival {
    model: Model,
    stiffness: Stiffness,
    samples: u64,
    step: u64,
    /// uⁿ, and uⁿ − uⁿ⁻¹, at the nodes in order, m.
    displacement: Vec<f64>,
    motion: Vec<f64>,
    /// h²D_xx and h⁴D_xxxx of uⁿ, and the motion to come.
    second: Vec<f64>,
    fourth: Vec<f64>,
    next: Vec<f64>,
    plucks: Vec<(PluckSpec, Reading)>,
    finger: Option<Finger>,
    /// ψ of each fixed contact, √J.
    psi: Vec<f64>,
    /// The first step in which each is calm after it has been made.
    calm: Vec<u64>,
    /// Fixed contacts near enough to be looked at, and steps until all are looked at again.
    near: Vec<usize>,
    patience: u32,
    rows: Vec<Row>,
    matrix: Vec<f64>,
    heard: f64,
}

/// The finger of a scene.
struct Finger {
    law: ContactLaw,
    damping: f64,
    mass: f64,
    hand_damping: f64,
    position: Curve,
    force: Curve,
    reading: Reading,
    height: f64,
    motion: f64,
    psi: f64,
}

impl Rival {
    /// The only string of a scene.
    pub fn new(scene: &Scene) -> Result<Rival> {
        ensure!(
            scene.string.len() == 1 && scene.finger.len() <= 1,
            "the rival plays one string under one finger"
        );
        let spec = &scene.string[0];
        let barrier =
            scene.fretboard.as_ref().map(|board| Barrier::from_spec(board, spec.length)).transpose()?;
        let string = StringParameters::from_spec(spec);
        let model = Model::new(string, barrier.as_ref(), 1, scene.solver, scene.sample_rate)?;
        let finger = scene.finger.first().map(|finger| {
            Ok::<_, low_action_dsp::Error>(Finger {
                law: model.finger_law(&finger.touch())?,
                damping: finger.damping,
                mass: finger.mass,
                hand_damping: finger.hand_damping,
                position: finger.position.clone(),
                force: finger.force.clone(),
                reading: model.grid.reading(finger.position.at(0.0)),
                height: finger.height,
                motion: finger.velocity * model.grid.time_step,
                psi: 0.0,
            })
        });
        let finger = finger.transpose().context("the finger")?;
        let room = || vec![0.0; model.grid.intervals + 1];
        Ok(Rival {
            stiffness: model.stiffness(model.string.tension),
            samples: scene.samples(),
            step: 0,
            displacement: room(),
            motion: room(),
            second: room(),
            fourth: room(),
            next: room(),
            plucks: scene.pluck.iter().map(|p| (p.clone(), model.grid.reading(p.position))).collect(),
            finger,
            psi: vec![0.0; model.contacts.len()],
            calm: vec![0; model.contacts.len()],
            near: Vec::new(),
            patience: 0,
            rows: Vec::new(),
            matrix: Vec::new(),
            heard: 0.0,
            model,
        })
    }

    /// Steps that the scene lasts.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Contacts that acted in the last step.
    pub fn active(&self) -> u32 {
        self.rows.len() as u32
    }

    /// Force on the bridge at the sample from which the last step led, N.
    pub fn output(&self) -> f64 {
        self.heard
    }

    /// Sum of the board's forces in the last step, N.
    pub fn board_force(&self) -> f64 {
        self.forces()
            .filter(|(kind, _)| matches!(kind, ContactKind::Board { .. }))
            .map(|(_, force)| force)
            .sum()
    }

    /// Forces of the frets in the last step, N.
    pub fn fret_forces(&self) -> Vec<(usize, f64)> {
        let fret = |(kind, force)| match kind {
            ContactKind::Fret { index } => Some((index, force)),
            ContactKind::Board { .. } => None,
        };
        self.forces().filter_map(fret).collect()
    }

    fn forces(&self) -> impl Iterator<Item = (ContactKind, f64)> + '_ {
        self.rows.iter().filter_map(|row| Some((self.model.contacts[row.fixed?].kind, row.force)))
    }

    /// How deep the string is in board and frets after the last step, m.
    pub fn penetration(&self) -> f64 {
        let fixed = self.rows.iter().filter_map(|row| row.fixed).map(|index| {
            let contact = &self.model.contacts[index];
            contact.pressed_in(contact.height - read(&contact.reading, &self.displacement))
        });
        fixed.fold(0.0, f64::max)
    }

    /// From sample n to n + 1.
    pub fn step(&mut self) {
        let k = self.model.grid.time_step;
        let time = self.step as f64 * k;
        self.step += 1;
        let pull = self.free_string(time);
        self.collect(time, time + k);
        let answer = self.solve(&pull);
        self.apply(&pull, answer);
    }

    /// The motion without contacts into `next`; gives what stretching answers to forces.
    fn free_string(&mut self, time: f64) -> Pull {
        let Self { model, stiffness, displacement: u, motion: d, second, fourth, next, .. } = self;
        let (string, k, h) = (&model.string, model.grid.time_step, model.grid.spacing);
        let (h2, last) = (h * h, model.grid.intervals);
        let inner = 1..last;
        for i in inner.clone() {
            second[i] = (u[i + 1] - u[i]) - (u[i] - u[i - 1]);
        }
        for i in inner.clone() {
            fourth[i] = (second[i + 1] - second[i]) - (second[i] - second[i - 1]);
        }
        let k2 = k * k;
        let (c2, shear) = (k2 * stiffness.tension / string.linear_density / h2, 2.0 * string.loss_1 * k / h2);
        let (bend, sixth) =
            (k2 * stiffness.kappa_squared / (h2 * h2), k2 * stiffness.kappa_6 / (h2 * h2 * h2));
        let keep = 1.0 - string.loss_0 * k;
        let strength = if string.tension_modulation {
            0.5 * k * (string.axial_stiffness() * h / (string.linear_density * string.length)).sqrt() / h2
        } else {
            0.0
        };
        let (mut with_motion, mut with_place, mut square) = (0.0, 0.0, 0.0);
        for i in inner.clone() {
            let six = (fourth[i + 1] - fourth[i]) - (fourth[i] - fourth[i - 1]);
            let turn = (d[i + 1] - d[i]) - (d[i] - d[i - 1]);
            next[i] = keep * d[i] + (c2 * second[i] - bend * fourth[i]) + (sixth * six + shear * turn);
            with_place += second[i] * (2.0 * u[i] - d[i]);
            square += second[i] * second[i];
        }
        for (pluck, reading) in &self.plucks {
            let force = pluck.force * pluck_push(time - pluck.start, k, pluck.duration, pluck.release);
            if force != 0.0 {
                spread(reading, next, k2 / (string.linear_density * h) * force);
            }
        }
        let s = 1.0 + string.loss_0 * k;
        for i in inner {
            next[i] -= strength * strength * with_place * second[i];
            with_motion += second[i] * next[i];
        }
        // A⁻¹ = (1/s)(1 − a aᵀ/(s + aᵀa)) with a = strength · second.
        let share = strength * strength / (s + strength * strength * square);
        for i in 1..last {
            next[i] = (next[i] - share * with_motion * second[i]) / s;
        }
        Pull { share, mobility: k2 / (string.linear_density * h * s) }
    }

    /// Takes the force on the bridge, where the string is stretched by the mean of (δuⁿ)ᵀδuⁿ⁺¹ and (δuⁿ)ᵀδuⁿ⁻¹.
    fn hear(&mut self) {
        let Self { model, stiffness, displacement: u, motion: d, second, next, .. } = self;
        let (string, h, last) = (&model.string, model.grid.spacing, model.grid.intervals);
        let stretched = if string.tension_modulation {
            let along: f64 = (1..last).map(|i| second[i] * (2.0 * u[i] - d[i] + next[i])).sum();
            -0.5 * along * string.axial_stiffness() / (2.0 * string.length * h)
        } else {
            0.0
        };
        let [slope, bend] = end_shape([1, 2, 3, 4].map(|away| u[last - away]));
        self.heard = (stiffness.tension + stretched) * slope / h
            + string.linear_density * string.kappa_squared() * bend / (h * h * h);
    }

    /// Moves string and finger on.
    fn apply(&mut self, pull: &Pull, felt: f64) {
        let last = self.model.grid.intervals;
        for row in &self.rows {
            spread(&row.reading, &mut self.next, row.sign * pull.mobility * row.force);
            match (row.fixed, &mut self.finger) {
                (Some(index), _) => self.psi[index] = row.psi,
                (None, Some(finger)) => {
                    finger.psi = row.psi;
                    finger.height += row.own * row.force;
                    finger.motion += row.own * row.force;
                }
                (None, None) => {}
            }
        }
        for i in 1..last {
            self.next[i] -= pull.mobility * pull.share * felt * self.second[i];
        }
        self.hear();
        for i in 1..last {
            self.motion[i] = self.next[i];
            self.displacement[i] += self.next[i];
        }
    }
}

/// What is read of values at the nodes in order.
fn read(reading: &Reading, values: &[f64]) -> f64 {
    values[reading.first..].iter().zip(reading.weights).map(|(value, weight)| value * weight).sum()
}

/// Adds `amount` times the weights to them.
fn spread(reading: &Reading, values: &mut [f64], amount: f64) {
    values[reading.first..]
        .iter_mut()
        .zip(reading.weights)
        .for_each(|(value, weight)| *value += weight * amount);
}

/// How the string answers forces: m/N at a grid point, and what stretching takes off.
struct Pull {
    share: f64,
    mobility: f64,
}
