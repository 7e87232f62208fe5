//! Pages of the documentation that hold tables a command writes, each between two marks.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::files;
use crate::repository::root;

/// The lines between which a measurement's table stands.
pub fn marks(measurement: &str) -> [String; 2] {
    [format!("<!-- begin: cargo xtask measure {measurement} -->"), "<!-- end -->".into()]
}

/// The table on a page, from the root of the repository, between two marks, as it was put there.
pub fn read(page: &str, marks: &[String; 2]) -> Result<String> {
    let text = fs::read_to_string(root().join(page)).with_context(|| format!("cannot read {page}"))?;
    let [_, table, _] = split(page, &text, marks)?;
    // The mark before it has a line of its own.
    Ok(table.strip_prefix('\n').unwrap_or(table).to_owned())
}

/// Puts a table into a page.
pub fn write(page: &str, marks: &[String; 2], table: &str) -> Result<()> {
    let (path, text) = with(page, marks, table)?;
    files::write(&path, text)
}

/// Where a page is, and its text with a table in it.
pub fn with(page: &str, marks: &[String; 2], table: &str) -> Result<(PathBuf, String)> {
    let path = root().join(page);
    let old = fs::read_to_string(&path).with_context(|| format!("cannot read {page}"))?;
    let [before, _, after] = split(page, &old, marks)?;
    let [begin, end] = marks;
    Ok((path, format!("{before}{begin}\n{table}{end}{after}")))
}

/// What stands before, between and after two marks in the text of a page.
fn split<'a>(page: &str, text: &'a str, [begin, end]: &[String; 2]) -> Result<[&'a str; 3]> {
    let (before, rest) = text.split_once(begin).with_context(|| format!("{page} lacks `{begin}`"))?;
    let (inside, after) = rest.split_once(end).with_context(|| format!("{page} lacks `{end}`"))?;
    Ok([before, inside, after])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_that_is_read_and_put_back_changes_nothing() {
        for (page, measurement) in [("docs/speed.md", "speed"), ("docs/trade.md", "trade")] {
            let marks = marks(measurement);
            let table = read(page, &marks).expect("there is a table");
            let (path, text) = with(page, &marks, &table).expect("it has its place");
            assert_eq!(text, fs::read_to_string(path).expect("it is there"), "{page}");
        }
    }
}
