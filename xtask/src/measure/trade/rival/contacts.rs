//! The contacts of the rival in one step: which act, and their forces from one linear system.

use low_action_dsp::contact::ContactLaw;
use low_action_dsp::grid::Reading;
use low_action_dsp::model::Contact;

use super::{Pull, Rival, read};

/// A contact in one step.
pub(super) struct Row {
    /// Index of the fixed contact, or of nothing for the finger.
    pub(super) fixed: Option<usize>,
    pub(super) reading: Reading,
    /// +1 pushes up, −1 down.
    pub(super) sign: f64,
    /// Answer of its own body to its force, m/N.
    pub(super) own: f64,
    pub(super) psi: f64,
    pub(super) g: f64,
    /// The lossy part of the force is this times r, N/m.
    pub(super) lossy: f64,
    /// Change of penetration without forces, then with them, m.
    pub(super) change: f64,
    pub(super) force: f64,
}

/// Steps between looks at all contacts, and how much faster than now the string may become between them.
const LOOK: u32 = 16;
const HASTE: f64 = 8.0;
/// Below this ½ψ² is nothing, J.
const NOTHING: f64 = 1e-24;

impl Rival {
    /// Lists the contacts that act.
    pub(super) fn collect(&mut self, time: f64, next_time: f64) {
        self.rows.clear();
        let k = self.model.grid.time_step;
        if self.patience == 0 {
            self.patience = LOOK;
            let fastest = self.motion.iter().fold(0.0_f64, |most, d| most.max(d.abs()));
            let room = 1e-5 + HASTE * f64::from(LOOK) * fastest;
            let reach =
                |contact: &Contact| read(&contact.reading, &self.displacement) - contact.height < room;
            self.near.clear();
            let contacts = self.model.contacts.iter().enumerate();
            let near = contacts.filter(|(i, contact)| self.psi[*i] != 0.0 || reach(contact));
            self.near.extend(near.map(|(i, _)| i));
        }
        self.patience -= 1;
        for &index in &self.near {
            let contact = &self.model.contacts[index];
            let penetration = contact.height - read(&contact.reading, &self.displacement);
            let psi = self.psi[index];
            if penetration <= 0.0 && psi == 0.0 {
                continue;
            }
            let motion = read(&contact.reading, &self.motion);
            if penetration > 0.0 && penetration + motion <= 0.0 {
                self.calm[index] = self.step + Contact::RADIATING;
            }
            let radiating = contact.radiating(self.calm[index].saturating_sub(self.step));
            let own = contact.damping * contact.own_force(penetration);
            let change = -(read(&contact.reading, &self.next) + motion);
            self.rows.push(Row {
                fixed: Some(index),
                reading: contact.reading,
                sign: 1.0,
                own: 0.0,
                psi,
                g: slope(&contact.law, penetration, psi, change),
                lossy: (own + radiating) / (2.0 * k),
                change,
                force: 0.0,
            });
        }
        let Some(finger) = &mut self.finger else { return };
        // (M, where the scheme has M̃: the same without the hand's damping, 1 to 2 % less at 48 kHz for fingers that press.)
        let (mass, damped) = (finger.mass, 0.5 * finger.hand_damping * k);
        let before = finger.height - finger.motion;
        let past = |reading: &Reading| read(reading, &self.displacement) - read(reading, &self.motion);
        let penetration = read(&finger.reading, &self.displacement) - finger.height;
        let penetration_before = past(&finger.reading) - before;
        let push = k * k * finger.force.at(time);
        finger.motion = ((mass - damped) * finger.motion - push) / (mass + damped);
        finger.height += finger.motion;
        finger.reading = self.model.grid.reading(finger.position.at(next_time));
        let (reading, psi) = (finger.reading, finger.psi);
        if penetration > 0.0 || psi != 0.0 {
            let after = read(&reading, &self.displacement) + read(&reading, &self.next) - finger.height;
            let change = after - penetration_before;
            self.rows.push(Row {
                fixed: None,
                reading,
                sign: -1.0,
                own: k * k / (mass + damped),
                psi,
                g: slope(&finger.law, penetration, psi, change),
                lossy: finger.damping * finger.law.force(penetration) / (2.0 * k),
                change,
                force: 0.0,
            });
        }
    }

