//! A slow, plain second implementation of the fretted string, to check the fast one against.
//!
//! It shares no code with the physics package: full matrices multiplied and factorised afresh each sample
//! instead of stencils and closed-form inverses, every contact of the scene in one dense system instead of
//! an active set. One sample solves
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
//!
//! Kept are u and the change d = u − u⁻, because the last digits lost in B u + C u⁻ add up from sample to
//! sample. With u⁻ = u − d and B + C − A = k² S − 2 a aᵀ the same equation reads
//!
//! ```text
//! A d⁺ = (k² S − 2 a aᵀ) u − C d + (k²/ρ) (Σ g_e f_e + G f)
//! ```

mod barrier;
mod contact;
mod setup;

pub use barrier::Barrier;
pub use contact::Law;
pub use setup::{
    Finger, Fret, Fretboard, Placement, Pluck, Setup, Stencil, Table, straight_weights, weights,
};

use contact::Contact;
use nalgebra::{DMatrix, DVector};
use setup::{at, mean};
use std::f64::consts::PI;

/// The simulation itself, moved on one sample at a time.
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
    /// D_x, 1/m: a row for each interval, the slope there.
    slope: DMatrix<f64>,
    /// Samples taken so far, n.
    pub sample: usize,
    /// uⁿ, m.
    pub now: DVector<f64>,
    /// dⁿ = uⁿ − uⁿ⁻¹, m.
    pub change: DVector<f64>,
    /// Heights of the fingers at n, m.
    pub finger_now: DVector<f64>,
    /// How far the fingers moved up since n − 1, m.
    pub finger_change: DVector<f64>,
    /// Contact forces of the last sample, barriers first, then fingers, N.
    pub forces: DVector<f64>,
    /// Power dissipated minus power supplied in the last sample, W.
    pub net_loss: f64,
    /// How many samples ago each barrier's contact was made: none if it never was.
    since_made: Vec<Option<i32>>,
}

/// For how many samples a contact that has just been made is met by the resistance, a part less in each.
const MET: i32 = 5;

impl Reference {
    /// At rest in the shape and heights the scene gives.
    pub fn new(setup: &Setup) -> Self {
        let intervals = setup.intervals();
        assert!(intervals >= 3, "the reference needs 3 intervals or more, the scene gives {intervals}");
        let points = intervals - 1;
        let spacing = setup.length / intervals as f64;
        let time_step = 1.0 / setup.sample_rate;
        let slope = DMatrix::from_fn(intervals, points, |row, point| {
            (f64::from(row == point) - f64::from(row == point + 1)) / spacing
        });
        let start = DVector::from_fn(points, |i, _| at(&setup.shape, (i + 1) as f64 * spacing));
        let heights = DVector::from_iterator(setup.fingers.len(), setup.fingers.iter().map(|f| f.height));
        let travel = setup.fingers.iter().map(|f| f.velocity * time_step);
        let finger_change = DVector::from_iterator(heights.len(), travel);
        let mut new = Self {
            setup: setup.clone(),
            intervals,
            spacing,
            time_step,
            slope,
            sample: 0,
            now: start,
            change: DVector::from_fn(points, |i, _| {
                let node = (i + 1) as f64;
                mean(&setup.velocity, (node - 0.5) * spacing, (node + 0.5) * spacing) * time_step
            }),
            finger_now: heights,
            finger_change,
            forces: DVector::zeros(0),
            barriers: Vec::new(),
            net_loss: 0.0,
            since_made: Vec::new(),
        };
        new.barriers = new.barriers();
        new.since_made = vec![None; new.barriers.len()];
        new.forces = DVector::zeros(new.barriers.len() + setup.fingers.len());
        new
    }

    /// D_xx v = −D_xᵀ D_x v. Taken one difference after the other, as here, it loses no digits of a smooth v;
    /// the ready-made product of the matrices would.
    fn curvature(&self, v: &DVector<f64>) -> DVector<f64> {
        -self.slope.transpose() * (&self.slope * v)
    }

