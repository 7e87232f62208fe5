//! A slow, plain second implementation of the fretted string, to check the fast one against.
//!
//! It shares no code with the physics package and is written the other way round wherever there is a
//! choice: positions at three instants instead of position and change, full matrices multiplied and
//! factorised afresh each sample instead of stencils, every contact of the scene in one dense system
//! instead of an active set. One sample solves
//!
//! ```text
//! A u⁺ = B u + C u⁻ + (k²/ρ) (Σ g_e f_e + G f)      f = max(0, λ(r) + P r)      r = η⁺ − η⁻
//! A = (1 + σ₀k) 1 + a aᵀ          a = (k/2) √(EAh/ρL) D_xx u
//! B = 2 + k² S + 2σ₁k D_xx        S = (T/ρ) D_xx − κ₂² D_xx² + κ₆ D_xx³
//! C = (σ₀k − 1) 1 − a aᵀ − 2σ₁k D_xx
//! ```
//!
//! with u⁻, u, u⁺ the heights of the interior points at (n−1)k, nk, (n+1)k. S is the string's own
//! stiffness; κ₂² and κ₆ depend on the stencil. A column g of G spreads a force over the points, and h gᵀu
//! reads the height there. Bilbao and Torin, "Numerical simulation of string/barrier collisions: the
//! fretboard", DAFx-14, equations 16 to 21.

mod contact;
mod setup;

pub use contact::Law;
pub use setup::{Finger, Fret, Fretboard, Pluck, Setup, Stencil, Table, weights};

use contact::Contact;
use nalgebra::{DMatrix, DVector};
use setup::at;
use std::f64::consts::PI;

/// A point of board or fret.
#[derive(Clone, Debug)]
pub struct Barrier {
    /// Spreading column g, 1/m.
    pub column: DVector<f64>,
    /// Height b, m.
    pub height: f64,
    /// Contact law.
    pub law: Law,
}

/// The simulation itself: three instants, moved on one sample at a time.
#[derive(Clone, Debug)]
pub struct Reference {
    setup: Setup,
    intervals: usize,
    /// Grid spacing h, m.
    pub spacing: f64,
    /// Time step k, s.
    pub time_step: f64,
    /// Board and fret points.
    pub barriers: Vec<Barrier>,
    /// D_xx and its second and third power, 1/m², 1/m⁴, 1/m⁶.
    differences: [DMatrix<f64>; 3],
    /// Samples taken so far, n.
    pub sample: usize,
    /// uⁿ, m.
    pub now: DVector<f64>,
    /// uⁿ⁻¹, m.
    pub before: DVector<f64>,
    /// Heights of the fingers at n, m.
    pub finger_now: DVector<f64>,
    /// Heights of the fingers at n − 1, m.
    pub finger_before: DVector<f64>,
    /// Contact forces of the last sample, barriers first, then fingers, N.
    pub forces: DVector<f64>,
    /// Power dissipated minus power supplied in the last sample, W.
    pub net_loss: f64,
}

impl Reference {
    /// At rest in the shape and heights the scene gives.
    pub fn new(setup: &Setup) -> Self {
        let intervals = setup.intervals();
        assert!(intervals >= 3, "the reference needs 3 intervals or more, the scene gives {intervals}");
        let points = intervals - 1;
        let spacing = setup.length / intervals as f64;
        let time_step = 1.0 / setup.sample_rate;
        // D_x: one row per interval, the difference between its right and its left node.
        let first = DMatrix::from_fn(intervals, points, |row, point| {
            (f64::from(row == point) - f64::from(row == point + 1)) / spacing
        });
        let start = DVector::from_fn(points, |i, _| at(&setup.shape, (i + 1) as f64 * spacing));
        let heights = DVector::from_iterator(setup.fingers.len(), setup.fingers.iter().map(|f| f.height));
        let travel = setup.fingers.iter().map(|f| f.velocity * time_step);
        let finger_before = &heights - DVector::from_iterator(heights.len(), travel);
        let barriers = barriers(setup, spacing, intervals);
        let second = -first.transpose() * &first;
        let fourth = &second * &second;
        let sixth = &fourth * &second;
        Self {
            setup: setup.clone(),
            intervals,
            spacing,
            time_step,
            differences: [second, fourth, sixth],
            sample: 0,
            now: start.clone(),
            before: start,
            finger_now: heights,
            finger_before,
            forces: DVector::zeros(barriers.len() + setup.fingers.len()),
            barriers,
            net_loss: 0.0,
        }
    }

    /// S at time t, 1/s².
    fn stiffness(&self, time: f64) -> DMatrix<f64> {
        let [second, fourth, sixth] = &self.differences;
        let tension = at(&self.setup.tension, time);
        let (kappa2, kappa6) = self.setup.stencil_stiffness(self.spacing, tension);
        second * (tension / self.setup.linear_density) - fourth * kappa2 + sixth * kappa6
    }

