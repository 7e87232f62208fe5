//! How far a long run is: a bar on a terminal, elsewhere a line for each tenth.

use std::sync::atomic::{AtomicU64, Ordering};

use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};

/// How far it is.
pub struct Progress {
    bar: ProgressBar,
    /// What is counted.
    what: &'static str,
    /// Tenths that have been told of.
    told: AtomicU64,
}

impl Progress {
    /// Of a run that has so much to do; `template` is how the bar looks.
    pub fn new(all: u64, what: &'static str, template: &str) -> Result<Progress> {
        let bar = ProgressBar::new(all).with_style(ProgressStyle::with_template(template)?);
        Ok(Progress { bar, what, told: AtomicU64::new(0) })
    }

    /// So much more is done.
    pub fn inc(&self, more: u64) {
        self.bar.inc(more);
        let (done, all) = (self.bar.position(), self.bar.length().unwrap_or(0));
        let tenths = tenths(done, all);
        if self.bar.is_hidden() && self.told.fetch_max(tenths, Ordering::Relaxed) < tenths {
            let message = self.bar.message();
            let comma = if message.is_empty() { "" } else { ", " };
            eprintln!("{} % of {all} {}{comma}{message}", 10 * tenths, self.what);
        }
    }

    /// Says how it goes, beside how far it is.
    pub fn set_message(&self, message: String) {
        self.bar.set_message(message);
    }

    /// Prints a line above it.
    pub fn println(&self, line: &str) {
        self.bar.suspend(|| println!("{line}"));
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Whole tenths of all that are done.
fn tenths(done: u64, all: u64) -> u64 {
    (10 * done).checked_div(all).unwrap_or(10).min(10)
}

#[cfg(test)]
mod tests {
    use super::tenths;

    #[test]
    fn tenths_are_whole() {
        assert_eq!([0, 9, 10, 99, 100, 120].map(|done| tenths(done, 100)), [0, 0, 1, 9, 10, 10]);
        assert_eq!(tenths(0, 0), 10);
    }
}
