//! What criterion found.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::repository::root;

/// Benchmarks as a run has left them.
pub struct Timed {
    folder: PathBuf,
    /// What was found before is of another run, if only one of those counts.
    since: Option<SystemTime>,
}

impl Timed {
    /// Those of a run that began then, or whatever is there.
    pub fn since(since: Option<SystemTime>) -> Timed {
        let target =
            std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| Path::new("target").into(), PathBuf::from);
        Timed { folder: root().join(target).join("criterion"), since }
    }

    /// Median time of a benchmark's iterations, ns: neighbours on the machine move it less than the mean.
    pub fn median(&self, group: &str, name: &str) -> Result<f64> {
        let estimates = self.read(group, name, "estimates.json")?;
        let point = estimates["median"]["point_estimate"].as_f64();
        point.with_context(|| format!("`{group}/{name}` has no median"))
    }

    /// How much of what it is measured by there is in one iteration.
    pub fn elements(&self, group: &str, name: &str) -> Result<f64> {
        let benchmark = self.read(group, name, "benchmark.json")?;
        let elements = benchmark["throughput"]["Elements"].as_f64();
        elements.with_context(|| format!("`{group}/{name}` does not say how much it does"))
    }

    fn read(&self, group: &str, name: &str, file: &str) -> Result<Value> {
        let file = self.folder.join(group).join(name).join("new").join(file);
        let text = std::fs::read_to_string(&file).with_context(|| {
            format!("`{group}/{name}` has not been timed: {} cannot be read", file.display())
        })?;
        if let Some(since) = self.since {
            let written = file.metadata().and_then(|known| known.modified());
            ensure!(
                written.with_context(|| format!("{} has no age", file.display()))? >= since,
                "`{group}/{name}` has not been timed in this run: {} is older",
                file.display()
            );
        }
        serde_json::from_str(&text).with_context(|| format!("{} cannot be read", file.display()))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::time::Duration;

    use super::*;

    #[test]
    fn what_an_earlier_run_found_is_refused() {
        let folder = std::env::temp_dir().join(format!("low-action-criterion-{}", std::process::id()));
        let inner = folder.join("points/48 kHz/new");
        fs::create_dir_all(&inner).expect("it can be made");
        let write = |file: &str, text: &str| fs::write(inner.join(file), text).expect("it can be written");
        write("estimates.json", r#"{ "median": { "point_estimate": 5.0 } }"#);
        write("benchmark.json", r#"{ "throughput": { "Elements": 724800 } }"#);
        let now = SystemTime::now();
        let timed = |since| Timed { folder: folder.clone(), since };
        for since in [None, Some(now - Duration::from_secs(60))] {
            assert_eq!(timed(since).median("points", "48 kHz").expect("it is there"), 5.0);
            assert_eq!(timed(since).elements("points", "48 kHz").expect("it is there"), 724_800.0);
        }
        let later = timed(Some(now + Duration::from_secs(60)));
        let refused = later.median("points", "48 kHz").expect_err("it is of another run").to_string();
        assert!(refused.contains("points/48 kHz") && refused.contains("older"), "{refused}");
        assert!(timed(None).median("points", "96 kHz").is_err());
        fs::remove_dir_all(&folder).expect("it is there");
    }
}
