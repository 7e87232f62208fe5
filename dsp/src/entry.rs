//! An entry of the energy ledger: one sample's energies and powers, term by term. Whatever sums terms takes all of them apart first,
//! so that a new one is not forgotten there.

use std::ops::AddAssign;

/// Stored energies at n + ½, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// Of the string as a linear one: motion, tension, bending, less the loss term of the scheme.
    pub string: f64,
    /// Of tension modulation.
    pub tension: f64,
    /// Of all contacts: board, frets and fingers' pads.
    pub contact: f64,
    /// Of the fingers' motion.
    pub finger: f64,
    /// Of the body under the strings of a scene: of its modes, and of what its bridge, out of its place, has in common with the
    /// strings, which is below 0 where it gives way to them.
    pub body: f64,
}

impl Energies {
    /// All of it, J.
    pub fn total(&self) -> f64 {
        let Self { string, tension, contact, finger, body } = *self;
        string + tension + contact + finger + body
    }
}

impl AddAssign for Energies {
    fn add_assign(&mut self, other: Energies) {
        let Energies { string, tension, contact, finger, body } = other;
        self.string += string;
        self.tension += tension;
        self.contact += contact;
        self.finger += finger;
        self.body += body;
    }
}

/// Powers lost at n, W, none below 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Losses {
    /// In the string, to its `loss_0`: of all frequencies alike.
    pub loss_0: f64,
    /// In the string, to its `loss_1`: the more, the higher the frequency.
    pub loss_1: f64,
    /// In contacts, as their laws have it: to the damping of pads, frets and board, and to the waves that a kinked
    /// fret sends off.
    pub contact: f64,
    /// In the hands behind the fingers, and in one laid along the string.
    pub hand: f64,
    /// In the body under the strings of a scene: to wood, and to air, which sounds.
    pub body: f64,
}

impl AddAssign for Losses {
    fn add_assign(&mut self, other: Losses) {
        let Losses { loss_0, loss_1, contact, hand, body } = other;
        self.loss_0 += loss_0;
        self.loss_1 += loss_1;
        self.contact += contact;
        self.hand += hand;
        self.body += body;
    }
}

/// Powers put in at n, W, negative where they are taken out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// By pushes on the string, which are plucks.
    pub pluck: f64,
    /// By a bridge that gives way: into a string, or by strings into the body under it. In all that comes to nothing, and it is no
    /// part of what is put in from outside.
    pub bridge: f64,
    /// By the hands' forces on the fingers.
    pub hand: f64,
    /// By slides: fingers in contact whose places move along a string that is not level.
    pub slide: f64,
    /// By frets and board that move.
    pub barrier: f64,
    /// By tension that changes.
    pub tension: f64,
    /// By fingers that are placed or taken away: what they bring or carry off, spread over a step.
    pub finger: f64,
}

impl AddAssign for Inputs {
    fn add_assign(&mut self, other: Inputs) {
        let Inputs { pluck, bridge, hand, slide, barrier, tension, finger } = other;
        self.pluck += pluck;
        self.bridge += bridge;
        self.hand += hand;
        self.slide += slide;
        self.barrier += barrier;
        self.tension += tension;
        self.finger += finger;
    }
}

/// One sample of the ledger. The terms of a loss or an input add up to it but for rounding (all but what a bridge has put in).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Entry {
    /// Stored energies at n + ½.
    pub energies: Energies,
    /// Power lost at n: string losses, hands, pads, frets and board, body, W.
    pub power_loss: f64,
    /// The terms of that.
    pub losses: Losses,
    /// Power lost to inexact contact forces (negative when they put energy in), W.
    pub power_solver: f64,
    /// Power put in from outside at n: pushes, hands, slides, moving tension and frets, fingers placed or removed, W.
    pub power_in: f64,
    /// The terms of that.
    pub inputs: Inputs,
    /// Energy that the balance does not explain, J.
    pub residual: f64,
}

impl AddAssign for Entry {
    fn add_assign(&mut self, other: Entry) {
        let Entry { energies, power_loss, losses, power_solver, power_in, inputs, residual } = other;
        self.energies += energies;
        self.power_loss += power_loss;
        self.losses += losses;
        self.power_solver += power_solver;
        self.power_in += power_in;
        self.inputs += inputs;
        self.residual += residual;
    }
}
