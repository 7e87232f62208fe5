//! Nothing blows up: random scenes and event streams that are absurd but legal.

use anyhow::{Result, bail};

/// Runs the measurement.
pub fn run(_arguments: Vec<String>) -> Result<()> {
    bail!("not measured yet")
}
