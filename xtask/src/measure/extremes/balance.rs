//! What flows into strings and what they hold, held to the promises.

use low_action_dsp::{Account, Entry, Ledger, Simulation};

use super::trial::Fault;

/// How far energy may stand above what was put in, and the balance be open, as a part of all that was put in;
/// and beside that as much as the last digits of the numbers in the balance are worth.
pub const TOLERANCE: f64 = 1e-9;

/// Energy that is none, J. What runs ahead of a wave is set to rest below 1e-120 m, which takes 1e-230 J at a time: of a string that
/// has 1e-224 J, as one had, that is more than the tolerance.
const NOTHING: f64 = 1e-210;

/// The balance of a whole trial as it goes on.
#[derive(Debug, Clone, Copy, Default)]
pub struct Balance {
    time_step: f64,
    /// All that was put in, what was taken out again not counted off, J. (Not the sum of what
    /// [accounts](Account::put_in_gross) have booked: in a sample in which one string is given what another gives, this takes
    /// what is left, and it ends as no number where a power is none.)
    pub put_in: f64,
    /// What the solver took, J.
    pub solver: f64,
    /// How far energy stands above what was put in, as a part of that; below nothing where some was lost.
    pub created: f64,
    /// How far the balance is open, and what its last digits are worth, as parts of the same.
    pub open: f64,
    pub rounding: f64,
}

/// The larger of two numbers, and not a number if either is none: `f64::max` would leave that one out.
fn larger(one: f64, other: f64) -> f64 {
    if one.is_nan() || one > other { one } else { other }
}

impl Balance {
    /// Of a simulation that begins, its ledgers open.
    pub fn new(simulation: &Simulation) -> Balance {
        let put_in = simulation.accounts().map(|account| account.initial).sum();
        Balance { time_step: 1.0 / simulation.sample_rate(), put_in, ..Balance::default() }
    }

    /// Looks at a step that was just taken.
    pub fn see(&mut self, simulation: &Simulation, entry: &Entry) {
        self.flow(entry);
        let sum = |part: fn(&Account) -> f64| simulation.accounts().map(part).sum::<f64>();
        let above = sum(|account| account.energies().total() - account.put_in);
        self.weigh(above, sum(|account| account.residual_sum), sum(|account| account.rounding));
    }

    /// What flows in a sample.
    fn flow(&mut self, entry: &Entry) {
        self.put_in += larger(self.time_step * entry.power_in, 0.0);
        self.solver += self.time_step * entry.power_solver;
    }

    /// Compares with all that was put in: the energy above that, what the balance does not explain, and what its last digits
    /// are worth, J.
    fn weigh(&mut self, above: f64, residual: f64, rounding: f64) {
        let all = larger(self.put_in, f64::MIN_POSITIVE);
        self.created = above / all;
        self.open = residual.abs() / all;
        self.rounding = rounding / all;
    }

    /// The promise that is broken, where so much energy is stored, J, and this is heard.
    pub fn fault(&self, total: f64, output: f64) -> Option<Fault> {
        if !(total.is_finite() && output.is_finite() && self.put_in.is_finite()) {
            return Some(Fault::NotFinite);
        }
        broken(self.created, self.open, TOLERANCE + self.rounding)
    }
}

/// What has flowed into a string of an instrument, seen once a block.
#[derive(Debug, Clone, Copy, Default)]
pub struct Flow {
    /// The ledger's sum at the last block, J.
    last: f64,
    /// All that was put in, what was taken out again within the same block counted off, J. (What the ledger has
    /// [booked](Account::put_in_gross) sample by sample is more, and would excuse more.)
    all: f64,
}

impl Flow {
    /// Checks a string's ledger; returns what it comes to as parts of all that was put in.
    ///
    /// # Errors
    /// When a promise is broken.
    pub fn check(&mut self, ledger: &Ledger) -> Result<Parts, Fault> {
        self.all += larger(ledger.put_in - self.last, 0.0);
        self.last = ledger.put_in;
        Parts::of(ledger, self.all)
    }
}

/// What a ledger comes to as parts of what was put in: energy above that, the open balance, and the worth of its last digits.
#[derive(Debug, Clone, Copy)]
pub struct Parts {
    pub created: f64,
    pub open: f64,
    pub rounding: f64,
}

impl Parts {
    /// Of a string into which so much was put, J.
    ///
    /// # Errors
    /// When a promise is broken.
    pub fn of(ledger: &Ledger, put_in: f64) -> Result<Parts, Fault> {
        let all = larger(put_in, NOTHING);
        let parts = Parts {
            created: (ledger.energies().total() - ledger.put_in) / all,
            open: ledger.residual_sum.abs() / all,
            rounding: ledger.rounding / all,
        };
        let Parts { created, open, rounding } = parts;
        if !(all.is_finite() && created.is_finite() && open.is_finite()) {
            return Err(Fault::NotFinite);
        }
        broken(created, open, TOLERANCE + rounding).map_or(Ok(parts), Err)
    }
}

/// The promise that is broken where so much was created, or the balance is open by so much, and so much is allowed.
fn broken(created: f64, open: f64, allowed: f64) -> Option<Fault> {
    // Written so that what is not a number breaks the promise.
    let (passive, closed) = (created <= allowed, open <= allowed);
    match (passive, closed) {
        (false, _) => Some(Fault::Created(created)),
        (true, false) => Some(Fault::Open(open)),
        (true, true) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A balance into which a joule has flown, and then a sample of so many watts.
    fn balance(power_in: f64) -> Balance {
        let mut balance = Balance { time_step: 1e-4, put_in: 1.0, ..Balance::default() };
        balance.flow(&Entry { power_in, ..Entry::default() });
        balance
    }

    #[test]
    fn what_is_taken_out_is_not_counted_off() {
        assert_eq!(balance(100.0).put_in, 1.01);
        assert_eq!(balance(-100.0).put_in, 1.0);
    }

    #[test]
    fn energy_above_what_was_put_in_and_an_open_balance_are_faults() {
        let fault = |above, residual, rounding| {
            let mut balance = balance(0.0);
            balance.weigh(above, residual, rounding);
            balance.fault(1.0, 0.0)
        };
        assert_eq!(fault(-0.5, 0.0, 0.0), None);
        assert_eq!(fault(0.9e-9, -0.9e-9, 0.0), None);
        assert_eq!(fault(2e-9, 0.0, 0.0), Some(Fault::Created(2e-9)));
        assert_eq!(fault(-0.5, -2e-9, 0.0), Some(Fault::Open(2e-9)));
        assert_eq!(fault(2e-9, -2e-9, 2e-9), None);
    }

    /// Wherever it comes from.
    #[test]
    fn what_is_not_a_number_is_a_fault() {
        for (power, above, residual, rounding) in [
            (f64::NAN, 0.0, 0.0, 0.0),
            (f64::INFINITY, 0.0, 0.0, 0.0),
            (0.0, f64::NAN, 0.0, 0.0),
            (0.0, 0.0, f64::NAN, 0.0),
            (0.0, 0.0, 0.0, f64::NAN),
        ] {
            let mut balance = balance(power);
            balance.weigh(above, residual, rounding);
            assert!(balance.fault(1.0, 0.0).is_some(), "{power} W, {above} J, {residual} J, {rounding} J");
        }
        assert_eq!(balance(0.0).fault(f64::NAN, 0.0), Some(Fault::NotFinite));
        assert_eq!(balance(0.0).fault(1.0, f64::NAN), Some(Fault::NotFinite));
    }
}
