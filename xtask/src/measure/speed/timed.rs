//! What criterion found.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result};
use serde_json::Value;

use crate::repository::root;

/// Benchmarks, as one round or several have found them.
#[derive(Default)]
pub struct Timed {
    /// By group and name.
    found: BTreeMap<(String, String), Found>,
}

/// What was found of a benchmark.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Found {
    /// Time of an iteration in the fastest of criterion's samples, ns: whatever else the machine does can only make one longer.
    fastest: f64,
    /// How much of what it is measured by there is in one, where it says so.
    elements: Option<f64>,
}

/// Where criterion puts what it finds.
pub fn folder() -> PathBuf {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| Path::new("target").into(), PathBuf::from);
    root().join(target).join("criterion")
}

impl Timed {
    /// Takes up a round that criterion has left in a folder. Of several rounds the shortest time of a benchmark counts, too: a
    /// neighbour that is busy for a while then falls on none of them. What was written before `since` is of another run and does not count.
    pub fn add_round(&mut self, folder: &Path, since: Option<SystemTime>) -> Result<()> {
        for group in folders(folder)? {
            for name in folders(&folder.join(&group))? {
                let inner = folder.join(&group).join(&name).join("new");
                let Some(found) = read(&inner, since).with_context(|| format!("`{group}/{name}`"))? else {
                    continue;
                };
                let known = self.found.entry((group.clone(), name)).or_insert(found);
                known.fastest = known.fastest.min(found.fastest);
            }
        }
        Ok(())
    }

    /// Time of a benchmark's iterations in the fastest sample of its best round, ns.
    pub fn fastest(&self, group: &str, name: &str) -> Result<f64> {
        Ok(self.of(group, name)?.fastest)
    }

    /// How much of what it is measured by there is in one iteration.
    pub fn elements(&self, group: &str, name: &str) -> Result<f64> {
        let elements = self.of(group, name)?.elements;
        elements.with_context(|| format!("`{group}/{name}` does not say how much it does"))
    }

    fn of(&self, group: &str, name: &str) -> Result<&Found> {
        let found = self.found.get(&(group.into(), name.into()));
        found.with_context(|| format!("`{group}/{name}` has not been timed in this run"))
    }
}

/// The folders in a folder, without the summaries that criterion leaves there.
fn folders(folder: &Path) -> Result<Vec<String>> {
    let entries = std::fs::read_dir(folder)
        .with_context(|| format!("nothing has been timed: {} cannot be read", folder.display()))?;
    let mut names = Vec::new();
    for entry in entries {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.file_type()?.is_dir() && name != "report" {
            names.push(name);
        }
    }
    Ok(names)
}

/// What one benchmark has left, if it is of this run.
fn read(folder: &Path, since: Option<SystemTime>) -> Result<Option<Found>> {
    let json = |name: &str| -> Result<Option<Value>> {
        let file = folder.join(name);
        // What a run that was broken off has left is none.
        let Ok(age) = file.metadata().and_then(|known| known.modified()) else { return Ok(None) };
        if since.is_some_and(|since| age < since) {
            return Ok(None);
        }
        let text = std::fs::read_to_string(&file).with_context(|| format!("{}", file.display()))?;
        Ok(Some(serde_json::from_str(&text).with_context(|| format!("{}", file.display()))?))
    };
    let (Some(sample), Some(benchmark)) = (json("sample.json")?, json("benchmark.json")?) else {
        return Ok(None);
    };
    let numbers =
        |name: &str| sample[name].as_array().map_or(&[][..], Vec::as_slice).iter().map(Value::as_f64);
    let each = numbers("times").zip(numbers("iters")).map(|(time, count)| Some(time? / count?));
    let fastest = each.collect::<Option<Vec<f64>>>().context("it has times that are none")?;
    let fastest = fastest.into_iter().reduce(f64::min).context("it has no times")?;
    Ok(Some(Found { fastest, elements: benchmark["throughput"]["Elements"].as_f64() }))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::time::Duration;

    use super::*;

    #[test]
    fn the_best_round_counts_and_none_of_an_earlier_run() {
        let folder = std::env::temp_dir().join(format!("low-action-criterion-{}", std::process::id()));
        let inner = folder.join("points/48 kHz/new");
        fs::create_dir_all(&inner).expect("it can be made");
        fs::create_dir_all(folder.join("points/report")).expect("it can be made");
        fs::create_dir_all(folder.join("frets/100/base")).expect("it can be made");
        let write = |file: &str, text: &str| fs::write(inner.join(file), text).expect("it can be written");
        let sample = |found: f64| {
            let times = [3.0 * found, 2.0 * found, 4.5 * found];
            write("sample.json", &format!(r#"{{ "iters": [1.0, 2.0, 3.0], "times": {times:?} }}"#));
            write("benchmark.json", r#"{ "throughput": { "Elements": 724800 } }"#);
        };
        let (now, minute) = (SystemTime::now(), Duration::from_secs(60));
        let mut timed = Timed::default();
        for (found, best) in [(7.0, 7.0), (5.0, 5.0), (6.0, 5.0)] {
            sample(found);
            timed.add_round(&folder, Some(now - minute)).expect("it can be read");
            assert_eq!(timed.fastest("points", "48 kHz").expect("it is there"), best);
            assert_eq!(timed.elements("points", "48 kHz").expect("it is there"), 724_800.0);
        }
        let mut later = Timed::default();
        later.add_round(&folder, Some(now + minute)).expect("it can be read");
        let refused = later.fastest("points", "48 kHz").expect_err("it is of another run").to_string();
        assert!(refused.contains("points/48 kHz"), "{refused}");
        let mut last = Timed::default();
        last.add_round(&folder, None).expect("it can be read");
        assert_eq!(last.fastest("points", "48 kHz").expect("it is there"), 6.0);
        assert!(last.fastest("points", "96 kHz").is_err());
        fs::remove_dir_all(&folder).expect("it is there");
        assert!(last.add_round(&folder, None).is_err());
    }
}