    /// S v with the S of time t.
    fn acceleration(&self, time: f64, v: &DVector<f64>) -> DVector<f64> {
        let tension = at(&self.setup.tension, time);
        let (kappa2, kappa6) = self.setup.stencil_stiffness(self.spacing, tension);
        let second = self.curvature(v);
        let fourth = self.curvature(&second);
        let sixth = self.curvature(&fourth);
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
                Law::new(finger.stiffness, finger.exponent)
            },
            |barrier| barrier.law,
        )
    }

    /// What a hand laid along the string adds to σ₀ in the next sample, 1/s.
    pub fn stilling(&self) -> f64 {
        at(&self.setup.stilling, self.sample as f64 * self.time_step)
    }

    /// One sample.
    pub fn step(&mut self) {
        let (h, k) = (self.spacing, self.time_step);
        let setup = &self.setup;
        let time = self.sample as f64 * k;
        let (u, d) = (&self.now, &self.change);
        let u_before = &(u - d);
        let (fingers, fixed) = (setup.fingers.len(), self.barriers.len());
        let loss = setup.loss_0 + self.stilling();

        let a = self.curvature(u) * (k / 2.0 * (self.stretch_stiffness() * h).sqrt());
        let stretch = &a * a.transpose();
        let one = DMatrix::<f64>::identity(u.len(), u.len());
        let second = -self.slope.transpose() * &self.slope;
        let matrix_a = (&one * (1.0 + loss * k) + &stretch).lu();
        let matrix_c = &one * (loss * k - 1.0) - &stretch - second * (2.0 * setup.loss_1 * k);
        let invert = |right: &DMatrix<f64>| matrix_a.solve(right).expect("A has eigenvalues above 1");

        // Without contacts: the string, then the fingers, (M̃ + R k/2) e⁺ = (M̃ − R k/2) e − k² f₀ with e = u_f − u_f⁻.
        let mobility = k * k / setup.linear_density;
        let pluck = self.plucks(time);
        let right =
            self.acceleration(time, u) * (k * k) - &stretch * u * 2.0 - matrix_c * d + &pluck * mobility;
        let d_free = matrix_a.solve(&right).expect("A has eigenvalues above 1");
        let mass = |i: usize| setup.fingers[i].mass_in_steps_of(k);
        let hand = |i: usize| setup.fingers[i].hand_damping * k / 2.0;
        let push = |i: usize| at(&setup.fingers[i].force, time);
        let e = &self.finger_change;
        let e_free = DVector::from_fn(fingers, |i, _| {
            ((mass(i) - hand(i)) * e[i] - k * k * push(i)) / (mass(i) + hand(i))
        });

        // The contacts: a moving finger acts where it will be, and its way so far began where it was.
        let g_before = self.columns((time - k).max(0.0));
        let g_after = self.columns(time + k);
        let eta_before = self.penetrations(&g_before, u_before, &(&self.finger_now - e));
        let eta = self.penetrations(&self.columns(time), u, &self.finger_now);
        let spread = invert(&(&g_after * mobility));
        // r = −c − M f: c is how far the contacts would open by themselves.
        let slide = (&g_after - &g_before).transpose() * u_before * h;
        let mut c = g_after.transpose() * (d + &d_free) * h + &slide;
        let mut m = g_after.transpose() * &spread * h;
        for i in 0..fingers {
            c[fixed + i] += e[i] + e_free[i];
            m[(fixed + i, fixed + i)] += k * k / (mass(i) + hand(i));
        }
        let since_made: Vec<_> = (0..fixed)
            .map(|i| {
                let made = eta[i] > 0.0 && eta_before[i] <= 0.0;
                if made { Some(0) } else { self.since_made[i].map(|samples| samples + 1) }
            })
            .collect();
        let contacts: Vec<Contact> = (0..eta.len())
            .map(|i| {
                let law = self.law(i);
                let resistance = match i.checked_sub(fixed) {
                    Some(finger) => setup.fingers[finger].damping * law.force(eta[i]),
                    None => {
                        let barrier = &self.barriers[i];
                        let met = since_made[i].map_or(0, |samples| (MET - samples).max(0));
                        let met = if eta[i] > 0.0 { f64::from(met) / f64::from(MET) } else { 0.0 };
                        barrier.damping * law.force_at_most_of_the_knee(eta[i]) + barrier.resistance * met
                    }
                };
                Contact { law, before: eta_before[i], damping: resistance / (2.0 * k) }
            })
            .collect();
        let forces = contact::solve(&contacts, &c, &m);
        let d_next = &d_free + &spread * &forces;
        let e_next =
            DVector::from_fn(fingers, |i, _| e_free[i] + k * k / (mass(i) + hand(i)) * forces[fixed + i]);

        // Dissipated and supplied power, with centred velocities.
        let velocity = (d + &d_next) / (2.0 * k);
        let r = -c - m * &forces;
        let rho = setup.linear_density;
        let retuned = self.acceleration(time, u_before) - self.acceleration((time - k).max(0.0), u_before);
        let mut net = 2.0 * rho * h * loss * velocity.norm_squared()
            - 2.0 * rho * h * setup.loss_1 * velocity.dot(&self.curvature(&velocity))
            - h * pluck.dot(&velocity)
            // Whoever turns the peg, and whoever moves a finger along the string, works as well.
            + rho * h / (2.0 * k) * u.dot(&retuned)
            + forces.dot(&slide) / (2.0 * k);
        for (i, contact) in contacts.iter().enumerate() {
            net += (forces[i] - contact.law.quotient(contact.before, r[i])) * r[i] / (2.0 * k);
        }
        for i in 0..fingers {
            let velocity = (e[i] + e_next[i]) / (2.0 * k);
            net += setup.fingers[i].hand_damping * velocity * velocity + push(i) * velocity;
        }

        self.net_loss = net;
        self.since_made = since_made;
        self.forces = forces;
        self.now += &d_next;
        self.change = d_next;
        self.finger_now += &e_next;
        self.finger_change = e_next;
        self.sample += 1;
    }

    /// Σ g_e f_e, N/m, in the mean from half a sample before to half a sample after: f_e = f_p sin²(πt/2t_p) while it grows, and
    /// f_p cos²(πt/2t_r) from then on while it falls, each by Simpson's rule in many pieces.
    fn plucks(&self, time: f64) -> DVector<f64> {
        const PIECES: usize = 1000;
        let k = self.time_step;
        let mut sum = DVector::zeros(self.now.len());
        for pluck in &self.setup.plucks {
            let since = time - pluck.start;
            // ∫ push over what of the sample lies between 0 and `until`.
            let pushed = |since: f64, until: f64, push: &dyn Fn(f64) -> f64| {
                let (from, to) = ((since - k / 2.0).max(0.0), (since + k / 2.0).min(until));
                let length = to - from;
                if length <= 0.0 {
                    return 0.0;
                }
                let push = |part: f64| push(from + part * length);
                let ends = (0..=PIECES).map(|i| push(i as f64 / PIECES as f64)).collect::<Vec<_>>();
                let middles = (0..PIECES).map(|i| push((i as f64 + 0.5) / PIECES as f64));
                let even = ends.iter().sum::<f64>() - 0.5 * (ends[0] + ends[PIECES]);
                (even + 2.0 * middles.sum::<f64>()) / (3.0 * PIECES as f64) * length
            };
            let (rise, fall) = (pluck.duration, pluck.release);
            let grown = pushed(since, rise, &|t| (PI * t / (2.0 * rise)).sin().powi(2));
            let fallen = pushed(since - rise, fall, &|t| (PI * t / (2.0 * fall)).cos().powi(2));
            let force = pluck.force * (grown + fallen) / k;
            sum += weights(pluck.position, self.spacing, self.intervals) * (force / self.spacing);
        }
        sum
    }

    /// Lets go of what `new` holds, or throws it: the mean of how it moved to where it is and will move from there is what it is
    /// thrown with, and nothing else at rest. Nothing is plucked, stilled or slid on meanwhile, and no barrier is near what is
    /// thrown.
    pub fn let_go(&mut self) {
        let mut after = self.clone();
        after.setup.plucks.clear();
        after.setup.stilling.clear();
        for finger in &mut after.setup.fingers {
            finger.position = vec![[0.0, at(&finger.position, 0.0)]];
        }
        after.step();
        // d⁺ = decay d + q from d = kv, and d⁺ + d = 2kv.
        let (k, sigma) = (self.time_step, self.setup.loss_0);
        let decay = (1.0 - sigma * k) / (1.0 + sigma * k);
        let thrown = &self.change;
        self.change = (thrown * 2.0 - (after.change - thrown * decay)) / (1.0 + decay);
        for (i, finger) in self.setup.fingers.iter().enumerate() {
            let (mass, hand) = (finger.mass_in_steps_of(k), finger.hand_damping * k / 2.0);
            let decay = (mass - hand) / (mass + hand);
            let thrown = self.finger_change[i];
            self.finger_change[i] =
                (2.0 * thrown - (after.finger_change[i] - decay * thrown)) / (1.0 + decay);
        }
    }

    /// Energy stored between the last two instants, J.
    pub fn energy(&self) -> f64 {
        let (h, k, rho) = (self.spacing, self.time_step, self.setup.linear_density);
        let (u, u_before) = (&self.now, &(&self.now - &self.change));
        let time = (self.sample as f64 - 1.0).max(0.0) * k;
        let velocity = &self.change / k;
        // (D_x u)ᵀ D_x v = −uᵀ D_xx v.
        let stretch = -u.dot(&self.curvature(u_before)) * h;
        let mut energy = rho * h / 2.0 * velocity.norm_squared()
            - rho * h / 2.0 * u.dot(&self.acceleration(time, u_before))
            + rho * self.setup.loss_1 * h * k / 2.0 * velocity.dot(&self.curvature(&velocity))
            + rho * self.stretch_stiffness() / 8.0 * stretch * stretch;
        let eta = self.penetrations(&self.columns(self.sample as f64 * k), u, &self.finger_now);
        let fingers_before = &self.finger_now - &self.finger_change;
        let eta_before = self.penetrations(&self.columns(time), u_before, &fingers_before);
        for i in 0..eta.len() {
            energy += (self.law(i).energy(eta[i]) + self.law(i).energy(eta_before[i])) / 2.0;
        }
        for (finger, change) in self.setup.fingers.iter().zip(&self.finger_change) {
            energy += finger.mass_in_steps_of(k) / 2.0 * (change / k).powi(2);
        }
        energy
    }
}
