//! What many trials came to, and the tables made of it.

use std::collections::BTreeMap;
use std::fmt::Write;

use indicatif::HumanCount;
use serde::{Deserialize, Serialize};

use super::balance::TOLERANCE;
use super::trial::{Outcome, Record};

/// Counts over many trials; two tallies add up.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
pub struct Tally {
    /// Trials drawn.
    pub trials: u64,
    /// Trials that were computed under a stream of events.
    pub streams: u64,
    /// Grid points times samples.
    pub point_samples: u64,
    /// Samples of a string with contacts to solve.
    pub solved: u64,
    /// The most contacts at once.
    pub contacts: u32,
    /// Trials in which the numbers themselves are worth more than the tolerance.
    pub coarse: u64,
    /// Trials that made use of that.
    pub beyond: u64,
    /// The most energy above what was put in, as a part of it, where the tolerance alone decides.
    pub created: f64,
    /// The most that a balance was open, likewise.
    pub open: f64,
    /// Instruments that took over from others, and those of them on which strings rang on.
    pub exchanges: [u64; 2],
    /// Those that were turned away while another was still fading.
    pub turned_away: u64,
    /// Trials in which board or frets stood above a string at rest.
    pub raised: u64,
    /// Refusals by reason.
    pub refused: BTreeMap<String, u64>,
    /// By cap of the solver; the key is its decimal digits.
    pub caps: BTreeMap<String, Cap>,
    /// Trials that broke a promise, and how.
    pub faults: BTreeMap<String, String>,
}

/// Counts over the trials of one cap.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, Serialize)]
pub struct Cap {
    /// Trials with contacts.
    pub trials: u64,
    /// Samples with contacts.
    pub solved: u64,
    /// Newton iterations in them.
    pub iterations: u64,
    /// Attempts of the fallback in them.
    pub fallbacks: u64,
    /// Sum over trials of the part of the energy put in that the solver took.
    pub lost: f64,
    /// Trials that lost less than a thousandth, a hundredth, a tenth.
    pub little: [u64; 3],
}

/// What [`Cap::little`] counts.
const LITTLE: [f64; 3] = [1e-3, 1e-2, 1e-1];

impl Tally {
    /// Counts a trial.
    pub fn count(&mut self, number: u64, outcome: &Outcome) {
        self.trials += 1;
        match outcome {
            Outcome::Refused(reason) => *self.refused.entry(kind(reason)).or_default() += 1,
            Outcome::Computed(record) => self.count_computed(number, record),
        }
    }

    fn count_computed(&mut self, number: u64, record: &Record) {
        self.streams += u64::from(record.stream);
        self.point_samples += record.point_samples;
        self.solved += record.solved;
        self.contacts = self.contacts.max(record.contacts);
        self.coarse += u64::from(record.rounding > TOLERANCE);
        self.count_exchanges(record.exchanges, record.turned_away, u64::from(record.raised));
        if let Some(fault) = record.fault {
            self.faults.insert(number.to_string(), fault.to_string());
            return;
        }
        if record.created.max(record.open) > TOLERANCE {
            self.beyond += 1;
        } else {
            self.created = self.created.max(record.created);
            self.open = self.open.max(record.open);
        }
        if record.solved > 0 {
            let cap = self.caps.entry(record.cap.to_string()).or_default();
            cap.trials += 1;
            cap.solved += record.solved;
            cap.iterations += record.iterations;
            cap.fallbacks += record.fallbacks;
            cap.lost += record.lost;
            for (count, limit) in cap.little.iter_mut().zip(LITTLE) {
                *count += u64::from(record.lost < limit);
            }
        }
    }

    /// Adds what another tally counted. The order in which tallies are added decides the last digits of sums.
    pub fn add(&mut self, other: &Tally) {
        self.trials += other.trials;
        self.streams += other.streams;
        self.point_samples += other.point_samples;
        self.solved += other.solved;
        self.contacts = self.contacts.max(other.contacts);
        self.coarse += other.coarse;
        self.beyond += other.beyond;
        self.created = self.created.max(other.created);
        self.open = self.open.max(other.open);
        self.count_exchanges(other.exchanges, other.turned_away, other.raised);
        for (reason, count) in &other.refused {
            *self.refused.entry(reason.clone()).or_default() += count;
        }
        for (cap, more) in &other.caps {
            let cap = self.caps.entry(cap.clone()).or_default();
            cap.trials += more.trials;
            cap.solved += more.solved;
            cap.iterations += more.iterations;
            cap.fallbacks += more.fallbacks;
            cap.lost += more.lost;
            for (count, more) in cap.little.iter_mut().zip(more.little) {
                *count += more;
            }
        }
        self.faults.extend(other.faults.clone());
    }