    /// G at time t: barriers push up, fingers push down.
    fn columns(&self, time: f64) -> DMatrix<f64> {
        let fingers =
            self.setup.fingers.iter().map(|finger| {
                -weights(at(&finger.position, time), self.spacing, self.intervals) / self.spacing
            });
        let all: Vec<_> = self.barriers.iter().map(|b| b.column.clone()).chain(fingers).collect();
        if all.is_empty() { DMatrix::zeros(self.intervals - 1, 0) } else { DMatrix::from_columns(&all) }
    }

    /// η: how deep each contact overlaps, given G, the string and the fingers.
    fn penetrations(&self, g: &DMatrix<f64>, u: &DVector<f64>, fingers: &DVector<f64>) -> DVector<f64> {
        let solid = self.barriers.iter().map(|b| b.height).chain(fingers.iter().map(|height| -height));
        DVector::from_iterator(self.forces.len(), solid) - g.transpose() * u * self.spacing
    }

    /// EA/(ρL) where stretching raises the tension, else 0.
    fn stretch_stiffness(&self) -> f64 {
        let area = PI * self.setup.core_radius * self.setup.core_radius;
        let strength = self.setup.youngs_modulus * area / (self.setup.linear_density * self.setup.length);
        if self.setup.tension_modulation { strength } else { 0.0 }
    }

    /// Law of contact i, barriers first.
    fn law(&self, i: usize) -> Law {
        self.barriers.get(i).map_or_else(
            || {
                let finger = &self.setup.fingers[i - self.barriers.len()];
                Law { stiffness: finger.stiffness, exponent: finger.exponent }
            },
            |barrier| barrier.law,
        )
    }

    /// One sample.
    pub fn step(&mut self) {
        let (h, k) = (self.spacing, self.time_step);
        let setup = &self.setup;
        let time = self.sample as f64 * k;
        let (u, u_before) = (&self.now, &self.before);
        let fingers = setup.fingers.len();
        let d2 = &self.differences[0];

        let a = d2 * u * (k / 2.0 * (self.stretch_stiffness() * h).sqrt());
        let one = DMatrix::<f64>::identity(u.len(), u.len());
        let stretch = &a * a.transpose();
        let matrix_a = (&one * (1.0 + setup.loss_0 * k) + &stretch).lu();
        let matrix_b = &one * 2.0 + self.stiffness(time) * (k * k) + d2 * (2.0 * setup.loss_1 * k);
        let matrix_c = &one * (setup.loss_0 * k - 1.0) - &stretch - d2 * (2.0 * setup.loss_1 * k);
        let invert = |right: &DMatrix<f64>| matrix_a.solve(right).expect("A has eigenvalues above 1");

        // Without contacts: the string, then the fingers.
        let mobility = k * k / setup.linear_density;
        let mut plucks = DVector::zeros(u.len());
        for pluck in &setup.plucks {
            let phase = (time - pluck.start) / pluck.duration;
            if (0.0..=1.0).contains(&phase) {
                let force = pluck.force / 2.0 * (1.0 - (PI * phase).cos());
                plucks += weights(pluck.position, h, self.intervals) * (force / h);
            }
        }
        let right = matrix_b * u + matrix_c * u_before + &plucks * mobility;
        let free = matrix_a.solve(&right).expect("A has eigenvalues above 1");
        let hand = |i: usize| setup.fingers[i].hand_damping * k / 2.0;
        let finger_mobility = |i: usize| k * k / (setup.fingers[i].mass + hand(i));
        let finger_free = DVector::from_fn(fingers, |i, _| {
            let mass = setup.fingers[i].mass;
            let push = at(&setup.fingers[i].force, time);
            (2.0 * mass * self.finger_now[i] - (mass - hand(i)) * self.finger_before[i] - k * k * push)
                / (mass + hand(i))
        });

        // The contacts: a moving finger acts where it will be, and its way so far began where it was.
        let (g_before, g, g_after) =
            (self.columns((time - k).max(0.0)), self.columns(time), self.columns(time + k));
        let eta_before = self.penetrations(&g_before, u_before, &self.finger_before);
        let eta = self.penetrations(&g, u, &self.finger_now);
        let eta_free = self.penetrations(&g_after, &free, &finger_free);
        let spread = invert(&(&g_after * mobility));
        let mut m = g_after.transpose() * &spread * h;
        let contacts: Vec<Contact> = (0..eta.len())
            .map(|i| {
                let law = self.law(i);
                let damping = i.checked_sub(self.barriers.len()).map_or(0.0, |finger| {
                    m[(i, i)] += finger_mobility(finger);
                    setup.fingers[finger].damping * law.force(eta[i]) / (2.0 * k)
                });
                Contact { law, before: eta_before[i], damping }
            })
            .collect();
        let forces = if contacts.is_empty() {
            DVector::zeros(0)
        } else {
            contact::solve(&contacts, &(&eta_before - &eta_free), &m)
        };

        let next = &free + &spread * &forces;
        let finger_next = DVector::from_fn(fingers, |i, _| {
            finger_free[i] + finger_mobility(i) * forces[self.barriers.len() + i]
        });
        let eta_after = self.penetrations(&g_after, &next, &finger_next);

        // Dissipated and supplied power, with centred velocities.
        let velocity = (&next - u_before) / (2.0 * k);
        let finger_velocity = (&finger_next - &self.finger_before) / (2.0 * k);
        let rho = setup.linear_density;
        let mut net = 2.0 * rho * h * setup.loss_0 * velocity.norm_squared()
            - 2.0 * rho * h * setup.loss_1 * velocity.dot(&(d2 * &velocity))
            - h * plucks.dot(&velocity)
            // Work done by whoever turns the peg.
            + rho * h / (2.0 * k) * u.dot(&((self.stiffness(time) - self.stiffness((time - k).max(0.0))) * u_before));
        for (i, contact) in contacts.iter().enumerate() {
            let r = eta_after[i] - eta_before[i];
            net += (forces[i] - contact.law.quotient(contact.before, r)) * r / (2.0 * k);
        }
        // Work done by whoever moves a finger along the string.
        let slide = (&g_after - &g_before) / (2.0 * k);
        net += h * forces.dot(&(slide.transpose() * u_before));
        for i in 0..fingers {
            let force = at(&setup.fingers[i].force, time);
            net += setup.fingers[i].hand_damping * finger_velocity[i].powi(2) + force * finger_velocity[i];
        }

        self.net_loss = net;
        self.forces = forces;
        self.before = std::mem::replace(&mut self.now, next);
        self.finger_before = std::mem::replace(&mut self.finger_now, finger_next);
        self.sample += 1;
    }

