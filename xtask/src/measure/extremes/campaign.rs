//! Many trials on several threads, in chunks whose tallies are kept, so that a run that was stopped goes on
//! where it was.

use std::fs;
use std::hash::Hasher;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use anyhow::{Context, Result};

use super::progress::Progress;
use super::shrink::shrink;
use super::tally::Tally;
use super::trial::{Outcome, Trial};
use crate::files;
use crate::measure::threads;

/// Trials whose tally is kept as one.
const CHUNK: u64 = 250;

/// A run of so many trials from a seed.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// What its files are called by.
    pub name: &'static str,
    /// Draws the trial of a number from a seed.
    pub draw: fn(u64, u64) -> Trial,
    /// Where the random numbers begin.
    pub seed: u64,
    /// Number of trials.
    pub trials: u64,
    /// Threads at work.
    pub threads: usize,
    /// Where tallies are kept and looked for; nowhere, if nothing is to be resumed.
    pub kept: Option<PathBuf>,
    /// Whether what is kept already is thrown away first.
    pub fresh: bool,
    /// Where trials that fail are written, made small.
    pub failures: PathBuf,
}

impl Campaign {
    /// Runs all trials, or those that are left.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn run(&self) -> Result<Tally> {
        let folder = self
            .kept
            .as_ref()
            .map(|kept| this_programs(kept, self.name, self.seed, self.fresh))
            .transpose()?;
        let chunk = |number: u64| number * CHUNK..((number + 1) * CHUNK).min(self.trials);
        let chunks: Vec<_> = (0..self.trials.div_ceil(CHUNK)).map(chunk).collect();
        let look = "{wide_bar} {pos}/{len} trials, {elapsed} of {duration}, {msg}";
        let progress = Progress::new(self.trials, "trials", look)?;
        progress.set_message("no fault".into());
        let faults = AtomicU64::new(0);
        let tallies = threads::try_each(self.threads, &chunks, |_, numbers| -> Result<Tally> {
            let name = format!("{:07}-{:07}.toml", numbers.start, numbers.end);
            let file = folder.as_ref().map(|folder| folder.join(name));
            let mut tally = Tally::default();
            if let Some(known) = file.as_deref().and_then(read) {
                tally = known;
                progress.inc(tally.trials);
            } else {
                for number in numbers.clone() {
                    tally.count(number, &self.one(number)?);
                    progress.inc(1);
                }
                if let Some(file) = &file {
                    files::write(file, toml::to_string(&tally)?)?;
                }
            }
            let count = tally.faults.len() as u64;
            if faults.fetch_add(count, Ordering::Relaxed) + count > 0 {
                progress.set_message(format!("{} faults", faults.load(Ordering::Relaxed)));
            }
            Ok(tally)
        })?;
        progress.finish();
        // In order, so that sums are the same whatever the threads did.
        let mut sum = Tally::default();
        tallies.iter().for_each(|tally| sum.add(tally));
        Ok(sum)
    }

    /// Runs one trial; writes it down, made small, if it fails.
    fn one(&self, number: u64) -> Result<Outcome> {
        let trial = (self.draw)(self.seed, number);
        let outcome = trial.run();
        if let Outcome::Computed(record) = &outcome
            && let Some(fault) = &record.fault
        {
            let small = shrink(&trial, fault);
            let (name, seed) = (self.name, self.seed);
            let text = format!("# {number} of the {name} of seed {seed}: {fault}.\n\n{}", small.to_toml());
            fs::create_dir_all(&self.failures)?;
            files::write(&self.failures.join(format!("seed-{seed}-{name}-{number}.toml")), text)?;
        }
        Ok(outcome)
    }
}

/// The folder of what this very program has tallied from a seed: one built anew begins anew.
fn this_programs(kept: &Path, name: &str, seed: u64, fresh: bool) -> Result<PathBuf> {
    let program = fs::read(std::env::current_exe()?).context("the program itself")?;
    let mut hasher = std::hash::DefaultHasher::new();
    hasher.write(&program);
    let folder = kept.join(format!("{:016x}-seed-{seed}-{name}", hasher.finish()));
    if fresh && folder.is_dir() {
        fs::remove_dir_all(&folder).with_context(|| format!("{}", folder.display()))?;
    }
    fs::create_dir_all(&folder).with_context(|| format!("{}", folder.display()))?;
    Ok(folder)
}

fn read(file: &Path) -> Option<Tally> {
    toml::from_str(&fs::read_to_string(file).ok()?).ok()
}
