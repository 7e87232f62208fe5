//! Pages of the documentation that hold a table a command writes.

use std::fs;

use anyhow::{Context, Result};

/// The lines between which a measurement's table stands.
fn marks(measurement: &str) -> [String; 2] {
    [format!("<!-- begin: cargo xtask measure {measurement} -->"), "<!-- end -->".into()]
}

/// The table on a page.
pub fn read(page: &str, measurement: &str) -> Result<String> {
    let text = fs::read_to_string(super::root().join(page)).with_context(|| format!("cannot read {page}"))?;
    let [begin, end] = marks(measurement);
    let inside = text.split_once(&begin).and_then(|(_, rest)| rest.split_once(&end));
    let (table, _) = inside.with_context(|| format!("{page} has no table between its marks"))?;
    Ok(table.to_owned())
}

/// Puts a table into a page.
pub fn write(page: &str, measurement: &str, table: &str) -> Result<()> {
    let path = super::root().join(page);
    let old = fs::read_to_string(&path).with_context(|| format!("cannot read {page}"))?;
    let [begin, end] = marks(measurement);
    let (before, rest) = old.split_once(&begin).with_context(|| format!("{page} lacks `{begin}`"))?;
    let (_, after) = rest.split_once(&end).with_context(|| format!("{page} lacks `{end}`"))?;
    let new = format!("{before}{begin}\n{table}{end}{after}");
    fs::write(path, new).with_context(|| format!("cannot write {page}"))
}
