//! What the qualities aim at, at a host's 48 kHz, and whether they reach it.

use anyhow::{Result, bail};
use low_action_dsp::Quality;

use super::Outcome;
use super::scenes::Kind;
use super::settings::{BASE, Setting, quality};
use super::table::{head, mean_load, plain, shown};

/// One of them.
pub struct Aim {
    what: &'static str,
    at_most: f64,
    found: Option<f64>,
}

/// What is missed and known to be: the page tells musicians of a cent and a quarter.
const KNOWN_TO_BE_MISSED: [&str; 1] = [HIGH];

const HIGH: &str =
    "`live`: pitch of light strings stopped high on the neck, before they are put in tune, cents";

impl Aim {
    /// (What was not measured is missed, and so is what is no number.)
    fn is_met(&self) -> bool {
        self.found.is_some_and(|found| found <= self.at_most)
    }
}

/// All of them, and what was found.
pub fn aims(outcomes: &[Outcome]) -> Vec<Aim> {
    const BUZZING: &[Kind] = &[Kind::BuzzingLight, Kind::BuzzingHeavy, Kind::EachBuzzing];
    let at = |one: Quality| quality(one, BASE.rate);
    let live = at(Quality::Live);
    let impulses = Outcome::impulses;
    let price =
        |one: Quality| Some(mean_load(&at(one), outcomes)? / mean_load(&at(Quality::Draft), outcomes)?);
    let rows = [
        (
            "`live`: partials of every open string, up to 4 kHz, cents",
            1.0,
            largest(live, &[Kind::Open, Kind::EachOpen], outcomes, |one| one.errors.partials()),
        ),
        (
            "`live`: pitch of stopped strings before they are put in tune, cents",
            1.0,
            largest(live, &[Kind::Pressed], outcomes, |one| one.errors.pitch()),
        ),
        (HIGH, 1.0, largest(live, &[Kind::High], outcomes, |one| one.errors.pitch())),
        ("`live`: forces of pressed strings, %", 3.0, largest(live, &[Kind::Pressed], outcomes, impulses)),
        ("`live`: buzz, %", 25.0, largest(live, BUZZING, outcomes, impulses)),
        ("`live`: price over that of `draft`", 2.0, price(Quality::Live)),
        ("`studio`: price over that of `draft`", 7.0, price(Quality::Studio)),
        ("`studio`: buzz, %", 15.0, largest(at(Quality::Studio), BUZZING, outcomes, impulses)),
        ("`reference`: price over that of `draft`", 20.0, price(Quality::Reference)),
        ("`reference`: buzz, %", 12.0, largest(at(Quality::Reference), BUZZING, outcomes, impulses)),
    ];
    rows.into_iter().map(|(what, at_most, found)| Aim { what, at_most, found }).collect()
}

/// The largest of something over scenes of some kinds under a setting, if any of them tells it.
fn largest(
    setting: Setting,
    kinds: &[Kind],
    outcomes: &[Outcome],
    value: fn(&Outcome) -> Option<f64>,
) -> Option<f64> {
    let these = outcomes.iter().filter(|one| one.setting == setting && kinds.contains(&one.kind()));
    these.filter_map(value).max_by(f64::total_cmp)
}

/// The table of them.
pub fn table(aims: &[Aim]) -> String {
    let mut text = head(["at most".into(), "found".into(), String::new()]);
    for aim in aims {
        let met = if aim.is_met() { "met" } else { "**missed**" };
        text += &format!("| {} | {} | {} | {met} |\n", aim.what, plain(aim.at_most), shown(aim.found));
    }
    text + "\nOnce an instrument is put in tune, all frets of the electric and acoustic guitars are within a cent at `live`, at a bridge that stands still \
            (`tests/tests/instrument/tuning.rs`).\n"
}

/// Refuses aims that are missed, but for what is known to be, and what is known to be missed and is not, so that this stays true.
///
/// # Errors
/// When there are such; all of them are named.
pub fn judge(aims: &[Aim]) -> Result<()> {
    let mut wrong = Vec::new();
    for aim in aims {
        let Aim { what, at_most, found } = aim;
        match (aim.is_met(), KNOWN_TO_BE_MISSED.contains(what)) {
            (false, false) => wrong.push(format!(
                "an aim is missed: {what}: {}, must be {} at most",
                shown(*found),
                plain(*at_most)
            )),
            (true, true) => wrong.push(format!(
                "an aim is met that is known to be missed, which can be taken off that list: {what}"
            )),
            (true, false) | (false, true) => {}
        }
    }
    if wrong.is_empty() { Ok(()) } else { bail!("{}", wrong.join("\n")) }
}

#[cfg(test)]
mod tests {
    use super::{Aim, HIGH, aims, judge, table};

    fn judged(what: &'static str, found: Option<f64>) -> Result<(), String> {
        judge(&[Aim { what: "another", at_most: 1.0, found: Some(1.0) }, Aim { what, at_most: 1.0, found }])
            .map_err(|error| error.to_string())
    }

    #[test]
    fn an_aim_that_is_missed_is_named() {
        assert_eq!(judged("buzz, %", Some(1.0)), Ok(()));
        for found in [Some(1.1), Some(f64::NAN), None] {
            let message = judged("buzz, %", found).expect_err("it is missed");
            assert!(message.contains("buzz, %") && message.contains("1.00 at most"), "{message}");
            assert!(!message.contains("another"), "{message}");
        }
    }

    #[test]
    fn what_is_known_to_be_missed_must_be() {
        assert_eq!(judged(HIGH, Some(1.1)), Ok(()));
        let message = judged(HIGH, Some(0.9)).expect_err("it is met");
        assert!(message.contains(HIGH), "{message}");
    }

    /// All that is wrong is told at once, and what stands in the table is what is judged.
    #[test]
    fn what_was_not_measured_is_missed() {
        let aims = aims(&[]);
        let message = judge(&aims).expect_err("nothing was measured").to_string();
        assert_eq!(message.lines().count(), aims.len() - 1, "{message}");
        assert_eq!(table(&aims).matches("**missed**").count(), aims.len());
    }
}