    /// Energy stored between the last two instants, J.
    pub fn energy(&self) -> f64 {
        let (h, k, rho) = (self.spacing, self.time_step, self.setup.linear_density);
        let (u, u_before) = (&self.now, &self.before);
        let time = (self.sample as f64 - 1.0).max(0.0) * k;
        let velocity = (u - u_before) / k;
        // (D_x u)ᵀ D_x v = −uᵀ D_xx v.
        let d2 = &self.differences[0];
        let stretch = -u.dot(&(d2 * u_before)) * h;
        let mut energy = rho * h / 2.0 * velocity.norm_squared()
            - rho * h / 2.0 * u.dot(&(self.stiffness(time) * u_before))
            + rho * self.setup.loss_1 * h * k / 2.0 * velocity.dot(&(d2 * &velocity))
            + rho * self.stretch_stiffness() / 8.0 * stretch * stretch;
        let eta = self.penetrations(&self.columns(self.sample as f64 * k), u, &self.finger_now);
        let eta_before = self.penetrations(&self.columns(time), u_before, &self.finger_before);
        for i in 0..eta.len() {
            energy += (self.law(i).energy(eta[i]) + self.law(i).energy(eta_before[i])) / 2.0;
        }
        for (i, finger) in self.setup.fingers.iter().enumerate() {
            energy += finger.mass / 2.0 * ((self.finger_now[i] - self.finger_before[i]) / k).powi(2);
        }
        energy
    }
}

/// A board point at every interior node and a fret at each place; a fret on a node replaces the board there.
fn barriers(setup: &Setup, spacing: f64, intervals: usize) -> Vec<Barrier> {
    let Some(fretboard) = &setup.fretboard else { return Vec::new() };
    let mut all = Vec::new();
    for node in 1..intervals {
        let position = node as f64 * spacing;
        let fretted = fretboard.frets.iter().any(|f| (f.position - position).abs() < 1e-9 * spacing);
        if let (Some(board), false) = (&fretboard.board, fretted) {
            let share = fretboard.board_reference_spacing.map_or(1.0, |reference| spacing / reference);
            all.push((position, at(board, position), fretboard.stiffness * share));
        }
    }
    all.extend(fretboard.frets.iter().map(|fret| (fret.position, fret.top, fretboard.stiffness)));
    all.into_iter()
        .map(|(position, height, stiffness)| Barrier {
            column: weights(position, spacing, intervals) / spacing,
            height,
            law: Law { stiffness, exponent: fretboard.exponent },
        })
        .collect()
}
