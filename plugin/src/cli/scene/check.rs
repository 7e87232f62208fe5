//! The final check of a scene: whether its result may be believed.

use low_action_dsp::Account;
use low_action_dsp::digits::{at_least, at_most, plain};

use super::seen::Seen;
use crate::cli::wav::Findings;
use crate::cli::{Failure, Outcome};

/// How far the energy balance may be open over a whole run, as a part of the largest energy or of all that was put in, whichever
/// is more, and beyond what rounding alone may come to. It leaves some 1e-13 a second.
const BALANCE: f64 = 1e-9;
/// Where rounding alone may come to more than this part, little or nothing of the balance is checked, and a warning says so.
pub(super) const COARSE: f64 = 1e-6;
/// Whether the result of a scene that is so called may be believed.
pub(super) fn check<'a>(
    name: &str,
    seen: &Seen,
    sound: Option<&Findings>,
    strings: usize,
    accounts: impl Iterator<Item = &'a Account>,
) -> Outcome {
    let fails = |text: String| Err(Failure::Check(format!("{name}: {text}")));
    if let Some(sample) = seen.not_finite {
        return fails(format!("the result is not finite from sample {sample} on; it is kept"));
    }
    if seen.ends_not_finite {
        return fails("a string is not finite at the end; the result is kept".into());
    }
    if let Some(sound) = sound.filter(|sound| sound.not_finite > 0) {
        let count = sound.not_finite;
        return fails(format!("{count} samples are too large for 32 bits; the file is kept"));
    }
    for (index, account) in accounts.enumerate() {
        let (open, limit) = (open_part(account), BALANCE + rounding_part(account));
        if open.is_nan() || open > limit {
            return fails(format!(
                "the energy balance of {} is open by {} of its largest energy or of all that was put in, over \
                 the limit of {}; the result is kept",
                named(index, strings),
                plain(at_least(open)),
                plain(at_most(limit))
            ));
        }
    }
    Ok(())
}

/// What the account of an index is of, where the first are of so many strings.
pub(super) fn named(index: usize, strings: usize) -> String {
    if index < strings { format!("string {}", index + 1) } else { "the body".into() }
}

/// How far a ledger is open in all, as a part of the largest energy or of all that was put in.
pub(super) fn open_part(account: &Account) -> f64 {
    if account.residual_sum == 0.0 { 0.0 } else { account.residual_sum.abs() / flow(account) }
}

/// How far rounding alone may open it, as the same part.
pub(super) fn rounding_part(account: &Account) -> f64 {
    account.rounding / flow(account)
}

/// What a balance is judged by, J: above 0. (What hands take out again has gone through it, too.)
fn flow(account: &Account) -> f64 {
    account.largest.max(account.put_in_gross).max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use low_action_dsp::{Scene, Simulation};

    use super::*;

    fn accounts() -> Vec<Account> {
        let text = "sample_rate = 44100\nduration = 0.01\n[[string]]\nlength = 0.65\nlinear_density = 5e-3\n\
                    tension = 60.0\nshape = [[0.0, 0.0], [0.3, 0.001], [0.65, 0.0]]\n";
        let mut simulation = Simulation::new(&Scene::from_toml(text).unwrap()).unwrap();
        simulation.open_ledger();
        simulation.step();
        simulation.accounts().cloned().collect()
    }

    #[test]
    fn a_good_result_passes() {
        assert!(check("it", &Seen::default(), Some(&Findings::default()), 1, accounts().iter()).is_ok());
    }

    #[test]
    fn what_is_not_finite_or_not_balanced_fails_with_3() {
        let code = |outcome: Outcome| outcome.err().map(|failure| failure.code());
        let nothing = [].iter();
        let seen = Seen { not_finite: Some(7), ..Seen::default() };
        assert_eq!(code(check("it", &seen, None, 1, nothing.clone())), Some(3));
        let seen = Seen { ends_not_finite: true, ..Seen::default() };
        assert_eq!(code(check("it", &seen, None, 1, nothing.clone())), Some(3));
        let sound = Findings { not_finite: 1, ..Findings::default() };
        assert_eq!(code(check("it", &Seen::default(), Some(&sound), 1, nothing)), Some(3));
        for part in [2.0 * BALANCE, -2.0 * BALANCE, f64::NAN] {
            let mut open = accounts();
            open[0].residual_sum = part * open[0].largest;
            assert_eq!(code(check("it", &Seen::default(), None, 1, open.iter())), Some(3));
            // Where more than that has gone through it, and been taken out again, it passes.
            open[0].put_in_gross = 10.0 * open[0].largest;
            let outcome = check("it", &Seen::default(), None, 1, open.iter());
            assert_eq!(code(outcome), part.is_nan().then_some(3));
        }
    }
}