    fn count_exchanges(&mut self, exchanges: [u64; 2], turned_away: u64, raised: u64) {
        for (count, more) in self.exchanges.iter_mut().zip(exchanges) {
            *count += more;
        }
        self.turned_away += turned_away;
        self.raised += raised;
    }

    /// What trials of exchanges came to, in a few lines.
    pub fn exchanges_in_words(&self) -> String {
        let [all, carried] = self.exchanges.map(HumanCount);
        format!(
            "{all} instruments took over from others, of {carried} of which the strings rang on, and {} were turned away\n\
             in {} trials board or frets stood above a string at rest\n\
             energy above what was put in, at most {:.0e} of it; balance open, at most {:.0e}\n\
             rounding alone may be more than 1e-9 in {}, and was in {}; {} refused, {} broke a promise",
            HumanCount(self.turned_away),
            HumanCount(self.raised),
            self.created,
            self.open,
            HumanCount(self.coarse),
            HumanCount(self.beyond),
            self.refused.values().sum::<u64>(),
            self.faults.len(),
        )
    }

    /// The tables, as Markdown.
    pub fn tables(&self) -> String {
        let mut text = String::new();
        let refused: u64 = self.refused.values().sum();
        let percent = |count: u64, of: u64| 100.0 * count as f64 / (of.max(1)) as f64;
        let mut row =
            |name: &str, value: String| writeln!(text, "| {name} | {value} |").expect("it is a string");
        row("what", "count".into());
        row("---", "---".into());
        row("trials", HumanCount(self.trials).to_string());
        row("with a stream of events", HumanCount(self.streams).to_string());
        row("grid points × samples", HumanCount(self.point_samples).to_string());
        row("string-samples with contacts", HumanCount(self.solved).to_string());
        row("most contacts at once", self.contacts.to_string());
        row("**not finite, energy created, or balance open**", format!("**{}**", self.faults.len()));
        row("energy above what was put in, at most", format!("{:.0e} of it", self.created));
        row("balance open, at most", format!("{:.0e} of what was put in", self.open));
        row("rounding alone may be more than 1e-9", HumanCount(self.coarse).to_string());
        row("of these, it was", HumanCount(self.beyond).to_string());
        row("refused", format!("{refused} ({:.2} %)", percent(refused, self.trials)));
        for (reason, count) in &self.refused {
            row(&format!("refused: {reason}"), count.to_string());
        }
        text += "\n| cap | trials with contact | lost < 0.1 % | < 1 % | < 10 % | mean loss | iterations | fallbacks |\n";
        text += "|---|---|---|---|---|---|---|---|\n";
        let mut caps: Vec<_> =
            self.caps.iter().filter_map(|(cap, counts)| Some((cap.parse::<u64>().ok()?, counts))).collect();
        caps.sort_by_key(|(cap, _)| *cap);
        for (cap, counts) in caps {
            let [a, b, c] = counts.little.map(|count| format!("{:.1} %", percent(count, counts.trials)));
            let each = |count: u64| count as f64 / counts.solved.max(1) as f64;
            writeln!(
                text,
                "| {cap} | {} | {a} | {b} | {c} | {:.1} % | {:.2} | {:.3} |",
                HumanCount(counts.trials),
                100.0 * counts.lost / counts.trials.max(1) as f64,
                each(counts.iterations),
                each(counts.fallbacks),
            )
            .expect("it is a string");
        }
        text
    }
}

/// A refusal without its numbers, so that refusals for one reason count as one.
fn kind(reason: &str) -> String {
    let (thing, accepted) = reason.split_once(" is refused: ").unwrap_or((reason, ""));
    let name = thing.split(" = ").next().unwrap_or(thing);
    let name: String = name.chars().filter(|c| !c.is_ascii_digit() && !"[]".contains(*c)).collect();
    let until_number = accepted.find(|c: char| c.is_ascii_digit()).unwrap_or(accepted.len());
    format!("{name}, {}", accepted[..until_number].trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped_and_left_out() {
        assert_eq!(HumanCount(0).to_string(), "0");
        assert_eq!(HumanCount(1_234_567).to_string(), "1,234,567");
        let reason = "string[1].length = 0.3 is refused: it must be at least 0.4 m";
        assert_eq!(kind(reason), "string.length, it must be at least");
    }
}