    /// Forces of all contacts from one linear system; gives Σ of forces as stretching feels them.
    pub(super) fn solve(&mut self, pull: &Pull) -> f64 {
        let (count, second) = (self.rows.len(), &self.second);
        if count == 0 {
            return 0.0;
        }
        let felt: Vec<f64> = self.rows.iter().map(|row| row.sign * read(&row.reading, second)).collect();
        let answer = |i: usize, j: usize| {
            let (a, b) = (&self.rows[i], &self.rows[j]);
            let direct = a.sign * b.sign * a.reading.overlap(&b.reading) - pull.share * felt[i] * felt[j];
            pull.mobility * direct + if i == j { a.own } else { 0.0 }
        };
        // With S = g²/4 + P: f = gψ + S(r₀ − Mf), made symmetric: (1 + √S M √S) f/√S = (gψ + S r₀)/√S.
        let roots: Vec<f64> = self.rows.iter().map(|row| (0.25 * row.g * row.g + row.lossy).sqrt()).collect();
        self.matrix.clear();
        for i in 0..count {
            for j in 0..=i {
                let unit = if i == j { 1.0 } else { 0.0 };
                self.matrix.push(unit + roots[i] * roots[j] * answer(i, j));
            }
        }
        let known = |(row, root): (&Row, &f64)| {
            if *root > 0.0 { row.g * row.psi / root + root * row.change } else { 0.0 }
        };
        let mut solution: Vec<f64> = self.rows.iter().zip(&roots).map(known).collect();
        cholesky(&mut self.matrix, &mut solution);
        let forces: Vec<f64> = solution.iter().zip(&roots).map(|(y, root)| y * root).collect();
        let changes: Vec<f64> = (0..count)
            .map(|i| self.rows[i].change - (0..count).map(|j| answer(i, j) * forces[j]).sum::<f64>())
            .collect();
        for ((row, force), change) in self.rows.iter_mut().zip(&forces).zip(changes) {
            row.force = *force;
            row.psi += 0.5 * row.g * change;
            if 0.5 * row.psi * row.psi < NOTHING {
                row.psi = 0.0;
            }
            row.change = change;
        }
        forces.iter().zip(felt).map(|(force, felt)| force * felt).sum()
    }
}

/// g at n. Out of contact it is what brings ψ to nothing, were there no forces.
fn slope(law: &ContactLaw, penetration: f64, psi: f64, change: f64) -> f64 {
    if penetration > 0.0 {
        let g = law.force(penetration) / (2.0 * law.energy(penetration)).sqrt();
        if psi < 0.0 { -g } else { g }
    } else if change != 0.0 {
        -2.0 * psi / change
    } else {
        0.0
    }
}

/// Solves a symmetric positive system, given by rows of its lower triangle.
fn cholesky(matrix: &mut [f64], right: &mut [f64]) {
    let at = |i: usize, j: usize| i * (i + 1) / 2 + j;
    let count = right.len();
    for i in 0..count {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|m| matrix[at(i, m)] * matrix[at(j, m)]).sum();
            let rest = matrix[at(i, j)] - sum;
            matrix[at(i, j)] = if i == j { rest.sqrt() } else { rest / matrix[at(j, j)] };
        }
        let sum: f64 = (0..i).map(|m| matrix[at(i, m)] * right[m]).sum();
        right[i] = (right[i] - sum) / matrix[at(i, i)];
    }
    for i in (0..count).rev() {
        let sum: f64 = (i + 1..count).map(|m| matrix[at(m, i)] * right[m]).sum();
        right[i] = (right[i] - sum) / matrix[at(i, i)];
    }
}
