//! What has gone through a balance.

use crate::entry::Energies;

/// What there is, and what has gone through a balance so far: of a string, or of the body under strings.
#[derive(Debug, Clone, PartialEq)]
pub struct Account {
    pub(super) energies: Energies,
    /// Energy there was when it was opened, J.
    pub initial: f64,
    /// The largest total energy so far, J: of a body the largest there would be if what it has in common with strings did not
    /// cancel.
    pub largest: f64,
    /// Energy put in so far, J, the initial energy included and what was taken out again counted off: what is stored is never
    /// more.
    pub put_in: f64,
    /// The same with what was taken out again not counted off, J: all that has gone through the balance, of which so many last
    /// digits are lost.
    pub put_in_gross: f64,
    /// Sum of the residuals, J.
    pub residual_sum: f64,
    /// The largest |residual| over the largest energy up to its sample.
    pub worst_residual: f64,
    /// How well the balance can be known at all, J: what a unit in the last place of every number that enters
    /// it is worth, summed over all steps.
    pub rounding: f64,
}

impl Account {
    /// Opens an account of what there is.
    pub(super) fn new(energies: Energies) -> Account {
        let initial = energies.total();
        Account {
            energies,
            initial,
            largest: initial,
            put_in: initial,
            put_in_gross: initial,
            residual_sum: 0.0,
            worst_residual: 0.0,
            rounding: 0.0,
        }
    }

    /// Books a step after which there are these energies, in all of such a size, J, in which so much was put in, J, and so much is
    /// open, J.
    pub(super) fn book(&mut self, energies: Energies, size: f64, put_in: f64, residual: f64) {
        self.energies = energies;
        self.largest = self.largest.max(size);
        self.put_in += put_in;
        self.put_in_gross += put_in.max(0.0);
        self.residual_sum += residual;
        // What is not a number is the worst there is, and stays.
        let open = residual.abs() / self.largest.max(f64::MIN_POSITIVE);
        if open.is_nan() || open > self.worst_residual {
            self.worst_residual = open;
        }
    }

    /// Books what was done beside steps: there are these energies now, and what that is more than before counts as put in. Gives
    /// that back, J.
    pub(super) fn rebook(&mut self, energies: Energies) -> f64 {
        let entered = energies.total() - self.energies.total();
        self.energies = energies;
        self.put_in += entered;
        self.put_in_gross += entered.max(0.0);
        self.largest = self.largest.max(energies.total());
        entered
    }

    /// Stored energies at the last sample booked.
    pub fn energies(&self) -> Energies {
        self.energies
    }
}
